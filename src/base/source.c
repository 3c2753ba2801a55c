/* Source text: reads a file whole, and finds lines and columns in it. Only errors need positions, so they are counted
 * from the beginning each time instead of being kept for every token. */
#define _DEFAULT_SOURCE /* madvise */
#include "base/source.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/input.h"
#include "base/memory.h"

enum {
  TEXT_PADDING = 2,          /* the NULs after the text, for scanners that want a sentinel */
  READ_STEP_BYTES = 1 << 16, /* first guess for an input without a size, such as a pipe */
  LONG_BYTES = 1 << 24,      /* a file longer than this stays open, so that its text can be dropped ... */
  DROP_STEP_BYTES = 1 << 20, /* ... in pieces of this size or more */
  DROP_ALIGNMENT = 1 << 16   /* covers whole pages of any size; at least this much before the end stays */
};

/* A file that stays open, because text[begin .. end-1] has been dropped. */
struct source_rest {
  int file; /* -1: nothing is dropped any more */
  size_t begin, end;
};

static struct source *source_create(const char *name)
{
  struct source *source = memory_alloc(1, sizeof *source);
  if (!source) return NULL;
  source->name = memory_copy_text(name);
  if (!source->name) {
    memory_free(source);
    return NULL;
  }
  return source;
}

static enum status grow_text(struct source *source, size_t *capacity, size_t wanted)
{
  if (wanted > SOURCE_MAX_BYTES + 1) wanted = SOURCE_MAX_BYTES + 1;
  char *text = memory_resize(source->text, wanted + TEXT_PADDING);
  if (!text) return STATUS_LIMIT;
  source->text = text;
  *capacity = wanted;
  return STATUS_OK;
}

/* Reads to the end of the file. The size known beforehand is only a guess, but if it is too large, so is the file. */
static enum status read_all(struct source *source, int file, size_t guess, const char **out_reason)
{
  size_t capacity;
  if (grow_text(source, &capacity, guess) != STATUS_OK) return STATUS_LIMIT;
  for (;;) {
    if (source->length > SOURCE_MAX_BYTES || guess > SOURCE_MAX_BYTES + 1) {
      *out_reason = "it is longer than 1 GiB";
      return STATUS_LIMIT;
    }
    if (source->length == capacity && grow_text(source, &capacity, 2 * capacity) != STATUS_OK) return STATUS_LIMIT;
    ssize_t got = read(file, source->text + source->length, capacity - source->length);
    if (got == 0) break;
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) {
      *out_reason = input_reason(errno);
      return STATUS_FILE;
    }
    source->length += (size_t)got;
  }
  memset(source->text + source->length, 0, TEXT_PADDING);
  return STATUS_OK;
}

enum status source_read(const char *path, enum input_kind kind, struct source **out_source, const char **out_reason)
{
  const int file = input_open(path, kind, out_reason);
  return file < 0 ? STATUS_FILE : source_read_open(path, file, out_source, out_reason);
}

enum status source_read_open(const char *name, int file, struct source **out_source, const char **out_reason)
{
  *out_reason = input_reason(ENOMEM);
  struct source *source = source_create(name);
  enum status status = source == NULL ? STATUS_LIMIT : STATUS_FILE;
  struct stat info;
  if (source == NULL) goto done;
  if (fstat(file, &info) != 0) {
    *out_reason = input_reason(errno);
    goto done;
  }
  source->device = (uint64_t)info.st_dev;
  source->inode = (uint64_t)info.st_ino;
  size_t guess = READ_STEP_BYTES;
  if (S_ISREG(info.st_mode) && info.st_size > 0) guess = (size_t)info.st_size + 1; /* one more, to see the end */
  status = read_all(source, file, guess, out_reason);
  if (status == STATUS_OK && S_ISREG(info.st_mode) && source->length > LONG_BYTES && memory_is_libcs()) {
    source->rest = memory_alloc(1, sizeof *source->rest);
    if (source->rest) source->rest->file = file;
  }
done:
  if (!source || !source->rest) (void)close(file);
  if (status == STATUS_OK) *out_source = source;
  else source_destroy(source);
  return status;
}

void source_drop(const struct source *source, size_t end)
{
#if defined(MADV_DONTNEED)
  struct source_rest *rest = source->rest;
  if (!rest || rest->file < 0 || end < rest->end + DROP_STEP_BYTES) return;
  const size_t misaligned = (uintptr_t)source->text % DROP_ALIGNMENT;
  if (rest->end == 0) rest->begin = rest->end = (DROP_ALIGNMENT - misaligned) % DROP_ALIGNMENT;
  const size_t from = rest->end, to = end - DROP_ALIGNMENT - (misaligned + end) % DROP_ALIGNMENT;
  if (madvise(source->text + from, to - from, MADV_DONTNEED) == 0) rest->end = to;
#else
  (void)source, (void)end;
#endif
}

void source_recall(const struct source *source)
{
  struct source_rest *rest = source->rest;
  if (!rest || rest->file < 0) return;
  for (size_t at = rest->begin; at < rest->end;) {
    const ssize_t got = pread(rest->file, source->text + at, rest->end - at, (off_t)at);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) break;
    at += (size_t)got;
  }
  (void)close(rest->file);
  rest->file = -1;
}

bool source_identify(const char *path, uint64_t *out_device, uint64_t *out_inode)
{
  struct stat info;
  if (stat(path, &info) != 0) return false;
  *out_device = (uint64_t)info.st_dev;
  *out_inode = (uint64_t)info.st_ino;
  return true;
}

struct source *source_share(const struct source *source, const char *path)
{
  struct source *other = source_create(path);
  if (!other) return NULL;
  source_recall(source);
  other->text = source->text;
  other->length = source->length;
  other->device = source->device;
  other->inode = source->inode;
  other->shared = true;
  return other;
}

struct source *source_from_text(const char *name, const char *text, size_t length)
{
  struct source *source = source_create(name);
  if (!source) return NULL;
  size_t capacity;
  if (length > SOURCE_MAX_BYTES || grow_text(source, &capacity, length) != STATUS_OK) {
    source_destroy(source);
    return NULL;
  }
  if (length > 0) memcpy(source->text, text, length);
  memset(source->text + length, 0, TEXT_PADDING);
  source->length = length;
  return source;
}

size_t source_character(const char *text, size_t length)
{
  const unsigned char *byte = (const unsigned char *)text;
  if (byte[0] < 0x80) return 1;
  size_t count = byte[0] >= 0xF0 ? 4 : byte[0] >= 0xE0 ? 3 : 2;
  if (byte[0] < 0xC2 || byte[0] > 0xF4 || count > length) return 0;
  for (size_t i = 1; i < count; i++)
    if ((byte[i] & 0xC0) != 0x80) return 0;
  /* Overlong forms, surrogates, and values beyond U+10FFFF (RFC 3629). */
  if ((byte[0] == 0xE0 && byte[1] < 0xA0) || (byte[0] == 0xED && byte[1] > 0x9F)) return 0;
  if ((byte[0] == 0xF0 && byte[1] < 0x90) || (byte[0] == 0xF4 && byte[1] > 0x8F)) return 0;
  return count;
}

bool source_is_shown(const char *text, size_t bytes)
{
  const unsigned char *c = (const unsigned char *)text;
  return bytes > 2 || (bytes == 2 && !(c[0] == 0xC2 && c[1] < 0xA0)) || (bytes == 1 && c[0] >= ' ' && c[0] != 0x7F);
}

/* Whether a line ends with that byte: LF, or a CR that no LF follows. */
static bool ends_line(const char *byte) { return *byte == '\n' || (*byte == '\r' && byte[1] != '\n'); }

size_t source_skip(const char *text, size_t length)
{
  uint64_t eight;
  if (length < sizeof eight) return 0;
  memcpy(&eight, text, sizeof eight);
  return eight & UINT64_C(0x8080808080808080) ? 0 : sizeof eight;
}

/* Line ends are counted in blocks of COUNTED bytes, without finding where they are. Of a line, LINE_AFTER bytes after
 * the place are examined, more than are shown. */
enum { COUNTED = 4096, LINE_AFTER = 4096 };

struct source_position source_locate(const struct source *source, size_t offset)
{
  const char *text = source->text;
  source_recall(source);
  if (offset > source->length) offset = source->length;
  struct source_position at = {.line = source->lines_before + 1, .column = 1};
  for (size_t begin = 0, end; begin < offset; begin = end) {
    const size_t before = at.line;
    end = offset - begin < COUNTED ? offset : begin + COUNTED;
    for (size_t i = begin; i < end; i++) at.line += ends_line(text + i);
    if (at.line > before) at.line_begin = end;
  }
  while (at.line_begin > 0 && !ends_line(text + at.line_begin - 1)) at.line_begin--;
  at.line_end = offset;
  const size_t farthest = source->length - offset < LINE_AFTER ? source->length : offset + LINE_AFTER;
  while (at.line_end < farthest && !ends_line(text + at.line_end)) at.line_end++;
  if (at.line_end > at.line_begin && text[at.line_end - 1] == '\r') at.line_end--;
  for (size_t i = at.line_begin; i < offset;) {
    const size_t skipped = source_skip(text + i, offset - i), bytes = source_character(text + i, source->length - i);
    i += skipped ? skipped : bytes ? bytes : 1;
    at.column += skipped ? skipped : 1;
  }
  return at;
}

void source_destroy(struct source *source)
{
  if (!source) return;
  memory_free(source->name);
  if (source->rest && source->rest->file >= 0) (void)close(source->rest->file);
  memory_free(source->rest);
  if (!source->shared) memory_free(source->text);
  memory_free(source);
}

/* ---- the file that an #include names ---- */

/* The path of the file of that name and ending in a folder, which is folder[0 .. length-1] with or without a final
 * slash. */
static char *path_in(struct arena *arena, const char *folder, size_t folder_length, const char *name, size_t length,
                     const char *ending)
{
  const size_t before = name[0] == '/' ? 0 : folder_length, size = before + length + strlen(ending) + 2;
  const char *slash = before > 0 && folder[before - 1] != '/' ? "/" : "";
  char *path = arena_alloc(arena, size, 1);
  if (path) snprintf(path, size, "%.*s%s%.*s%s", (int)before, folder, slash, (int)length, name, ending);
  return path;
}

/* The length of a file's folder in its name, slash included. */
static size_t length_of_folder(const struct source *source)
{
  const char *slash = strrchr(source->name, '/');
  return slash ? (size_t)(slash - source->name) + 1 : 0;
}

/* The k-th folder to look in, or NULL. */
static const char *folder_at(const struct include_folders *folders, size_t k, size_t *out_length)
{
  if (k > 1) {
    const char *folder = folders->others ? folders->others[k - 2] : NULL;
    *out_length = folder ? strlen(folder) : 0;
    return folder;
  }
  const struct source *source = k == 0 ? folders->scene : folders->includer;
  *out_length = length_of_folder(source);
  return source->name;
}

/* The path with that ending. */
static char *path_of(struct arena *arena, const struct include_folders *folders, const char *name, size_t length,
                     const char *ending, uint64_t *out_device, uint64_t *out_inode)
{
  char *beside = NULL;
  const char *folder;
  size_t folder_length;
  for (size_t k = folders->scene == folders->includer; (folder = folder_at(folders, k, &folder_length)) != NULL; k++) {
    char *path = path_in(arena, folder, folder_length, name, length, ending);
    if (!path || source_identify(path, out_device, out_inode)) return path;
    if (k == 1) beside = path;
  }
  *out_device = *out_inode = 0;
  return beside;
}

char *include_path(struct arena *arena, const struct include_folders *folders, const char *name, size_t length,
                   uint64_t *out_device, uint64_t *out_inode)
{
  static const char *const endings[] = {".inc", ".INC", ""};
  const char *end = length < 4 ? "" : name + length - 4;
  const bool whole = strncmp(end, ".inc", 4) == 0 || strncmp(end, ".INC", 4) == 0;
  char *path = NULL;
  *out_inode = 0;
  for (int k = whole ? 2 : 0; k < 3 && *out_inode == 0; k++) {
    path = path_of(arena, folders, name, length, endings[k], out_device, out_inode);
    if (!path) return NULL;
  }
  return path;
}

bool include_is_modest(const char *name, size_t length)
{
  bool modest = length > 0 && name[0] != '/';
  for (size_t begin = 0, end; begin < length && modest; begin = end + 1) {
    for (end = begin; end < length && name[end] != '/';) end++;
    modest = !(end - begin == 2 && memcmp(name + begin, "..", 2) == 0);
  }
  return modest;
}

bool include_is_below(const struct include_folders *folders, int file)
{
  const struct source *scene = folders->scene;
  const size_t length = length_of_folder(scene);
  bool below = (scene->inode != 0 || length > 0) && input_is_below(file, scene->name, length);
  for (size_t k = 0; folders->others && folders->others[k] && !below; k++)
    below = input_is_below(file, folders->others[k], strlen(folders->others[k]));
  return below;
}

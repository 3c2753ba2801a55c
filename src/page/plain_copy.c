/* Scene text without solver statements. The language's own scanner finds them, so comments and strings are left
 * alone. */
#include "page/plain_copy.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "base/source.h"
#include "language/scan.h"
#include "language/words.h"

enum {
  MAX_FILES = 10000,
  MAX_NAME = 4096,
  MOST_KEPT = 250 /* bytes of a file's name: with its number and the -, at most the 255 that a file system takes */
};

/* The files met so far; [0] is the scene. Each is copied once, wherever it is included from. */
struct copies {
  struct arena *arena; /* of paths */
  struct source **source;
  size_t count, room;
  const char *folder, *name;
  const char *const *folders; /* more folders to look in */
  const char *reason;
  char *word; /* the first one that reads or writes files, or "" */
};

/* A copy being written: the text up to `done` is in the file. */
struct copy {
  struct copies *all;
  const struct source *source;
  struct scan scan;
  jmp_buf broken; /* for the scanner */
  FILE *file;
  size_t done;
  enum status status;
};

static void copy_name(const struct copies *copies, size_t index, char out[MAX_NAME])
{
  if (index == 0) {
    snprintf(out, MAX_NAME, "%s", copies->name);
    return;
  }
  const char *path = copies->source[index]->name, *slash = strrchr(path, '/');
  snprintf(out, MAX_NAME, "%zu-%.*s", index, MOST_KEPT, slash == NULL ? path : slash + 1);
}

/* Takes a source over. Returns its index, also if the file is known already; MAX_FILES if there is no room. */
static size_t add_source(struct copies *copies, struct source *source)
{
  for (size_t k = 0; k < copies->count; k++) {
    const struct source *other = copies->source[k];
    if (other->device == source->device && other->inode == source->inode && source->inode != 0) {
      source_destroy(source);
      return k;
    }
  }
  struct source **list = copies->count == MAX_FILES
                           ? NULL
                           : memory_grow(copies->source, &copies->room, copies->count + 1, sizeof *list);
  if (list == NULL) {
    source_destroy(source);
    return MAX_FILES;
  }
  copies->source = list;
  copies->source[copies->count] = source;
  return copies->count++;
}

static void put(struct copy *copy, const char *text, size_t length)
{
  if (copy->status == STATUS_OK && fwrite(text, 1, length, copy->file) != length) {
    copy->all->reason = strerror(errno);
    copy->status = STATUS_FILE;
  }
}

/* Writes the unwritten text before byte `end`. */
static void put_until(struct copy *copy, size_t end)
{
  put(copy, copy->source->text + copy->done, end - copy->done);
  copy->done = end;
}

/* Writes blanks for it, but keeps its lines. */
static void blank_until(struct copy *copy, size_t end)
{
  for (; copy->done < end; copy->done++) put(copy, copy->source->text[copy->done] == '\n' ? "\n" : " ", 1);
}

/* Reads the file that the language would include, or returns NULL. */
static struct source *read_included(const struct copy *copy, const char *name, size_t length)
{
  const struct include_folders folders = {copy->all->source[0], copy->source, copy->all->folders};
  struct source *source;
  const char *reason;
  uint64_t device, inode;
  const char *path = include_path(copy->all->arena, &folders, name, length, &device, &inode);
  if (path == NULL) return NULL;
  return source_read(path, INPUT_FILE, &source, &reason) == STATUS_OK ? source : NULL;
}

/* Notes the last token, and what is before it, as something that reads or writes files. */
static void note_word(struct copy *copy, const char *before)
{
  const struct scan *scan = &copy->scan;
  const int length = scan->end - scan->begin < 40 ? (int)(scan->end - scan->begin) : 40;
  if (copy->all->word[0] == '\0')
    snprintf(copy->all->word, PLAIN_COPY_WORD_SIZE, "%s%.*s in '%.300s'", before, length,
             copy->source->text + scan->begin, copy->source->name);
}

/* Whether the last token is a word by which POV-Ray reads or writes a file. */
static bool uses_files(const struct copy *copy)
{
  static const char *const words[] = {"bump_map",     "density_file", "fclose",    "file_exists",
                                      "fopen",        "height_field", "image_map", "image_pattern",
                                      "material_map", "read",         "ttf",       "write"};
  size_t length = copy->scan.end - copy->scan.begin;
  const char *word = words_directive(copy->source->text + copy->scan.begin, &length);
  for (size_t k = 0; k < sizeof words / sizeof *words; k++)
    if (words_compare(word, length, words[k]) == 0) return true;
  return false;
}

/* Copies a file name behind #include. */
static void copy_include(struct copy *copy)
{
  const size_t begin = copy->scan.begin, end = copy->scan.end;
  char new_name[MAX_NAME];
  struct source *source = read_included(copy, copy->source->text + begin + 1, end - begin - 2);
  if (source == NULL) return;
  const size_t index = add_source(copy->all, source);
  if (index == MAX_FILES) {
    copy->status = STATUS_LIMIT;
    return;
  }
  copy_name(copy->all, index, new_name);
  put_until(copy, begin + 1);
  put(copy, new_name, strlen(new_name));
  copy->done = end - 1;
}

/* At the word `solver`, drops it with its name and block. Returns the token after them, or the } of the block. */
static int drop_solver(struct copy *copy)
{
  const size_t begin = copy->scan.begin;
  int token = pscn_scan_next(&copy->scan);
  if (!words_is(token)) return token; /* no solver statement */
  size_t end = copy->scan.end;
  token = pscn_scan_next(&copy->scan);
  if (token == '{') {
    while (token != '}' && token != 0) token = pscn_scan_next(&copy->scan);
    end = copy->scan.end;
  }
  put_until(copy, begin);
  blank_until(copy, end);
  return token;
}

static void copy_text(struct copy *copy)
{
  if (setjmp(copy->broken) != 0) {
    copy->status = STATUS_LIMIT;
    return;
  }
  pscn_scan_open(&copy->scan, copy->source->text, copy->source->length, &copy->broken);
  int token = pscn_scan_next(&copy->scan);
  while (token != 0 && copy->status == STATUS_OK && copy->all->word[0] == '\0') {
    if (token == PSCN_TOKEN_SOLVER) {
      token = drop_solver(copy);
    } else if (token == TOKEN_INCLUDE) {
      token = pscn_scan_next(&copy->scan);
      if (token == PSCN_TOKEN_STRING) copy_include(copy);
      else note_word(copy, "#include ");
    } else {
      if ((words_is(token) || token > TOKEN_FIRST_PRIVATE) && uses_files(copy)) note_word(copy, "");
      token = pscn_scan_next(&copy->scan);
    }
  }
  put_until(copy, copy->source->length);
  pscn_scan_close(&copy->scan);
}

static enum status copy_file(struct copies *copies, size_t index)
{
  char name[MAX_NAME], path[2 * MAX_NAME];
  struct copy copy = {.all = copies, .source = copies->source[index], .status = STATUS_OK};
  copy_name(copies, index, name);
  snprintf(path, sizeof path, "%s/%s", copies->folder, name);
  copy.file = fopen(path, "wb");
  if (copy.file == NULL) {
    copies->reason = strerror(errno);
    copy.status = STATUS_FILE;
  } else {
    copy_text(&copy);
    if (fclose(copy.file) != 0 && copy.status == STATUS_OK) {
      copies->reason = strerror(errno);
      copy.status = STATUS_FILE;
    }
  }
  return copy.status;
}

enum status plain_copy(const char *path, const char *const *folders, const char *folder, const char *name,
                       const char **out_reason, char out_word[PLAIN_COPY_WORD_SIZE])
{
  struct copies copies = {
    .arena = arena_create(), .folder = folder, .name = name, .folders = folders, .word = out_word};
  struct source *scene = NULL;
  out_word[0] = '\0';
  enum status status = copies.arena == NULL ? STATUS_LIMIT : STATUS_OK;
  if (status == STATUS_OK) status = source_read(path, INPUT_FILE_OR_PIPE, &scene, &copies.reason);
  if (status == STATUS_OK && add_source(&copies, scene) == MAX_FILES) status = STATUS_LIMIT;
  for (size_t k = 0; k < copies.count && status == STATUS_OK && out_word[0] == '\0';
       k++) /* copying a file adds those it includes */
    status = copy_file(&copies, k);
  for (size_t k = 0; k < copies.count; k++) source_destroy(copies.source[k]);
  memory_free(copies.source);
  arena_destroy(copies.arena);
  *out_reason = copies.reason;
  return status;
}

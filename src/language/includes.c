/* Files that #include names. */
#include "language/includes.h"

#include <string.h>
#include <unistd.h>

#include "base/include_path.h"
#include "base/memory.h"
#include "language/sources.h"
#include "language/symbols.h"

enum {
  MAX_INCLUDE_DEPTH = 32,
  MAX_SOURCES = 10000 /* loops can ask for any number of reads */
};

/* Whether the text is UTF-16: it begins with a byte order mark of that, or with two characters of ASCII. */
static bool is_wide(const struct source *source)
{
  const unsigned char *t = (const unsigned char *)source->text;
  if (source->length >= 2 && ((t[0] == 0xFF && t[1] == 0xFE) || (t[0] == 0xFE && t[1] == 0xFF))) return true;
  return source->length >= 4 && (t[0] == 0) == (t[2] == 0) && (t[1] == 0) == (t[3] == 0) && (t[0] == 0) != (t[1] == 0);
}

bool include_open(struct language *language, struct source *source)
{
  const bool wide = is_wide(source);
  if (wide) memset(source->text, 0, source->length), source->length = 0;
  if (!sources_open(language, source)) return false;
  if (wide)
    language_tell(language, sources_span(language->sources->frame, 0, 0), "this is UTF-16: save it as UTF-8 or ASCII");
  return true;
}

/* Reads the file, of a stranger's scene only if it is in these folders or below them. */
static enum status read_file(const char *path, const struct include_folders *folders, struct source **out,
                             const char **out_reason)
{
  const int file = input_open(path, INPUT_FILE, out_reason);
  if (file < 0) return STATUS_FILE;
  if (!folders || include_is_below(folders, file)) return source_read_open(path, file, out, out_reason);
  (void)close(file);
  return STATUS_FILE;
}

/* Of a stranger's scene, says as little of a file as if it were not there. */
static void tell_unreadable(struct language *language, struct span place, const char *path, const char *reason)
{
  if (language->untrusted)
    language_tell(language, place,
                  "there is no such file below the scene's folder or another allowed one (--untrusted)");
  else language_tell(language, place, "cannot include '%.300s': %s", path, reason);
}

/* Returns NULL after reporting an error. */
static struct source *read_included(struct language *language, struct span place, const char *name, size_t length)
{
  const struct sources *sources = language->sources;
  const struct include_folders folders = {sources_scene(sources), sources->frame->source, sources->folders};
  const char *reason = "memory is short";
  uint64_t device, inode;
  struct source *source = NULL;
  if (language->untrusted && !include_is_modest(name, length)) {
    tell_unreadable(language, place, "", "");
    return NULL;
  }
  const char *path = include_path(language->arena, &folders, name, length, &device, &inode);
  if (!path) {
    language->ended_early = true;
    return NULL;
  }
  const struct source *known = sources_of_file(sources, device, inode);
  enum status status = STATUS_OK;
  if (known) source = source_share(known, path);
  else status = read_file(path, language->untrusted ? &folders : NULL, &source, &reason);
  if (status == STATUS_FILE) {
    tell_unreadable(language, place, path, reason);
  } else if (!source) {
    if (memory_limit_reached()) reason = "reading takes more memory than is allowed; --max-memory allows more";
    language_limit(language, place, reason);
  }
  return source;
}

void include_file(struct language *language, struct span place, const char *name, size_t length)
{
  struct sources *sources = language->sources;
  if (sources->included > MAX_INCLUDE_DEPTH) {
    language_limit(language, place, "files are included more than 32 deep");
    return;
  }
  if (sources->count == MAX_SOURCES) {
    language_limit(language, place, "more than 10000 files are included");
    return;
  }
  struct source *source = read_included(language, place, name, length);
  if (!source) return;
  if (source->length >= UINT32_MAX - sources->end) { /* a minute's reading, and the most that spans can express */
    language_limit(language, place, "more than 4 GiB of text are included");
    source_destroy(source);
    return;
  }
  source->includer = sources->frame->source;
  source->include_begin = sources->frame->scan.begin;
  if (!include_open(language, source)) language->ended_early = true;
  else symbols_enter(language->symbols);
}

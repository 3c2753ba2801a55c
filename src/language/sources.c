/* The stack of sources, and files that #include names. */
#include "language/sources.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "base/memory.h"
#include "base/source.h"
#include "language/symbols.h"

__extension__ typedef unsigned __int128 hash_type;

/* Every source that was read stays until the end, because places point into their texts. */
struct source_list {
  struct table_entry entry; /* of the first source of its file */
  struct source_list *next;
  struct source *source;
  uint32_t base;  /* where its spans begin */
  hash_type hash; /* of its text */
};

/* FNV-1a of 128 bits (Fowler, Noll, Vo; RFC 9923), on eight bytes at once, with the upper half folded down. */
static hash_type hash_add(hash_type hash, uint64_t bytes)
{
  const hash_type prime = ((hash_type)1 << 88) + 0x13b;
  hash = (hash ^ bytes) * prime;
  return hash ^ hash >> 64;
}

static hash_type hash_begin(uint64_t length)
{
  return hash_add((hash_type)UINT64_C(0x6c62272e07bb0142) << 64 | UINT64_C(0x62b821756295c58d), length);
}

static hash_type hash_text(const struct source *source)
{
  const unsigned char *text = (const unsigned char *)source->text;
  hash_type hash = hash_begin(source->length);
  size_t k = 0;
  for (; source->length - k >= 8; k += 8) {
    const unsigned char *b = text + k;
    hash = hash_add(hash, b[0] | (uint64_t)b[1] << 8 | (uint64_t)b[2] << 16 | (uint64_t)b[3] << 24 |
                            (uint64_t)b[4] << 32 | (uint64_t)b[5] << 40 | (uint64_t)b[6] << 48 | (uint64_t)b[7] << 56);
  }
  for (; k < source->length; k++) hash = hash_add(hash, text[k]);
  return hash;
}

/* Remembers a source, so that it is found when included again, and destroyed at the end. */
static void remember(struct language *language, struct source *source)
{
  struct sources *sources = language->sources;
  struct source_list *entry = arena_alloc(language->arena, 1, sizeof *entry);
  if (!entry) {
    source_destroy(source);
    language_end(language, STATUS_LIMIT);
  }
  entry->next = sources->all;
  entry->source = source;
  entry->base = sources->end + 1;
  entry->hash = source->shared ? 0 : hash_text(source);
  sources->all = entry;
  sources->count++;
  sources->end = entry->base + (uint32_t)source->length;
  if (source->shared) return;
  language_afford(language, sizeof *entry + source->length);
  if (source->inode != 0 && !table_add(&sources->files, language->arena, &entry->entry,
                                       (uint64_t[]){source->device, source->inode}, 2 * sizeof(uint64_t)))
    language_end(language, STATUS_LIMIT);
}

static void open_frame(struct language *language, const struct frame *frame)
{
  struct sources *sources = language->sources;
  struct frame *made = sources->unused;
  if (made) sources->unused = made->outer;
  else made = language_alloc(language, sizeof *made);
  *made = *frame;
  made->outer = sources->frame;
  pscn_scan_open(&made->scan, frame->source->text, frame->source->length, &language->ended);
  sources->frame = made;
  language->number = made->scan.number;
}

/* Whether the text is UTF-16: it begins with a byte order mark of that, or with two characters of ASCII. */
static bool is_wide(const struct source *source)
{
  const unsigned char *t = (const unsigned char *)source->text;
  if (source->length >= 2 && ((t[0] == 0xFF && t[1] == 0xFE) || (t[0] == 0xFE && t[1] == 0xFF))) return true;
  return source->length >= 4 && (t[0] == 0) == (t[2] == 0) && (t[1] == 0) == (t[3] == 0) && (t[0] == 0) != (t[1] == 0);
}

void sources_open(struct language *language, struct source *source)
{
  const bool wide = is_wide(source);
  if (wide) memset(source->text, 0, source->length), source->length = 0;
  remember(language, source);
  language->sources->included++;
  open_frame(language, &(struct frame){.source = source, .base = language->sources->all->base});
  if (wide)
    language_tell(language, sources_span(language->sources->frame, 0, 0), "this is UTF-16: save it as UTF-8 or ASCII");
}

void sources_call(struct language *language, const struct passage *text, struct span called)
{
  source_recall(text->source);
  open_frame(language, &(struct frame){.source = text->source, .base = text->base, .macro = true, .called = called});
  language->sources->again++;
  pscn_scan_seek(&language->sources->frame->scan, text->begin);
}

struct condition *sources_open_condition(struct language *language, enum opener opener, struct span place)
{
  struct sources *sources = language->sources;
  struct frame *frame = sources->frame;
  struct condition *condition = sources->closed;
  if (frame->conditions == MAX_CONDITIONS)
    language_limit(language, place, "conditions and loops are nested more than 200 deep");
  if (condition) sources->closed = condition->outer;
  else condition = language_alloc(language, sizeof *condition);
  *condition = (struct condition){.outer = frame->condition, .opener = opener, .place = place};
  frame->condition = condition;
  frame->conditions++;
  if (opener == OPEN_WHILE || opener == OPEN_FOR) {
    source_recall(frame->source); /* its text is read more than once */
    sources->again++;
  }
  return condition;
}

void sources_close_condition(struct language *language)
{
  struct sources *sources = language->sources;
  struct frame *frame = sources->frame;
  struct condition *condition = frame->condition;
  frame->condition = condition->outer;
  frame->conditions--;
  sources->again -= condition->opener == OPEN_WHILE || condition->opener == OPEN_FOR;
  condition->outer = sources->closed;
  sources->closed = condition;
}

size_t sources_around(const struct language *language, struct diagnostics_around out[], size_t most)
{
  size_t count = 0;
  for (const struct frame *f = language->sources->frame; f; f = f->outer) {
    for (const struct condition *c = f->condition; c; c = c->outer) {
      if ((c->opener != OPEN_WHILE && c->opener != OPEN_FOR) || ++count > most) continue;
      out[most - count] = (struct diagnostics_around){sources_place(language, c->place), c->rounds};
    }
    if (f->macro && ++count <= most)
      out[most - count] = (struct diagnostics_around){sources_place(language, f->called), 0};
  }
  return count;
}

/* The hash of all files, from the last one read to the first. */
static void hash_texts(const struct sources *sources, char out[SCENE_HASH_SIZE])
{
  hash_type hash = hash_begin((uint64_t)sources->count);
  for (const struct source_list *entry = sources->all; entry; entry = entry->next)
    if (!entry->source->shared) hash = hash_add(hash_add(hash, (uint64_t)(entry->hash >> 64)), (uint64_t)entry->hash);
  snprintf(out, SCENE_HASH_SIZE, "%016" PRIx64 "%016" PRIx64, (uint64_t)(hash >> 64), (uint64_t)hash);
}

void sources_list(struct language *language, struct scene *scene)
{
  const struct sources *sources = language->sources;
  hash_texts(sources, scene->text_hash);
  scene->files = language_alloc_in(language, scene->arena, (size_t)sources->count, sizeof *scene->files);
  for (const struct source_list *entry = sources->all; entry; entry = entry->next) {
    const char *name = entry->source->name;
    if (entry->source->shared || entry->source->inode == 0) continue;
    scene->files[scene->file_count++] = strcpy(language_alloc_in(language, scene->arena, strlen(name) + 1, 1), name);
  }
}

struct place sources_place(const struct language *language, struct span span)
{
  const struct source_list *entry = language->sources->all;
  while (entry && entry->base > span_begin(span)) entry = entry->next;
  if (!entry) return (struct place){NULL, 0, 0};
  return (struct place){entry->source, span_begin(span) - entry->base, span_end(span) - entry->base};
}

bool sources_has(const struct language *language, struct span span)
{
  const struct frame *frame = language->sources->frame;
  return span_begin(span) >= frame->base && span_begin(span) - frame->base <= frame->source->length;
}

struct name sources_name(const struct language *language, struct span span)
{
  const struct frame *frame = language->sources->frame;
  const struct source *source = frame->source;
  size_t begin = span_begin(span) - frame->base;
  if (!sources_has(language, span)) { /* the last word of an included file */
    const struct place place = sources_place(language, span);
    source = place.source, begin = place.begin;
  }
  const size_t said = span_end(span) - span_begin(span), left = source->length - begin;
  return (struct name){.place = span, .text = source->text + begin, .length = said < left ? said : left};
}

void sources_pass(struct language *language)
{
  const struct frame *frame = language->sources->frame;
  source_drop(frame->source, frame->scan.begin);
}

void sources_leave(struct language *language)
{
  struct sources *sources = language->sources;
  struct frame *frame = sources->frame;
  while (frame->condition) sources_close_condition(language);
  sources->frame = frame->outer;
  sources->included -= !frame->macro;
  sources->again -= frame->macro;
  if (frame->outer) language->number = frame->outer->scan.number;
  pscn_scan_close(&frame->scan);
  frame->outer = sources->unused;
  sources->unused = frame;
}

void sources_close(struct language *language)
{
  while (language->sources->frame) sources_leave(language);
  for (const struct source_list *entry = language->sources->all; entry; entry = entry->next)
    source_destroy(entry->source);
}

/* ---- files that #include names ---- */

enum {
  MAX_INCLUDE_DEPTH = 32,
  MAX_SOURCES = 10000 /* loops can ask for any number of reads */
};

/* The first source of that file, or NULL. */
static const struct source *of_file(const struct sources *sources, uint64_t device, uint64_t inode)
{
  const struct table_entry *entry = table_find(&sources->files, (uint64_t[]){device, inode}, 2 * sizeof(uint64_t));
  for (; entry; entry = entry->older) {
    const struct source *source = ((const struct source_list *)entry)->source;
    if (source->device == device && source->inode == inode) return source;
  }
  return NULL;
}

static const struct source *scene_source(const struct sources *sources)
{
  const struct frame *frame = sources->frame;
  while (frame->outer) frame = frame->outer;
  return frame->source;
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
  const struct include_folders folders = {scene_source(sources), sources->frame->source, sources->folders};
  const char *reason = "memory is short";
  uint64_t device, inode;
  struct source *source = NULL;
  if (language->untrusted && !include_is_modest(name, length)) {
    tell_unreadable(language, place, "", "");
    return NULL;
  }
  const char *path = include_path(language->arena, &folders, name, length, &device, &inode);
  if (!path) language_end(language, STATUS_LIMIT);
  const struct source *known = of_file(sources, device, inode);
  enum status status = STATUS_OK;
  if (known) source = source_share(known, path);
  else status = read_file(path, language->untrusted ? &folders : NULL, &source, &reason);
  if (status == STATUS_FILE) {
    tell_unreadable(language, place, path, reason);
  } else if (!source) {
    if (memory_limit_reached()) reason = MORE_THAN_ALLOWED;
    language_limit(language, place, reason);
  }
  return source;
}

void sources_include(struct language *language, struct span place, const char *name, size_t length)
{
  struct sources *sources = language->sources;
  if (sources->included > MAX_INCLUDE_DEPTH) language_limit(language, place, "files are included more than 32 deep");
  if (sources->count == MAX_SOURCES) language_limit(language, place, "more than 10000 files are included");
  struct source *source = read_included(language, place, name, length);
  if (!source) return;
  if (source->length >= UINT32_MAX - sources->end) { /* a minute's reading, and the most that spans can express */
    source_destroy(source);
    language_limit(language, place, "more than 4 GiB of text are included");
  }
  source->includer = sources->frame->source;
  source->include_begin = sources->frame->scan.begin;
  sources_open(language, source);
  symbols_enter(language->symbols);
}

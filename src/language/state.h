/* The state of one reading, its memory, and its errors. The state of each part is in its own header.
 *
 * Each header needs only those before it: state, sources (text and places), symbols (names), values. */
#ifndef PSCN_LANGUAGE_STATE_H
#define PSCN_LANGUAGE_STATE_H

#include <setjmp.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/arena.h"
#include "base/diagnostics.h"
#include "base/memory.h"

/* The most blocks open within each other, and declared objects within declared objects. */
enum { MAX_NESTING = 200 };

/* Bytes begin .. end-1 of the text: all sources, one behind the other as their reading begins; byte 0 is none. One
 * number, begin x 2^32 + end, because the parser carries one along with each token. */
struct span {
  uint64_t ends;
};

static inline struct span span_of(uint64_t begin, uint64_t end) { return (struct span){begin << 32 | end}; }
static inline uint32_t span_begin(struct span span) { return (uint32_t)(span.ends >> 32); }
static inline uint32_t span_end(struct span span) { return (uint32_t)span.ends; }

/* From the beginning of `first` to the end of `last`. */
static inline struct span span_join(struct span first, struct span last)
{
  return span_end(last) < span_begin(first) ? first : span_of(span_begin(first), span_end(last));
}

/* A word that names something. Its text is not terminated and lives as long as its source. */
struct name {
  struct span place;
  const char *text;
  size_t length;
};

/* A block in braces, or something else that is read piece by piece. */
struct block {
  struct span place; /* of its first word */
  size_t errors;     /* reported or held before it */
};

/* How far a block has come, which decides what may follow. */
enum stage { STAGE_SETTINGS, STAGE_BODY, STAGE_MODIFIERS };

/* A declaration that is being read. */
struct declaration {
  struct declaration *outer;
  struct value *to;
  const struct frame *frame; /* where its = stands, with that many braces open */
  int braces;
  bool begun; /* something of its value has been read */
  struct span name;
  int depth;         /* of its symbol */
  struct span lacks; /* the first thing in it that is not supported, or none */
};

struct language {
  struct diagnostics *diagnostics;
  struct arena *arena;             /* for what is needed only while reading */
  size_t memory_bytes, max_memory; /* in use while reading; allowed */
  bool unaffordable;               /* more was needed */
  bool untrusted;                  /* settings.untrusted */
  bool limit_told;                 /* reading ended at a stated limit, which is reported */
  enum status status;              /* once it has ended */
  jmp_buf ended;                   /* where it goes on when it ends early */
  struct span unknown;             /* the last word reported as unknown */
  struct declaration *declaration; /* the innermost that is open, or NULL */
  struct value *layered;           /* the declared texture that more layers may follow, or NULL */
  size_t declared;                 /* declarations that have ended */
  int idle;                        /* choices whose other branch is being read */
  bool lenient;                    /* settings.lenient */
  double clock;                    /* of the frame */
  bool animated;                   /* clock_on */
  size_t work, max_work;           /* tokens read by loops and macros; allowed */
  struct value *unused;            /* values to be reused */
  const double *number;            /* of the last token, if that is a number or a vector; until the next one */
  struct symbols *symbols;
  struct sources *sources;
  struct left_out *left_out; /* what was, the last kind first */
  struct span left_out_last; /* its last place */
  struct open_array *array;  /* the innermost that is open */
  struct value *list;        /* what a directive's parentheses hold */
  struct growing randoms;    /* the states of the generators that seed has made, uint32_t */
  struct messages *messages; /* what #debug says */
  struct tokens *tokens;
  struct texture *texture;               /* the innermost that is open */
  const struct texture *texture_default; /* as the last #default left it */
  struct transform *transform;           /* the last statement's */
  struct transforms *transforms;         /* the innermost transform { } that is open */
  struct span transform_place;           /* its place */
  struct transform_angles *angles;       /* of rotations */
  struct method *method;                 /* of the last solver statement */
  struct span method_name;               /* the word in it that names the solver */
  unsigned method_items;                 /* the items that it has set, by their bits */
  struct objects *objects;
  struct camera_items *camera;
  struct settings *settings;
};

#define MORE_THAN_ALLOWED "reading takes more memory than is allowed; --max-memory allows more"

/* Ends reading at once: STATUS_LIMIT if memory is short. What is in use is freed by whoever began to read. */
_Noreturn void language_end(struct language *language, enum status status);

/* Counts that many more bytes; ends reading if settings.max_memory does not allow them. */
void language_afford(struct language *language, size_t bytes);

/* Zeroed memory, never NULL: if it is short, reading ends. In the arena of the reading, or in another one, where
 * max_memory does not count it. */
void *language_alloc(struct language *language, size_t size);
void *language_alloc_in(struct language *language, struct arena *arena, size_t count, size_t size);

/* A copy of text that may be dropped. */
const char *language_keep(struct language *language, const char *text, size_t length);

/* ---- errors: one is reported where it is found, and reading goes on with a harmless value, so that one run finds many.
 * A scene is made only if there was none. ---- */

/* Reports an error in how files are put together: in comments, quotes, conditions or blocks as a whole. */
void language_tell(struct language *language, struct span place, const char *format, ...)
  __attribute__((format(printf, 3, 4)));

/* Reports an error in what the text means, unless it is in the branch of a choice that is not chosen. */
void language_error(struct language *language, struct span place, const char *format, ...)
  __attribute__((format(printf, 3, 4)));

/* Leaves out what is not supported, a word of POV-Ray's or a colour: `what`, which is at the place or in the declaration of
 * the name used there. Without settings.lenient, and if it cannot be left out, that is an error, once a kind. In a
 * declaration it counts only where the declared name is used, because libraries declare more than a scene uses. */
void language_lacks(struct language *language, struct span place, struct span what);
/* At the end, warns of what settings.lenient has left out. */
void language_tell_left_out(struct language *language);

struct block language_block(const struct language *language, struct span place);
/* Whether no error has been reported since the block began. If one has, what is missing in it may be a consequence. */
bool language_sound(const struct language *language, const struct block *block);
/* Reports an error about a block, if the block is sound. */
void language_error_in(struct language *language, const struct block *block, struct span place, const char *text);

/* Reports a stated limit, and ends reading with STATUS_LIMIT. */
_Noreturn void language_limit(struct language *language, struct span place, const char *text);

/* Reports the last token, which is none of `count` expected ones. `is_word`: nor is it a word of the language. */
void syntax_error(struct language *language, bool is_word, const char *const expected[], int count);

/* Reports the character at which the scanner stopped. */
void character_error(struct language *language);

#endif

/* The bottom of this room: places, tokens, and the state of one reading with its errors and its memory.
 *
 * What happens where an error is found: it is told, and reading goes on with a harmless value, so that one run finds
 * many errors; a scene comes out only where none was found. What each part of the room keeps while reading stands in
 * its own header.
 */
#ifndef PSCN_LANGUAGE_STATE_H
#define PSCN_LANGUAGE_STATE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/arena.h"
#include "base/diagnostics.h"

/* Blocks open within each other, and declared objects within declared objects. */
enum { MAX_NESTING = 200 };

/* Bytes begin .. end-1 of the text: of all sources, one behind the other as their reading begins; byte 0 is none. One
 * number, begin x 2^32 + end, for the parser takes one along with each token. */
struct span {
  uint64_t ends;
};

static inline struct span span_of(uint64_t begin, uint64_t end) { return (struct span){begin << 32 | end}; }
static inline uint32_t span_begin(struct span span) { return (uint32_t)(span.ends >> 32); }
static inline uint32_t span_end(struct span span) { return (uint32_t)span.ends; }

/* From the beginning of one to the end of the other. */
static inline struct span span_join(struct span first, struct span last)
{
  return span_end(last) < span_begin(first) ? first : span_of(span_begin(first), span_end(last));
}

/* A word that names something. The text is not terminated and lives as long as its source. */
struct name {
  struct span place;
  const char *text;
  size_t length;
};

/* A block in braces, or what else is read piece by piece. */
struct block {
  struct span place; /* of the word it begins with */
  size_t errors;     /* told or held before it began */
};

/* How far a block has come: what may follow. */
enum stage { STAGE_SETTINGS, STAGE_BODY, STAGE_MODIFIERS };

struct symbol;

/* What pscn has not, within a declaration: told where its name is used. */
struct held {
  struct held *next;
  struct span place;
  const char *text; /* or, where that is NULL, */
  struct held *of;  /* all of a name that was used there */
  /* Of the first of a list: */
  bool told;          /* the list is, or is about to be */
  struct held *after; /* the list that is told after it */
};

/* A declaration that is being read. */
struct declaration {
  struct declaration *outer;
  struct symbol *symbol;
  struct held *held, **held_end;
  size_t held_count;
};

struct language {
  struct diagnostics *diagnostics;
  struct arena *arena; /* of what is needed while reading only */
  int width, height;
  size_t memory_bytes, max_memory;        /* held while reading; allowed */
  bool unaffordable;                      /* more was wanted */
  bool ended_early;                       /* memory, or a stated limit: STATUS_LIMIT */
  bool limit_told;                        /* which of them */
  struct span unknown;                    /* the last word told to be unknown */
  struct declaration *declaration;        /* the innermost that is open, or NULL */
  struct declaration *layered;            /* a texture's, behind which more layers may come, or NULL */
  size_t held_count;                      /* in all declarations */
  struct value *unused;                   /* values that are needed no more */
  const double *number;                   /* of the last token, if it is a number or a vector; until the next one */
  _Alignas(max_align_t) char spare[4096]; /* stands in for memory that there is not */
  size_t spare_used;

  struct symbols *symbols;
  struct sources *sources;
  struct tokens *tokens;
  struct texture *texture;               /* the innermost that is open */
  const struct texture *texture_default; /* what #default has said last */
  struct transform *transform;           /* the last statement's */
  struct span transform_place;           /* and where it stands */
  struct matrix *matrix;                 /* the numbers of the last one */
  struct transform_angles *angles;       /* of rotations */
  struct method *method;                 /* of the last solver statement */
  struct objects *objects;
  struct camera_items *camera;
  struct settings *settings;
};

/* An error in how files are put together: in whole comments, quotes, conditions, blocks. */
void language_tell(struct language *language, struct span place, const char *format, ...)
  __attribute__((format(printf, 3, 4)));

/* An error in what the text means. */
void language_error(struct language *language, struct span place, const char *format, ...)
  __attribute__((format(printf, 3, 4)));

/* What pscn has not, though POV-Ray may. Where a declaration is being read this is held, and so is what language_error
 * gets in it from there on: libraries declare more than a scene uses. */
void language_foreign(struct language *language, struct span place, const char *format, ...)
  __attribute__((format(printf, 3, 4)));

/* Whether language_error holds what it gets now. */
bool language_holds(const struct language *language);

/* Whether the declaration being read holds so much that language_foreign only counts what it gets now. */
bool language_holds_enough(const struct language *language);

/* The same of a name that was declared so. */
void language_hold(struct language *language, struct span place, struct held *of);

struct block language_block(const struct language *language, struct span place);
/* Whether no error has been told since the block began: what is missing in it may be the consequence of one. */
bool language_sound(const struct language *language, const struct block *block);
/* An error about a block, told only where it is sound. */
void language_error_in(struct language *language, const struct block *block, struct span place, const char *text);

/* A stated limit: reading ends at the next token, with STATUS_LIMIT. */
void language_limit(struct language *language, struct span place, const char *text);

/* Whether so many more bytes are within what settings.max_memory allows; if so they are counted. */
bool language_afford(struct language *language, size_t bytes);

/* zeroed, never NULL: reading ends at the next token instead */
void *language_alloc(struct language *language, size_t size);

/* A copy of text that may be dropped; NULL where memory is short: reading ends then. */
const char *language_keep(struct language *language, const char *text, size_t length);

#endif

/* The stack of sources being read: the scene, what it includes, and the macros called; and the places of their words. */
#ifndef PSCN_LANGUAGE_SOURCES_H
#define PSCN_LANGUAGE_SOURCES_H

#include "base/table.h"
#include "language/scan.h"
#include "language/state.h"
#include "scene/scene.h"

/* The directives that an #end ends. */
enum opener { OPEN_IF, OPEN_WHILE, OPEN_FOR, OPEN_SWITCH };

struct condition {
  struct condition *outer; /* of the same frame; or of those to be reused */
  enum opener opener;
  struct span place; /* of its directive */
  bool seen_else;
  size_t begin, end; /* of a loop: where its condition or its text begins; behind its #end, once that has been met */
  double rounds;     /* of a loop */
  double last, step; /* of a #for */
  struct name name;
  double chosen; /* of a #switch */
};

enum { MAX_CONDITIONS = 200 }; /* open in one source */

/* A macro's text, from byte `begin` of that source on; its #end ends it. */
struct passage {
  const struct source *source;
  uint32_t base; /* where the spans of the source begin */
  size_t begin;
};

/* A source being read, or the text of a macro. */
struct frame {
  struct frame *outer;
  const struct source *source;
  uint32_t base; /* where its spans begin */
  struct scan scan;
  struct condition *condition; /* the innermost that is open */
  int conditions;
  bool macro;         /* not a whole source */
  struct span called; /* the macro, where */
};

/* Zeroed: no sources. */
struct sources {
  struct frame *frame;  /* being read */
  struct frame *unused; /* to be reused */
  struct condition *closed;
  struct source_list *all;    /* all that have been read */
  struct table files;         /* the first source of each file */
  int count, included;        /* sources; those open */
  size_t again;               /* loops and macros being read */
  uint32_t end;               /* where the spans of all of them end */
  const char *const *folders; /* where to look besides the includer's folder, or NULL */
};

/* Begins to read a source, which it takes over. */
void sources_open(struct language *language, struct source *source);

/* Begins to read the file that an #include names at `place`, or reports an error. */
void sources_include(struct language *language, struct span place, const char *name, size_t length);

/* Writes the names of the files that were read to the scene. */
void sources_list(struct language *language, struct scene *scene);

/* The text read so far is needed only for errors now: gives back the memory of a long one. */
void sources_pass(struct language *language);

/* Begins to read the text of a macro, named at `called`. */
void sources_call(struct language *language, const struct passage *text, struct span called);

/* Opens and closes a condition or a loop in the source being read. */
struct condition *sources_open_condition(struct language *language, enum opener opener, struct span place);
void sources_close_condition(struct language *language);

/* The loops and macros around what is being read, the innermost last, `most` of them. Returns how many there are. */
size_t sources_around(const struct language *language, struct diagnostics_around out[], size_t most);

/* Goes back to the includer or to the call. */
void sources_leave(struct language *language);
void sources_close(struct language *language);

/* Bytes begin .. end-1 of that source. */
static inline struct span sources_span(const struct frame *frame, size_t begin, size_t end)
{
  return span_of(frame->base + begin, frame->base + end);
}

/* That of the last token of the source being read. */
static inline struct span sources_here(const struct language *language)
{
  const struct frame *frame = language->sources->frame;
  return sources_span(frame, frame->scan.begin, frame->scan.end);
}

/* The place of a span, for an error; nowhere for a zeroed span. */
struct place sources_place(const struct language *language, struct span span);

/* Whether the span is in the file being read. */
bool sources_has(const struct language *language, struct span span);

/* The text at the span, which has been read just now, or whose source has been recalled. */
struct name sources_name(const struct language *language, struct span span);

#endif

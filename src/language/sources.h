/* The stack of sources being read: the scene and what it includes. */
#ifndef PSCN_LANGUAGE_SOURCES_H
#define PSCN_LANGUAGE_SOURCES_H

#include "language/scan.h"
#include "language/symbols.h"
#include "scene/scene.h"

struct condition {
  struct span place; /* of the #ifdef */
  bool seen_else;
};

enum { MAX_CONDITIONS = 200 }; /* open in one source */

/* A source being read. */
struct frame {
  struct frame *outer;
  const struct source *source;
  uint32_t base; /* of the spans in it */
  struct scan scan;
  struct condition condition[MAX_CONDITIONS];
  int conditions;
};

/* Zeroed: none. */
struct sources {
  struct frame *frame;     /* the one being read */
  struct source_list *all; /* that have been read */
  struct table files;      /* the first source of each file */
  int count;
  uint32_t end;               /* of the spans in all of them */
  jmp_buf broken;             /* for the scanners */
  const char *const *folders; /* where to look besides the includer's, or NULL */
};

/* Begins to read a source, which is taken over even on failure: false where memory is short. */
bool sources_open(struct language *language, struct source *source);

/* Tells the scene which files were read; false where memory is short. */
bool sources_list(const struct language *language, struct scene *scene);

/* Reads the file name behind #include and begins to read that file, or tells an error. */
void sources_include(struct language *language);

/* At a quote that is not closed. */
void sources_tell_open_string(struct language *language);

/* What has been read so far is needed no more, but for errors: the memory of a long text is given back. */
void sources_pass(struct language *language);

/* Goes back to the includer. */
void sources_leave(struct language *language);
void sources_close(struct language *language);

/* Bytes begin .. end-1 of that source. */
static inline struct span sources_span(const struct frame *frame, size_t begin, size_t end)
{
  return span_of(frame->base + begin, frame->base + end);
}

/* Those of the last token of the source being read. */
static inline struct span sources_here(const struct language *language)
{
  const struct frame *frame = language->sources->frame;
  return sources_span(frame, frame->scan.begin, frame->scan.end);
}

/* Where that is, for an error; nowhere where the span is zeroed. */
struct place sources_place(const struct language *language, struct span span);

/* Whether that is in the file being read. */
bool sources_has(const struct language *language, struct span span);

/* The word that stands there, which has been read just now. */
struct name sources_name(const struct language *language, struct span span);

#endif

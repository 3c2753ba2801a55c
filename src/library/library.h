/* What the files of src/library share, and what the commands that use pscn.h ask besides. */
#ifndef PSCN_LIBRARY_LIBRARY_H
#define PSCN_LIBRARY_LIBRARY_H

#include <fenv.h>

#include "base/arena.h"
#include "base/diagnostics.h"
#include "base/memory.h"
#include "intersect/intersect.h"
#include "library/pscn.h"
#include "scene/scene.h"

struct message {
  struct message *next;
  struct pscn_message is;
  const char *shown; /* all lines of it, each with its end */
};

struct pscn_scene {
  struct memory_hooks hooks;
  enum pscn_status status;
  struct diagnostics diagnostics;
  struct arena *arena; /* of the messages */
  struct message *messages, **messages_end;
  size_t message_count;
  char *text;           /* what all messages show, or NULL where there was no memory for that */
  struct message spare; /* stands for those that there was no memory for */
  struct scene *scene;
  struct intersector *intersector; /* NULL where the scene was not built */
};

/* Arithmetic as ours counts on: rounding to nearest, no flush to zero, no traps. Between calm_begin and calm_end. */
struct calm {
  fenv_t callers;
};

static inline struct calm calm_begin(void)
{
  struct calm calm;
  (void)fegetenv(&calm.callers);
  (void)fesetenv(FE_DFL_ENV);
  return calm;
}

static inline void calm_end(const struct calm *calm) { (void)fesetenv(&calm->callers); }

#endif

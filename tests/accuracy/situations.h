/* Situations in which methods fail: each class a named, seeded generator of patches and rays. */
#ifndef TESTS_ACCURACY_SITUATIONS_H
#define TESTS_ACCURACY_SITUATIONS_H

#include <stddef.h>
#include <stdint.h>

#include "accuracy/models.h"
#include "intersect/intersect.h"
#include "random.h"

enum { SITUATION_RAYS = 16 };

/* Patches, and rays that are hard for them. */
struct situation {
  size_t count;
  double P[MODEL_MOST_PATCHES][4][4][3];
  struct ray rays[SITUATION_RAYS];
};

struct situation_class {
  const char *name;
  uint64_t seed; /* to start `random` with */
  double share;  /* in (0,1], of the rays to try: the reference takes longest on rays that it leaves undecided */
  /* Writes situation number `index` of a sequence. `index` chooses sizes and kinds, `random` the rest. */
  void (*generate)(struct random *random, size_t index, struct situation *out);
};

size_t situation_class_count(void);
const struct situation_class *situation_class_at(size_t index); /* index < the count */

#endif

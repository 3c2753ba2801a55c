/* Situations in which methods fail: each class a named, seeded generator of patches and rays. */
#ifndef TESTS_ACCURACY_SITUATIONS_H
#define TESTS_ACCURACY_SITUATIONS_H

#include <stdbool.h>
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

/* S(u,v) of patch n. */
static inline void situation_point(const struct situation *s, size_t n, double u, double v, double out[3])
{
  net_point((const double(*)[4][3])s->P[n], u, v, out);
}

struct situation_class {
  const char *name;
  uint64_t seed; /* to start `random` with */
  double share;  /* in (0,1], of the rays to try: judges take longest on rays that they leave undecided */
  /* Writes situation number `index` of a sequence. `index` chooses sizes and kinds, `random` the rest. */
  void (*generate)(struct random *random, size_t index, struct situation *out);
};

/* Of situations.c, for both judges. */
size_t situation_class_count(void);
const struct situation_class *situation_class_at(size_t index); /* index < the count */

/* Those and the ones of hostile.c, for the exact judge: rays that an adversary would aim, starts next to special features,
 * nets that are degenerate up to some roundings, coordinates of every size. */
size_t every_class_count(void);
const struct situation_class *every_class_at(size_t index); /* index < the count */

/* Whether a ray's limit of work ends the search before the roots are told apart: tangencies of the third order and
 * higher, rays past met poles. Findings on grazing answers are counted and printed, and prove no fault. */
bool class_told_only(const struct situation_class *class);

#endif

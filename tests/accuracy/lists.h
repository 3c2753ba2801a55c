/* Judges lists of all hits by the roots that exact.h finds on each patch.
 *
 * A list may not be out of order. A certain hit, in any list, must be a root: by its t, and inside a patch by its u and v.
 * A certain list must have a hit for each root inside a patch, and one at each point of a border. */
#ifndef TESTS_ACCURACY_LISTS_H
#define TESTS_ACCURACY_LISTS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "intersect/intersect.h"
#include "reference/facts.h"
#include "scene/scene.h"

enum list_finding {
  LIST_RIGHT,
  LIST_UNDECIDED, /* right, but the judge has left something open */
  LIST_LOST,
  LIST_INVENTED,
  LIST_BORDER_LOST,
  LIST_ORDER,
  LIST_FINDINGS
};

extern const char *const list_finding_names[LIST_FINDINGS];

enum { LIST_MOST_ROOTS = 512 };

struct list_root {
  uint32_t patch;
  double t, u, v;
  struct facts_floor floor;
  bool border, met; /* on a border; a hit has been found for it */
};

/* The roots of one ray. */
struct list_truth {
  size_t count;
  bool doubt; /* the judge has left something open */
  struct list_root root[LIST_MOST_ROOTS];
};

/* Finds the roots of all patches between the ray's ends; the reference gives their floors. */
void list_truth_find(const struct scene *scene, const struct reference *reference, const struct ray *ray,
                     struct list_truth *out);

/* Judges a list of the same ray, and notes which roots it has met. */
enum list_finding list_judge(const struct hit_list *list, struct list_truth *truth);

#endif

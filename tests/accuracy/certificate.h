/* Proves or refutes answers of the intersector, by the roots that exact.h finds on each patch.
 *
 * certain hit   proven if a root is at T, and none before it; refuted if no root is at T, or a proven one before it.
 *               At T: within CERTIFICATE_FLOORS of what one rounding of each input, or of the patch's extent, moves it
 * certain miss  proven if there is no root, refuted if there is one
 * grazing       refuted if it loses a proven root: one before T, or any for a miss. A hit must be as near to ray and
 *               patch as TRIAL_NEAR in trial.h says
 * undecided     what exact.h left undecided matters
 *
 * A list of all hits may not be out of order. A certain hit, in any list, must be a root: by its t, and inside a patch by
 * its u and v. A certain list must have a hit for each root inside a patch, and one at each point of a border. */
#ifndef TESTS_ACCURACY_CERTIFICATE_H
#define TESTS_ACCURACY_CERTIFICATE_H

#include <stdbool.h>
#include <stddef.h>

#include "accuracy/exact.h"
#include "intersect/intersect.h"
#include "reference/facts.h"
#include "reference/reference.h"
#include "scene/scene.h"

#define CERTIFICATE_FLOORS 4

enum finding {
  FINDING_PROVEN,
  FINDING_UNDECIDED,
  FINDING_LOST,     /* a proven root, answered by a miss */
  FINDING_LATER,    /* a proven root before T */
  FINDING_INVENTED, /* no root at T */
  FINDING_SURFACE,  /* a hit whose U, V or T are out of range, whose point is not within its error, or with no normal */
  FINDINGS
};

extern const char *const finding_names[FINDINGS];

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

struct certificate {
  enum finding finding;
  bool sure;      /* the hit or miss is proven to be the answer: a grazing one could be certain */
  double t;       /* lost, later: of the proven root; otherwise of the nearest root, or INFINITY */
  double u, v;    /* its place */
  uint32_t patch; /* or REFERENCE_NONE */
  double off;     /* |T - t| of the root at T, in floors */
  size_t boxes;
};

struct truth_root {
  struct exact_root at;
  uint32_t patch;
  bool met;     /* a hit of the last list has been found for it */
  bool floored; /* `floor` is known */
  struct facts_floor floor;
};

/* The roots of one ray, up to `end`. */
struct truth {
  bool known;
  struct ray ray;
  double end;
  struct truth_root *root;
  size_t count, capacity, boxes;
  bool judged; /* an answer has this certificate; the next solver may give the same one */
  struct hit hit;
  struct certificate certificate;
};

struct certifier {
  const struct scene *scene;
  struct reference *reference; /* for floors and residuals only */
  double (*boxes)[2][3];
  double size;        /* the largest coordinate of a control point */
  struct truth truth; /* of the last ray, so that one proof judges what several solvers answer to it */
};

/* Borrows scene and reference. Aborts the running test if memory is short. */
void certifier_create(struct certifier *certifier, const struct scene *scene, struct reference *reference);
void certifier_destroy(struct certifier *certifier);

void certify(struct certifier *certifier, const struct ray *ray, const struct hit *hit, struct certificate *out);

/* Judges a list of all hits, and notes in `truth` which roots it has met. */
enum list_finding certify_list(struct certifier *certifier, const struct ray *ray, const struct hit_list *list);

#endif

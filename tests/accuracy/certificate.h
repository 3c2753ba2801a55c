/* Proves or refutes answers of the intersector, with what exact.h finds.
 *
 * certain hit   proven where a root is at T, within CERTIFICATE_FLOORS of how far one rounding of each input, or of the
 *               patch's extent, moves it, and none is before it; refuted where there is none at T, or a proven one before it
 * certain miss  proven where there is no root, refuted where there is one
 * grazing       as an answer refuted where a proven root is lost: before T, or at all. A hit must be as near to ray and
 *               patch as trial.h's TRIAL_NEAR has it.
 * undecided     what exact.h left undecided matters
 */
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

struct certificate {
  enum finding finding;
  bool sure;      /* the hit, or the miss, is proven to be the answer: a grazing one could be certain */
  double t;       /* lost, later: the proven root's; else the nearest root's, or INFINITY */
  double u, v;    /* its place */
  uint32_t patch; /* or REFERENCE_NONE */
  double off;     /* |T - t| of the root at T, in floors */
  size_t boxes;
};

struct truth_root {
  struct exact_root at;
  uint32_t patch;
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
  bool judged; /* an answer, which the next solver may give too, has this certificate */
  struct hit hit;
  struct certificate certificate;
};

struct certifier {
  const struct scene *scene;
  struct reference *reference; /* for floors and residuals only */
  double (*boxes)[2][3];
  double size;        /* the largest coordinate of a control point */
  struct truth truth; /* of the last ray: what several solvers answer to one ray is held to one proof */
};

/* Borrows scene and reference. Aborts the running test where memory is short. */
void certifier_create(struct certifier *certifier, const struct scene *scene, struct reference *reference);
void certifier_destroy(struct certifier *certifier);

void certify(struct certifier *certifier, const struct ray *ray, const struct hit *hit, struct certificate *out);

#endif

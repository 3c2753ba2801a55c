/* The scene's own method on one ray and leaf: resultant, roots, back-substitution (paper 2.1 and 2.2).
 *
 * Internal to src/intersect. Everything that a `solver` statement can choose happens here: the basis, the determinant,
 * the solver, its start, and how v follows from u. The results are starting points; with `polish on` the caller proves
 * them. A solver without items that change its numbers runs on all lanes at once instead (lanes/resultant.c).
 */
#ifndef PSCN_INTERSECT_METHOD_H
#define PSCN_INTERSECT_METHOD_H

#include "intersect/explain.h"
#include "intersect/prepare/leaf.h"
#include "intersect/tracer.h"

struct method_roots {
  int found; /* roots of r */
  int steps; /* of the iterations that found them */
  int count;
  double u[POLYNOMIAL_MAX_DEGREE], v[POLYNOMIAL_MAX_DEGREE]; /* leaf parameters, near or in [0,1] */
};

/* A leaf's polynomials on a ray. */
struct method_planes {
  const struct leaf_form *form;
  double a[16], b[16]; /* the nets of its form, a[4 * i + j], i of the kept parameter */
};

/* Forms r from the planes, finds its roots by the method's solver, from `warm` if that is not NULL, and substitutes
 * back. The solver takes no more than most_steps for a root, but one in any case. The results are starting points only:
 * nothing here is proven. `story`, if not NULL, gets what became of r. */
void method_find(const struct method *method, const struct method_planes *planes, int most_steps,
                 struct solver_warm *warm, struct method_roots *out, struct explained_roots *story);

#endif

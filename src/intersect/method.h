/* The scene's own method on one ray and leaf: resultant, roots, back-substitution (paper 2.1 and 2.2).
 *
 * Internal to src/intersect. Everything a `solver` statement can choose happens here: the basis, the determinant, the
 * solver, its start, and how v follows from u. What comes out are starting points; with `polish on` the caller proves
 * them. A solver without items that change its numbers has a way of its own on all lanes at once (lanes/resultant.c,
 * lanes/all_roots.c).
 */
#ifndef PSCN_INTERSECT_METHOD_H
#define PSCN_INTERSECT_METHOD_H

#include "intersect/explain.h"
#include "intersect/tracer.h"

enum { METHOD_MAX_ROOTS = POLYNOMIAL_MAX_DEGREE };

struct method_roots {
  int found; /* roots of r */
  int count;
  double u[METHOD_MAX_ROOTS], v[METHOD_MAX_ROOTS]; /* leaf parameters, near or in [0,1] */
};

/* Forms r from the nets a, b of the form of leaf `number` with its patch's method, finds its roots with that solver
 * and substitutes back. Counts the roots. Starting points only: nothing here is proven. */
void method_solve(struct tracer *tracer, const struct method *method, const struct leaf *leaf, int64_t number,
                  const double a[16], const double b[16], double error, struct method_roots *out);

/* The same of any model's leaf, for whoever asks what became of r: `story` may be NULL. Counts nothing. */
void method_find(const struct method *method, struct solver_warm *warm, const struct leaf *leaf, const double a[16],
                 const double b[16], double error, struct method_roots *out, struct explained_roots *story);

#endif

/* What the files of src/intersect share: the tracer, the state of a packet's answers, and the stages of a candidate.
 *
 * Internal to src/intersect. A candidate is a ray and a leaf whose box it passes.
 */
#ifndef PSCN_INTERSECT_TRACER_H
#define PSCN_INTERSECT_TRACER_H

#include "algebra/solver.h"
#include "intersect/intersect.h"
#include "intersect/local_ray.h"
#include "intersect/model.h"

/* The entry points of one instruction set. */
struct kernel {
  const char *name;
  void (*closest)(struct tracer *tracer, size_t count, const struct ray rays[], struct hit out_hits[]);
  void (*occluded)(struct tracer *tracer, size_t count, const struct ray rays[], bool out_occluded[]);
};

enum { KERNELS_MAX = 3 };

/* intersect.c: the kernels that this processor can run, the best first; returns how many. */
size_t kernels_here(const struct kernel *out[KERNELS_MAX]);

/* Warm starts of one leaf, valid where `epoch` is the tracer's. */
struct warm_leaf {
  uint64_t epoch;
  struct solver_warm warm;
};

struct tracer {
  const struct model *model;
  const struct kernel *kernel;
  struct intersect_counts counts;
  uint64_t epoch;
  struct warm_leaf *warm; /* one a leaf, NULL where no patch asks for it */
};

/* candidate.c: what the scene's solver finds. */

enum { CANDIDATE_MAX_ROOTS = POLYNOMIAL_MAX_DEGREE };

struct candidate_roots {
  int count;
  double u[CANDIDATE_MAX_ROOTS], v[CANDIDATE_MAX_ROOTS]; /* leaf parameters, near or in [0,1] */
};

/* |Bernstein coefficient of r| <= RESULTANT_WEIGHT[n] (alpha beta)^n for nets with |a| <= alpha, |b| <= beta and n
 * eliminated: a minor [kl] is at most 2 C(n,k) C(n,l) alpha beta (Vandermonde's convolution sums the rest to 1), and
 * the determinant is the sum of the products of those bounds. A coefficient of r passes at most RESULTANT_ROUNDINGS
 * roundings: scaling 4, a minor 9 (8 products summed), cofactor 2 x 13 + 8, determinant 13 + 34 + 9. So it is off by
 * at most
 *   RESULTANT_WEIGHT[n] (alpha beta)^n (RESULTANT_ROUNDINGS UNIT_ROUNDOFF + n error (1/alpha + 1/beta)). */
static const double RESULTANT_WEIGHT[4] = {0, 2, 20, 1376};
#define RESULTANT_ROUNDINGS 64

/* Forms r from the nets a, b of the leaf's form with the patch's method, finds its roots with the patch's solver and
 * substitutes back. Counts the roots. Starting points only: nothing here is proven. */
void candidate_solve(struct tracer *tracer, const struct leaf *leaf, const double a[16], const double b[16],
                     double error, struct candidate_roots *out);

#endif

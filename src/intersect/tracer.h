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

/* Subdivision gives up on a box where a plane polynomial stays within this many error bounds of zero, its own
 * included. */
#define UNDECIDED_ERRORS 5

/* A point where a ray meets a leaf. */
struct leaf_hit {
  double u, v;               /* leaf parameters, in [0,1] up to the radii */
  double radius_u, radius_v; /* the exact root is within; meaningless where not certain */
  double w;                  /* x_k of the point, local */
  double t, t_error;         /* place on the ray, in units of the scaled direction, and a bound on its error */
  bool certain;              /* proven to exist, proven to be alone within its radii */
  bool sharp;                /* t and t_error are leaf_hit_sharpen's */
};

/* Whether a root lies behind t_min: where that can not be told, nobody can tell whether a ray that starts on the
 * surface meets it. */
enum leaf_hit_side { SIDE_BEFORE, SIDE_UNKNOWN, SIDE_BEHIND };

/* The bound on the error of a proven root's place on the ray: how far its radii let x_k move, and the roundings of
 * x_k and t. */
static inline double leaf_hit_t_error(const struct leaf *leaf, const struct leaf_hit *hit, double to_t)
{
  const double size = to_t < 0 ? -to_t : to_t, t = hit->t < 0 ? -hit->t : hit->t, w = hit->w < 0 ? -hit->w : hit->w;
  return size * (leaf->first[0] * hit->radius_u + leaf->first[1] * hit->radius_v) + 8 * UNIT_ROUNDOFF * (t + size * w);
}

/* zoom.c: t of a proven root to the last place of its own, however near to 0, from control points and ray as they
 * are. */
void leaf_hit_sharpen(const struct model *model, const struct leaf *leaf, const struct ray *ray, struct leaf_hit *root);

/* The side of t_min that the root is on; sharpens it where that is needed to tell. */
static inline enum leaf_hit_side leaf_hit_side(const struct model *model, const struct leaf *leaf,
                                               const struct ray *ray, struct leaf_hit *root)
{
  for (int n = 0; n < 2; n++) {
    if (root->t > ray->t_min + root->t_error) return SIDE_BEHIND;
    if (root->t < ray->t_min - root->t_error) return SIDE_BEFORE;
    if (!root->certain || root->sharp) break;
    leaf_hit_sharpen(model, leaf, ray, root);
  }
  return SIDE_UNKNOWN;
}

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

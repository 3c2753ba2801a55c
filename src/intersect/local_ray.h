/* A ray in the frame of one patch.
 *
 * Internal to src/intersect. Let k be the axis along which the direction d is longest, i and j the two others. The ray
 * is the line where two planes meet (paper eq 2), chosen so that their normals are exactly perpendicular to d:
 *
 *     x_i - (d_i/d_k) x_k = m[0],   x_j - (d_j/d_k) x_k = m[1].
 *
 * The moments m are formed in double-double from the unrounded origin. Their size is about 1 for a ray that passes the
 * patch, and they are right to a few units in the last place of that if the ray starts at most some 2^50 patches away;
 * beyond that their error grows, and `error` includes it. The position along the ray is read off x_k.
 */
#ifndef PSCN_INTERSECT_LOCAL_RAY_H
#define PSCN_INTERSECT_LOCAL_RAY_H

#include "intersect/intersect.h"
#include "intersect/model.h"

/* From positions on x_k to positions along the ray: t = ((unit w + start[1]) + start[0]) to_t at x_k = w. */
struct depth_map {
  double unit;     /* 1, or the power of two that keeps a start beyond the range of double within it */
  double start[2]; /* unit (center_k - origin_k)/scale as a double-double */
  double to_t;     /* scale/d_k/unit */
};

static inline double t_of_depth(const struct depth_map *map, double w)
{
  return ((map->unit * w + map->start[1]) + map->start[0]) * map->to_t;
}

/* The position w at which t is this, as nearly as doubles have it. */
static inline double depth_of_t(const struct depth_map *map, double t)
{
  return ((t / map->to_t - map->start[0]) - map->start[1]) / map->unit;
}

struct local_ray {
  int axis;         /* k; i = k + 1, j = k + 2 modulo 3 */
  double slope[2];  /* d_i/d_k, d_j/d_k, rounded; at most 1 in size */
  double moment[2]; /* m */
  struct depth_map depth;
  double error; /* bound on the error of a coefficient or a value (inside [0,1]^2) of either plane's polynomial */
};

/* Rounding errors, in units of UNIT_ROUNDOFF, of a = (x_i - m) - slope x_k and of its value in Bernstein form, for |x|
 * <= 1: net 8 (two for leaves that are cut exactly; others add the rounding of the cut, prepare/leaf.h and
 * leaf_kernel.c), slope 2 (packet.c multiplies by the reciprocal), moment 4|m|, the two operations 2 + |m|, and for the
 * value ten products and sums on coefficients of at most 2 + |m|. A value from weights, as in geometry/patch.h, has
 * eighteen: still less than sqrt 2 times this, and the certificate has that to spare for sums of a row. */
#define PLANE_ERROR(m0, m1) (UNIT_ROUNDOFF * (36 + 16 * ((m0) + (m1))))

/* What double-double leaves unknown of a moment m_i. Of q_i d_k and q_k d_i, exact products of the leading parts of the
 * origin's coordinates q in the frame of the patch, the sum of the rests takes roundings of at most 8 UNIT_ROUNDOFF^2
 * of the two. qi = |q_i|, qk = |q_k d_i/d_k|. */
#define MOMENT_ERROR(qi, qk) (8 * UNIT_ROUNDOFF * UNIT_ROUNDOFF * ((qi) + (qk)))

/* The axis along which d is longest. */
static inline int dominant_axis(const double d[3])
{
  const double x = d[0] < 0 ? -d[0] : d[0], y = d[1] < 0 ? -d[1] : d[1], z = d[2] < 0 ? -d[2] : d[2];
  return x >= y && x >= z ? 0 : y >= z ? 1 : 2;
}

void local_ray_make(const struct model_patch *patch, const struct ray *ray, struct local_ray *out);

/* Brings near a ray that starts so far away that double precision loses it, in wide arithmetic and by exact products,
 * so that no distance costs a digit.
 *
 * out_at: where the ray comes within 2 `frame` of `origin` along its dominant axis, or the ray's start if that is
 * later, as (point - origin)/frame, coordinates beyond 2^30 cut off there. Returns how far this is from the ray's
 * origin along that axis, in units of `frame`, at most 2^1000. */
double local_ray_enter(const struct ray *ray, const double origin[3], double frame, double out_at[3]);

/* The point at which the ray passes the middle of a copy, in the coordinates of the copy's object. Returns t there. */
double local_ray_enter_copy(const struct ray *ray, const struct model_copy *copy, double out_at[3]);

/* The plane polynomials' nets a, b and the net w of x_k for a local net x. */
void local_ray_nets(const struct local_ray *ray, const double x[3][16], double a[16], double b[16], double w[16]);

#endif

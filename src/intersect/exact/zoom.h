/* A ray through a patch in more than twice the precision: over small boxes of it, and at its roots.
 *
 * Internal to src/intersect/exact. Pure; safe on any thread.
 *
 * Where a ray is nearly tangent, some combination of the two plane polynomials is so small all over a box that double
 * precision cannot tell it from zero. Its coefficients over just that box are therefore formed in fixed point
 * (base/fixed.h) from the unrounded control points, and only then rounded to double. They are right to their own last
 * places: what was below all rounding becomes a polynomial like any other. docs/method.md, "The numbers of the last
 * resort", states how many bits it has, and what they suffice for.
 */
#ifndef PSCN_INTERSECT_EXACT_ZOOM_H
#define PSCN_INTERSECT_EXACT_ZOOM_H

#include <float.h>
#include <math.h>

#include "base/fixed.h"
#include "intersect/exact/exact.h"

/* A ray through a whole patch: a, b and x_k in powers of 2u - 1 and 2v - 1. Each is scaled by a power of two, which is
 * larger the thinner the patch is that way. */
struct zoom {
  /* k: the axis along which the ray is longest, or for a very thin patch longest relative to the patch */
  int axis;
  fixed power[3][4][4];
  double unit[3]; /* those powers of two */
  wide origin;    /* (origin_k - center_k)/scale */
  wide to_t;      /* t = (x_k - origin) to_t */
  /* bound on the rounding of the scaled a or b on the patch, or of their coefficients over a box */
  double error;
  double depth_error; /* the same for x_k, unscaled */
  bool pole[4];       /* the patch's borders that are one point */
};

/* The error of t that an error of x_k makes. Below the normal numbers it is rounded up, with the little that may be
 * added to it. */
static inline double error_to_t(double to_t, double error) { return fabs(to_t) * error + DBL_TRUE_MIN; }

/* Bound on rounding in the patch's frame. */
static inline double zoom_error(const struct zoom *zoom)
{
  const double *unit = zoom->unit;
  return zoom->depth_error + zoom->error / (unit[0] < unit[1] ? unit[0] : unit[1]);
}

/* The same over a box, in the box's parameters. */
struct zoomed {
  /* two combinations of a and b with the same common roots, at most 1 in size; x_k less that of the box's middle */
  double net[3][4][4];
  double error[2]; /* bounds on the errors of the first two nets' coefficients */
  /* of zoom_pole_box, if the pole is met but not exactly: their additional errors, over the distance from the border,
   * as a part of the box */
  double met[2];
  wide start; /* t = (w + start) scale/d_k for w of net[2] */
};

/* P: the patch's control points, in the scene. */
void zoom_start(const struct model_patch *patch, double (*P)[4][3], const struct ray *ray, struct zoom *out);

/* The box of the patch with low corner (low[0], low[1]). zeros: how often a and b are exactly 0 along each of its
 * borders (geometry/edges.h); both are divided by the distance from there as often, and else their roots are the same.
 * Returns how many of the two combinations are not zero as far as fixed point can tell: 2; 1, both nets then being that
 * one; or 0, and the nets mean nothing. */
int zoom_box(const struct zoom *zoom, const wide low[2], const wide size[2], const int zeros[4], struct zoomed *out);

/* How a ray passes a border of the patch that is one point. */
enum zoom_pole {
  POLE_PASSED, /* past it */
  POLE_MET     /* as far as wide arithmetic can tell */
};

/* A met pole is no farther from the ray than this many of the zoom's errors. */
#define ZOOM_POLE_REACH 0x1p26

/* If the pole is met, nothing is told of what is nearer to its border than this, as a part of the box. */
#define ZOOM_POLE_MET 0x1p-40

/* The same for a box at a border that is one point (geometry/edges.h), where both polynomials are constant. The
 * combination that is zero there is replaced by its quotient by the distance d to the border. Away from the border the
 * roots are the same, and they are simple however near the ray passes. If the pole is met, both combinations are
 * divided. */
bool zoom_pole_box(const struct zoom *zoom, const wide low[2], const wide size[2], int border, struct zoomed *out,
                   enum zoom_pole *out_pole);

/* p a + q b, in powers. */
static inline void zoom_combine(fixed a[4][4], fixed b[4][4], fixed p, fixed q, fixed out[4][4])
{
  for (int n = 0; n < 16; n++)
    out[n / 4][n % 4] = fixed_product(p, a[n / 4][n % 4]) + fixed_product(q, b[n / 4][n % 4]);
}

/* ---- sharpen.c ---- */

/* t of the point (u,v). */
wide zoom_t(struct zoom *zoom, wide u, wide v);

/* Two combinations of a and b at (u,v), out[k] = row[k][0] a + row[k][1] b: value, and derivatives by the parameters,
 * from -1 to 1, of a box that is size[0] long in u and size[1] in v. Returns a bound on the errors of the values. */
double zoom_combinations(struct zoom *zoom, wide u, wide v, const double size[2], double row[2][2], double out[2][3]);

/* Refines a proven root of this ray and patch as far as wide arithmetic allows. Returns false if the certificate does
 * not hold there, or what is found is not the same root; then the root may be at a better place, with bounds that are
 * wider by as much as it moved. */
bool zoom_sharpen(struct zoom *zoom, struct exact_root *root);

#endif

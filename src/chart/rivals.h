/* Other ways to intersect a ray with a patch, each from its publication, for the chart only: nothing here is proven, and
 * nothing else of pscn is used but the hierarchy of boxes.
 *
 * All of them get the same parts of patches, by the same hierarchy, one ray at a time in scalar arithmetic, and look for
 * the common roots of the two planes' polynomials (paper eq 2 and 3) on a part. None is told how far the nearest hit so
 * far is.
 */
#ifndef PSCN_CHART_RIVALS_H
#define PSCN_CHART_RIVALS_H

#include <math.h>

#include "chart/judge.h"
#include "chart/measure.h"
#include "geometry/patch.h"

enum { RIVAL_SPLIT = 8, RIVAL_ROOTS = 18 }; /* parts of a patch along each side; roots that one part can have */

/* A part reaches this far beyond its borders, in its parameters, so that no root is lost between two. */
#define RIVAL_EDGE 1e-8

struct rival_root {
  double u, v; /* in [0,1], of the part */
};

/* The Bernstein nets over a part, a[i][j] with i along u. Returns how many roots were found, at most RIVAL_ROOTS. */
typedef int rival_seek(double a[4][4], double b[4][4], struct rival_root out[RIVAL_ROOTS]);

/* Whether all values of a net, so its polynomial too, have one sign, and none is 0. */
static inline bool rival_keeps_sign(double net[4][4])
{
  double low = net[0][0], high = low;
  for (int n = 1; n < 16; n++) low = fmin(low, net[n / 4][n % 4]), high = fmax(high, net[n / 4][n % 4]);
  return low > 0 || high < 0;
}

/* A step of Newton's method in two dimensions; returns its larger part. */
static inline double rival_step(double a[4][4], double b[4][4], struct rival_root *root)
{
  const struct patch_jet f = patch_evaluate(a, root->u, root->v), g = patch_evaluate(b, root->u, root->v);
  const double inverse = 1 / (f.du * g.dv - f.dv * g.du);
  const double du = (f.value * g.dv - g.value * f.dv) * inverse, dv = (g.value * f.du - f.value * g.du) * inverse;
  root->u -= du, root->v -= dv;
  return fmax(fabs(du), fabs(dv));
}

rival_seek rival_newton;      /* rival_newton.c */
rival_seek rival_subdivision; /* rival_boxes.c */
rival_seek rival_krawczyk;    /* rival_boxes.c */
rival_seek rival_clipping;    /* rival_clipping.c */

/* By LAPACK, in a module of its own (rival_eigen.c), which need not be there. */
#define RIVAL_MODULE_FILE "pscn_lapack.so"
#define RIVAL_COMPANION "rival_companion"
#define RIVAL_PENCIL "rival_pencil"
rival_seek rival_companion, rival_pencil;

struct rivals;

/* Cuts the patches into parts. Borrows rays[RAY_KINDS]. NULL if memory is short. */
struct rivals *rivals_create(const struct scene *scene, const struct ray_list *rays);
void rivals_destroy(struct rivals *rivals);

/* The rays by one of the methods; *rivals answers by this one from then on. */
struct runner rivals_face(struct rivals *rivals, rival_seek *seek);

#endif

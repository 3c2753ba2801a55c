/* Bezier clipping (T. Nishita, T. W. Sederberg, M. Kakimoto, "Ray Tracing Trimmed Rational Surface Patches", SIGGRAPH
 * 1990). The patch as the two planes see it is a patch in the plane, (a, b), and the ray is the origin. Distances of its
 * control points from a line through the origin, along the mean direction of the patch's other parameter, are a
 * function whose convex hull meets 0 in a part of the range; the rest is clipped away. */
#include <string.h>

#include "chart/rivals.h"

/* A range narrower than this is a root. Its best: narrower ones gain no digit of T. */
#define NARROW 1e-12

/* A clip that leaves more than this of the range is replaced by a split, as there are two roots. */
#define LEFT_OVER 0.8

/* What is kept on either side of a clip for roundings, of its range. */
#define ROOM 1e-10

enum { MOST_CLIPS = 1024, WAITING = 64 };

struct range {
  double from[2], width[2]; /* in u and v, of the part */
  double a[4][4], b[4][4];
};

/* Where the hull of the distances may be 0 along u (0) or v (1). Returns whether it may be at all. */
static bool clip(struct range *range, int along, double *out_from, double *out_to)
{
  double line[2] = {0, 0}, x[8], d[8];
  for (int end = 0; end < 4; end += 3) {
    const int i = along == 0 ? end : 3, j = along == 0 ? 3 : end, k = along == 0 ? end : 0, l = along == 0 ? 0 : end;
    line[0] += range->a[i][j] - range->a[k][l], line[1] += range->b[i][j] - range->b[k][l];
  }
  for (int k = 0; k < 4; k++) {
    x[k] = x[4 + k] = k / 3.0;
    d[k] = INFINITY, d[4 + k] = -INFINITY;
    for (int n = 0; n < 4; n++) {
      const int i = along == 0 ? k : n, j = along == 0 ? n : k;
      const double distance = line[0] * range->b[i][j] - line[1] * range->a[i][j];
      d[k] = fmin(d[k], distance), d[4 + k] = fmax(d[4 + k], distance);
    }
  }
  *out_from = INFINITY, *out_to = -INFINITY;
  for (int above = 0; above < 8; above++) {
    for (int below = 0; below < 8; below++) {
      if (!(d[above] >= 0 && d[below] <= 0)) continue;
      const double drop = d[above] - d[below];
      const double at = drop > 0 ? x[above] + (x[below] - x[above]) * (d[above] / drop) : x[above];
      *out_from = fmin(*out_from, at), *out_to = fmax(*out_to, at);
    }
  }
  *out_from = fmax(*out_from - ROOM, 0), *out_to = fmin(*out_to + ROOM, 1);
  return *out_from <= *out_to;
}

static void narrow(struct range *range, int along, double from, double to)
{
  const double u[2] = {along == 0 ? from : 0, along == 0 ? to : 1}, v[2] = {along == 1 ? from : 0, along == 1 ? to : 1};
  patch_subnet(range->a, u[0], u[1], v[0], v[1], range->a);
  patch_subnet(range->b, u[0], u[1], v[0], v[1], range->b);
  range->from[along] += from * range->width[along];
  range->width[along] *= to - from;
}

int rival_clipping(double a[4][4], double b[4][4], struct rival_root out[RIVAL_ROOTS])
{
  struct range stack[WAITING];
  int top = 1, count = 0, along = 0;
  stack[0] = (struct range){.width = {1, 1}};
  memcpy(stack[0].a, a, sizeof stack[0].a), memcpy(stack[0].b, b, sizeof stack[0].b);
  for (int clips = 0; top > 0 && clips < MOST_CLIPS && count < RIVAL_ROOTS; clips++) {
    struct range *range = &stack[top - 1];
    double from, to;
    if (fmax(range->width[0], range->width[1]) < NARROW) {
      out[count++] = (struct rival_root){range->from[0] + 0.5 * range->width[0],
                                         range->from[1] + 0.5 * range->width[1]};
      top--;
      continue;
    }
    along = range->width[!along] >= NARROW ? !along : along;
    if (!clip(range, along, &from, &to)) {
      top--;
    } else if (to - from <= LEFT_OVER || top == WAITING) {
      narrow(range, along, from, to);
    } else {
      along = range->width[1] > range->width[0];
      stack[top] = *range;
      narrow(&stack[top++], along, 0.5, 1);
      narrow(range, along, 0, 0.5);
    }
  }
  return count;
}

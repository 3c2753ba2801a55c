/* Newton's method on two planes through the ray (the planes are from J. Kajiya, "Ray tracing parametric patches",
 * SIGGRAPH 1982), one ray a lane. */
#include <float.h>
#include <math.h>

#include "base/kernel.h"
#include "base/lanes.h"
#include "chart/plain_newton.h"
#include "chart/plain_newton_kernel.h"
#include "geometry/vector.h"

#define LAST_STEP 1e-8 /* of a parameter: the remaining error is of the order of its square */
#define EDGE 1e-9      /* of a parameter: roots this far outside a part still count, so that none is lost between two */
#define ASTRAY 8       /* in half sides of a part: farther iterates are given up */

/* Relative. The t at which a ray enters a box, and that at which it leaves, have three roundings each (the difference,
 * the product and the inverse), and the product with the slack has one more: 7 x 2^-53 in all. With 10 x 2^-53, no ray
 * that only grazes the box is lost. */
#define BOX_SLACK (1 + 5 * DBL_EPSILON)

enum { STEPS = 5 };

struct ray_lanes {
  lanes origin[3], direction[3], inverse[3], t_min;
  lanes normal[2][3]; /* of the two planes */
};

struct best {
  lanes t;
  uint32_t patch[LANES];
};

/* Values and derivatives of the cubic Bernstein polynomials. */
LANES_INLINE void weights(lanes u, lanes w[4], lanes d[4])
{
  const lanes s = 1 - u, uu = u * u, ss = s * s, us = u * s;
  w[0] = ss * s, w[1] = 3 * ss * u, w[2] = 3 * s * uu, w[3] = uu * u;
  d[0] = -3 * ss, d[1] = 3 * (ss - 2 * us), d[2] = 3 * (2 * us - uu), d[3] = 3 * uu;
}

/* net(u,v) and its derivatives. */
LANES_INLINE void evaluate(const lanes net[16], const lanes wu[4], const lanes du[4], const lanes wv[4],
                           const lanes dv[4], lanes out[3])
{
  out[0] = out[1] = out[2] = lanes_all(0);
#pragma GCC unroll 4
  for (int i = 0; i < 4; i++) {
    lanes row = lanes_all(0), slope = lanes_all(0);
#pragma GCC unroll 4
    for (int j = 0; j < 4; j++) row += net[4 * i + j] * wv[j], slope += net[4 * i + j] * dv[j];
    out[0] += row * wu[i], out[1] += row * du[i], out[2] += slope * wu[i];
  }
}

/* The distances of the control points from the two planes. */
LANES_INLINE void form_nets(const struct ray_lanes *ray, double (*x)[4][4], lanes a[16], lanes b[16])
{
  for (int k = 0; k < 16; k++) {
    const lanes p[3] = {x[0][k / 4][k % 4] - ray->origin[0], x[1][k / 4][k % 4] - ray->origin[1],
                        x[2][k / 4][k % 4] - ray->origin[2]};
    a[k] = p[0] * ray->normal[0][0] + p[1] * ray->normal[0][1] + p[2] * ray->normal[0][2];
    b[k] = p[0] * ray->normal[1][0] + p[1] * ray->normal[1][1] + p[2] * ray->normal[1][2];
  }
}

/* t of S(u,v), in units of the direction, which has length 1. */
LANES_INLINE lanes distance(const struct ray_lanes *ray, double (*x)[4][4], lanes u, lanes v)
{
  lanes wu[4], wv[4], unused[4], t = lanes_all(0);
  weights(u, wu, unused);
  weights(v, wv, unused);
  for (int axis = 0; axis < 3; axis++) {
    lanes sum = lanes_all(0);
    for (int i = 0; i < 4; i++) {
      lanes row = lanes_all(0);
      for (int j = 0; j < 4; j++) row += x[axis][i][j] * wv[j];
      sum += row * wu[i];
    }
    t += (sum - ray->origin[axis]) * ray->direction[axis];
  }
  return t;
}

static void try_part(const struct plain_model *model, const struct plain_part *part, const struct ray_lanes *ray,
                     struct best *best)
{
  const double half = 0.5 / PLAIN_NEWTON_SPLIT;
  double(*x)[4][4] = model->x[part->patch];
  lanes a[16], b[16], u = lanes_all(part->u), v = lanes_all(part->v), step = lanes_all(INFINITY);
  lane_mask going = lanes_mask((1u << LANES) - 1);
  form_nets(ray, x, a, b);
  for (int n = 0; n < STEPS; n++) {
    lanes wu[4], du[4], wv[4], dv[4], fa[3], fb[3];
    weights(u, wu, du);
    weights(v, wv, dv);
    evaluate(a, wu, du, wv, dv, fa);
    evaluate(b, wu, du, wv, dv, fb);
    const lanes inverse = 1 / (fa[1] * fb[2] - fa[2] * fb[1]);
    const lanes su = (fa[0] * fb[2] - fb[0] * fa[2]) * inverse, sv = (fb[0] * fa[1] - fa[0] * fb[1]) * inverse;
    u -= su, v -= sv;
    step = lanes_max(lanes_abs(su), lanes_abs(sv));
    going &= (lanes_abs(u - part->u) < ASTRAY * half) & (lanes_abs(v - part->v) < ASTRAY * half);
    if (!lanes_any(going & (step > LAST_STEP))) break;
  }
  going &= (step <= LAST_STEP) & (lanes_abs(u - part->u) <= half + EDGE) & (lanes_abs(v - part->v) <= half + EDGE);
  if (!lanes_any(going)) return;
  const lanes t = distance(ray, x, u, v);
  going &= (t > ray->t_min) & (t < best->t);
  best->t = lanes_select(going, t, best->t);
  for (unsigned bits = lanes_bits(going), k = 0; bits != 0; bits >>= 1, k++)
    if (bits & 1u) best->patch[k] = part->patch;
}

/* t at which the rays enter a child's box; INFINITY for those that miss it. */
LANES_INLINE lanes enter_box(const struct bvh_node *node, int side, const struct ray_lanes *ray, lanes t_max)
{
  lanes t_min = ray->t_min;
  for (int k = 0; k < 3; k++) {
    const lanes p = ((double)node->lo[k][side] - ray->origin[k]) * ray->inverse[k];
    const lanes q = ((double)node->hi[k][side] - ray->origin[k]) * ray->inverse[k];
    t_min = lanes_max(lanes_min(p, q), t_min);
    t_max = lanes_min(lanes_max(p, q), t_max);
  }
  return lanes_select(t_min <= t_max * BOX_SLACK, t_min, lanes_all(INFINITY));
}

LANES_INLINE double least(lanes x)
{
  double value = x[0];
  for (int k = 1; k < LANES; k++) value = x[k] < value ? x[k] : value;
  return value;
}

static void walk(const struct plain_model *model, const struct ray_lanes *ray, bool any, struct best *best)
{
  struct {
    uint32_t at;
    double enter;
  } stack[BVH_STACK];
  const lanes t_max = best->t;
  size_t top = 0;
  if (model->bvh.node_count > 0) stack[top].at = 0, stack[top++].enter = 0;
  while (top > 0) {
    const uint32_t at = stack[--top].at;
    if (!lanes_any(best->t > stack[top].enter)) continue;
    if (any && !lanes_any((best->t == t_max) & (ray->t_min < t_max))) return;
    if (at & BVH_LEAF) {
      try_part(model, &model->parts[at & ~BVH_LEAF], ray, best);
      continue;
    }
    const struct bvh_node *node = &model->bvh.nodes[at];
    const size_t first = top;
    for (int side = 0; side < BVH_WIDTH && node->child[side] != 0; side++) {
      const double enter = least(enter_box(node, side, ray, best->t));
      if (!isfinite(enter)) continue;
      size_t n = top++; /* the nearest on top */
      for (; n > first && stack[n - 1].enter < enter; n--) stack[n] = stack[n - 1];
      stack[n].at = node->child[side], stack[n].enter = enter;
    }
  }
}

/* Loads ray k into lane k; lanes without a ray never hit. length[k]: that of the direction. */
static void load(size_t count, const struct ray *rays, struct ray_lanes *out, lanes *out_t_max, double length[LANES])
{
  for (size_t k = 0; k < LANES; k++) {
    const struct ray *ray = &rays[k < count ? k : 0];
    const double *d = ray->direction;
    length[k] = vector_length(d);
    const int large = fabs(d[0]) > fabs(d[1]) ? (fabs(d[0]) > fabs(d[2]) ? 0 : 2) : (fabs(d[1]) > fabs(d[2]) ? 1 : 2);
    const int i = (large + 1) % 3, j = (large + 2) % 3;
    for (int axis = 0; axis < 3; axis++) {
      out->origin[axis][k] = ray->origin[axis];
      out->direction[axis][k] = d[axis] / length[k];
      out->inverse[axis][k] = length[k] / d[axis];
    }
    out->normal[0][i][k] = out->normal[1][j][k] = 1;
    out->normal[0][j][k] = out->normal[1][i][k] = 0;
    out->normal[0][large][k] = -d[i] / d[large];
    out->normal[1][large][k] = -d[j] / d[large];
    out->t_min[k] = ray->t_min * length[k];
    (*out_t_max)[k] = k < count ? ray->t_max * length[k] : -INFINITY;
  }
}

void KERNEL(plain_newton)(const struct plain_model *model, size_t count, const struct ray *rays, bool any,
                          struct answer *out)
{
  for (size_t first = 0; first < count; first += LANES) {
    const size_t some = count - first < LANES ? count - first : LANES;
    struct ray_lanes ray = {.t_min = lanes_all(0)};
    struct best best;
    lanes t_max = lanes_all(0);
    double length[LANES];
    load(some, rays + first, &ray, &t_max, length);
    best.t = t_max;
    walk(model, &ray, any, &best);
    for (size_t k = 0; k < some; k++) {
      const bool hit = best.t[k] < t_max[k];
      out[first + k] = (struct answer){hit ? best.t[k] / length[k] : INFINITY, hit ? best.patch[k] : HIT_NONE};
    }
  }
}

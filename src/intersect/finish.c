/* From the winning roots to the answers: the last Newton step, the point, the normal, the certainty. */
#include <math.h>

#include "base/real.h"
#include "geometry/patch.h"
#include "geometry/vector.h"
#include "intersect/last_step.h"
#include "intersect/tracer.h"

static double clamp01(double t) { return t < 0 ? 0 : t > 1 ? 1 : t; }

/* The borders of the patch (see geometry/edges.h) that the root lies on within its radius, as bits; a leaf's own borders inside
 * the patch are none. */
static unsigned borders_of(const struct model_patch *patch, const struct leaf *leaf, const struct leaf_hit *root)
{
  const int last = patch->split - 1;
  return (unsigned)(leaf->column_u == 0 && root->u < root->radius_u) << 0 |
         (unsigned)(leaf->column_u == last && root->u > 1 - root->radius_u) << 1 |
         (unsigned)(leaf->column_v == 0 && root->v < root->radius_v) << 2 |
         (unsigned)(leaf->column_v == last && root->v > 1 - root->radius_v) << 3;
}

/* The side of the border's curve, as seen along d, on which the patch lies at `along`: the sign of det(d, tangent, inward), 0
 * where it is too small a part of what it could be to be sure of. The tangent runs along the border's parameter. */
static int inner_side(struct model_patch *patch, int border, double along, const double d[3])
{
  /* Derivatives are right to some units in the last place of the patch's size 1; the side is sure well above that. */
  static const double sure = 0x1p-40;
  const double u = border == 0 ? 0 : border == 1 ? 1 : along, v = border == 2 ? 0 : border == 3 ? 1 : along;
  const double inward = border == 0 || border == 2 ? 1 : -1;
  double tangent[3], in[3], normal[3];
  for (int c = 0; c < 3; c++) {
    const struct patch_jet jet = patch_evaluate(patch->x[c], u, v);
    tangent[c] = border < 2 ? jet.dv : jet.du;
    in[c] = inward * (border < 2 ? jet.du : jet.dv);
  }
  vector_cross(tangent, in, normal);
  const double side = vector_dot(normal, d);
  return side > sure ? 1 : side < -sure ? -1 : 0;
}

/* A root on a border is proven where the border is shared and the two patches lie on either side of it as seen along the ray:
 * then the ray, wherever it passes within the radius, meets one of them. */
static bool passes_border(const struct model *model, uint32_t index, unsigned borders, double u, double v, const double d[3])
{
  if (borders & (borders - 1)) return false; /* a corner */
  const int border = __builtin_ctz(borders);
  const struct edge_neighbour *other = &model->neighbours[4 * (size_t)index + (size_t)border];
  if (other->patch == EDGE_NONE) return false;
  const double along = border < 2 ? v : u;
  const int here = inner_side(&model->patches[index], border, along, d);
  int there = inner_side(&model->patches[other->patch], other->border, other->reversed ? 1 - along : along, d);
  if (other->reversed) there = -there;
  return here * there == -1;
}

/* The point: its value (ten roundings on coefficients below one), the last places of u and v, one rounding of the sum; in each
 * coordinate, so up to sqrt(3) of it in distance. */
static double point_error(const struct model_patch *patch, double tangent, double magnitude)
{
  return 2 * ((12 + 2 * tangent) * UNIT_ROUNDOFF * patch->scale + UNIT_ROUNDOFF * magnitude);
}

/* The point, its error bound and the normal at (u,v). */
static void set_surface(struct model_patch *patch, const double direction[3], struct hit *out)
{
  double tangent = 0, magnitude = 0, su[3], sv[3];
  for (int c = 0; c < 3; c++) {
    const struct patch_jet jet = patch_evaluate(patch->x[c], out->u, out->v);
    out->point[c] = patch->center[c] + patch->scale * jet.value;
    su[c] = jet.du, sv[c] = jet.dv;
    tangent = real_max(tangent, fabs(jet.du) + fabs(jet.dv));
    magnitude = real_max(magnitude, fabs(out->point[c]));
  }
  out->point_error = point_error(patch, tangent, magnitude);
  vector_cross(su, sv, out->normal);
  const double length = vector_length(out->normal);
  if (length > PLAIN_NORMAL * tangent * tangent) vector_scale(1 / length, out->normal, out->normal);
  else patch_normal(patch->x, out->u, out->v, out->normal);
  if (vector_dot(out->normal, direction) > 0) vector_scale(-1, out->normal, out->normal);
}

/* Gives a root on a shared border to the patch that stands first in the scene, so that which of the two has it does not depend on
 * the last bits. A corner is left where it was found. */
static void settle_border(const struct model *model, unsigned borders, struct hit *hit)
{
  if (borders == 0 || (borders & (borders - 1))) return;
  const int border = __builtin_ctz(borders);
  const struct edge_neighbour *other = &model->neighbours[4 * (size_t)hit->patch + (size_t)border];
  if (other->patch >= hit->patch) return; /* EDGE_NONE is the largest */
  const double found = border < 2 ? hit->v : hit->u, along = other->reversed ? 1 - found : found, side = other->border & 1;
  hit->patch = other->patch;
  hit->u = other->border < 2 ? side : along;
  hit->v = other->border < 2 ? along : side;
}

/* A ray that starts nearer to the surface than this cannot be told from one that starts on it: the point's own error and the
 * rounding of the new origin, and the distance within which subdivision cannot exclude a root: UNDECIDED_ERRORS error bounds of
 * either plane, with moments of at most 2 as for all rays that start in the patch's box; doubled for the planes' being
 * oblique. On a border the neighbour's size counts as well. */
static double clearance(const struct model *model, uint32_t index, unsigned borders, const struct hit *hit)
{
  double scale = model->patches[index].scale, magnitude = 0;
  for (int border = 0; border < 4; border++) {
    const uint32_t other = model->neighbours[4 * (size_t)index + (size_t)border].patch;
    if ((borders >> border & 1) && other != EDGE_NONE) scale = real_max(scale, model->patches[other].scale);
  }
  for (int k = 0; k < 3; k++) magnitude = real_max(magnitude, fabs(hit->point[k]));
  return hit->point_error + 4 * UNIT_ROUNDOFF * magnitude + 2 * UNDECIDED_ERRORS * PLANE_ERROR(2, 2) * scale;
}

/* What the last step has found on a lane. */
static void take_lane(const struct last_step *l, unsigned lane, struct hit *out)
{
  struct model_patch *patch = (struct model_patch *)l->patch;
  out->u = l->u[lane], out->v = l->v[lane], out->t = l->t[lane];
  double facing = 0, magnitude = 0;
  for (int c = 0; c < 3; c++) {
    out->point[c] = patch->center[c] + patch->scale * l->point[c][lane];
    out->normal[c] = l->normal[c][lane];
    facing += out->normal[c] * l->direction[c][lane];
    magnitude = real_max(magnitude, fabs(out->point[c]));
  }
  if (!l->plain[lane]) {
    double direction[3];
    for (int c = 0; c < 3; c++) direction[c] = l->direction[c][lane];
    set_surface(patch, direction, out);
    return;
  }
  out->point_error = point_error(patch, l->tangent[lane], magnitude);
  if (facing > 0) vector_scale(-1, out->normal, out->normal);
}

/* Certainty, border and clearance of a hit whose place is settled. */
static void settle(const struct model *model, const struct ray *ray, const struct best *best, struct hit *out)
{
  const struct leaf *leaf = best->leaf;
  /* The improvement may have taken the last bits of t to the end of the interval. */
  if (!(out->t > ray->t_min)) out->t = nextafter(ray->t_min, INFINITY);
  if (!(out->t < ray->t_max)) out->t = nextafter(ray->t_max, -INFINITY);
  const unsigned borders = borders_of(&model->patches[leaf->patch], leaf, &best->root);
  if (!best->root.certain || (borders && !passes_border(model, leaf->patch, borders, out->u, out->v, ray->direction)))
    out->certainty = CERTAINTY_GRAZING;
  settle_border(model, borders, out);
  if (out->patch != leaf->patch) set_surface(&model->patches[out->patch], ray->direction, out);
  out->clearance = clearance(model, leaf->patch, borders, out);
}

void finish_hits(const struct model *model, size_t count, const struct ray rays[], const struct best best[],
                 struct hit out[])
{
  unsigned left = 0; /* lanes with a hit that is not finished */
  for (size_t l = 0; l < count; l++) {
    out[l].patch = best[l].leaf ? best[l].leaf->patch : HIT_NONE;
    out[l].certainty = model->unproven || best[l].doubt ? CERTAINTY_GRAZING : CERTAINTY_CERTAIN;
    if (best[l].leaf) left |= 1u << l;
  }
  while (left) {
    const unsigned first = (unsigned)__builtin_ctz(left);
    struct last_step step;
    step.patch = &model->patches[out[first].patch], step.axis = dominant_axis(rays[first].direction);
    unsigned group = 0;
    for (unsigned l = 0; l < LANES; l++) {
      const bool one = left >> l & 1 && out[l].patch == out[first].patch && dominant_axis(rays[l].direction) == step.axis;
      const unsigned at = one ? l : first; /* idle lanes repeat the first */
      const struct best *b = &best[at];
      group |= (unsigned)one << l;
      for (int c = 0; c < 3; c++) step.origin[c][l] = rays[at].origin[c], step.direction[c][l] = rays[at].direction[c];
      step.u[l] = clamp01(leaf_to_patch(step.patch->split, b->leaf->column_u, b->root.u));
      step.v[l] = clamp01(leaf_to_patch(step.patch->split, b->leaf->column_v, b->root.v));
      step.t[l] = b->root.t, step.improves[l] = b->root.certain ? -1 : 0;
    }
    last_step(&step);
    for (unsigned bits = group; bits; bits &= bits - 1) {
      const unsigned l = (unsigned)__builtin_ctz(bits);
      take_lane(&step, l, &out[l]);
      settle(model, &rays[l], &best[l], &out[l]);
    }
    left &= ~group;
  }
}

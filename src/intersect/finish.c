/* From the winning roots to the answers: the last Newton step, the point, the normal, the certainty. */
#include <math.h>

#include "base/real.h"
#include "geometry/patch.h"
#include "geometry/vector.h"
#include "intersect/last_step.h"
#include "intersect/packet.h"

/* What a settled root is decided by. */
struct settling {
  const struct ray *ray;
  uint32_t patch;
  unsigned borders; /* of the patch (see geometry/edges.h) that the root lies on within its radius, as bits */
  bool certain;
};

/* The side of the border's curve, as seen along d, on which the patch lies at `along`: the sign of det(d, tangent,
 * inward), 0 where it is too small a part of what it could be to be sure of. The tangent runs along the border's
 * parameter. */
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

/* A root on a border is proven where the border is shared and the two patches lie on either side of it as seen along
 * the ray: then the ray, wherever it passes within the radius, meets one of them. */
static bool passes_border(const struct model *model, uint32_t index, unsigned borders, double u, double v,
                          const double d[3])
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

/* The point: its value (ten roundings on coefficients below one), the last places of u and v, one rounding of the
 * sum; in each coordinate, so up to sqrt(3) of it in distance. `tangent` bounds the derivatives' coordinates. */
#define POINT_ERROR(scale, tangent, magnitude) \
  (2 * ((12 + 2 * (tangent)) * UNIT_ROUNDOFF * (scale) + UNIT_ROUNDOFF * (magnitude)))

/* A ray that starts nearer to the surface than this and the point's own error cannot be told from one that starts on
 * it: the rounding of the new origin, and the distance within which subdivision cannot exclude a root:
 * UNDECIDED_ERRORS error bounds of either plane, with moments of at most 2 as for all rays that start in the patch's
 * box, and what a copy is loose by; doubled for the planes' being oblique. */
#define CLEARANCE(scale, loose, magnitude) \
  (4 * UNIT_ROUNDOFF * (magnitude) + 2 * UNDECIDED_ERRORS * (PLANE_ERROR(2, 2) * (scale) + 2 * (loose)))

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
  out->point_error = POINT_ERROR(patch->scale, tangent, magnitude);
  vector_cross(su, sv, out->normal);
  const double length = vector_length(out->normal);
  if (length > PLAIN_NORMAL * tangent * tangent) vector_scale(1 / length, out->normal, out->normal);
  else patch_normal(patch->x, out->u, out->v, out->normal);
  if (vector_dot(out->normal, direction) > 0) vector_scale(-1, out->normal, out->normal);
}

/* Gives a root on a shared border to the patch that stands first in the scene, so that which of the two has it does
 * not depend on the last bits. A corner is left where it was found. */
static void settle_border(const struct model *model, unsigned borders, struct hit *hit)
{
  if (borders == 0 || (borders & (borders - 1))) return;
  const int border = __builtin_ctz(borders);
  const struct edge_neighbour *other = &model->neighbours[4 * (size_t)hit->patch + (size_t)border];
  if (other->patch >= hit->patch) return; /* EDGE_NONE is the largest */
  const double found = border < 2 ? hit->v : hit->u, along = other->reversed ? 1 - found : found,
               side = other->border & 1;
  hit->patch = other->patch;
  hit->u = other->border < 2 ? side : along;
  hit->v = other->border < 2 ? along : side;
}

/* The clearance of a hit, on a border by the size of the neighbour as well. */
static double clearance(const struct model *model, uint32_t index, unsigned borders, const struct hit *hit)
{
  double scale = model->patches[index].scale, loose = model->patches[index].loose, magnitude = 0;
  for (int border = 0; border < 4; border++) {
    const uint32_t other = model->neighbours[4 * (size_t)index + (size_t)border].patch;
    if (!(borders >> border & 1) || other == EDGE_NONE) continue;
    scale = real_max(scale, model->patches[other].scale), loose = real_max(loose, model->patches[other].loose);
  }
  for (int k = 0; k < 3; k++) magnitude = real_max(magnitude, fabs(hit->point[k]));
  return hit->point_error + CLEARANCE(scale, loose, magnitude);
}

/* Certainty, border and clearance of a hit whose place is settled. */
static void settle(const struct model *model, const struct settling *s, struct hit *out)
{
  const uint32_t patch = s->patch;
  /* The improvement may have taken the last bits of t to the end of the interval. */
  if (!(out->t > s->ray->t_min)) out->t = nextafter(s->ray->t_min, INFINITY);
  if (!(out->t < s->ray->t_max)) out->t = nextafter(s->ray->t_max, -INFINITY);
  if (!s->certain || (s->borders && !passes_border(model, patch, s->borders, out->u, out->v, s->ray->direction)))
    out->certainty = CERTAINTY_GRAZING;
  settle_border(model, s->borders, out);
  if (out->patch != patch) set_surface(&model->patches[out->patch], s->ray->direction, out);
  out->clearance = clearance(model, patch, s->borders, out);
}

/* The lanes of `group`, whose best roots are on one patch and whose rays share an axis. */
static void finish_group(const struct packet *p, unsigned group, int axis, uint32_t index, struct hit out[])
{
  const struct model *model = p->model;
  struct model_patch *patch = &model->patches[index];
  const struct best *best = &p->best;
  const lane_mask mask = lanes_mask(group);
  struct last_step step;
  step.patch = patch, step.axis = axis, step.origin = p->origin, step.direction = p->direction;
  step.improves = mask & best->certain;
  step.u = last_step_clamp(best->u), step.v = last_step_clamp(best->v);
  step.t = best->t;
  last_step(&step);
  /* next to the ray's start it has more digits than the last step's sums */
  step.t = lanes_select(best->sharp, best->t, step.t);
  lanes facing = lanes_all(0), magnitude = lanes_all(0), point[3];
  for (int c = 0; c < 3; c++) {
    point[c] = patch->center[c] + patch->scale * step.point[c];
    facing += step.normal[c] * p->direction[c];
    magnitude = lanes_max(lanes_abs(point[c]), magnitude);
  }
  for (int c = 0; c < 3; c++) step.normal[c] = lanes_select(facing > 0, -step.normal[c], step.normal[c]);
  const lanes point_error = POINT_ERROR(patch->scale, step.tangent, magnitude);
  const lanes clear = point_error + CLEARANCE(patch->scale, patch->loose, magnitude);
  const lane_mask border[4] = {best->u < best->radius_u, best->u > 1 - best->radius_u, best->v < best->radius_v,
                               best->v > 1 - best->radius_v};
  const lane_mask within = (step.t > p->t_min) & (step.t < p->t_max);
  const lane_mask special = border[0] | border[1] | border[2] | border[3] | ~best->certain | ~within;
  const unsigned specials = lanes_bits(special), plain = lanes_bits(step.plain);
  for (unsigned bits = group; bits; bits &= bits - 1) {
    const int l = __builtin_ctz(bits);
    struct hit *hit = &out[l];
    hit->u = step.u[l], hit->v = step.v[l], hit->t = step.t[l], hit->patch = index;
    for (int c = 0; c < 3; c++) hit->point[c] = point[c][l], hit->normal[c] = step.normal[c][l];
    hit->point_error = point_error[l], hit->clearance = clear[l];
    if (!(plain >> l & 1)) set_surface(patch, p->rays[l].direction, hit);
    if (!((specials | ~plain) >> l & 1)) continue;
    struct settling settling = {&p->rays[l], index, 0, best->certain[l]};
    for (unsigned k = 0; k < 4; k++) settling.borders |= (unsigned)(border[k][l] & 1) << k;
    settle(model, &settling, hit);
  }
}

void finish_hits(const struct packet *p, struct hit out[])
{
  const struct model *model = p->model;
  const unsigned doubt = model->unproven ? ~0u : lanes_bits(p->best.doubt);
  unsigned left = lanes_bits(p->best.patch != NO_PATCH); /* lanes with a hit that is not finished */
  for (unsigned l = 0; l < p->count; l++)
    out[l].patch = HIT_NONE, out[l].certainty = doubt >> l & 1 ? CERTAINTY_GRAZING : CERTAINTY_CERTAIN;
  while (left) {
    const int first = __builtin_ctz(left), axis = p->on_axis[0][first] ? 0 : p->on_axis[1][first] ? 1 : 2;
    const int64_t patch = p->best.patch[first];
    const unsigned group = left & lanes_bits((p->best.patch == patch) & p->on_axis[axis]);
    finish_group(p, group, axis, (uint32_t)patch, out);
    left &= ~group;
  }
}

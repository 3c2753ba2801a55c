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
  if (length > SURFACE_PLAIN * tangent * tangent) vector_scale(1 / length, out->normal, out->normal);
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

/* The answers of a packet's lanes but for what settle() has to say. */
struct answers {
  lanes u, v, t;
  struct surface_point point;
  lanes normal[3]; /* of unit length and either sense */
  lane_mask plain; /* point and normal are sure */
};

/* Lanes whose answer, whatever it is, is not sure. */
static unsigned packet_doubt(const struct packet *p) { return p->model->unproven ? ~0u : lanes_bits(p->best.doubt); }

/* Writes the hits of the lanes of `group`. Returns how many are not certain. */
static unsigned write_hits(const struct packet *p, unsigned group, const struct answers *a, struct hit out[])
{
  const struct model *model = p->model;
  const struct best *best = &p->best;
  const unsigned doubt = packet_doubt(p);
  lanes facing = lanes_all(0), normal[3];
  for (int c = 0; c < 3; c++) facing += a->normal[c] * p->direction[c];
  for (int c = 0; c < 3; c++) normal[c] = lanes_select(facing > 0, -a->normal[c], a->normal[c]);
  /* next to the ray's start a sharp root has more digits than the last step's sums */
  const lanes t = lanes_select(best->sharp, best->t, a->t);
  const lane_mask border[4] = {best->u < best->radius_u, best->u > 1 - best->radius_u, best->v < best->radius_v,
                               best->v > 1 - best->radius_v};
  const lane_mask within = (t > p->t_min) & (t < p->t_max);
  const lane_mask special = border[0] | border[1] | border[2] | border[3] | ~best->certain | ~within | ~a->plain;
  const unsigned specials = lanes_bits(special), plain = lanes_bits(a->plain);
  double row[LANES][12];
  unsigned grazing = 0;
  const struct surface_point *point = &a->point;
  lanes_store4(t, a->u, a->v, point->error, &row[0][0], 12);
  lanes_store4(point->at[0], point->at[1], point->at[2], point->clearance, &row[0][4], 12);
  lanes_store4(normal[0], normal[1], normal[2], t, &row[0][8], 12);
  for (unsigned bits = group; bits; bits &= bits - 1) {
    const int l = __builtin_ctz(bits);
    struct hit *hit = &out[l];
    const double *x = row[l];
    const uint32_t patch = (uint32_t)best->patch[l];
    *hit = (struct hit){.patch = patch, .certainty = CERTAINTY_CERTAIN, .t = x[0], .u = x[1], .v = x[2],
                        .point = {x[4], x[5], x[6]}, .point_error = x[3], .clearance = x[7],
                        .normal = {x[8], x[9], x[10]}};
    if (!((specials | doubt) >> l & 1)) continue;
    if (doubt >> l & 1) hit->certainty = CERTAINTY_GRAZING;
    if (!(plain >> l & 1)) set_surface(&model->patches[patch], p->rays[l].direction, hit);
    struct settling settling = {&p->rays[l], patch, 0, best->certain[l]};
    for (unsigned k = 0; k < 4; k++) settling.borders |= (unsigned)(border[k][l] & 1) << k;
    settle(model, &settling, hit);
    grazing += hit->certainty == CERTAINTY_GRAZING;
  }
  return grazing;
}

/* The lanes of `group`, whose best roots are final. */
static unsigned finish_final(const struct packet *p, unsigned group, struct hit out[])
{
  const struct best *best = &p->best;
  struct answers a;
  a.u = surface_clamp(best->u), a.v = surface_clamp(best->v), a.t = best->t;
  a.plain = surface_normal(best->normal, best->tangent, a.normal);
  a.point = best->point;
  return write_hits(p, group, &a, out);
}

/* The lanes of `group`, whose best roots are on one patch and whose rays share an axis. */
static unsigned finish_group(const struct packet *p, unsigned group, int axis, uint32_t index, struct hit out[])
{
  struct model_patch *patch = &p->model->patches[index];
  const struct best *best = &p->best;
  struct last_step step;
  step.patch = patch, step.axis = axis, step.origin = p->origin, step.direction = p->direction;
  step.improves = lanes_mask(group) & best->certain;
  step.u = surface_clamp(best->u), step.v = surface_clamp(best->v), step.t = best->t;
  last_step(&step);
  struct answers a = {.u = step.u, .v = step.v, .t = step.t, .plain = step.plain};
  a.point = surface_point(patch, step.point, step.tangent);
  for (int c = 0; c < 3; c++) a.normal[c] = step.normal[c];
  return write_hits(p, group, &a, out);
}

unsigned finish_hits(const struct packet *p, struct hit out[])
{
  unsigned left = lanes_bits(p->best.patch != NO_PATCH); /* lanes with a hit that is not finished */
  const unsigned misses = ~left & ((1u << p->count) - 1), doubt = misses & packet_doubt(p);
  for (unsigned bits = misses; bits; bits &= bits - 1) {
    const int l = __builtin_ctz(bits);
    out[l].patch = HIT_NONE, out[l].certainty = doubt >> l & 1 ? CERTAINTY_GRAZING : CERTAINTY_CERTAIN;
  }
  unsigned grazing = (unsigned)__builtin_popcount(doubt);
  const unsigned final = left & lanes_bits(p->best.final);
  if (final) grazing += finish_final(p, final, out);
  left &= ~final;
  while (left) {
    const unsigned first = (unsigned)__builtin_ctz(left);
    const int axis = packet_axis(p, first);
    const int64_t patch = p->best.patch[first];
    const unsigned group = left & lanes_bits((p->best.patch == patch) & p->on_axis[axis]);
    grazing += finish_group(p, group, axis, (uint32_t)patch, out);
    left &= ~group;
  }
  return grazing;
}

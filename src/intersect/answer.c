/* The hit at a point of a patch: the point, its error bound, the normal, the clearance. */
#include <float.h>
#include <math.h>

#include "base/real.h"
#include "geometry/patch.h"
#include "geometry/vector.h"
#include "intersect/exact/exact.h"
#include "intersect/local_ray.h"

/* ---- the patch in wide arithmetic, from its control points P ---- */

/* Su x Sv divided by its largest coordinate. Returns false if that is at most `least`. */
static bool wide_across(double (*P)[4][3], wide u, wide v, wide least, wide n[3])
{
  wide wu[4], du[3], wv[4], dv[3], su[3] = {0}, sv[3] = {0}, size = 0;
  wide_cubic(u, wu, du);
  wide_cubic(v, wv, dv);
  for (int c = 0; c < 3; c++) {
    for (int i = 0; i < 3; i++) {
      for (int j = 0; j < 4; j++) {
        su[c] += du[i] * wv[j] * ((wide)P[i + 1][j][c] - P[i][j][c]);
        sv[c] += wu[j] * dv[i] * ((wide)P[j][i + 1][c] - P[j][i][c]);
      }
    }
  }
  for (int c = 0; c < 3; c++) {
    n[c] = su[(c + 1) % 3] * sv[(c + 2) % 3] - su[(c + 2) % 3] * sv[(c + 1) % 3];
    size = wide_max(size, wide_abs(n[c]));
  }
  for (int c = 0; c < 3; c++) n[c] /= size;
  return size > least;
}

/* Su x Sv at (u,v), of unit length. Returns false if it is no longer than `least`. */
static bool wide_normal(double (*P)[4][3], wide u, wide v, wide least, double out[3])
{
  wide n[3];
  if (!wide_across(P, u, v, least, n)) return false;
  for (int c = 0; c < 3; c++) out[c] = (double)n[c];
  const double length = sqrt(out[0] * out[0] + out[1] * out[1] + out[2] * out[2]);
  for (int c = 0; c < 3; c++) out[c] /= length;
  return true;
}

/* ---- the hit ---- */

/* A product of derivatives no larger than what rounding the control points may make of it is that of a pole whose
 * points were rounded one by one; the normal is then the limit on the way there. In roundings of a coordinate: two in a
 * difference of points, three times that in a derivative, two products with one, and some room. */
#define NET_ROUNDINGS 16

/* The normal where the product of the derivatives is not sure: on a patch that is nearly a curve, and at a pole or next
 * to one. `tangent` bounds the derivatives' coordinates. If the surface has no normal, it is seen from the front. */
static void unsure_normal(const struct model *model, struct model_patch *patch, const double direction[3],
                          double tangent, struct hit *out)
{
  double(*P)[4][3] = model->scene->patches[out->patch].P, far = 1;
  for (int c = 0; c < 3; c++) far = real_max(far, fabs(patch->center[c]) / patch->scale + 1);
  const double rounded = NET_ROUNDINGS * UNIT_ROUNDOFF * far * tangent, u = out->u, v = out->v;
  /* in the scene's units, whose square may be beyond the doubles */
  const wide least = (wide)rounded * patch->scale * patch->scale;
  if (!wide_normal(P, u, v, least, out->normal) && !patch_normal(patch->x, u, v, rounded, out->normal) &&
      !wide_normal(P, u, v, 0, out->normal) && !patch_normal(patch->x, u, v, 0, out->normal))
    vector_scale(-1 / vector_length(direction), direction, out->normal);
}

/* Sets the point with its error, and the normal, facing the ray. */
static void set_surface(const struct model *model, const struct ray *ray, struct hit *out)
{
  struct patch_room room;
  struct model_patch *patch = model_patch_at(model, out->patch, &room);
  const double *direction = ray->direction;
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
  if (length > SURFACE_SURE * tangent * real_max(tangent, SURFACE_LEAST)) /* never where products may underflow */
    vector_scale(1 / length, out->normal, out->normal);
  else unsure_normal(model, patch, direction, tangent, out);
  if (vector_dot(out->normal, direction) > 0) vector_scale(-1, out->normal, out->normal);
}

/* The clearance; on a border it takes the neighbour's size into account. */
static double clearance(const struct model *model, uint32_t patch, unsigned borders, const struct hit *hit)
{
  struct patch_room room;
  double scale = model_patch_at(model, patch, &room)->scale, loose = model->cuts[patch].loose, magnitude = 0;
  for (int border = 0; border < 4; border++) {
    const uint32_t other = model_neighbour(model, patch, border)->patch;
    if (!(borders >> border & 1) || other == EDGE_NONE) continue;
    scale = real_max(scale, model_patch_at(model, other, &room)->scale);
    loose = real_max(loose, model->cuts[other].loose);
  }
  for (int k = 0; k < 3; k++) magnitude = real_max(magnitude, fabs(hit->point[k]));
  return hit->point_error + CLEARANCE(scale, loose, magnitude);
}

/* The double nearest to t in the ray's range; rounding may have taken t to an end of that. If no double lies between
 * the ends it is t_max, so that a ray continued from there comes to an end. */
static double t_within(double t, double t_min, double t_max)
{
  const double first = nextafter(t_min, INFINITY);
  return !(t > t_min) ? first : !(t < t_max) ? real_max(nextafter(t_max, -INFINITY), first) : t;
}

/* The hit at (u,v) of a patch and t of the ray. `borders`: those of the patch on which the point lies. */
static void answer(const struct model *model, const struct ray *ray, uint32_t patch, unsigned borders, double t,
                   struct hit *out)
{
  out->patch = patch;
  out->u = real_clamp(out->u, 0, 1), out->v = real_clamp(out->v, 0, 1);
  out->t = t_within(t, ray->t_min, ray->t_max);
  set_surface(model, ray, out);
  out->clearance = clearance(model, patch, borders, out);
}

/* A certain hit has its parameters to this accuracy. */
#define LARGEST_RADIUS 0x1p-20

/* If ray and normal are nearer to a right angle than this, rounding may have reversed the normal. */
#define SIDE_SURE 0x1p-40

/* Turns the normal of a hit at (u,v) to the side from which the ray comes, if rounding has reversed it. */
static void face(double (*P)[4][3], const struct ray *ray, wide u, wide v, double normal[3])
{
  wide n[3], along = 0, same = 0;
  const double slant = fabs(vector_dot(normal, ray->direction));
  if (slant > SIDE_SURE * vector_length(ray->direction) || !wide_across(P, u, v, 0, n)) return;
  for (int c = 0; c < 3; c++) along += n[c] * ray->direction[c], same += n[c] * normal[c];
  if (along != 0 && (along > 0) == (same > 0)) vector_scale(-1, normal, normal);
}

void exact_hit(const struct model *model, const struct ray *ray, const struct exact_root *root, bool sure,
               struct hit *out)
{
  const double u = (double)root->u, v = (double)root->v;
  const bool at[4] = {u <= root->radius_u, 1 - u <= root->radius_u, v <= root->radius_v, 1 - v <= root->radius_v};
  unsigned borders = 0;
  for (unsigned k = 0; k < 4; k++) borders |= (unsigned)at[k] << k;
  sure = sure && root->radius_u <= LARGEST_RADIUS && root->radius_v <= LARGEST_RADIUS;
  *out = (struct hit){.certainty = sure ? CERTAINTY_CERTAIN : CERTAINTY_GRAZING, .u = u, .v = v};
  answer(model, ray, root->patch, borders, (double)root->t, out);
  face(model->scene->patches[root->patch].P, ray, root->u, root->v, out->normal);
}

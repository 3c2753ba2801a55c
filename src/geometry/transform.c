/* Affine transforms. */
#include "geometry/transform.h"

#include <string.h>

#include "base/kernel.h"
#include "base/real.h"
#include "geometry/patch.h"

struct transform transform_identity(void)
{
  static const struct transform identity = {
    .identity = true, .moves = true, .A = {{{1, 0}}, {{0, 0}, {1, 0}}, {{0, 0}, {0, 0}, {1, 0}}}};
  return identity;
}

struct transform transform_then(const struct transform *first, const struct transform *second)
{
  if (first->identity) return *second;
  if (second->identity) return *first;
  struct transform r;
  if (!first->moves || !second->moves) {
    KERNEL_BEST(transform_kernel).compose(first, second, &r);
    return r;
  }
  r = *first;
  for (int j = 0; j < 3; j++) {
    r.A[3][j] = dd_add(second->A[3][j], first->A[3][j]);
    r.moves &= r.A[3][j].lo == 0;
  }
  return r;
}

bool transform_finite(const struct transform *transform)
{
  uint64_t over = 0;
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 3; j++) over |= real_infinite(transform->A[i][j].hi);
  return over == 0;
}

void transform_points(const struct transform *transform, const transform_row p, transform_row out)
{
  if (!transform->moves) {
    KERNEL_BEST(transform_kernel).apply(transform, p, out);
    return;
  }
  if (transform->identity) {
    memmove(out, p, sizeof(transform_row));
    return;
  }
  for (int n = 0; n < 4; n++)
    for (int j = 0; j < 3; j++) out[n][j] = transform->A[3][j].hi + p[n][j];
}

void transform_point(const struct transform *transform, const double p[3], double out[3])
{
  transform_row all = {{p[0], p[1], p[2]}};
  transform_points(transform, all, all);
  memcpy(out, all[0], sizeof all[0]);
}

void transform_direction(const struct transform *transform, const double p[3], double out[3])
{
  struct transform fixed = *transform;
  memset(fixed.A[3], 0, sizeof fixed.A[3]);
  transform_point(&fixed, p, out);
}

/* A rotation's place in the cache, by bits. */
static struct transform_turn *place_of(const double degrees[3], struct transform_angles *angles)
{
  uint64_t hash = 0;
  for (int axis = 0; axis < 3; axis++) hash = (hash + real_bits(degrees[axis])) * UINT64_C(0x9e3779b97f4a7c15);
  return &angles->turns[hash >> (64 - TRANSFORM_TURN_BITS)];
}

void transform_rotation(const double degrees[3], struct transform_angles *angles, struct transform *out)
{
  struct transform_turn *turn = place_of(degrees, angles);
  if (!turn->known || memcmp(turn->degrees, degrees, sizeof turn->degrees) != 0) {
    turn->known = true;
    memcpy(turn->degrees, degrees, sizeof turn->degrees);
    KERNEL_BEST(transform_kernel).rotation(degrees, angles, &turn->turned);
  }
  *out = turn->turned;
}

/* ---- control points (geometry/patch.h); not in patch.c, which modules compile without kernels ---- */

void points_range(const double P[4][4][3], double out_lo[3], double out_hi[3])
{
  KERNEL_BEST(points_range)(P, out_lo, out_hi);
}

bool points_frame(const double P[4][4][3], const double center[3], double unit, double out_x[3][4][4],
                  double out_rest[3][4][4])
{
  return KERNEL_BEST(points_frame)(P, center, unit, out_x, out_rest);
}

void points_tangents(const double P[4][4][3], double u, double v, double out_du[3], double out_dv[3])
{
  KERNEL_BEST(points_tangents)(P, u, v, out_du, out_dv);
}

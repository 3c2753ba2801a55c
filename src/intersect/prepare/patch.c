/* One patch of the scene: its frame. See patch.h. */
#include "intersect/prepare/patch.h"

#include <math.h>

#include "base/real.h"
#include "geometry/patch.h"
#include "geometry/vector.h"

/* A patch's frame is no smaller than this, so that its reciprocal and all products with it are normal numbers. */
#define LEAST_SCALE 0x1p-1000

/* Sets the patch's frame and net. `rest` gets what rounding the net takes away; returns whether that is anything. */
static bool patch_frame(const double P[4][4][3], double scene_size, struct model_patch *out, double rest[3][4][4])
{
  double largest = 0, extent = 0, lo[3], hi[3];
  points_range(P, lo, hi);
  for (int k = 0; k < 3; k++) {
    extent = real_max(extent, hi[k] / 2 - lo[k] / 2);
    largest = real_max(largest, real_max(fabs(lo[k]), fabs(hi[k])));
  }
  if (scene_size > 0)
    extent = real_max(extent, real_max(LEAST_EXTENT * (largest > 0 ? largest : scene_size), LEAST_SCALE));
  int exponent = 0;                             /* if all of the scene is the origin, any scale will do */
  if (extent > 0) frexp(extent, &exponent);     /* extent < 2^exponent */
  out->scale = real_power_of_two(exponent + 1); /* the center may be a grain off the middle */
  for (int k = 0; k < 3; k++) {
    const double middle = lo[k] / 2 + hi[k] / 2, grain = out->scale / 4;
    out->center[k] = fabs(middle) < grain * 0x1p50 ? real_coarse(middle, grain) : middle;
  }
  return points_frame(P, out->center, 1 / out->scale, out->x, rest);
}

/* How the patch's solver works on lanes: with the whole method as it is by default, or not at all. */
static enum solver_lanes lanes_of(const struct method *s)
{
  const bool all = s->basis == BASIS_BERNSTEIN && s->resultant == RESULTANT_BEZOUT &&
                   s->back_substitution == BACK_SUBSTITUTION_NULL_VECTOR && s->polish;
  const enum solver_lanes lanes = s->roots.solver->lanes;
  return all && (lanes == SOLVER_LANES_SIGNS || solver_options_improved(&s->roots)) ? lanes : SOLVER_LANES_NONE;
}

bool patch_on_lanes(const struct method *method) { return lanes_of(method) != SOLVER_LANES_NONE; }

void patch_make(const struct model *model, uint32_t index, struct model_patch *out, double rest[3][4][4])
{
  static const double none[3][4][4];
  struct scene_patch *source = &model->scene->patches[index];
  const bool rounded = patch_frame((const double(*)[4][3])source->P, model->size, out, rest);
  out->rest = rounded ? (const double(*)[4][4])rest : none;
  for (int k = 0; k < 4; k++) out->pole[k] = edge_is_point(source->P, k);
  out->method = &model->scene->solvers[source->solver];
  out->lanes = lanes_of(out->method);
  out->cut = model->cuts[index];
}

double patch_net_area(const struct model_patch *patch)
{
  double area = 0;
  for (int n = 0; n < 9; n++) {
    const int i = n / 3, j = n % 3;
    double one[3], other[3], across[3];
    for (int k = 0; k < 3; k++) {
      one[k] = patch->x[k][i + 1][j + 1] - patch->x[k][i][j];
      other[k] = patch->x[k][i][j + 1] - patch->x[k][i + 1][j];
    }
    vector_cross(one, other, across);
    area += vector_length(across) / 2;
  }
  return area;
}

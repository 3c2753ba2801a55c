/* How far patches are cut: halved along whichever parameter lowers the expected time of a picture most, for as long as
 * that lowers it. See cut.h.
 *
 * As many rays meet a convex body as it has surface (Crofton). So of the rays that meet a patch, each passes as many
 * boxes of leaves, and is tried on as many leaves, as the surfaces of all these boxes are larger than the patch. Boxes
 * of short leaves have less air in them, in particular where a patch is long and aslant to the axes; a leaf that is half
 * as long is a quarter as thick; and one that turns less is decided sooner. On the other hand more leaves take more
 * levels of the hierarchy, more memory and more time to make. All numbers below are choices of speed.
 */
#include "intersect/prepare/cut.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/real.h"
#include "intersect/prepare/patch.h"

/* The most leaves along a side. */
enum { SIDE_MOST = 64 };

/* ns that a ray takes, if some go together: at a level of the hierarchy; at the box of a leaf; in a leaf; and how much
 * farther each leaf of its patch makes memory. */
#define LEVEL_TIME 3.0
#define BOX_TIME 10.0
#define TRY_TIME 40.0
#define FAR_TIME 0.1

/* A leaf whose derivatives turn by this part of its side takes twice as long: along its short side, or of the mean of
 * both sides along the long one. */
#define TURN 0.5

/* Where surfaces are close together, a ray is tried on all leaves in whose boxes its hit is. A cell is not filled
 * evenly: there are so many times more than its mean density says. */
#define CROWDING 16.0

/* A patch as a mean over its net: how long its lines are along u and v, how far they reach along each axis, and second
 * derivatives by uu, uv and vv. */
struct shape {
  double length[2], reach[2][3], second[3];
};

/* The derivative of order p, q: its mean length, and the mean of its components' sizes. */
static double mean_derivative(const struct model_patch *patch, int p, int q, double out[3])
{
  static const double weight[3][3] = {{1, 0, 0}, {-3, 3, 0}, {6, -12, 6}};
  double length = 0;
  const int rows = 4 - p, row = 4 - q;
  out[0] = out[1] = out[2] = 0;
  for (int n = 0; n < rows * row; n++) {
    double square = 0;
    for (int k = 0; k < 3; k++) {
      double d = 0;
      for (int i = 0; i <= p; i++)
        for (int j = 0; j <= q; j++) d += weight[p][i] * weight[q][j] * patch->x[k][n / row + i][n % row + j];
      square += d * d, out[k] += fabs(d) / (rows * row);
    }
    length += sqrt(square) / (rows * row);
  }
  return length;
}

static struct shape shape_of(const struct model_patch *patch)
{
  struct shape s;
  double unused[3];
  for (int side = 0; side < 2; side++) s.length[side] = mean_derivative(patch, 1 - side, side, s.reach[side]);
  for (int n = 0; n < 3; n++) s.second[n] = mean_derivative(patch, 2 - n, n, unused);
  return s;
}

/* The time, in ns, of a ray that meets a patch in a crowd of this density, cut into a x b leaves. */
static double expected_time(const struct shape *s, double crowd, double leaf_time, int a, int b)
{
  const double u = s->length[0] / a, v = s->length[1] / b;
  const double uu = s->second[0] / (a * a), uv = s->second[1] / (a * b), vv = s->second[2] / (b * b);
  const double thick = (uu + 2 * uv + vv) / 8, mean = sqrt(u * v);
  const double turn = (uu / real_min(u, mean) + 2 * uv / real_min(u, v) + vv / real_min(v, mean)) / (2 * TURN);
  double reach[3];
  for (int k = 0; k < 3; k++) reach[k] = s->reach[0][k] / a + s->reach[1][k] / b + thick / 2;
  const double box = reach[0] * reach[1] + reach[1] * reach[2] + reach[2] * reach[0];
  const double along = (u * v + thick * (u + v)) * (1 + CROWDING * crowd * thick);
  return (BOX_TIME * box + TRY_TIME * along * (1 + turn * turn)) / (u * v) + leaf_time * a * b +
         LEVEL_TIME * log2(a * b);
}

/* ---- density ---- */

/* A cube as large as the frame of the patches in it, and their area in that frame. */
struct cell {
  uint64_t key; /* 0: nobody's */
  double area;
};

/* The patch's cell. There are twice as many as patches, so one is free (Knuth 6.4, linear probing). */
static struct cell *cell_of(const struct cells *cells, const struct model_patch *patch)
{
  uint64_t key = 0;
  for (int k = 0; k < 4; k++) {
    const double at = k < 3 ? floor(patch->center[k] / patch->scale) + 0.0 : patch->scale; /* no -0 */
    uint64_t bits;
    memcpy(&bits, &at, sizeof bits);
    key = (key ^ bits) * UINT64_C(0x9e3779b97f4a7c15), key ^= key >> 29;
  }
  key |= 1;
  size_t n = (size_t)(key >> 16) & cells->mask;
  while (cells->cell[n].key != 0 && cells->cell[n].key != key) n = (n + 1) & cells->mask;
  cells->cell[n].key = key;
  return &cells->cell[n];
}

enum status cells_fill(const struct model *model, struct cells *out)
{
  const size_t count = model->scene->patch_count;
  for (out->mask = 1; out->mask < 2 * count; out->mask = 2 * out->mask + 1) continue;
  out->cell = memory_alloc(out->mask + 1, sizeof *out->cell);
  if (!out->cell) return STATUS_LIMIT;
  for (size_t p = 0; p < count; p++)
    if (!model->cuts[p].copied && !model_again(model, p))
      cell_of(out, &model->patches[p])->area += patch_net_area(&model->patches[p]);
  return STATUS_OK;
}

void cells_free(struct cells *cells)
{
  memory_free(cells->cell);
  cells->cell = NULL;
}

/* ---- the cut ---- */

void patch_cut(const struct model_patch *patch, const struct cells *cells, const struct cut_limit *limit,
               uint16_t split[2])
{
  const struct shape s = shape_of(patch);
  const double crowd = cells->cell ? real_max(cell_of(cells, patch)->area - patch_net_area(patch), 0) : 0;
  const double leaf_time = limit->leaf_time + FAR_TIME;
  double least = expected_time(&s, crowd, leaf_time, 1, 1);
  split[0] = split[1] = 1;
  for (int best = -1; best != 0;) {
    best = 0;
    for (int halved = 1; halved < 4; halved++) { /* as bits: u, v */
      const int a = split[0] << (halved & 1), b = split[1] << (halved >> 1);
      if (a > SIDE_MOST || b > SIDE_MOST || a * b > limit->most) continue;
      const double time = expected_time(&s, crowd, leaf_time, a, b);
      if (time < least) least = time, best = halved;
    }
    split[0] = (uint16_t)(split[0] << (best & 1)), split[1] = (uint16_t)(split[1] << (best >> 1));
  }
}

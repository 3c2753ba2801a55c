/* Preparing patches: local frames, true degrees, which parameter to keep, leaves and their bounds. */
#include "intersect/model.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/real.h"
#include "geometry/patch.h"
#include "geometry/vector.h"

/* A declared control point carries half a unit in the last place of its decimal form and a few of its transforms: a patch whose
 * excess over a lower degree is no more than this, relative to its largest coordinate, was meant to be of that degree. */
#define DEGREE_SLACK (8 * UNIT_ROUNDOFF)

/* Leaves of `split auto`: cut until a leaf's derivatives turn by no more than about this fraction of their size, for then one
 * Newton process holds on the whole leaf for all but grazing rays. A choice of speed, not of correctness. */
#define AUTO_TURN 0.25
enum { AUTO_SPLIT_MAX = 16 };

/* Leaves of all patches with `split auto` together: large scenes have small patches, and their leaves cost memory and time to
 * make. The limit on the split is halved until they fit. */
enum { AUTO_LEAVES_MAX = 1 << 18 };

/* Rounding of the local net itself: of P - center (half a unit), and of cutting leaves (six lerps of two roundings each in
 * either direction on values below one). Used for the boxes. */
#define LEAF_NET_ERROR (32 * UNIT_ROUNDOFF)

/* x rounded to a multiple of the power of two `grain`. */
static double coarse(double x, double grain) { return rint(x / grain) * grain; }

/* A patch smaller than this part of the scene's coordinates is framed as if it were that large: one that is a single point has
 * no size of its own, and a frame too small would overflow. */
#define LEAST_EXTENT 0x1p-100

/* Nor is a patch's frame smaller than this, so that its reciprocal and all products with it are normal numbers. */
#define LEAST_SCALE 0x1p-1000

/* A frame no smaller than this: its reciprocal times a direction is finite. */
#define LEAST_FRAME 0x1p-700

static void patch_frame(double P[4][4][3], double scene_size, struct model_patch *out)
{
  double extent = scene_size > 0 ? real_max(LEAST_EXTENT * scene_size, LEAST_SCALE) : 0, lo[3], hi[3];
  for (int k = 0; k < 3; k++) {
    lo[k] = INFINITY, hi[k] = -INFINITY;
    for (int i = 0; i < 4; i++)
      for (int j = 0; j < 4; j++) lo[k] = real_min(lo[k], P[i][j][k]), hi[k] = real_max(hi[k], P[i][j][k]);
    extent = real_max(extent, hi[k] / 2 - lo[k] / 2);
  }
  int exponent = 0; /* all of the scene is the origin: any scale will do */
  if (extent > 0) frexp(extent, &exponent); /* extent < 2^exponent */
  out->scale = ldexp(1, exponent + 1); /* the center may be a grain off the middle */
  for (int k = 0; k < 3; k++) {
    const double middle = lo[k] / 2 + hi[k] / 2, grain = out->scale / 4;
    out->center[k] = fabs(middle) < grain * 0x1p50 ? coarse(middle, grain) : middle;
    for (int i = 0; i < 4; i++)
      for (int j = 0; j < 4; j++) out->x[k][i][j] = (P[i][j][k] - out->center[k]) / out->scale;
  }
}

static double largest_coordinate(double P[4][4][3])
{
  double size = 0;
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++)
      for (int k = 0; k < 3; k++) size = real_max(size, fabs(P[i][j][k]));
  return size;
}

/* How many leaves a side make every leaf nearly flat: second derivatives fall with the square, first ones with one over it. */
static int auto_split(struct model_patch *patch, int most)
{
  double second[3], first = 0;
  patch_second_derivative_bounds(patch->x, second);
  for (int i = 0; i < 4; i++) {
    for (int j = 0; j < 3; j++) {
      double du[3], dv[3];
      for (int k = 0; k < 3; k++) {
        dv[k] = 3 * (patch->x[k][i][j + 1] - patch->x[k][i][j]);
        du[k] = 3 * (patch->x[k][j + 1][i] - patch->x[k][j][i]);
      }
      first = real_max(first, real_max(vector_length(du), vector_length(dv)));
    }
  }
  const double turn = (second[0] + 2 * second[1] + second[2]) / 2;
  int split = 1;
  while (split < most && turn > AUTO_TURN * split * first) split *= 2;
  return split;
}

static void first_derivative_bounds(double x[3][4][4], double out[2])
{
  out[0] = out[1] = 0;
  for (int i = 0; i < 4; i++) {
    for (int j = 0; j < 3; j++) {
      double du[3], dv[3];
      for (int k = 0; k < 3; k++) dv[k] = 3 * (x[k][i][j + 1] - x[k][i][j]), du[k] = 3 * (x[k][j + 1][i] - x[k][j][i]);
      out[0] = real_max(out[0], vector_length(du)), out[1] = real_max(out[1], vector_length(dv));
    }
  }
}

/* Whether row i (or column i) of the net is one point to the last bit. */
static bool row_collapsed(double x[3][4][4], int i)
{
  for (int k = 0; k < 3; k++)
    for (int j = 1; j < 4; j++)
      if (x[k][i][j] != x[k][i][0]) return false;
  return true;
}

static bool column_collapsed(double x[3][4][4], int j)
{
  for (int k = 0; k < 3; k++)
    for (int i = 1; i < 4; i++)
      if (x[k][i][j] != x[k][0][j]) return false;
  return true;
}

/* Whether rows must be kept (true) or columns: the parameter along which an edge collapses is kept, for the other would leave
 * r identically zero at the apex; otherwise the one of higher degree, for the determinant is the smaller then. */
static bool keep_v(const struct model_patch *patch, double x[3][4][4])
{
  const int rows = row_collapsed(x, 0) + row_collapsed(x, 3), columns = column_collapsed(x, 0) + column_collapsed(x, 3);
  if (rows != columns) return columns > rows;
  return patch->n > patch->m;
}

/* How far the polynomial of bidegree (m,n) with the net r is from the bicubic x, on [0,1]^2: the largest distance of x from r's
 * net raised to (3,3), whose own roundings (two degrees twice, three each) are added. */
static double reduction_excess(double r[4][4], int m, int n, double x[4][4])
{
  double up[4][4], excess = 0, size = 0;
  memcpy(up, r, sizeof up);
  for (int d = n; d < 3; d++)
    for (int i = 0; i <= m; i++)
      for (int j = d + 1; j >= 0; j--)
        up[i][j] = ((j > 0 ? j * up[i][j - 1] : 0) + (j <= d ? (d + 1 - j) * up[i][j] : 0)) / (d + 1);
  for (int d = m; d < 3; d++)
    for (int j = 0; j < 4; j++)
      for (int i = d + 1; i >= 0; i--)
        up[i][j] = ((i > 0 ? i * up[i - 1][j] : 0) + (i <= d ? (d + 1 - i) * up[i][j] : 0)) / (d + 1);
  for (int k = 0; k < 16; k++) {
    excess = real_max(excess, fabs(up[k / 4][k % 4] - x[k / 4][k % 4]));
    size = real_max(size, fabs(r[k / 4][k % 4]));
  }
  return m == 3 && n == 3 ? 0 : excess + 16 * UNIT_ROUNDOFF * size;
}

static enum status leaf_set_form(struct arena *arena, const struct model_patch *patch, double x[3][4][4], struct leaf *leaf)
{
  leaf->v_kept = keep_v(patch, x);
  const int kept = leaf->v_kept ? patch->n : patch->m, eliminated = leaf->v_kept ? patch->m : patch->n;
  leaf->kept_degree = (uint8_t)kept, leaf->eliminated_degree = (uint8_t)eliminated;
  const bool low = leaf->v_kept ? column_collapsed(x, 0) : row_collapsed(x, 0);
  const bool high = leaf->v_kept ? column_collapsed(x, 3) : row_collapsed(x, 3);
  leaf->zeros[0] = (uint8_t)(low ? eliminated : 0), leaf->zeros[1] = (uint8_t)(high ? eliminated : 0);
  leaf->form = NULL;
  if (patch->m == 3 && patch->n == 3 && !leaf->v_kept) return STATUS_OK;
  struct leaf_form *form = arena_alloc(arena, 1, sizeof *form);
  if (!form) return STATUS_LIMIT;
  form->size = 1, form->excess = 0;
  for (int k = 0; k < 3; k++) {
    double r[4][4];
    patch_reduce(x[k], patch->m, patch->n, r);
    form->excess = real_max(form->excess, reduction_excess(r, patch->m, patch->n, x[k]));
    for (int i = 0; i < 4; i++) {
      for (int j = 0; j < 4; j++) {
        form->x[k][4 * i + j] = leaf->v_kept ? r[j][i] : r[i][j];
        form->size = real_max(form->size, fabs(r[i][j]));
      }
    }
  }
  leaf->form = form;
  return STATUS_OK;
}

/* |Su x Sv| relative to the squared derivatives below which a box along the leaf is not worth its rounding. */
#define LEAST_AREA 0x1p-30

/* A leaf whose derivatives turn by no more than this fraction of their size is tried as a bilinear one first: the root of its
 * corners is off by about an eighth of it, and two Newton steps make that 1e-6. A choice of speed: what comes of it is proven. */
#define BILINEAR_TURN 1.0

static bool nearly_bilinear(const struct leaf *leaf)
{
  const double turn = (leaf->second[0] + 2 * leaf->second[1] + leaf->second[2]) / 2;
  return turn <= BILINEAR_TURN * real_min(leaf->first[0], leaf->first[1]);
}

/* A net whose middle has no normal gets a box that tells nothing. */
static void leaf_set_slabs(struct leaf *leaf)
{
  struct leaf_slabs *slabs = &leaf->slabs;
  double along_u[3], along_v[3], *normal = slabs->g[0], largest = 0;
  for (int k = 0; k < 3; k++) {
    const double *x = leaf->x[k];
    along_u[k] = 0.5 * ((x[12] - x[0]) + (x[15] - x[3])), along_v[k] = 0.5 * ((x[3] - x[0]) + (x[15] - x[12]));
  }
  vector_cross(along_u, along_v, normal);
  const double area = vector_length(normal);
  const bool flat = !(area > LEAST_AREA * (vector_dot(along_u, along_u) + vector_dot(along_v, along_v)));
  vector_scale(flat ? 0 : 1 / area, normal, normal);
  vector_cross(along_v, normal, slabs->g[1]);
  vector_cross(normal, along_u, slabs->g[2]);
  for (int q = 0; q < 3; q++) {
    double *g = slabs->g[q], lo = INFINITY, hi = -INFINITY;
    if (q > 0) vector_scale(flat ? 0 : 1 / area, g, g);
    for (int n = 0; n < 16; n++) {
      const double x = g[0] * leaf->x[0][n] + g[1] * leaf->x[1][n] + g[2] * leaf->x[2][n];
      lo = real_min(lo, x), hi = real_max(hi, x);
    }
    const double size = fabs(g[0]) + fabs(g[1]) + fabs(g[2]);
    slabs->offset[q] = 0.5 * (lo + hi);
    slabs->half[q] = 0.5 * (hi - lo) + 8 * UNIT_ROUNDOFF * size; /* |x| <= 1 */
    largest = real_max(largest, size);
  }
  slabs->slack = flat ? INFINITY : 16 * largest * largest;
}

static enum status leaf_prepare(struct model *model, struct model_patch *patch, int column_u, int column_v, struct leaf *leaf,
                                struct bvh_box *box)
{
  const double parts = patch->split, step = 1 / parts; /* quotients, so that the last one is 1 whatever the split */
  const double u0 = column_u / parts, u1 = (column_u + 1) / parts, v0 = column_v / parts, v1 = (column_v + 1) / parts;
  const double margin = LEAF_MARGIN * step;
  double x[3][4][4], wide[3][4][4];
  for (int k = 0; k < 3; k++) {
    patch_subnet(patch->x[k], u0, u1, v0, v1, x[k]);
    patch_subnet(patch->x[k], u0 - margin, u1 + margin, v0 - margin, v1 + margin, wide[k]);
    memcpy(leaf->x[k], x[k], sizeof leaf->x[k]);
    double lo = INFINITY, hi = -INFINITY;
    for (int i = 0; i < 16; i++) lo = real_min(lo, leaf->x[k][i]), hi = real_max(hi, leaf->x[k][i]);
    const double shift = patch->center[k] - model->origin[k];
    const double slack = LEAF_NET_ERROR * patch->scale + 2 * UNIT_ROUNDOFF * (fabs(shift) + patch->scale);
    box->lo[k] = (shift + patch->scale * lo - slack) / model->frame;
    box->hi[k] = (shift + patch->scale * hi + slack) / model->frame;
  }
  patch_second_derivative_bounds(wide, leaf->second);
  first_derivative_bounds(wide, leaf->first);
  /* From the widened net's parameters back to the leaf's. */
  const double shrink = 1 / (1 + 2 * LEAF_MARGIN);
  for (int k = 0; k < 3; k++) leaf->second[k] *= shrink * shrink;
  for (int k = 0; k < 2; k++) leaf->first[k] *= shrink;
  leaf->bilinear = patch->lanes && nearly_bilinear(leaf);
  leaf_set_slabs(leaf);
  leaf->column_u = (uint16_t)column_u, leaf->column_v = (uint16_t)column_v;
  return leaf_set_form(model->arena, patch, x, leaf);
}

static bool fast_method(const struct solver_options *s)
{
  return s->solver == solver_at(0) && s->basis == BASIS_BERNSTEIN && s->resultant == RESULTANT_BEZOUT &&
         s->back_substitution == BACK_SUBSTITUTION_NULL_VECTOR && s->polish;
}

static void prepare_patches(struct model *model)
{
  const struct scene *scene = model->scene;
  double lo[3] = {0}, hi[3] = {0}, size = 0;
  for (size_t p = 0; p < scene->patch_count; p++) {
    size = real_max(size, largest_coordinate(scene->patches[p].P));
    for (int k = 0; k < 3; k++) {
      for (int i = 0; i < 16; i++) {
        const double c = scene->patches[p].P[i / 4][i % 4][k];
        lo[k] = p == 0 && i == 0 ? c : real_min(lo[k], c), hi[k] = p == 0 && i == 0 ? c : real_max(hi[k], c);
      }
    }
  }
  double extent = real_max(LEAST_EXTENT * size, LEAST_FRAME);
  for (int k = 0; k < 3; k++) model->origin[k] = lo[k] / 2 + hi[k] / 2, extent = real_max(extent, hi[k] / 2 - lo[k] / 2);
  int exponent;
  frexp(extent, &exponent); /* extent < 2^exponent */
  model->frame = ldexp(1, exponent);
  int most = AUTO_SPLIT_MAX;
  while (most > 1 && scene->patch_count * (size_t)(most * most) > AUTO_LEAVES_MAX) most /= 2;
  for (size_t p = 0; p < scene->patch_count; p++) {
    struct scene_patch *source = &scene->patches[p];
    struct model_patch *patch = &model->patches[p];
    patch_frame(source->P, size, patch);
    patch_bidegree(patch->x, DEGREE_SLACK * real_max(1, largest_coordinate(source->P) / patch->scale), &patch->m, &patch->n);
    patch->solver = &scene->solvers[source->solver];
    patch->lanes = fast_method(patch->solver);
    model->unproven |= !patch->solver->polish;
    patch->split = patch->solver->split > 0 ? patch->solver->split : auto_split(patch, most);
    patch->first_leaf = model->leaf_count;
    model->leaf_count += (size_t)patch->split * (size_t)patch->split;
  }
}

enum status model_create(const struct scene *scene, struct model **out)
{
  *out = NULL;
  struct bvh_box *boxes = NULL;
  enum status status = STATUS_LIMIT;
  struct model *model = calloc(1, sizeof *model);
  if (!model) return STATUS_LIMIT;
  model->scene = scene;
  model->arena = arena_create();
  if (!model->arena) goto done;
  model->patches = arena_alloc(model->arena, scene->patch_count + 1, sizeof *model->patches);
  model->neighbours = arena_alloc(model->arena, scene->patch_count + 1, 4 * sizeof *model->neighbours);
  if (!model->patches || !model->neighbours) goto done;
  status = edges_match(scene->patches, sizeof *scene->patches, scene->patch_count, model->neighbours);
  if (status != STATUS_OK) goto done;
  status = STATUS_LIMIT;
  prepare_patches(model);
  model->leaves = arena_alloc(model->arena, model->leaf_count + 1, sizeof *model->leaves);
  boxes = calloc(model->leaf_count + 1, sizeof *boxes);
  if (!model->leaves || !boxes) goto done;
  for (size_t p = 0, l = 0; p < scene->patch_count; p++) {
    struct model_patch *patch = &model->patches[p];
    for (int i = 0; i < patch->split; i++) {
      for (int j = 0; j < patch->split; j++, l++) {
        model->leaves[l].patch = (uint32_t)p;
        status = leaf_prepare(model, patch, i, j, &model->leaves[l], &boxes[l]);
        if (status != STATUS_OK) goto done;
      }
    }
  }
  status = bvh_build(boxes, model->leaf_count, &model->bvh);
  if (status != STATUS_OK) goto done;
  *out = model;
  model = NULL;
done:
  free(boxes);
  model_destroy(model);
  return status;
}

void model_destroy(struct model *model)
{
  if (!model) return;
  bvh_free(&model->bvh);
  arena_destroy(model->arena);
  free(model);
}

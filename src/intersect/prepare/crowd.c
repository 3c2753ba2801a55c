/* Leaves in one another's boxes.
 *
 * A box along a leaf is as thick as the leaf bends, and a ray that meets a surface is tried on all leaves whose boxes
 * hold that place. How far derivatives turn tells nothing of these leaves, so they are counted at some places of each
 * patch. Where there are many, the leaves are made shorter: one half as long is a quarter as thick.
 */
#include "intersect/prepare/crowd.h"

#include <math.h>

#include "base/memory.h"
#include "base/real.h"
#include "geometry/patch.h"
#include "intersect/exact/exact.h"
#include "intersect/prepare/leaf.h"
#include "intersect/prepare/making.h"
#include "intersect/prepare/patch.h"

/* PLACES leaves of a patch a side are examined, or one if there are more than MANY patches; for each, LOOKS boxes and
 * nodes of the hierarchy at most, until FOUND leaves are found. Choices of speed. */
enum { PLACES = 2, MANY = 4096, LOOKS = 1024, FOUND = 64 };

/* What stands about a patch, and how the patch bends. In parameters of its leaves, if it is cut into a x b, its second
 * derivatives uu, uv and vv are 1/a^2, 1/(a b) and 1/b^2 of those in its own. */
struct crowd {
  float others; /* boxes along leaves that hold the middle of one of the patch's, except its own; on average */
  /* bounds on second derivatives, and on their part across the patch, on the leaves examined */
  float second[3], across[3];
};

/* A place, and the count of the boxes that hold it. */
struct search {
  const struct model *model;
  double x[3];
  uint32_t own; /* the leaf that it is on */
  int looks, found;
};

static bool in_node_box(const struct bvh_node *node, int side, const float at[3])
{
  bool in = true;
  for (int k = 0; k < 3; k++) in &= node->lo[k][side] <= at[k] && at[k] <= node->hi[k][side];
  return in;
}

static bool in_leaf_box(const struct oriented_box *box, const float at[3])
{
  bool in = true;
  for (int q = 0; q < 3; q++)
    in &= fabsf(box->g[0][q] * at[0] + box->g[1][q] * at[1] + box->g[2][q] * at[2] - box->offset[q]) <= box->half[q];
  return in;
}

/* If a place is no farther from a leaf's surface than this part of its box's half, cutting the leaf does not help: this
 * is how thick an eighth of the leaf is, a 64th. */
#define ON_LEAF 0x1p-6

static bool is_on_leaf(const struct model *model, const struct leaf *leaf, const double x[3])
{
  const struct model_patch *patch = &model->patches[leaf->patch];
  const double *c = leaf->quadric.c;
  double y[3];
  for (int q = 0; q < 3; q++) {
    y[q] = -leaf->slab[q].offset;
    for (int k = 0; k < 3; k++) y[q] += leaf->slab[q].g[k] * ((x[k] - patch->center[k]) / patch->scale);
  }
  const double on = c[0] + c[1] * y[1] + c[2] * y[2] + c[3] * y[1] * y[1] + c[4] * y[1] * y[2] + c[5] * y[2] * y[2];
  return fabs(y[0] - on) <= ON_LEAF * leaf->slab[0].half;
}

/* Counts other leaves around s->x; twins, which the tree has not, do not count. */
static void search_tree(struct search *s, const struct model_tree *tree)
{
  const struct model *model = s->model;
  uint32_t wait[BVH_STACK];
  float at[3];
  for (int k = 0; k < 3; k++) at[k] = (float)((s->x[k] - tree->origin[k]) / tree->frame);
  size_t count = 0;
  for (wait[count++] = 0; count > 0 && s->looks < LOOKS && s->found < FOUND; s->looks++) {
    const struct bvh_node *node = &tree->bvh.nodes[wait[--count]];
    for (int side = 0; side < BVH_WIDTH && (side == 0 || node->child[side] != 0); side++) {
      const uint32_t child = node->child[side], box = child & ~BVH_LEAF;
      if (!in_node_box(node, side, at)) continue;
      if (child == box) wait[count++] = child;
      else if (model_is_tree(model, box)) search_tree(s, model_inner(model, tree, box));
      else if (box < model->leaf_count && box != s->own)
        s->looks++, s->found += in_leaf_box(&model->oriented[box], at) && !is_on_leaf(model, &model->leaves[box], s->x);
    }
  }
}

/* Bounds on the second derivatives of the leaf's net across the leaf. */
static void bends_across(const struct leaf *leaf, double out[3])
{
  const double *g = leaf->slab[0].g;
  double z[4][4];
  for (int n = 0; n < 16; n++) z[n / 4][n % 4] = g[0] * leaf->x[0][n] + g[1] * leaf->x[1][n] + g[2] * leaf->x[2][n];
  patch_bends(z, out);
}

/* Examines patch number `number`, whose leaves begin at `first`. */
static void find_crowd(const struct model *model, size_t number, size_t first, struct crowd *out)
{
  const struct model_patch *patch = &model->patches[number];
  const int most = model->scene->patch_count > MANY ? 1 : PLACES;
  const int a = patch->cut.split[0], b = patch->cut.split[1], rows = a < most ? a : most, row = b < most ? b : most;
  double second[3] = {0}, across[3] = {0};
  int found = 0;
  for (int k = 0; k < rows * row; k++) {
    const int u = (2 * (k / row) + 1) * a / (2 * rows), v = (2 * (k % row) + 1) * b / (2 * row);
    const size_t l = first + (size_t)(u * b + v);
    const struct leaf *leaf = &model->leaves[l];
    struct search s = {.model = model, .own = (uint32_t)l};
    for (int c = 0; c < 3; c++) s.x[c] = patch->center[c] + patch->scale * leaf->parts.base[0][c];
    search_tree(&s, &model->tree);
    found += s.found;
    double bends[3];
    bends_across(leaf, bends);
    for (int c = 0; c < 3; c++)
      second[c] = real_max(second[c], leaf->second[c]), across[c] = real_max(across[c], bends[c]);
  }
  const double cells[3] = {a * a, a * b, b * b};
  out->others = (float)found / (float)(rows * row);
  for (int c = 0; c < 3; c++)
    out->second[c] = (float)(second[c] * cells[c]), out->across[c] = (float)(across[c] * cells[c]);
}

/* The thickness of leaves with these derivatives, up to a factor. */
static double bend_of(const float second[3], const uint16_t split[2])
{
  const double a = split[0], b = split[1];
  return (double)second[0] / (a * a) + 2 * (double)second[1] / (a * b) + (double)second[2] / (b * b);
}

/* The most leaves a side and of a patch, as for other patches: the last resort has room for them (patch.c). */
enum { SIDE_MOST = EXACT_REGIONS_MAX / 2, LEAVES_MOST = EXACT_LEAVES };

/* Leaves may be twice as long along a parameter if they then bend by at most this factor more. A choice of speed. */
#define STRAIGHT 1.125

/* Cuts a patch that more than `stay` leaves stand about finer, so that about `stay` do: each time along the parameter
 * that bends more. Along one that does not bend it is cut less. */
static void split_crowd(const struct crowd *crowd, double stay, uint16_t split[2])
{
  if (!((double)crowd->others > stay)) return;
  const double most = stay / (double)crowd->others * bend_of(crowd->across, split);
  for (int side = 0; side < 2; side++) {
    uint16_t half[2] = {split[0], split[1]};
    for (half[side] /= 2; half[side] > 0; half[side] /= 2) {
      if (!(bend_of(crowd->second, half) <= STRAIGHT * bend_of(crowd->second, split))) break;
      if (!(bend_of(crowd->across, half) <= STRAIGHT * bend_of(crowd->across, split))) break;
      split[side] = half[side];
    }
  }
  while (split[0] * split[1] < LEAVES_MOST && bend_of(crowd->across, split) > most) {
    const double a = split[0], b = split[1];
    uint16_t *cut = &split[(double)crowd->across[2] / (b * b) > (double)crowd->across[0] / (a * a)];
    if (2 * *cut > SIDE_MOST) break;
    *cut = (uint16_t)(2 * *cut);
  }
}

/* ---- all patches ---- */

/* Whether the patch is cut as it bends, and is no twin, which would change nothing. */
static bool may_be_finer(const struct model *model, size_t p)
{
  return !model->cuts[p].copied && model->patches[p].method->split == 0 && !(model->twin && model->twin[p]);
}

static enum status find_crowds(void *context, size_t worker)
{
  struct making *m = context;
  (void)worker;
  for (size_t part, p, end; making_take_part(m, &part, &p, &end);) {
    size_t l = m->leaves[part];
    for (; p < end; p++) {
      const struct model_cut *cut = &m->model->cuts[p];
      if (cut->copied) continue;
      if (may_be_finer(m->model, p)) find_crowd(m->model, p, l, &m->crowds[p]);
      l += cut_leaves(cut);
    }
  }
  return STATUS_OK;
}

/* How many leaves there are if `stay` of the others stay; also cuts the patches so if `really`. */
static size_t cut_crowds(struct making *m, double stay, bool really)
{
  struct model *model = m->model;
  size_t all = 0;
  for (size_t part = 0; really && part < m->part_count; part++) m->leaves[part] = 0;
  for (size_t p = 0; p < model->scene->patch_count; p++) {
    const struct model_cut *cut = &model->cuts[p];
    if (cut->copied) continue;
    uint16_t split[2] = {cut->split[0], cut->split[1]};
    if (may_be_finer(model, p)) split_crowd(&m->crowds[p], stay, split);
    const size_t count = (size_t)split[0] * split[1];
    if (really) patch_cut_as(model, (uint32_t)p, split, &model->patches[p]), m->leaves[p / m->part] += count;
    all += count;
  }
  return all;
}

/* A ray that meets a patch may be tried in vain on STAY leaves before the patch is cut finer; but all is done once more
 * only if those beyond are CROWDED on average over all patches. No scene that is measured (docs/performance.md) has
 * more than half of that; books and rolls of paper have at least eight times that. Choices of speed. */
#define STAY 1.0
#define CROWDED 0.25

/* Examines the patches, `own` of which may be cut, and cuts them so that there are at most `most` leaves. */
static enum status cut_own(struct making *m, size_t own, double most, bool *out)
{
  const size_t count = m->model->scene->patch_count;
  const enum status status = making_do_parts(m, find_crowds, count);
  double beyond = 0, stay = STAY;
  for (size_t p = 0; p < count; p++) beyond += real_max((double)m->crowds[p].others - STAY, 0);
  if (status != STATUS_OK || beyond < CROWDED * (double)own) return status;
  size_t all;
  while ((double)(all = cut_crowds(m, stay, false)) > most) stay *= 1.25;
  *out = all != m->model->leaf_count;
  if (*out) (void)cut_crowds(m, stay, true);
  return STATUS_OK;
}

enum status crowd_cut_finer(struct making *m, bool *out)
{
  const struct model *model = m->model;
  const size_t count = model->scene->patch_count;
  size_t own = 0;
  *out = false;
  for (size_t p = 0; p < count; p++) own += may_be_finer(model, p);
  const double most = m->limit.leaves * (double)own;
  if (2 * (double)model->leaf_count > most) return STATUS_OK; /* not twice as many: not worth it */
  m->crowds = memory_alloc(count + 1, sizeof *m->crowds);
  if (!m->crowds) return STATUS_LIMIT;
  const enum status status = cut_own(m, own, most, out);
  memory_free(m->crowds), m->crowds = NULL;
  return status;
}

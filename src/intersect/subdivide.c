/* The last resort: the nearest root of (a, b) in a leaf by recursive halving, in double and, where that is not enough, wider.
 *
 * A box of parameters is dropped where some linear combination of the two plane polynomials keeps one sign on it (the convex
 * hull property), solved where the Newton-Kantorovich test finds a root that is alone in it, and halved otherwise. Boxes are
 * taken nearest first and dropped behind the best root found, so curves of roots (a ray in the plane of a flat patch) cost no
 * more than points. A box on which a combination is indistinguishable from zero, and which is small along the ray, cannot
 * be decided in the precision at hand. In double the surface is then seen edge-on, nearer to tangency than about 1e-7: the
 * search is made again in wide arithmetic, from the untouched control points. Where even that leaves something undecided (a double
 * root, a ray in the surface), and at poles, the answer is the first search's: a hit that is not certain.
 */
#include "intersect/subdivide.h"

#include <math.h>
#include <string.h>

#include "base/real.h"
#include "base/wide.h"

/* How far outside a box, in its own parameters, its root may lie and still be told from having none (then the neighbour has it);
 * and the growth of second-derivative bounds, quartic in the extent, when they are used that far outside. */
#define BOX_MARGIN 0.0625
#define BOX_MARGIN_GROWTH 1.61

/* Newton's last step in box parameters; see refine.h. */
#define LAST_STEP 0x1p-28

/* A combination whose computed values are within this many of its error bounds all over a box says nothing about it. */
#define FLAT_ERRORS (UNDECIDED_ERRORS - 1)

/* A leaf is as wide at this distance from a collapsed border, in its parameters, as some tens of the planes' error bounds: what
 * cannot be decided there in double is the pole itself. */
#define POLE_REACH 0x1p-40

enum verdict {
  VERDICT_EMPTY, /* no root in the box */
  VERDICT_FLAT,  /* some combination, but not all, is indistinguishable from zero on it */
  VERDICT_POINT, /* all are: the box is a point on the ray as far as can be told */
  VERDICT_OPEN
};

/* 2^-50 of the leaf either way. The number of boxes is far above what isolated roots need (some hundreds): only surfaces that
 * lie along the ray over an area come there. */
#define SEARCH_REAL double
#define SEARCH_NAME(name) double_##name
#define SEARCH_ROUNDOFF UNIT_ROUNDOFF
#define SEARCH_RESOLUTION 0x1p-44
#define SEARCH_HALVINGS 100
#define SEARCH_BOXES 20000
#define SEARCH_LAST 0
#include "intersect/subdivide_search.h"

#define SEARCH_REAL wide
#define SEARCH_NAME(name) wide_##name
#define SEARCH_ROUNDOFF WIDE_ROUNDOFF
#define SEARCH_RESOLUTION 0x1p-52
#define SEARCH_HALVINGS 160
#define SEARCH_BOXES 2000
#define SEARCH_LAST 1
#include "intersect/subdivide_search.h"

/* The net of the exact patch over the leaf, one coordinate, in the patch's frame. */
static void wide_leaf_net(const struct subdivide_task *task, int c, wide out[4][4])
{
  const struct model_patch *patch = task->patch;
  wide net[4][4];
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++) net[i][j] = ((wide)task->P[i][j][c] - patch->center[c]) / patch->scale;
  const wide range[2][2] = {{(wide)task->leaf->column_u / patch->split, (wide)(task->leaf->column_u + 1) / patch->split},
                            {(wide)task->leaf->column_v / patch->split, (wide)(task->leaf->column_v + 1) / patch->split}};
  for (int pass = 0; pass < 2; pass++) {
    const wide *t = range[1 - pass];
    for (int n = 0; n < 4; n++) {
      for (int k = 0; k < 4; k++) { /* control value k is the blossom at 3 - k times t[0] and k times t[1] */
        wide q[4];
        for (int m = 0; m < 4; m++) q[m] = pass == 0 ? net[n][m] : out[m][n];
        for (int level = 3; level > 0; level--) {
          const wide at = t[level <= k];
          for (int m = 0; m < level; m++) q[m] += at * (q[m + 1] - q[m]);
        }
        if (pass == 0) out[n][k] = q[0];
        else net[k][n] = q[0];
      }
    }
  }
  memcpy(out, net, sizeof net);
}

/* Returns whether the search came to an end, and only then writes *out_found and, where that is true, *out. */
static bool wide_search(const struct subdivide_task *task, bool *out_found, struct leaf_hit *out)
{
  const struct model_patch *patch = task->patch;
  const double *d = task->world->direction, *o = task->world->origin;
  const int k = task->local->axis, axis[2] = {(k + 1) % 3, (k + 2) % 3};
  wide x[3][4][4], q[3], size = 1;
  for (int c = 0; c < 3; c++) {
    wide_leaf_net(task, c, x[c]);
    q[c] = ((wide)o[c] - patch->center[c]) / patch->scale;
  }
  struct wide_box whole = {.u = 0, .v = 0, .size_u = 1, .size_v = 1, .halvings = 0};
  for (int s = 0; s < 2; s++) {
    const wide slope = (wide)d[axis[s]] / d[k], moment = q[axis[s]] - slope * q[k];
    size = wide_max(size, wide_abs(q[axis[s]]) + wide_abs(q[k]));
    for (int n = 0; n < 16; n++) whole.net[s][n / 4][n % 4] = x[axis[s]][n / 4][n % 4] - slope * x[k][n / 4][n % 4] - moment;
  }
  memcpy(whole.net[2], x[k], sizeof x[k]);
  /* As PLANE_ERROR, but the moment is formed from the origin, whose size it is relative to. */
  struct wide_search search = {.leaf = task->leaf, .start = {-q[k], 0}, .to_t = patch->scale / (wide)d[k],
                               .error = WIDE_ROUNDOFF * (64 + 16 * size), .t_min = task->t_min, .t_max = task->t_max};
  wide_run(&search, &whole);
  if (search.hopeless) return false;
  *out_found = search.found, *out = search.best;
  return true;
}

bool subdivide_closest(const struct subdivide_task *task, struct leaf_hit *out)
{
  const struct local_ray *ray = task->local;
  struct double_search search = {.leaf = task->leaf, .start = {ray->start[0], ray->start[1]}, .to_t = ray->to_t, .error = ray->error,
                                 .t_min = task->t_min, .t_max = task->t_max};
  struct double_box whole = {.u = 0, .v = 0, .size_u = 1, .size_v = 1, .halvings = 0};
  double nets[3][16];
  local_ray_nets(ray, task->leaf->x, nets[0], nets[1], nets[2]);
  memcpy(whole.net, nets, sizeof nets);
  double_run(&search, &whole);
  *out = search.best;
  bool found = search.found;
  if (found && !search.best.certain && search.edge_on) wide_search(task, &found, out);
  return found;
}

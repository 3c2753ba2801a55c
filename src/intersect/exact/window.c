/* Windows of a patch: see window.h. */
#include "intersect/exact/window.h"

#include <math.h>

#include "base/real.h"
#include "geometry/patch.h"

/* columns/split, without the slow division if a double has it exactly. */
static wide part_of(int columns, int split)
{
  return (split & (split - 1)) == 0 ? (wide)((double)columns / split) : (wide)columns / split;
}

struct window window_of_region(struct judge *j, const struct exact_region *region)
{
  struct window window = {.judge = j, .depth = j->local.depth, .depth_error = PLANE_ERROR(0, 0)};
  for (int k = 0; k < 2; k++)
    window.low[k] = part_of(region->column[k], j->prepared->cut.split[k]),
    window.size[k] = part_of(region->span[k], j->prepared->cut.split[k]);
  return window;
}

struct window window_closer(const struct window *window, const struct box *box)
{
  struct window closer = {.judge = window->judge,
                          .zooms = window->zooms + 1,
                          .depth.unit = window->depth.unit,
                          .depth.to_t = (double)(judge_zoom(window->judge)->to_t / window->depth.unit)};
  closer.size[0] = window->size[0] * box->size_u, closer.size[1] = window->size[1] * box->size_v;
  closer.low[0] = window->low[0] + window->size[0] * box->u, closer.low[1] = window->low[1] + window->size[1] * box->v;
  return closer;
}

void window_set_depths(struct window *window, const struct zoomed *zoomed)
{
  double size = 0;
  for (int n = 0; n < 16; n++) size = real_max(size, fabs(zoomed->net[2][n / 4][n % 4]));
  const wide start = zoomed->start * window->depth.unit;
  window->depth.start[0] = (double)start, window->depth.start[1] = (double)(start - window->depth.start[0]);
  window->depth_error = 32 * UNIT_ROUNDOFF * size + judge_zoom(window->judge)->depth_error;
}

void window_set_reach(const struct window *window, struct box *box)
{
  double lo = box->net[2][0][0], hi = lo;
  for (int n = 1; n < 16; n++)
    lo = real_min(lo, box->net[2][n / 4][n % 4]), hi = real_max(hi, box->net[2][n / 4][n % 4]);
  const double p = t_of_depth(&window->depth, lo), q = t_of_depth(&window->depth, hi);
  const double slack = window_length(window, window->depth_error) + 8 * UNIT_ROUNDOFF * real_max(fabs(p), fabs(q));
  box->near = real_min(p, q) - slack, box->far = real_max(p, q) + slack;
}

struct exact_root window_root(const struct window *window, struct box *box, const double at[2], const double radius[2])
{
  const struct patch_jet w = patch_evaluate(box->net[2], at[0], at[1]);
  double bend[3];
  patch_bends(box->net[2], bend);
  const double sum = radius[0] + radius[1], rounding = window->zooms > 0 ? 0 : 4 * UNIT_ROUNDOFF;
  const double off = fabs(w.du) * radius[0] + fabs(w.dv) * radius[1] +
                     BOX_MARGIN_GROWTH * (bend[0] + 2 * bend[1] + bend[2]) * sum * sum;
  struct exact_root root = {.sharp = false};
  if (window->zooms > 0) {
    root.u = window_place(window, box, 0, at[0]);
    root.v = window_place(window, box, 1, at[1]);
    root.t = zoom_t(judge_zoom(window->judge), root.u, root.v);
    root.t_error = window_length(window, off + judge_zoom(window->judge)->depth_error) +
                   8 * (double)WIDE_ROUNDOFF * fabs((double)root.t);
  } else {
    const double t = t_of_depth(&window->depth, w.value);
    root.t = t;
    root.t_error = window_length(window, off + window->depth_error) +
                   8 * UNIT_ROUNDOFF * (fabs(t) + window_length(window, fabs(w.value)));
    root.u = (double)window->low[0] + (double)window->size[0] * (box->u + box->size_u * at[0]);
    root.v = (double)window->low[1] + (double)window->size[1] * (box->v + box->size_v * at[1]);
  }
  root.radius_u = radius[0] * box->size_u * (double)window->size[0] * (1 + 4 * UNIT_ROUNDOFF) + rounding;
  root.radius_v = radius[1] * box->size_v * (double)window->size[1] * (1 + 4 * UNIT_ROUNDOFF) + rounding;
  return root;
}

void window_tell_maybe(const struct window *window, const struct box *box, double u, double v, double t, double t_error)
{
  judge_maybe(window->judge, (double)window_place(window, box, 0, u), (double)window_place(window, box, 1, v), t,
              t_error, real_max(box->near, t - t_error));
}

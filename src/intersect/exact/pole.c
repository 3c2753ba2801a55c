/* Boxes of a search at a pole, a border that is one point. They are zoomed, divided by the distance to the border
 * (zoom_pole_box), again and again towards it. If the ray meets the pole, this file decides what is told.
 *
 * Along such a border both polynomials are constant. So a ray that passes the pole closely is as good as tangent,
 * wherever along the border it passes. docs/method.md, "The numbers of the last resort", states how far this goes and
 * where it ends.
 */
#include "intersect/exact/search.h"

#include <math.h>

#include "base/real.h"

/* A box is zoomed if it reaches no farther from the pole than this part of the patch. A choice of speed. */
#define ZOOM_POLE 0x1p-10

/* It is zoomed again if it reaches no farther from the border than this part of the last window, and at most this
 * often, one within the other. */
#define ZOOM_AGAIN_POLE 0x1p-10
enum { ZOOM_DEPTH = 12 };

/* The certificate takes derivatives to be off by no more than this many times the error of values (certificate.h,
 * kappa). The quotient is off by e/d, its derivatives by e/d^2, or between the root and another point at d' by e/(d
 * d'). That is no more in a box that reaches no farther than this many times the root's distance d. */
#define CERTIFICATE_SLOPES 16

/* A box no wider along the border than this part of the patch is halved only towards the pole: the place along the
 * border is known no better than the direction in which the ray passes the pole. A choice of speed. */
#define NARROW_AT_POLE 0x1p-5

/* Which of the box's borders are one point. */
static void poles_of_box(const struct search *s, const struct box *box, bool out[4])
{
  const bool at[4] = {box->u == 0, box->u + box->size_u == 1, box->v == 0, box->v + box->size_v == 1};
  for (int k = 0; k < 4; k++) out[k] = s->pole[k] && at[k];
}

int pole_of_box(const struct search *s, const struct box *box)
{
  bool at[4];
  int pole = NO_BORDER;
  poles_of_box(s, box, at);
  for (int k = 0; k < 4; k++)
    if (at[k] && s->window.judge->zeros[k] == 0) pole = pole == NO_BORDER ? k : TWO_BORDERS;
  return pole;
}

bool pole_zeros(const struct search *s, const struct box *box, int out[4])
{
  bool at[4], any = false;
  poles_of_box(s, box, at);
  for (int k = 0; k < 4; k++) out[k] = at[k] ? s->window.judge->zeros[k] : 0, any |= out[k] > 0;
  return any;
}

/* How far the box reaches from the border, as a part of the search's whole box. */
static double reach_from(const struct box *box, int border) { return border < 2 ? box->size_u : box->size_v; }

bool pole_narrow(const struct search *s, const struct box *box)
{
  if (s->divided == NO_BORDER || pole_of_box(s, box) != s->divided) return false;
  return (double)(s->divided < 2 ? s->window.size[1] * box->size_v : s->window.size[0] * box->size_u) <= NARROW_AT_POLE;
}

bool pole_asks_zoom(const struct search *s, const struct box *box)
{
  int zeros[4];
  double reach = 0;
  if (!pole_zeros(s, box, zeros) || s->window.zooms >= ZOOM_DEPTH) return false;
  for (int k = 0; k < 4; k++)
    if (zeros[k] > 0) reach = real_max(reach, reach_from(box, k));
  return reach <= ZOOM_AGAIN_POLE;
}

/* Whether to zoom the box: as soon as it is near enough to the pole, and again whenever it has become small. */
static bool asks_zoom(const struct search *s, const struct box *box, int border)
{
  if (border < 0 || s->met || s->dependent || s->window.zooms >= ZOOM_DEPTH) return false;
  const double reach = reach_from(box, border);
  if (s->divided != border) return reach * (double)s->window.size[border / 2] <= ZOOM_POLE;
  return reach <= ZOOM_AGAIN_POLE;
}

/* For a net of depths that is `depth` at the pole's border: a bound on how far it is from that anywhere, over the
 * distance from the border. */
static double slope_at_pole(double net[4][4], double depth)
{
  double rise = 0;
  for (int n = 0; n < 16; n++) rise = real_max(rise, fabs(net[n / 4][n % 4] - depth));
  return 3 * rise;
}

static double depth_of_pole(double net[4][4], int border)
{
  const int at = edge_at(border, 0);
  return net[at / 4][at % 4];
}

/* How far from the pole, along the ray, anything may lie that is nearer to it than ZOOM_POLE_MET, a part of the
 * window. */
static double met_reach(const struct window *closer, struct zoomed *zoomed, int border)
{
  double(*net)[4] = zoomed->net[2];
  return window_length(closer, ZOOM_POLE_MET * slope_at_pole(net, depth_of_pole(net, border)));
}

bool pole_zoom(struct search *s, const struct box *box, int border)
{
  if (!asks_zoom(s, box, border)) return false;
  struct search closer = search_closer(s, box);
  struct zoomed zoomed;
  enum zoom_pole pole;
  judge_spend(s->window.judge, WORK_ZOOM);
  const bool done = zoom_pole_box(judge_zoom(s->window.judge), closer.window.low, closer.window.size, border, &zoomed,
                                  &pole);
  const double reach = done ? met_reach(&closer.window, &zoomed, border) : 0;
  closer.met = pole == POLE_MET;
  if (closer.met) judge_pole(s->window.judge, border, reach);
  s->dependent |= !done;
  if (!done) return false;
  closer.divided = border;
  for (int k = 0; k < 2; k++) closer.met_error[k] = zoomed.met[k];
  search_run_closer(&closer, &zoomed);
  return true;
}

/* How far beyond an end of the ray the pole at t certainly is: at most 0 if it may be at that end. */
static double pole_gap(const struct search *s, double t)
{
  const struct ray *ray = s->window.judge->asked->ray;
  const double gap = t <= ray->t_min ? ray->t_min - t : t - ray->t_max;
  return gap - window_length(&s->window, s->window.depth_error) - 8 * UNIT_ROUNDOFF * real_max(fabs(t), gap);
}

/* For a box at a pole at `depth` that may be met and lies beyond an end of the ray by the gap: whether the box has no
 * root on this side of that end. Such a root is farther from the border than `least`, as a part of the box; the farther
 * it is, the less the nets are off by. */
static bool pole_alone(const struct search *s, struct box *box, double depth, double gap)
{
  double error[2];
  const double least = real_min(gap / window_length(&s->window, slope_at_pole(box->net[2], depth)), 1);
  if (!(least > 0)) return false;
  search_rounding(s, box, error);
  pole_add_error(s, least * reach_from(box, s->divided), error);
  return box_test(box, error) == VERDICT_EMPTY;
}

/* If the pole has been told, nothing is said of what is next to it. If it may be at an end of the ray, what is next to
 * it is a doubt, and nothing else is said of it. If it is beyond that end, what is next to it is halved towards it. */
enum pole_box pole_decide(struct search *s, struct box *box)
{
  const struct ray *ray = s->window.judge->asked->ray;
  const int border = s->divided;
  const double depth = depth_of_pole(box->net[2], border), t = t_of_depth(&s->window.depth, depth);
  const double gap = pole_gap(s, t);
  const bool told = t > ray->t_min && t < ray->t_max, at_end = !told && !(gap > 0);
  const bool smallest = reach_from(box, border) <= ZOOM_POLE_MET, alone = !told && pole_alone(s, box, depth, gap);
  if (smallest && !told && !alone) search_tell_maybe(s, box, false);
  else if (at_end) judge_undecided(s->window.judge, box->near);
  if (smallest || alone) return POLE_BOX_DECIDED;
  return told || at_end ? POLE_BOX_OPEN : POLE_BOX_HALVED;
}

void pole_add_error(const struct search *s, double distance, double error[2])
{
  for (int k = 0; k < 2; k++) error[k] += s->met_error[k] / distance;
}

/* In a box at the pole, a root counts from a sixteenth of the box's reach on (pole_far), and that reach is at least
 * ZOOM_POLE_MET. Any other box reaches no farther than its distance from the pole, and a root beside it is not nearer
 * than half of that (BOX_MARGIN). */
double pole_told_from(const struct search *s, const struct box *box)
{
  const double distance[4] = {box->u, 1 - (box->u + box->size_u), box->v, 1 - (box->v + box->size_v)};
  return real_max(distance[s->divided] / 2, ZOOM_POLE_MET / CERTIFICATE_SLOPES);
}

bool pole_far(const struct search *s, const struct box *box, const double root[2])
{
  const double u = box->u + box->size_u * root[0], v = box->v + box->size_v * root[1];
  const double distance[4] = {u, 1 - u, v, 1 - v};
  int zeros[4];
  (void)pole_zeros(s, box, zeros); /* or there are none */
  for (int k = 0; k < 4; k++)
    if ((k == s->divided || zeros[k] > 0) && CERTIFICATE_SLOPES * distance[k] < reach_from(box, k)) return false;
  return true;
}

/* A ray through a point where several patches meet: a corner, or a pole, a border that is one point.
 *
 * A walk round the point from border to border passes through all patches that have it, and returns if the surface is
 * closed round it. As the ray sees it, each patch fills a sector there, between its borders' directions. If all sectors
 * turn the same way and go round just once, the projections of the patches fit together without a fold. Next to the
 * point the surface is then a sheet across the ray, which meets it exactly once, wherever it passes.
 */
#include <math.h>

#include "intersect/exact/judge.h"

/* Directions are differences of control points of size at most 1 in the frame of a patch, right to some units of 2^-53.
 * What is sure with this as their error leaves room for the surface to bend within 2^-40 of the point. */
#define DIRECTION_ERROR 0x1p-36

/* How often a pole's directions are halved to prove that they turn one way. */
enum { TURN_HALVINGS = 8 };

/* The point in one patch: it lies between two borders, and the walk goes from `in` to `out`. */
struct wedge {
  uint32_t patch;
  int in, out;
  int end;  /* the end of `in` at which the point is: 0 or 1 of its running parameter */
  int pole; /* the border between the two that is the point; -1 if they meet there */
};

struct direction {
  double x, y; /* along the two axes across the dominant one, as the ray sees them */
};

/* The wedge of a patch whose border `in` ends in the point. */
static struct wedge wedge_at(const struct model *model, uint32_t patch, int in, int end)
{
  const int other = (in < 2 ? 2 : 0) + end; /* the border at that end */
  struct wedge w = {patch, in, other, end, -1};
  if (edge_is_point(model->scene->patches[patch].P, other)) w.pole = other, w.out = in ^ 1;
  return w;
}

/* The end of `out` at which the point is. */
static int out_end(const struct wedge *w) { return w->pole >= 0 ? w->end : w->in & 1; }

/* The wedge across the border `out`. Returns false if there is none. */
static bool next_wedge(const struct model *model, const struct wedge *w, struct wedge *out)
{
  const struct edge_neighbour *other = model_neighbour(model, w->patch, w->out);
  if (other->patch == EDGE_NONE) return false;
  *out = wedge_at(model, other->patch, other->border, other->reversed ? 1 - out_end(w) : out_end(w));
  return true;
}

/* The wedge of a root found in a corner or at a pole. Returns false if the root is on one border only. */
static bool wedge_of(const struct model *model, const struct exact_found *found, struct wedge *out)
{
  const uint32_t patch = found->root.patch;
  int bits[4], count = 0;
  for (int k = 0; k < 4; k++)
    if (found->borders >> k & 1) bits[count++] = k;
  for (int k = 0; k < count; k++) {
    if (!edge_is_point(model->scene->patches[patch].P, bits[k])) continue;
    *out = wedge_at(model, patch, bits[k] < 2 ? 2 : 0, bits[k] & 1);
    return out->pole == bits[k];
  }
  if (count != 2 || bits[1] < 2 || bits[0] > 1) return false;
  *out = wedge_at(model, patch, bits[0], bits[1] & 1);
  return true;
}

/* Whether the two are the same place of one patch. */
static bool same_wedge(const struct wedge *a, const struct wedge *b)
{
  if (a->patch != b->patch || (a->pole >= 0) != (b->pole >= 0)) return false;
  if (a->pole >= 0) return a->pole == b->pole;
  return (a->in == b->in && a->out == b->out) || (a->in == b->out && a->out == b->in);
}

/* ---- how it is seen ---- */

/* The direction from one control point of the patch to another, numbered as by edge_at. */
static struct direction seen(const struct judge *j, uint32_t patch, int from, int to)
{
  struct patch_room room;
  double(*x)[4][4] = model_patch_at(j->asked->model, patch, &room)->x, t[3];
  for (int c = 0; c < 3; c++) t[c] = x[c][to / 4][to % 4] - x[c][from / 4][from % 4];
  const double *d = j->asked->ray->direction;
  const int k = dominant_axis(d), one = (k + 1) % 3, two = (k + 2) % 3;
  return (struct direction){t[one] - d[one] / d[k] * t[k], t[two] - d[two] / d[k] * t[k]};
}

/* The direction of a border away from that end. */
static struct direction border_direction(const struct judge *j, uint32_t patch, int border, int end)
{
  return seen(j, patch, edge_at(border, end ? 3 : 0), edge_at(border, end ? 2 : 1));
}

/* The sense in which a turns to b, 1 or -1; 0 if not sure. */
static int turn(struct direction a, struct direction b)
{
  const double sine = a.x * b.y - a.y * b.x;
  const double least = 4 * DIRECTION_ERROR *
                       (fmax(fabs(a.x), fabs(a.y)) + fmax(fabs(b.x), fabs(b.y)) + DIRECTION_ERROR);
  return sine > least ? 1 : sine < -least ? -1 : 0;
}

/* A walk round the point. */
struct round {
  struct direction at; /* direction looked in */
  int way;             /* the sense of the first turn; 0: none yet */
  double angle;        /* total angle turned */
};

/* Turns to b, which is less than half a turn away. Returns false if that is the other sense, or not sure. */
static bool go_to(struct round *round, struct direction b)
{
  const struct direction a = round->at;
  const int way = turn(a, b);
  if (way == 0 || (round->way != 0 && way != round->way)) return false;
  round->at = b, round->way = way;
  round->angle += atan2(fabs(a.x * b.y - a.y * b.x), a.x * b.x + a.y * b.y);
  return true;
}

/* Turns along a cubic of directions. It turns one way, and by less than half a turn, if any two of its control values
 * do. */
static bool go_along(struct round *round, const struct direction c[4], int halvings)
{
  int sum = 0;
  for (int a = 0; a < 4; a++)
    for (int b = a + 1; b < 4; b++) sum += turn(c[a], c[b]);
  if (sum == 6 || sum == -6) return go_to(round, c[3]);
  if (halvings == 0) return false;
  struct direction half[2][4], level[4] = {c[0], c[1], c[2], c[3]};
  for (int n = 0; n < 4; n++) {
    half[0][n] = level[0], half[1][3 - n] = level[3 - n];
    for (int k = 0; k + n < 3; k++)
      level[k] = (struct direction){(level[k].x + level[k + 1].x) / 2, (level[k].y + level[k + 1].y) / 2};
  }
  return go_along(round, half[0], halvings - 1) && go_along(round, half[1], halvings - 1);
}

/* Goes through a wedge. */
static bool go_through(const struct judge *j, const struct wedge *w, struct round *round)
{
  if (w->pole < 0) return go_to(round, border_direction(j, w->patch, w->out, out_end(w)));
  struct direction c[4];
  for (int n = 0; n < 4; n++) {
    const int at = edge_at(w->pole, w->in & 1 ? 3 - n : n); /* a pole runs from one of its two borders to the other */
    c[n] = seen(j, w->patch, at, at + edge_inward(w->pole));
  }
  return go_along(round, c, TURN_HALVINGS);
}

/* Whether the walk went round once, up to rounding. */
static bool once_round(const struct round *round) { return fabs(round->angle - 2 * acos(-1)) < 1; }

/* The index of the root that lies there in the wedge; `end` for none. */
static size_t root_in(const struct judge *j, const struct wedge *w, const struct exact_root *at, size_t first,
                      size_t end)
{
  for (size_t k = first; k < end; k++) {
    const struct exact_found *found = &j->list->at[k];
    struct wedge its;
    if (found->root.patch == w->patch && found->kind == EXACT_BORDER && wedge_of(j->asked->model, found, &its) &&
        same_wedge(w, &its) && judge_tie(&found->root, at))
      return k;
  }
  return end;
}

size_t judge_star(struct judge *j, size_t at, size_t first, size_t end, size_t out[STAR_MAX])
{
  const struct model *model = j->asked->model;
  const struct exact_root *root = &j->list->at[at].root;
  struct wedge start, w;
  if (!wedge_of(model, &j->list->at[at], &start)) return 0;
  struct round round = {.at = border_direction(j, start.patch, start.in, start.end)};
  w = start;
  for (size_t count = 0; count < STAR_MAX;) {
    const size_t found = root_in(j, &w, root, first, end);
    if (found == end || !go_through(j, &w, &round)) return 0;
    out[count++] = found;
    if (!next_wedge(model, &w, &w)) return 0;
    if (same_wedge(&w, &start) && w.in == start.in) return once_round(&round) ? count : 0;
  }
  return 0;
}

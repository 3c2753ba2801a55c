/* Whether a ray crosses the surface on a border: where two patches meet, or round a vertex in which several do.
 *
 * As the ray sees it, in the plane of (a,b), it is the origin. Where it meets a border, it crosses the surface if the
 * two patches lie on either side of the border's curve. A vertex is a corner, or a pole, a border that is one point. A
 * walk round it from border to border passes through all patches that have it, and returns if the surface is closed
 * there. Each patch fills a sector, from one border's direction to the other's; near the vertex it has no further root,
 * so the angles add up to how often the surface goes round the ray. If that is once, the ray crosses it there.
 */
#include "base/real.h"
#include "geometry/edges.h"
#include "intersect/exact/judge.h"

/* The vertex in one patch: it lies between two borders, and the walk goes from `in` to `out`. */
struct wedge {
  uint32_t patch;
  int in, out;
  int end;  /* the end of `in` at which the vertex is: 0 or 1 of its running parameter */
  int pole; /* the border between the two that is the vertex; -1 if they meet there */
};

struct direction {
  double x, y;
};

/* The wedge of a patch whose border `in` ends in the vertex. */
static struct wedge wedge_at(const struct model *model, uint32_t patch, int in, int end)
{
  const int other = (in < 2 ? 2 : 0) + end; /* the border at that end */
  struct wedge w = {patch, in, other, end, -1};
  if (edge_is_point(model->scene->patches[patch].P, other)) w.pole = other, w.out = in ^ 1;
  return w;
}

/* The end of `out` at which the vertex is. */
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
static bool wedge_of(const struct model *model, const struct exact_root *root, struct wedge *out)
{
  int bits[4], count = 0;
  for (int k = 0; k < 4; k++)
    if (root->borders >> k & 1) bits[count++] = k;
  for (int k = 0; k < count; k++) {
    if (!edge_is_point(model->scene->patches[root->patch].P, bits[k])) continue;
    *out = wedge_at(model, root->patch, bits[k] < 2 ? 2 : 0, bits[k] & 1);
    return true;
  }
  if (count != 2) return false;
  *out = wedge_at(model, root->patch, bits[0], bits[1] & 1);
  return true;
}

/* Whether the two are the same place of one patch. */
static bool same_wedge(const struct wedge *a, const struct wedge *b)
{
  if (a->patch != b->patch || a->pole != b->pole) return false;
  return a->pole >= 0 || (a->in == b->in && a->out == b->out) || (a->in == b->out && a->out == b->in);
}

/* ---- angles ---- */

/* Control value `at` of (a,b), of length about 1. Returns false if it is 0. */
static bool direction_at(const struct piece *plane, int at, struct direction *out)
{
  wide x[2];
  bool exact;
  for (int k = 0; k < 2; k++) x[k] = piece_coefficient(plane, k, at, &exact);
  const wide size = wide_max(wide_abs(x[0]), wide_abs(x[1]));
  if (size > 0) *out = (struct direction){(double)(x[0] / size), (double)(x[1] / size)};
  return size > 0;
}

/* The direction of a border away from that end: that of its first control value that is not the vertex. Returns its
 * number from there, 1 to 3: at 1 the border has a handle; 0 for none. */
static int border_direction(const struct piece *plane, int border, int end, struct direction *out)
{
  for (int n = 1; n < 4; n++)
    if (direction_at(plane, edge_at(border, end ? 3 - n : n), out)) return n;
  return 0;
}

/* The angle from a to b, less than half a turn. */
static double angle(struct direction a, struct direction b)
{
  return atan2(a.x * b.y - a.y * b.x, a.x * b.x + a.y * b.y);
}

/* What is nearer to half a turn may be one the other way. A choice of caution: angles are right to some 2^-50. */
#define HALF_TURN (3.14159 - 0x1p-20)

/* Adds the angle along the first row of control values from a pole on which not all are the pole. The cubic of directions
 * does not go through the origin, and turns as its ends do, if they are not the pole, and lie in a half plane with those
 * between that are not. */
static bool add_pole(const struct piece *plane, const struct wedge *w, double *sum)
{
  struct direction c[4] = {{0, 0}};
  bool there[4] = {false};
  for (int row = 1; row < 4 && !(there[0] || there[1] || there[2] || there[3]); row++)
    for (int n = 0; n < 4; n++)
      there[n] = direction_at(plane, edge_at(w->pole, w->in & 1 ? 3 - n : n) + row * edge_inward(w->pole), &c[n]);
  double low = 0, high = 0;
  for (int n = 1; n < 4; n++)
    if (there[n]) low = real_min(low, angle(c[0], c[n])), high = real_max(high, angle(c[0], c[n]));
  *sum += angle(c[0], c[3]);
  return there[0] && there[3] && high - low < HALF_TURN;
}

/* Adds the angle of a wedge of the current patch. */
static bool add_wedge(const struct judge *j, const struct wedge *w, double *sum)
{
  const struct piece *plane = &j->sight.plane;
  struct direction in = {0, 0}, out = {0, 0};
  if (w->pole >= 0) return add_pole(plane, w, sum);
  const int first[2] = {border_direction(plane, w->in, w->end, &in), border_direction(plane, w->out, out_end(w), &out)};
  /* Without a handle the corner's sector is as its borders say only if a combination of a and b themselves shows it. A
   * border without a direction is met. */
  if ((first[0] != 1 || first[1] != 1) && (j->sight.borders > 0 || j->sight.met)) return false;
  const double turn = angle(in, out); /* at a smooth corner, either way */
  *sum += turn;
  return fabs(turn) < HALF_TURN;
}

/* ---- crossings ---- */

/* The index of the list's root in the wedge; the count for none. */
static size_t root_in(const struct judge *j, const struct wedge *w)
{
  const struct exact_found *found = j->list->at;
  for (size_t k = 0; k < j->list->count; k++) {
    struct wedge its;
    if (found[k].root.patch == w->patch && found[k].kind == EXACT_BORDER &&
        wedge_of(j->asked->model, &found[k].root, &its) && same_wedge(w, &its))
      return k;
  }
  return j->list->count;
}

static size_t round_vertex(struct judge *j, const struct wedge *start, size_t out[VERTEX_MAX])
{
  const double whole = 2 * acos(-1);
  struct wedge w = *start;
  double sum = 0;
  for (size_t count = 0; count < VERTEX_MAX;) {
    const size_t found = root_in(j, &w);
    if (found == j->list->count) return 0;
    judge_turn(j, w.patch);
    if (!add_wedge(j, &w, &sum)) return 0;
    out[count++] = found;
    if (!next_wedge(j->asked->model, &w, &w)) return 0;
    if (same_wedge(&w, start)) return fabs(fabs(sum) - whole) < 1 ? count : 0;
  }
  return 0;
}

/* Where two patches meet: the same border has the same roots, at one t and one place. */
static size_t across_border(struct judge *j, size_t at, size_t out[VERTEX_MAX])
{
  struct exact_found *found = j->list->at, *here = &found[at];
  const int border = __builtin_ctz(here->root.borders);
  const struct edge_neighbour *other = model_neighbour(j->asked->model, here->root.patch, border);
  for (size_t k = 0; k < j->list->count && other->patch != EDGE_NONE; k++) {
    struct exact_root *root = &found[k].root;
    if (root->patch != other->patch || found[k].kind != EXACT_BORDER || root->borders != 1u << other->border) continue;
    const wide along = border < 2 ? here->root.v : here->root.u, its = other->border < 2 ? root->v : root->u;
    const double apart = fabs((double)(along - (other->reversed ? 1 - its : its)));
    if (apart > here->root.radius_u + here->root.radius_v + root->radius_u + root->radius_v) continue;
    if (judge_compare(j, root, &here->root) != 0) continue;
    out[0] = at, out[1] = k;
    return here->root.side * root->side * (other->reversed ? -1 : 1) == -1 ? 2 : 0;
  }
  return 0;
}

size_t vertex_crossed(struct judge *j, size_t at, size_t out[VERTEX_MAX])
{
  struct wedge start;
  if (wedge_of(j->asked->model, &j->list->at[at].root, &start)) return round_vertex(j, &start, out);
  return across_border(j, at, out);
}

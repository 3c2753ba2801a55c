/* Exact subdivision; see exact.h. Methods: G. Farin, Curves and Surfaces for CAGD (nets, halving); R. Moore, R.
 * Kearfott, M. Cloud, Introduction to Interval Analysis, chapter 8 (preconditioning, Krawczyk's operator). */
#include "accuracy/exact.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "accuracy/exact_parts.h"

/* Bits of balls: enough for most roots, and for the next ones. Each step after these takes 4 times as many. */
enum { FIRST_PRECISION = 128, SECOND_PRECISION = 768 };

/* t is told to twice a double's digits if this many bits of it are known. */
enum { T_BITS = 100 };

/* If the nets are multiples of one, or vanish on one line, there is a common curve, and more boxes than CURVE_BOXES
 * prove little. It is looked for after SUSPICIOUS_BOXES. */
enum { CURVE_BOXES = 400, SUSPICIOUS_BOXES = 64 };

/* A root is sought with balls if Newton's method ends this near to the part, relative to its size. */
#define NEAR_PART 0x1p-30

/* If an exact root cannot be told from a double one, it is looked at from nearer this many times more. */
enum { HOPELESS_ZOOMS = 3 };

enum { MOST_HALVINGS = 1200, PARTS = 4 * EXACT_BOXES };

struct search {
  struct exact_roots *out;
  struct interval interval;
  struct box whole; /* the patch */
  size_t known;     /* proven roots that have a ball: */
  arb_t at[EXACT_MOST_ROOTS][2];
  struct quick parts[PARTS]; /* of the boxes being looked at, one box after the other */
};

/* ---- roots of a box ---- */

static double double_of(const arb_t x) { return arf_get_d(arb_midref(x), ARF_RND_NEAR); }

/* From a box's parameter to that of the whole patch, and back. */
static void to_whole(const fmpz *corner, int halved, const arb_t at, arb_t out)
{
  arb_add_fmpz(out, at, corner, ARF_PREC_EXACT);
  arb_mul_2exp_si(out, out, -halved);
}

static void to_own(const fmpz *corner, int halved, const arb_t at, arb_t out)
{
  arb_mul_2exp_si(out, at, halved);
  arb_sub_fmpz(out, out, corner, ARF_PREC_EXACT);
}

static double whole(const fmpz *corner, int halved, const arb_t at)
{
  arb_t x;
  arb_init(x);
  arb_set_fmpz(x, corner), arb_add(x, x, at, UNIT_PRECISION), arb_mul_2exp_si(x, x, -halved);
  const double value = double_of(x);
  arb_clear(x);
  return value;
}

static struct exact_root *add_root(struct search *s)
{
  struct exact_roots *out = s->out;
  if (out->count < EXACT_MOST_ROOTS) return &out->root[out->count++];
  return NULL;
}

/* Adds a range of t in which nothing is known. If there is no room, the last one is extended instead. */
static void add_unknown(struct search *s, double u, double v, double low, double high)
{
  struct exact_root *root = add_root(s);
  if (root) {
    *root = (struct exact_root){.u = u, .v = v, .t = low, .t_end = high};
    return;
  }
  root = &s->out->root[EXACT_MOST_ROOTS - 1];
  *root = (struct exact_root){.u = root->u, .v = root->v, .t = fmin(root->t, low), .t_end = fmax(root->t_end, high)};
}

/* t for a value, a ball, of the box's net T. */
static void t_of(const struct search *s, const struct box *box, const arb_t value, arb_t out)
{
  arb_mul(out, value, s->interval.unit, UNIT_PRECISION);
  arb_mul_2exp_si(out, out, -3 * (box->halved[0] + box->halved[1]));
}

/* Whether x, in the unit of the box's net T, lies after the end `end` of the interval: 1 yes, -1 no, 0 unknown. */
static int after(const struct box *box, const arb_t x, const fmpz_t end)
{
  arb_t difference;
  fmpz_t scaled_end;
  arb_init(difference), fmpz_init(scaled_end);
  fmpz_mul_2exp(scaled_end, end, (ulong)(3 * (box->halved[0] + box->halved[1])));
  arb_sub_fmpz(difference, x, scaled_end, EXACT_PRECISION);
  const int sign = arb_is_positive(difference) ? 1 : arb_is_nonpositive(difference) ? -1 : 0;
  arb_clear(difference), fmpz_clear(scaled_end);
  return sign;
}

/* Adds the only root in the balls at_u, at_v of the box, if it is within patch and interval. False if that takes more
 * precision. */
static bool accept(struct search *s, const struct box *box, const arb_t at_u, const arb_t at_v, long bits, bool last)
{
  const enum side side = ball_side(box, at_u, at_v);
  if (side == SIDE_OUT) return true;
  const struct interval *interval = &s->interval;
  struct ball_jet jet;
  ball_jet_init(&jet);
  ball_evaluate(box->c[T], at_u, at_v, &jet, 2 * bits);
  const int begun = after(box, jet.value, interval->low),
            ended = interval->endless ? -1 : after(box, jet.value, interval->high);
  bool sure = side == SIDE_IN && begun && ended, out = begun < 0 || ended > 0;
  if (!sure && !out) {
    const enum side exactly = point_side(box, at_u, at_v, interval->low, interval->endless ? NULL : interval->high);
    sure = exactly == SIDE_IN, out = exactly == SIDE_OUT;
  }
  if (out || (!sure && !last)) {
    ball_jet_clear(&jet);
    return out;
  }
  arb_t t;
  arb_init(t);
  t_of(s, box, jet.value, t);
  if (!last && arb_rel_accuracy_bits(t) < T_BITS) { /* next to the ray's start t is known less well than u and v */
    arb_clear(t), ball_jet_clear(&jet);
    return false;
  }
  const double near = double_of(t), u = whole(&box->u, box->halved[0], at_u), v = whole(&box->v, box->halved[1], at_v);
  struct exact_root *root = sure ? add_root(s) : NULL;
  arb_set_d(jet.ds, near), arb_sub(t, t, jet.ds, UNIT_PRECISION);
  if (root) {
    *root = (struct exact_root){u, v, near, double_of(t), true, near};
    to_whole(&box->u, box->halved[0], at_u, s->at[s->known][0]);
    to_whole(&box->v, box->halved[1], at_v, s->at[s->known][1]);
    s->known++;
  } else add_unknown(s, u, v, near, near);
  arb_clear(t), ball_jet_clear(&jet);
  return true;
}

/* Whether x is within NET_OVERHANG of [0,1]. Out of line, or GCC 12 takes a ball's radius for smaller than it is. */
__attribute__((noinline)) static bool near_box(const arb_t x)
{
  const double m = double_of(x);
  return m > -NET_OVERHANG / 2 && m < 1 + NET_OVERHANG / 2 && mag_cmp_2exp_si(arb_radref(x), -42) < 0;
}

/* Whether x, of the whole patch, is as near to the place. */
static bool near_place(const struct place *place, int axis, const arb_t x)
{
  arb_t own;
  arb_init(own);
  arb_mul_2exp_si(own, x, place->halved[axis]);
  arb_sub_ui(own, own, place->corner[axis], UNIT_PRECISION);
  const bool near = near_box(own);
  arb_clear(own);
  return near;
}

/* Whether balls u and v lie in the box, or in `place` of it, or next to it. */
static bool near_part(const struct place *place, const arb_t u, const arb_t v)
{
  return place ? near_place(place, 0, u) && near_place(place, 1, v) : near_box(u) && near_box(v);
}

/* Whether the only root in the box or `place`, or next to it, is listed: as that of another part, on the line where
 * both meet or next to it. Fails for parts as small as the root's own uncertainty. */
static bool is_known(const struct search *s, const struct box *box, const struct place *place)
{
  bool found = false;
  arb_t u, v;
  arb_init(u), arb_init(v);
  for (size_t k = 0; k < s->known && !found; k++) {
    to_own(&box->u, box->halved[0], s->at[k][0], u);
    to_own(&box->v, box->halved[1], s->at[k][1], v);
    found = near_part(place, u, v);
  }
  arb_clear(u), arb_clear(v);
  return found;
}

/* Starts at (u,v) of the box, in or next to which (or `place`) is at most one root. Returns whether that is settled. F:
 * two independent combinations of the box's nets. */
static bool settle_one(struct search *s, const struct box *box, const fmpz (*F)[16], const struct place *place, arb_t u,
                       arb_t v)
{
  bool done = false;
  for (long bits = FIRST_PRECISION; !done && bits <= EXACT_PRECISION;
       bits = bits == FIRST_PRECISION ? SECOND_PRECISION : 4 * bits) {
    mag_zero(arb_radref(u)), mag_zero(arb_radref(v));
    if (!ball_prove(F, u, v, bits)) {
      if (bits == FIRST_PRECISION) continue;
      break;
    }
    if (!near_part(place, u, v)) break;
    done = is_known(s, box, place) || accept(s, box, u, v, bits, 4 * bits > EXACT_PRECISION);
  }
  return done;
}

/* Whether all of the box's net T lies outside of the interval. */
static bool outside_interval(const struct search *s, const struct box *box)
{
  fmpz_t end;
  bool before = true, behind = !s->interval.endless;
  fmpz_init(end);
  const ulong shift = (ulong)(3 * (box->halved[0] + box->halved[1]));
  fmpz_mul_2exp(end, s->interval.low, shift);
  for (int n = 0; n < 16 && before; n++) before = fmpz_cmp(&box->c[T][n], end) <= 0;
  fmpz_mul_2exp(end, s->interval.high, shift);
  for (int n = 0; n < 16 && behind; n++) behind = fmpz_cmp(&box->c[T][n], end) >= 0;
  fmpz_clear(end);
  return before || behind;
}

/* Whether the box is done with: it has no root, or only one that is known. */
static bool settle(struct search *s, const struct box *box)
{
  if (net_sign(box->c[A]) || net_sign(box->c[B]) || outside_interval(s, box)) return true;
  fmpz F[2][16];
  nets_init(&F[0][0], 32);
  box_combinations(box, F);
  bool done = net_sign(F[0]) || net_sign(F[1]);
  if (!done && net_dominates(F[0], 0) && net_dominates(F[1], 1)) {
    arb_t u, v;
    arb_init(u), arb_init(v);
    ball_start((const fmpz(*)[16])F, u, v);
    done = settle_one(s, box, (const fmpz(*)[16])F, NULL, u, v);
    arb_clear(u), arb_clear(v);
  }
  nets_clear(&F[0][0], 32);
  return done;
}

/* A box, and how it is looked at in doubles. */
struct view {
  const struct box *box;
  const fmpz (*F)[16]; /* its nets A and B, or two independent combinations of them */
  slong unit;          /* of net T, see quick_start */
  double ends[2];      /* of the interval */
  size_t base;         /* of its first part */
  int zooms;           /* how many more times its parts may be looked at from nearer */
};

/* Leaves a part undecided. */
static void give_up_part(struct search *s, const struct view *view, const struct quick *part)
{
  double range[2] = {INFINITY, -INFINITY}, at[2];
  for (int n = 0; n < 16; n++) range[0] = fmin(range[0], part->c[T][n]), range[1] = fmax(range[1], part->c[T][n]);
  range[0] -= 2 * part->error[T], range[1] += 2 * part->error[T];
  arb_t x;
  arb_init(x);
  for (int k = 0; k < 2; k++) {
    arb_set_d(x, range[k]);
    arb_mul_2exp_si(x, x, view->unit);
    t_of(s, view->box, x, x);
    range[k] = double_of(x);
    arb_set_d(x, ldexp((double)part->place.corner[k] + 0.5, -part->place.halved[k]));
    at[k] = whole(k ? &view->box->v : &view->box->u, view->box->halved[k], x);
  }
  arb_clear(x);
  add_unknown(s, at[0], at[1], range[0], range[1]);
}

/* ---- edges met exactly ---- */

/* If both polynomials vanish on a border, all its points are roots. Adds them, and divides them out. */
static void strip_edges(struct search *s)
{
  struct box *box = &s->whole;
  for (int border = 0; border < 4; border++) {
    bool known = false;
    while (point_edge_vanishes(box->c[A], border) && point_edge_vanishes(box->c[B], border)) {
      arb_t value, t;
      arb_init(value), arb_init(t);
      double low = INFINITY, high = -INFINITY;
      bool in = true;
      for (int n = 0; n < 4; n++) {
        const fmpz *c = &box->c[T][border == 0 ? n : border == 1 ? 12 + n : border == 2 ? 4 * n : 4 * n + 3];
        arb_set_fmpz(value, c);
        t_of(s, box, value, t);
        low = fmin(low, double_of(t)), high = fmax(high, double_of(t));
        in = in && fmpz_cmp(c, s->interval.low) > 0 && (s->interval.endless || fmpz_cmp(c, s->interval.high) < 0);
      }
      const double u = border == 1 ? 1 : border == 0 ? 0 : 0.5, v = border == 3 ? 1 : border == 2 ? 0 : 0.5;
      struct exact_root *root = !known && in && low == high ? add_root(s) : NULL;
      if (root) {
        arb_set_d(value, low), arb_sub(t, t, value, UNIT_PRECISION);
        *root = (struct exact_root){u, v, low, double_of(t), true, low};
      } else if (!known && !outside_interval(s, box) && !(low == high)) add_unknown(s, u, v, low, high);
      known = true;
      arb_clear(value), arb_clear(t);
      bool zero = true;
      for (int n = 0; n < 16; n++) zero = zero && fmpz_is_zero(&box->c[A][n]) && fmpz_is_zero(&box->c[B][n]);
      if (zero) return;
      for (int f = A; f <= B; f++) {
        for (int n = 0; n < 4; n++) {
          fmpz *line = &box->c[f][border < 2 ? n : 4 * n];
          const int stride = border < 2 ? 4 : 1;
          if (border % 2) fmpz_swap(line, line + 3 * stride), fmpz_swap(line + stride, line + 2 * stride);
          point_divide_out(line, stride);
          if (border % 2) fmpz_swap(line, line + 3 * stride), fmpz_swap(line + stride, line + 2 * stride);
        }
      }
    }
  }
}

/* ---- the search ---- */

/* Whether the only root that the part may have, near `at`, is known, or known not to exist. */
static bool settle_part(struct search *s, const struct view *view, const struct place *place, const double at[2])
{
  for (int k = 0; k < 2; k++)
    if (!(fabs(at[k] - 0.5) <= 0.5 + NEAR_PART)) return false;
  arb_t u, v;
  arb_init(u), arb_init(v);
  arb_set_d(u, ldexp((double)place->corner[0] + at[0], -place->halved[0]));
  arb_set_d(v, ldexp((double)place->corner[1] + at[1], -place->halved[1]));
  const bool done = settle_one(s, view->box, view->F, place, u, v);
  arb_clear(u), arb_clear(v);
  return done;
}

/* Moves the part that begins first on the ray to the front: where a common curve begins matters most. */
static void nearest_first(struct quick *parts, size_t count)
{
  size_t nearest = 0;
  for (size_t n = 1; n < count; n++)
    if (parts[n].begin < parts[nearest].begin) nearest = n;
  const struct quick first = parts[0];
  parts[0] = parts[nearest], parts[nearest] = first;
}

static void view_start(const struct search *s, struct view *view, struct quick *first)
{
  fmpz_t low, high;
  fmpz_init(low), fmpz_init(high);
  const ulong shift = (ulong)(3 * (view->box->halved[0] + view->box->halved[1]));
  fmpz_mul_2exp(low, s->interval.low, shift), fmpz_mul_2exp(high, s->interval.high, shift);
  view->unit = quick_start(view->F, view->box->c[T], low, s->interval.endless ? NULL : high, first, view->ends);
  fmpz_clear(low), fmpz_clear(high);
}

static void zoom(struct search *s, const struct view *view, const struct quick *part, size_t base);

/* Searches the whole patch breadth first. If there is a common curve, halves the part that begins first, and uses fewer
 * boxes. */
static void look(struct search *s, struct view *view)
{
  const bool top = view->box == &s->whole, dependent = top && box_dependent(&s->whole);
  bool curve = dependent;
  size_t done = 0, count = 1, hidden = 0, most = curve ? CURVE_BOXES : EXACT_BOXES;
  struct quick *parts = &s->parts[view->base];
  double at[2];
  if (dependent) box_straighten(&s->whole, &s->interval);
  if (dependent && outside_interval(s, &s->whole)) return;
  view_start(s, view, parts);
  while (done < count) {
    if (curve) nearest_first(&parts[done], count - done);
    const struct quick *part = &parts[done++];
    if (quick_empty(part, view->ends)) continue;
    const enum quick_verdict verdict = dependent ? quick_depth(part) : quick_look(part, at);
    if (verdict == QUICK_EMPTY || (verdict == QUICK_ONE && settle_part(s, view, &part->place, at))) continue;
    if (top && !curve && s->out->boxes >= SUSPICIOUS_BOXES && point_hopeless(&s->whole, &part->place) == HOPELESS_CURVE)
      curve = true, most = s->out->boxes + CURVE_BOXES;
    const bool spent = verdict == QUICK_SPENT;
    if (spent && !curve && view->zooms > 0) {
      parts[hidden++] = *part; /* for later: parts that are done with leave room for it */
    } else if (spent || ++s->out->boxes > most || view->base + count + 2 > PARTS) {
      give_up_part(s, view, part);
    } else {
      quick_halve(part, &parts[count]);
      count += 2;
    }
  }
  for (size_t n = 0; n < hidden; n++) zoom(s, view, &parts[n], view->base + hidden);
}

static void *nearer_room(size_t size)
{
  void *room = malloc(size);
  if (!room) abort();
  return room;
}

/* Looks at a box in new doubles. */
static void look_nearer(struct search *s, const struct box *box, size_t base, int zooms)
{
  fmpz(*F)[16] = nearer_room(2 * sizeof *F);
  nets_init(&F[0][0], 32);
  box_combinations(box, F);
  struct view view = {.box = box, .F = (const fmpz(*)[16])F, .base = base, .zooms = zooms};
  look(s, &view);
  nets_clear(&F[0][0], 32);
  free(F);
}

/* Looks, in new doubles, at the exact nets of a part in which rounding hides the answer. If the part is the whole box,
 * this is halved exactly. */
static void zoom(struct search *s, const struct view *view, const struct quick *part, size_t base)
{
  const struct box *box = view->box;
  const int *halved = part->place.halved;
  if (++s->out->boxes > EXACT_BOXES || base + 3 > PARTS || box->halved[0] + box->halved[1] >= 2 * MOST_HALVINGS) {
    give_up_part(s, view, part);
    return;
  }
  const bool all = halved[0] + halved[1] == 0;
  if (all && settle(s, box)) return;
  struct box *half = nearer_room(2 * sizeof *half); /* not on the stack, since these calls are nested */
  box_init(&half[0]), box_init(&half[1]);
  if (all) {
    box_split(box, box_changes_along_v(box), &half[0], &half[1]);
    for (int k = 0; k < 2; k++) look_nearer(s, &half[k], base, view->zooms);
  } else {
    const bool hopeless = box == &s->whole && point_hopeless(box, &part->place) == HOPELESS_POINT;
    box_of_place(box, &part->place, &half[0]);
    look_nearer(s, &half[0], base, hopeless ? HOPELESS_ZOOMS : view->zooms - 1);
  }
  box_clear(&half[0]), box_clear(&half[1]);
  free(half);
}

void exact_patch_roots(const double P[4][4][3], const double origin[3], const double direction[3], double t_min,
                       double t_max, struct exact_roots *out)
{
  struct search s; /* too large to be cleared each time */
  s.out = out;
  out->count = out->boxes = s.known = 0;
  for (size_t k = 0; k < EXACT_MOST_ROOTS; k++) arb_init(s.at[k][0]), arb_init(s.at[k][1]);
  fmpz_init(s.interval.low), fmpz_init(s.interval.high), arb_init(s.interval.unit);
  box_init(&s.whole);
  box_of_patch(P, origin, direction, t_min, t_max, &s.whole, &s.interval);
  strip_edges(&s);
  struct view view = {.box = &s.whole, .F = (const fmpz(*)[16])s.whole.c, .zooms = MOST_HALVINGS};
  look(&s, &view);
  for (size_t k = 0; k < EXACT_MOST_ROOTS; k++) arb_clear(s.at[k][0]), arb_clear(s.at[k][1]);
  box_clear(&s.whole);
  fmpz_clear(s.interval.low), fmpz_clear(s.interval.high), arb_clear(s.interval.unit);
}

void exact_cleanup(void) { flint_cleanup(); }

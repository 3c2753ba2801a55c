/* Validates roots: one judge for all solvers, which uses nothing but the values and the polynomial.
 *
 * Let q_j be the Taylor coefficients at z of a polynomial q of degree n, rounded up or down by their bounds
 * (evaluation.h), so that what follows holds for the true polynomial. Roots at infinity only make it safer.
 *
 * One root. Each |q_j / q_0| is an elementary symmetric function of the reciprocal distances from z to the roots, at
 * most C(n,j) / d^j with d the smallest distance. So for every j there is a root within (C(n,j) |q_0| / |q_j|)^(1/j).
 *
 * k roots. If |q_k| r^k is larger than the sum of all other |q_j| r^j, exactly k roots are within r of z (M. A. Pellet
 * 1881, from Rouche's theorem). A value gets such a disc with k = 1 where it has one. Values without a disc, and values
 * whose discs meet, are joined with their nearest neighbours, and the k values of a group seek a disc with k roots
 * about their mean, moved to the mean of the roots by a step of Newton's method on the derivative of order k - 1. In
 * the end any two discs are disjoint, or one lies in the other and its values are among those of the other. So roots
 * and values can be paired, each root in the disc of its value, and a value's radius reaches all of its disc. A disc
 * that meets the real axis is sought again with its centre there: its roots are real, or in conjugate pairs.
 *
 * Discs are taken in the chart variable and carried to u; both charts are Moebius maps. If z = s/w, with w the chart's
 * denominator at u, the disc of radius r about z lies within r |w|^2 / (1 - r |w|) of u, or reaches infinity if
 * r |w| >= 1.
 */
#include <math.h>
#include <string.h>

#include "algebra/root_problem.h"

/* The chart point is computed from u with a difference, a reciprocal of a square and products: under 10 roundings. */
#define CHART_ROUNDING (10 * UNIT_ROUNDOFF)

/* ---- charts ---- */

/* The chart point z = top/low of u, with low = w. */
struct chart {
  struct complex_number z;
  double width;    /* |w| */
  double rounding; /* of z */
  bool whole;      /* z = u */
};

static bool is_reversed(enum basis basis, struct complex_number u)
{
  return hypot(u.re, u.im) > (basis == BASIS_POWER ? 1.0 : hypot(1.0 - u.re, u.im));
}

static struct chart chart_of(enum basis basis, bool reversed, struct complex_number u)
{
  const bool power = basis == BASIS_POWER;
  const struct complex_number v = power ? (struct complex_number){1.0, 0.0}
                                        : (struct complex_number){1.0 - u.re, -u.im};
  const struct complex_number top = reversed ? v : u, low = reversed ? u : v;
  struct chart out = {.z = complex_divide(top, low), .width = hypot(low.re, low.im), .whole = power && !reversed};
  if (out.whole) out.z = u;
  else out.rounding = CHART_ROUNDING * hypot(out.z.re, out.z.im);
  return out;
}

/* Converts a bound on a distance from the chart point to one in u. */
static double radius_in_u(const struct chart *chart, double bound)
{
  if (chart->whole) return bound >= 0.0 ? bound : INFINITY;
  const double reach = bound * chart->width * BOUND_ROOM, room = 1.0 - reach;
  const double radius = reach * chart->width / room * BOUND_ROOM;
  return room > 0.0 && radius >= 0.0 ? radius : INFINITY; /* NaN ends here too */
}

/* ---- Taylor coefficients ---- */

struct taylor {
  double re[POLYNOMIAL_MAX_DEGREE + 1], im[POLYNOMIAL_MAX_DEGREE + 1];
  double low[POLYNOMIAL_MAX_DEGREE + 1], high[POLYNOMIAL_MAX_DEGREE + 1]; /* bounds on |q_j| */
};

static void taylor_make(const struct evaluation *p, struct complex_number z, bool reversed, struct taylor *out)
{
  const int n = p->degree;
  const size_t bytes = sizeof(double) * (size_t)(n + 1);
  const double modulus = hypot(z.re, z.im) * (1.0 + 4 * UNIT_ROUNDOFF);
  double error[POLYNOMIAL_MAX_DEGREE + 1];
  memcpy(out->re, reversed ? p->reverse : p->forward, bytes);
  memset(out->im, 0, bytes);
  memcpy(error, reversed ? p->reverse_bound : p->forward_bound, bytes);
  for (int j = 0; j <= n; j++) {
    for (int k = n - 1; k >= j; k--) {
      out->re[k] += out->re[k + 1] * z.re - out->im[k + 1] * z.im;
      out->im[k] += out->re[k + 1] * z.im + out->im[k + 1] * z.re;
      error[k] += error[k + 1] * modulus;
    }
    const double size = complex_small_modulus((struct complex_number){out->re[j], out->im[j]}),
                 doubt = error[j] + (modulus > 0.0 ? UNDERFLOW_ERROR : 0.0);
    out->high[j] = (size + doubt) * BOUND_ROOM;
    out->low[j] = fmax(size * (2.0 - BOUND_ROOM) - doubt, 0.0);
  }
}

/* A root is within this of z. */
static double one_root_within(int n, const struct taylor *q)
{
  double best = q->high[0] == 0.0 ? 0.0 : INFINITY;
  for (int j = 1; j <= n && best > 0.0; j++)
    if (q->low[j] > 0.0)
      best = fmin(best, pow(polynomial_binomial(n, j) * q->high[0] / q->low[j], 1.0 / j) * BOUND_ROOM);
  return best;
}

/* A radius is sought from just above its lower bound, in steps by this factor. */
#define FIRST_ROOM (1.0 + 0x1p-10)
#define GROWTH 1.125

/* Exactly k roots are within this of z; INFINITY where no such radius is found. */
static double k_roots_within(int n, int k, const struct taylor *q)
{
  double r = 0.0;
  for (int j = 0; j < k; j++) r = fmax(r, pow(q->high[j] / q->low[k], 1.0 / (k - j)));
  if (!(q->low[k] > 0.0)) return INFINITY;
  if (r == 0.0) return 0.0;
  for (r *= FIRST_ROOM; r < INFINITY; r *= GROWTH) {
    double below = 0.0, above = 0.0;
    for (int j = 0; j < k; j++) below = (below + q->high[j]) / r;
    for (int j = n; j > k; j--) above = (above + q->high[j]) * r;
    if ((below + above) * BOUND_ROOM < q->low[k]) return r;
    if (!(above < q->low[k])) break;
  }
  return INFINITY;
}

/* ---- discs ---- */

struct disc {
  struct complex_number z; /* a chart point */
  bool reversed;           /* whether z is 1/x */
  double radius;
  uint64_t members; /* as many values as the disc has roots, by their bits */
};

enum { NO_DISC = -1 };

_Static_assert(POLYNOMIAL_MAX_DEGREE <= 64, "a bit for each value");

struct judge {
  const struct evaluation *p;
  int count;
  struct root *root;
  int group[POLYNOMIAL_MAX_DEGREE]; /* the least index of a value joined with this one */
  int disc_of[POLYNOMIAL_MAX_DEGREE];
  int disc_count;
  struct disc disc[2 * POLYNOMIAL_MAX_DEGREE];
};

static struct complex_number value_of(const struct judge *judge, int i)
{
  return (struct complex_number){judge->root[i].re, judge->root[i].im};
}

/* The image of a disc in the other chart; false if it holds infinity. With s the square of radius over |z|, its centre is
 * 1 / (z (1 - s)). */
static bool disc_turn(struct disc *disc)
{
  const double size = hypot(disc->z.re, disc->z.im), ratio = disc->radius / size;
  const double room = (1.0 - ratio * ratio) * (2.0 - BOUND_ROOM);
  if (!(ratio < 1.0 && room > 0.0)) return false;
  disc->z = complex_divide((struct complex_number){1.0 / room, 0.0}, disc->z);
  disc->radius = (ratio / size / room + CHART_ROUNDING / (size * room)) * BOUND_ROOM;
  disc->reversed = !disc->reversed;
  return true;
}

static double distance(struct complex_number a, struct complex_number b)
{
  return complex_small_modulus(complex_subtract(a, b));
}

static bool discs_disjoint(struct disc a, struct disc b)
{
  if (a.reversed != b.reversed && !disc_turn(&a) && !disc_turn(&b)) return false;
  return distance(a.z, b.z) > (a.radius + b.radius) * BOUND_ROOM;
}

static bool disc_inside(struct disc a, struct disc b)
{
  if ((a.members & b.members) != a.members || (a.reversed != b.reversed && !disc_turn(&a))) return false;
  return (distance(a.z, b.z) + a.radius) * BOUND_ROOM <= b.radius;
}

static bool discs_agree(const struct disc *a, const struct disc *b)
{
  return discs_disjoint(*a, *b) || disc_inside(*a, *b) || disc_inside(*b, *a);
}

/* Seeks a disc for the values of the set. Returns its number, or NO_DISC. */
static int disc_make(struct judge *judge, uint64_t members)
{
  const struct evaluation *p = judge->p;
  struct taylor q;
  struct disc disc = {.members = members};
  int k = 0, reversed = 0;
  for (int i = 0; i < judge->count; i++)
    if (members >> i & 1) k++, reversed += is_reversed(p->basis, value_of(judge, i));
  disc.reversed = 2 * reversed > k;
  for (int i = 0; i < judge->count; i++)
    if (members >> i & 1)
      disc.z = complex_add(disc.z, complex_scale(1.0 / k, chart_of(p->basis, disc.reversed, value_of(judge, i)).z));
  if (k > 1) {
    taylor_make(p, disc.z, disc.reversed, &q);
    const struct complex_number value = {q.re[k - 1], q.im[k - 1]}, slope = {k * q.re[k], k * q.im[k]};
    const struct complex_number step = complex_divide(value, slope);
    if (isfinite(step.re) && isfinite(step.im)) disc.z = complex_subtract(disc.z, step);
  }
  taylor_make(p, disc.z, disc.reversed, &q);
  disc.radius = k_roots_within(p->degree, k, &q);
  if (disc.radius < INFINITY && disc.z.im != 0.0 && fabs(disc.z.im) <= disc.radius) {
    disc.z.im = 0.0;
    taylor_make(p, disc.z, disc.reversed, &q);
    disc.radius = k_roots_within(p->degree, k, &q);
  }
  if (!(disc.radius < INFINITY)) return NO_DISC;
  judge->disc[judge->disc_count] = disc;
  return judge->disc_count++;
}

/* The square of the distance of two values on the sphere of the numbers x, or u. */
static double sphere_distance(const struct judge *judge, int i, int j)
{
  const enum basis basis = judge->p->basis;
  const struct complex_number a = root_problem_x_from_u(basis, value_of(judge, i)),
                              b = root_problem_x_from_u(basis, value_of(judge, j));
  const double apart = distance(a, b) / (hypot(1.0, hypot(a.re, a.im)) * hypot(1.0, hypot(b.re, b.im)));
  return isnan(apart) ? INFINITY : apart;
}

/* Joins the groups of values i and j and seeks a disc for the values that have none, or one that reaches out of it. */
static void join(struct judge *judge, int i, int j)
{
  const int from = judge->group[i], to = judge->group[j];
  uint64_t members = 0;
  for (int k = 0; k < judge->count; k++) {
    if (judge->group[k] == from) judge->group[k] = to;
    if (judge->group[k] == to) members |= (uint64_t)1 << k;
  }
  const int made = disc_make(judge, members);
  for (int k = 0; made != NO_DISC && k < judge->count; k++)
    if ((members >> k & 1) &&
        (judge->disc_of[k] == NO_DISC || !disc_inside(judge->disc[judge->disc_of[k]], judge->disc[made])))
      judge->disc_of[k] = made;
}

/* Takes away two discs that meet, and joins their values. Returns whether there were any. */
static bool settle_conflict(struct judge *judge)
{
  for (int i = 0; i < judge->count; i++) {
    for (int j = 0; j < i; j++) {
      const int a = judge->disc_of[i], b = judge->disc_of[j];
      if (a == b || a == NO_DISC || b == NO_DISC || discs_agree(&judge->disc[a], &judge->disc[b])) continue;
      for (int k = 0; k < judge->count; k++)
        if (judge->disc_of[k] == a || judge->disc_of[k] == b) judge->disc_of[k] = NO_DISC;
      if (judge->group[i] != judge->group[j]) join(judge, i, j);
      return true;
    }
  }
  return false;
}

/* Joins a value without a disc with its nearest neighbour beyond its group. Returns whether there were such. */
static bool settle_lone(struct judge *judge)
{
  int lone = 0, nearest = -1;
  double least = INFINITY;
  while (lone < judge->count && judge->disc_of[lone] != NO_DISC) lone++;
  if (lone == judge->count) return false;
  for (int j = 0; j < judge->count; j++) {
    const double apart = judge->group[j] == judge->group[lone] ? INFINITY : sphere_distance(judge, lone, j);
    if (judge->group[j] != judge->group[lone] && (nearest < 0 || apart < least)) nearest = j, least = apart;
  }
  join(judge, lone, nearest < 0 ? lone : nearest);
  return nearest >= 0;
}

/* ---- values and their radii ---- */

static bool uses_disc(const struct judge *judge, int i, int d) { return i < judge->count && judge->disc_of[i] == d; }

/* A disc about a real point: its values become conjugate pairs where they nearly are, otherwise real. */
static void pair_within(struct judge *judge, int d)
{
  bool paired[POLYNOMIAL_MAX_DEGREE] = {false};
  for (int i = 0; i < judge->count; i++) {
    struct root *a = &judge->root[i], *best = NULL;
    int at = -1;
    if (!uses_disc(judge, i, d) || !(a->im > 0.0)) continue;
    for (int j = 0; j < judge->count; j++) {
      struct root *b = &judge->root[j];
      if (!uses_disc(judge, j, d) || paired[j] || !(b->im < 0.0)) continue;
      if (best == NULL || hypot(a->re - b->re, a->im + b->im) < hypot(a->re - best->re, a->im + best->im))
        best = b, at = j;
    }
    if (best == NULL || hypot(a->re - best->re, a->im + best->im) > fmin(a->im, -best->im)) continue;
    paired[i] = paired[at] = true;
    a->re = best->re = 0.5 * a->re + 0.5 * best->re;
    a->im = 0.5 * a->im - 0.5 * best->im;
    best->im = -a->im;
  }
  for (int i = 0; i < judge->count; i++)
    if (uses_disc(judge, i, d) && !paired[i]) judge->root[i].im = 0.0;
}

/* A disc above the real axis and the one whose roots are conjugate to its own: the values of that with the larger
 * radius become the conjugates of the other's. */
static void pair_across(struct judge *judge, int d)
{
  const struct disc *above = &judge->disc[d];
  struct disc mirrored = *above;
  mirrored.z.im = -mirrored.z.im;
  int below = NO_DISC;
  for (int i = 0; i < judge->count; i++) {
    const int other = judge->disc_of[i];
    if (other == NO_DISC || other == below || discs_disjoint(mirrored, judge->disc[other])) continue;
    if (below != NO_DISC || other == d) return;
    below = other;
  }
  if (below == NO_DISC) return;
  const int from = above->radius <= judge->disc[below].radius ? d : below, to = from == d ? below : d;
  int i = 0, j = 0, pairs = 0;
  for (int k = 0; k < judge->count; k++) pairs += uses_disc(judge, k, d) - uses_disc(judge, k, below);
  if (pairs != 0 || judge->disc[below].z.im * above->z.im >= 0.0 || above->reversed != judge->disc[below].reversed)
    return;
  const uint64_t members = judge->disc[to].members;
  judge->disc[to] = judge->disc[from];
  judge->disc[to].z.im = -judge->disc[to].z.im, judge->disc[to].members = members;
  for (;; i++, j++) {
    while (i < judge->count && !uses_disc(judge, i, from)) i++;
    while (j < judge->count && !uses_disc(judge, j, to)) j++;
    if (i == judge->count || j == judge->count) return;
    judge->root[j].re = judge->root[i].re, judge->root[j].im = -judge->root[i].im;
  }
}

static void set_radius(struct judge *judge, int i)
{
  struct root *root = &judge->root[i];
  double radius = INFINITY;
  if (judge->disc_of[i] != NO_DISC) {
    const struct disc *disc = &judge->disc[judge->disc_of[i]];
    const struct chart chart = chart_of(judge->p->basis, disc->reversed, value_of(judge, i));
    radius = radius_in_u(&chart, (distance(chart.z, disc->z) + disc->radius) * BOUND_ROOM + chart.rounding);
    const bool alone = (disc->members & (disc->members - 1)) == 0;
    if (!alone && root->status == ROOT_CONVERGED) root->status = ROOT_CLUSTER;
  }
  root->radius = fmax(root->radius, radius);
}

static void judge_all(const struct evaluation *p, int count, struct root root[])
{
  struct judge judge = {.p = p, .count = count, .root = root};
  for (int i = 0; i < count; i++) judge.group[i] = i, judge.disc_of[i] = disc_make(&judge, (uint64_t)1 << i);
  while (settle_conflict(&judge) || settle_lone(&judge)) continue;
  for (int d = 0; d < judge.disc_count; d++)
    if (judge.disc[d].z.im == 0.0) pair_within(&judge, d);
    else if (judge.disc[d].z.im > 0.0) pair_across(&judge, d);
  for (int i = 0; i < count; i++) set_radius(&judge, i);
}

/* Values for some of the roots only: each by itself. */
static void judge_each(const struct evaluation *p, int count, struct root root[])
{
  for (int i = 0; i < count; i++) {
    struct taylor q;
    const struct complex_number u = {root[i].re, root[i].im};
    const bool reversed = is_reversed(p->basis, u);
    const struct chart chart = chart_of(p->basis, reversed, u);
    taylor_make(p, chart.z, reversed, &q);
    root[i].radius = fmax(root[i].radius, radius_in_u(&chart, one_root_within(p->degree, &q) + chart.rounding));
  }
}

/* Marks discs that meet as clusters; of those from number `exact` on only where `each` was judged by itself. */
static void mark_clusters(struct root_set *roots, int exact, bool each)
{
  for (int i = 0; i < (each ? roots->count : exact); i++) {
    struct root *a = &roots->root[i];
    for (int j = i + 1; j < roots->count; j++) {
      struct root *b = &roots->root[j];
      const double dx = a->re - b->re, dy = a->im - b->im, reach = a->radius + b->radius;
      if (dx * dx + dy * dy <= reach * reach) {
        a->status = a->status == ROOT_CONVERGED ? ROOT_CLUSTER : a->status;
        b->status = b->status == ROOT_CONVERGED ? ROOT_CLUSTER : b->status;
      }
    }
  }
}

/* Whether p may have a root at infinity: its leading coefficient in powers of u, which in Bernstein form is the value
 * of q at x = -1, is not told from zero. */
static bool may_reach_infinity(const struct evaluation *p)
{
  const bool power = p->basis == BASIS_POWER;
  const struct evaluation_real at = evaluation_at_real(p, power ? 0.0 : -1.0, power);
  return fabs(at.value) <= at.error;
}

void validation_judge(const struct evaluation *p, bool all_sought, int exact, struct root_set *roots)
{
  (all_sought ? judge_all : judge_each)(p, roots->count - exact, roots->root + exact);
  bool infinite = false, asked = false;
  int kept = exact;
  for (int i = exact; i < roots->count; i++) {
    struct root *root = &roots->root[i];
    if (!(root->radius < INFINITY)) {
      infinite = asked ? infinite : may_reach_infinity(p);
      asked = true;
      if (infinite && hypot(root->re - 0.5, root->im) > 1.0 && root->status != ROOT_LIMIT)
        continue; /* a candidate for [0,1] is kept in any case */
      root->status = ROOT_LIMIT;
    }
    roots->root[kept++] = *root;
  }
  roots->count = kept;
  mark_clusters(roots, exact, !all_sought);
}

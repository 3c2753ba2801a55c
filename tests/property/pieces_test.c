/* Rays through a point of a patch that is known exactly: whatever part holds it, however small, is not said to be
 * without a root, nor is the root outside of what is left of the part, nor elsewhere along the ray. Control points are
 * whole and parameters sixteenths, so points, derivatives and rays are exact in doubles. */
#include <math.h>
#include <stdlib.h>

#include "base/real.h"
#include "cmocka_test.h"
#include "geometry/edges.h"
#include "intersect/exact/sight.h"
#include "random.h"

enum { SEED = 20261129, CASES = 4000, CUTS = 6, OF = 16, POOL = 1 << 16 };

static const double t_of_root = 0.5;

struct subject {
  double P[4][4][3], point[3], du[3], dv[3];
  int at[2], other[2]; /* u and v, times OF, and those of another root; `at` again if none is known */
  struct ray ray;
};

static struct pool pool;
static int roots, empties, boxes, exchanged;
static double worst_value, worst_depth, worst_root;

/* The Bernstein polynomials of degree 3 at k / OF, times OF^3, and their derivatives, times OF^2 / 3. */
static void basis(int k, double value[4], double slope[4])
{
  const double s = OF - k, t = k;
  value[0] = s * s * s, value[1] = 3 * s * s * t, value[2] = 3 * s * t * t, value[3] = t * t * t;
  slope[0] = -s * s, slope[1] = s * s - 2 * s * t, slope[2] = 2 * s * t - t * t, slope[3] = t * t;
}

static void evaluate(struct subject *s)
{
  double u[4], v[4], du[4], dv[4];
  basis(s->at[0], u, du), basis(s->at[1], v, dv);
  for (int c = 0; c < 3; c++) {
    s->point[c] = s->du[c] = s->dv[c] = 0;
    for (int n = 0; n < 16; n++) {
      const double x = s->P[n / 4][n % 4][c];
      s->point[c] += x * u[n / 4] * v[n % 4] * 0x1p-24;
      s->du[c] += x * du[n / 4] * v[n % 4] * 0x1p-20, s->dv[c] += x * u[n / 4] * dv[n % 4] * 0x1p-20;
    }
  }
}

static void ray_along(struct subject *s, const double direction[3])
{
  s->ray.t_max = INFINITY;
  for (int c = 0; c < 3; c++) {
    s->ray.direction[c] = direction[c], s->ray.origin[c] = s->point[c] - t_of_root * direction[c];
    assert_true(s->ray.origin[c] + t_of_root * direction[c] == s->point[c]);
  }
}

/* A bent patch, sometimes with a border that is a point, or whose handles have no length, or that is straight and in one
 * plane with the ray; the ray is sometimes tangent, or goes through a second point. */
static void make_subject(struct random *random, struct subject *s)
{
  const int kind = (int)(random_bits(random) % 6), border = (int)(random_bits(random) % 4);
  double direction[3];
  for (int n = 0; n < 16; n++) {
    const double base[3] = {60 * (n / 4), 60 * (n % 4), 0};
    for (int c = 0; c < 3; c++) s->P[n / 4][n % 4][c] = base[c] + (double)(random_bits(random) % 97) - 48;
  }
  const double *first = s->P[edge_at(border, 0) / 4][edge_at(border, 0) % 4];
  for (int k = 1; k < 4; k++) {
    double *to = s->P[edge_at(border, k) / 4][edge_at(border, k) % 4];
    const double *from = k == 1 ? first : s->P[edge_at(border, 3) / 4][edge_at(border, 3) % 4];
    for (int c = 0; c < 3; c++) {
      if (kind == 1) to[c] = first[c];
      if (kind == 2 && k < 3) to[c] = from[c];
      if (kind == 3) to[c] = first[c] + k * (c == border / 2 ? 7 : 50);
    }
  }
  for (int k = 0; k < 2; k++) s->other[k] = s->at[k] = (int)(random_bits(random) % (OF + 1));
  evaluate(s);
  double second[3];
  memcpy(second, s->point, sizeof second);
  if (kind == 5) {
    for (int k = 0; k < 2; k++) s->at[k] = (int)(random_bits(random) % (OF + 1));
    evaluate(s);
  }
  const double a = (double)(random_bits(random) % 7) - 3, b = (double)(random_bits(random) % 3) + 1;
  for (int c = 0; c < 3; c++) {
    direction[c] = (double)(random_bits(random) % 9) - 4;
    if (kind == 1 || kind == 3) direction[c] = first[c] - s->point[c];
    if (kind == 4) direction[c] = a * s->du[c] + b * s->dv[c];
    if (kind == 5) direction[c] = second[c] - s->point[c];
  }
  if (direction[0] == 0 && direction[1] == 0 && direction[2] == 0) direction[2] = 1;
  ray_along(s, direction);
}

/* Its doubles are within their errors of an exact copy's, which may be scaled otherwise. */
static void check_values(const struct piece *piece, const struct piece *exact)
{
  for (int k = 0; k < 2; k++) {
    double most[2] = {0, 0};
    for (int n = 0; n < 16; n++) {
      most[0] = real_max(most[0], fabs(piece->value[k][n / 4][n % 4]));
      most[1] = real_max(most[1], fabs(exact->value[k][n / 4][n % 4]));
    }
    if (most[1] == 0 || most[0] <= 4 * piece->error[k]) continue;
    const double scale = exp2(round(log2(most[1] / most[0])));
    for (int n = 0; n < 16; n++) {
      const double off = fabs(scale * piece->value[k][n / 4][n % 4] - exact->value[k][n / 4][n % 4]);
      worst_value = real_max(worst_value, off / (scale * piece->error[k] + exact->error[k]));
    }
  }
}

static void check_piece(const struct subject *s, const struct sight *sight, struct piece *piece, const double local[2])
{
  struct piece exact = *piece;
  struct piece_root root;
  double least, most, error;
  bool known;
  assert_false(piece_misses(piece));
  piece_depths(piece, &least, &most);
  assert_true(least <= t_of_root * sight->along && t_of_root * sight->along <= most);
  assert_true(piece_exact(&exact, &pool));
  assert_false(piece_misses(&exact));
  check_values(piece, &exact);
  const enum piece_verdict verdict = piece_root(piece, false, &pool, &root);
  assert_int_not_equal(verdict, PIECE_EMPTY);
  boxes += verdict == PIECE_OPEN && root.box[0][1] - root.box[0][0] < 0.5;
  for (int k = 0; k < 2 && verdict == PIECE_OPEN; k++)
    assert_true(root.box[k][0] <= local[k] && local[k] <= root.box[k][1]);
  if (verdict != PIECE_ROOT) return;
  roots++;
  bool within = s->other[0] != s->at[0] || s->other[1] != s->at[1];
  for (int k = 0; k < 2; k++) {
    const double place = (double)(((wide)s->other[k] / OF - piece->low[k]) / piece->size[k]);
    within = within && place > -PIECE_MARGIN && place < 1 + PIECE_MARGIN;
  }
  assert_false(within); /* it is the only one there */
  for (int k = 0; k < 2; k++) worst_root = real_max(worst_root, (fabs(root.at[k] - local[k]) - 0x1p-52) / root.radius);
  const double w = (double)(piece_depth(&exact, root.at, root.radius, &error, &known) - (wide)t_of_root * sight->along);
  if (error > 0) worst_depth = real_max(worst_depth, fabs(w) / error);
  else assert_true(w == 0);
}

/* A part of the piece that holds the place. */
static bool cut_about(struct random *random, const int at[2], struct piece *piece, double local[2])
{
  struct piece part = *piece;
  for (int axis = 0; axis < 2; axis++) {
    const int log2 = 1 + (int)(random_bits(random) % 8);
    const wide here = ((wide)at[axis] / OF - part.low[axis]) / part.size[axis];
    const double cells = ldexp(1, log2), cell = real_min(floor((double)here * cells), cells - 1);
    const double from = real_max(cell - (double)(random_bits(random) % 3), 0);
    const double to = real_min(cell + 1 + (double)(random_bits(random) % 3), cells);
    if (random_bits(random) % 4 == 0) continue;
    if (!piece_part(&part, axis, (limb)from, (limb)to, log2, &pool, &part)) return false;
  }
  *piece = part;
  for (int k = 0; k < 2; k++) local[k] = (double)(((wide)at[k] / OF - part.low[k]) / part.size[k]);
  return true;
}

/* Pieces beside the root are without one if they are far enough from all others: those say so that are small. */
static void check_beside(const struct piece *whole, const int at[2])
{
  struct piece half = *whole, part;
  struct piece_root root;
  const limb cell[2] = {(limb)(at[0] % OF) << 16, (limb)(at[1] % OF) << 16};
  if (!piece_part(&half, 0, cell[0] + 1, cell[0] + 2, 20, &pool, &half) ||
      !piece_part(&half, 1, cell[1] + 1, cell[1] + 2, 20, &pool, &part))
    return;
  empties += piece_misses(&part) || piece_root(&part, false, &pool, &root) == PIECE_EMPTY;
}

TEST(a_root_is_in_every_piece_that_holds_it)
{
  struct random random = {SEED};
  limb *room = malloc(POOL * sizeof *room);
  assert_non_null(room);
  for (int n = 0; n < CASES; n++) {
    struct subject s;
    struct sight sight;
    make_subject(&random, &s);
    pool = (struct pool){room, POOL, 0, 1 << 20};
    assert_true(sight_make(s.P, &s.ray, &pool, &sight));
    bool on = sight.dependent;
    for (int k = 0; k < 4; k++) {
      const int border = k < sight.borders ? sight.border[k] : -1;
      on |= border >= 0 && s.at[border / 2] == (border & 1 ? OF : 0);
      on |= (sight.met >> k & 1) && s.at[k / 2] == (k & 1 ? OF : 0);
    }
    exchanged += !on && (sight.borders > 0 || sight.met);
    const size_t before = pool.used;
    for (int off = 0; off < (on ? 1 : 2); off++) {
      struct piece piece = off ? sight.off : sight.plane;
      double local[2] = {(double)s.at[0] / OF, (double)s.at[1] / OF};
      check_beside(&piece, s.at);
      for (int k = 0; k < CUTS; k++) {
        check_piece(&s, &sight, &piece, local);
        if (!cut_about(&random, s.at, &piece, local)) break;
      }
      pool.used = before;
    }
  }
  free(room);
  print_message("%d roots, %d boxes, %d empty, %d exchanged; of their bounds: values %.2g, depths %.2g, roots %.2g\n",
                roots, boxes, empties, exchanged, worst_value, worst_depth, worst_root);
  assert_true(worst_value <= 1 && worst_depth <= 1 && worst_root <= 1);
  assert_true(roots > CASES && exchanged > CASES / 8);
  assert_true(boxes > 2 * CASES && empties > CASES); /* pieces next to tangencies are cut, those beside roots dropped */
}

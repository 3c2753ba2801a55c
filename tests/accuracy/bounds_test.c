/* The bounds of the exact search (piece.h), each against exact arithmetic. Inputs are those that come nearest to a bound:
 * coefficients of alternating sign at the margin, numbers just below powers of two, sums that nearly cancel. The files
 * under test are part of this one, so that their steps are tested alone. */
#include <arf.h>
#include <flint/fmpz.h>

#include "cmocka_test.h"
#include "intersect/exact/piece.c"
#include "intersect/exact/root.c"
#include "intersect/exact/sight.c"
#include "random.h"

enum { SEED = 20261130, CASES = 1500, POOL = 1 << 15 };

typedef arf_t dyadic_net[16]; /* coefficient 4 i + j; static numbers are 0 */

static struct random random_numbers = {SEED};
static limb room[POOL];
static struct pool pool;
static fmpz integer[NETS][16];      /* the whole's coefficients */
static dyadic_net exact[NETS], net; /* the piece's polynomials over it; another one */
static arf_t zero, x, y;
static fmpz z;

static int below(int n) { return (int)(random_bits(&random_numbers) % (uint64_t)n); }
static int sign(void) { return 1 - 2 * below(2); }
static double unit(void) { return random_unit(&random_numbers); }

/* ---- numbers without roundings ---- */

static void subtract(arf_t a, const arf_t b) { arf_sub(a, a, b, ARF_PREC_EXACT, ARF_RND_NEAR); }
static void multiply(arf_t out, const arf_t a, const arf_t b) { arf_mul(out, a, b, ARF_PREC_EXACT, ARF_RND_NEAR); }
static void times(arf_t a, ulong b) { arf_mul_ui(a, a, b, ARF_PREC_EXACT, ARF_RND_NEAR); }

/* a += t (b - a) */
static void approach(arf_t a, const arf_t b, double t)
{
  static arf_t off, weight;
  arf_set(off, b), subtract(off, a), arf_set_d(weight, t), arf_addmul(a, off, weight, ARF_PREC_EXACT, ARF_RND_NEAR);
}

/* The blossom: the value, if all u are one number and all v are. */
static void blossom(arf_t out, dyadic_net of, const double u[3], const double v[3])
{
  static dyadic_net step;
  for (int c = 0; c < 16; c++) arf_set(step[c], of[c]);
  for (int n = 0; n < 3; n++)
    for (int c = 0; c < 4 * (3 - n); c++) approach(step[c], step[c + 4], u[n]);
  for (int n = 0; n < 3; n++)
    for (int c = 0; c < 3 - n; c++) approach(step[c], step[c + 1], v[n]);
  arf_set(out, step[0]);
}

static void net_value(arf_t out, dyadic_net of, double u, double v)
{
  blossom(out, of, (double[]){u, u, u}, (double[]){v, v, v});
}

/* The derivative by u (axis 0) or v. */
static void net_slope(arf_t out, dyadic_net of, int axis, double u, double v)
{
  static arf_t low;
  blossom(out, of, (double[]){axis ? u : 1, u, u}, (double[]){axis ? 1 : v, v, v});
  blossom(low, of, (double[]){axis ? u : 0, u, u}, (double[]){axis ? 0 : v, v, v});
  subtract(out, low), times(out, 3);
}

/* The same polynomial over [ends[0], ends[1]] along an axis. */
static void net_cut(dyadic_net of, int axis, const double ends[2])
{
  static const double all[2] = {0, 1};
  static dyadic_net part;
  const double *u = axis ? all : ends, *v = axis ? ends : all;
  for (int c = 0; c < 16; c++) {
    const int i = c / 4, j = c % 4;
    blossom(part[c], of, (double[]){u[i > 0], u[i > 1], u[i > 2]}, (double[]){v[j > 0], v[j > 1], v[j > 2]});
  }
  for (int c = 0; c < 16; c++) arf_swap(of[c], part[c]);
}

/* a 2^-exponent less b, rounded. */
static double off_by(const arf_t a, int exponent, double b)
{
  static arf_t off, to;
  arf_mul_2exp_si(off, a, -exponent), arf_set_d(to, b), subtract(off, to);
  return arf_get_d(off, ARF_RND_NEAR);
}

/* All digits of a number of wide arithmetic. */
static void set_wide(arf_t out, wide a)
{
  static arf_t part;
  slong exponent = 0;
  for (arf_zero(out); a != 0 && wide_abs(a) < 0x1p-900; exponent -= 900) a *= 0x1p900;
  for (int n = 0; n < 3; n++, a -= (double)a)
    arf_set_d(part, (double)a), arf_add(out, out, part, ARF_PREC_EXACT, ARF_RND_NEAR);
  arf_mul_2exp_si(out, out, exponent);
}

/* The power of two that an exact net has over the same net in doubles; false if that has too few digits. */
static bool net_scale(dyadic_net of, const double value[4][4], double error, int *scale)
{
  double most[2] = {0, 0};
  for (int c = 0; c < 16; c++) {
    most[0] = real_max(most[0], fabs(off_by(of[c], 0, 0)));
    most[1] = real_max(most[1], fabs(value[c / 4][c % 4]));
  }
  if (most[0] == 0 || most[1] <= 4 * error) return false;
  *scale = (int)lrint(log2(most[0]) - log2(most[1]));
  return true;
}

/* The net of (1 - 2u)^3 (1 - 2v)^3, which outside of the square is as large as its coefficients allow. */
static int alternating(int c) { return (c / 4 + c % 4) % 2 ? -1 : 1; }

/* ---- pieces ---- */

enum style { DIGITS, WORDS, SIZES, RAMP, NEAR, WAVES, CLIFF, START, EQUAL, STYLES };

/* A random integer of some style, of coefficient c of a net; a ramp rises `steep` along u and 3 - steep along v. */
static void random_integer(fmpz_t out, enum style style, int c, int bits, int steep)
{
  static fmpz_t step;
  const int own = style == DIGITS ? 4 : style == SIZES ? 1 + below(bits) : style == RAMP ? bits - 4 - below(4) : bits;
  fmpz_zero(out), fmpz_one_2exp(step, bits > 2 ? (ulong)bits - 2 : 0);
  for (int k = 0; k < own; k += 32)
    fmpz_mul_2exp(out, out, 32), fmpz_add_ui(out, out, random_bits(&random_numbers) >> 32);
  fmpz_fdiv_r_2exp(out, out, (ulong)own), fmpz_mul_si(out, out, sign());
  if (style == RAMP) fmpz_addmul_si(out, step, steep * (c / 4) + (3 - steep) * (c % 4) - 4);
  if (style == NEAR || style == WAVES || style == CLIFF) /* just below a power of two, where roundings are largest */
    fmpz_fdiv_q_2exp(out, out, 5), fmpz_abs(out, out), fmpz_submul_ui(out, step, 4);
  if (style == WAVES) fmpz_mul_si(out, out, alternating(c));
  if (style == NEAR && bits % 2) fmpz_neg(out, out);
  if (style == CLIFF && (steep == 2 ? c / 4 : c % 4) < 2) fmpz_neg(out, out);
}

/* The piece of these integers, with exponents of 0, and its exact polynomials. */
static struct piece make_piece(void)
{
  struct piece piece = {.length = {1, 1}, .size = {1, 1}, .borders = 15};
  pool = (struct pool){room, POOL, 0, INT64_MAX};
  for (int k = 0; k < NETS; k++) {
    int limbs = 1;
    for (int c = 0; c < 16; c++) limbs = (int)real_max(limbs, limbs_for((int)fmpz_bits(&integer[k][c])));
    piece.net[k] = pool_net(&pool, limbs), piece.limbs[k] = limbs;
    for (int c = 0; c < 16; c++) {
      arf_set_fmpz(exact[k][c], &integer[k][c]);
      fmpz_get_signed_ui_array(piece.net[k] + c * limbs, limbs, &integer[k][c]);
    }
  }
  piece_measure(&piece);
  return piece;
}

static void set_integers(int k, enum style style, int bits)
{
  const int start = bits + 40 + below(80);
  for (int c = 0; c < 16; c++) {
    fmpz *to = &integer[k][c];
    random_integer(to, style, c, bits, 1 + (k != NET_B));
    if (style == START) fmpz_setbit(to, (ulong)start);
    if (style == EQUAL) fmpz_set(to, &integer[k][0]);
    if (style == DIGITS && bits % 10 == 0) fmpz_set_si(to, -below(2));
    if (k == NET_W && c == 0 && style == WAVES) fmpz_zero(to); /* w is taken from its first coefficient */
    if (k == NET_W && c == 0 && style == NEAR) fmpz_fdiv_q_2exp(to, to, 4);
    if (k == NET_W && c > 0 && style == NEAR) fmpz_add(to, to, &integer[k][0]);
    if (k == NET_B && bits % 4 == 0) fmpz_addmul_si(to, &integer[0][c], 12345678); /* nearly a multiple */
  }
}

/* An exact piece of random nets. */
static struct piece random_piece(void)
{
  const int corner = 12 * below(2) + 3 * below(2);
  for (int k = 0; k < NETS; k++) {
    set_integers(k, (enum style)below(k == NET_W ? STYLES : START), (below(3) ? 50 : 150) + below(30));
    if (k != NET_W && below(3) == 0) fmpz_set_si(&integer[k][corner], below(2) * sign());
  }
  return make_piece();
}

/* Cuts the piece, if there is room; so are the exact polynomials. */
static bool cut_piece(struct piece *piece)
{
  const int axis = below(2), log2 = 1 + below(below(4) ? 4 : 40);
  const limb cells = (limb)1 << log2, most = below(2) ? 1 : cells < 1 << 16 ? cells : 1 << 16;
  const limb length = 1 + random_bits(&random_numbers) % most, last = cells - length;
  const limb from = below(2) ? random_bits(&random_numbers) % (last + 1) : (limb)below(2) * last;
  const double ends[2] = {ldexp((double)from, -log2), ldexp((double)(from + length), -log2)};
  for (int k = 0; k < NETS; k++) net_cut(exact[k], axis, ends);
  return piece_part(piece, axis, from, from + length, log2, &pool, piece);
}

/* Doubles are within their error of an exact net less `start`. */
static void assert_within(const double value[4][4], double error, dyadic_net of, int scale, const arf_t start)
{
  for (int c = 0; c < 16; c++)
    arf_set(x, of[c]), subtract(x, start), assert_true(fabs(off_by(x, scale, value[c / 4][c % 4])) <= error);
}

/* What coefficient c of the integers of net k is. */
static void get_integer(arf_t out, const struct piece *piece, int k, int c)
{
  fmpz_set_signed_ui_array(&z, piece->net[k] + c * piece->limbs[k], piece->limbs[k]);
  arf_set_fmpz(out, &z), arf_mul_2exp_si(out, out, piece->exponent[k]);
  assert_true(fmpz_is_zero(&z) || arf_cmpabs_2exp_si(out, piece->bits[k] + piece->exponent[k]) <= 0);
}

static bool keeps_sign(dyadic_net of)
{
  int signs = 0;
  for (int c = 0; c < 16; c++) signs += arf_sgn(of[c]);
  return abs(signs) == 16;
}

/* After chains of cuts doubles are within their errors, and so are bounds of w. An exact copy is exact. */
TEST(parts_are_within_their_errors)
{
  static arf_t start;
  double least, most;
  for (int n = 0; n < CASES; n++) {
    struct piece piece = random_piece();
    for (int cuts = 0; cuts < 6; cuts++) {
      struct piece copy = piece;
      const size_t before = pool.used;
      get_integer(start, &piece, NET_W, 0);
      for (int k = 0; k < NETS; k++) {
        int scale = piece.scale;
        if (k == NET_W || net_scale(exact[k], piece.value[k], piece.error[k], &scale))
          assert_within(piece.value[k], piece.error[k], exact[k], scale, k == NET_W ? start : zero);
      }
      for (int c = 0; c < 32 && piece_is_exact(&piece); c++) {
        const double value = piece.value[c / 16][c % 16 / 4][c % 4];
        const int here = arf_sgn(exact[c / 16][c % 16]);
        assert_true((value < 0) == (here < 0) && (here > 0 || value <= 0));
      }
      piece_depths(&piece, &least, &most);
      for (int c = 0; c < 16; c++)
        assert_true(arf_cmp_d(exact[NET_W][c], least) >= 0 && arf_cmp_d(exact[NET_W][c], most) <= 0);
      assert_false(piece_misses(&piece) && !keeps_sign(exact[0]) && !keeps_sign(exact[1]));
      if (!piece_exact(&copy, &pool)) break;
      for (int c = 0; c < NETS * 16; c++)
        get_integer(x, &copy, c / 16, c % 16), assert_true(arf_equal(x, exact[c / 16][c % 16]));
      for (int c = 0; c < 4; c++) {
        struct piece other = piece;
        const int at = 12 * (c / 2) + 3 * (c % 2), zeros = arf_is_zero(exact[0][at]) && arf_is_zero(exact[1][at]);
        assert_int_equal(piece_corner_root(&other, c / 2, c % 2, &pool), zeros);
      }
      if (below(4)) pool.used = before;
      else piece = copy;
      if (!cut_piece(&piece)) break;
    }
  }
}

/* w at a place is within its error of w wherever the root can be. Of some w the first coefficient loses nearly four
 * roundings to wide arithmetic, and the sum one more. */
TEST(depths_are_within_their_errors)
{
  int equal = 0, rounded = 0;
  for (int n = 0; n < 8 * CASES; n++) {
    struct piece piece = random_piece();
    const double radius = below(2) ? 0 : ldexp(PIECE_MARGIN / 2, -below(n % 2 ? 3 : 60));
    double at[2], to[2], error;
    bool known;
    for (int c = 0; c < 16 && n % 100 == 0; c++) {
      fmpz *w = &integer[NET_W][c]; /* 2^200 + 2^89 - 1, and 2^87 - 2^40 more */
      fmpz_set_ui(w, ((ulong)1 << 49) + (c ? ((ulong)1 << 47) - 1 : 0)), fmpz_mul_2exp(w, w, 40);
      fmpz_sub_ui(w, w, 1), fmpz_setbit(w, 200);
    }
    if (n % 100 == 0) piece = make_piece();
    for (int k = 0; k < 2; k++) {
      const double end = below(2) ? 1 + PIECE_MARGIN : -PIECE_MARGIN;
      at[k] = below(2) ? end - (end > 0 ? radius : -radius) : unit(), to[k] = at[k] + (at[k] > 0.5 ? radius : -radius);
    }
    const wide w = piece_depth(&piece, at, radius, &error, &known);
    set_wide(x, w), net_value(y, exact[NET_W], to[0], to[1]), subtract(y, x);
    const double off = off_by(y, 0, 0);
    if (error > 0) assert_true(fabs(off) <= error);
    else if (known) assert_true(off == 0), equal++;
    else assert_true(off > 0 && off < 4 * WIDE_ROUNDOFF * wide_abs(w)), rounded++;
  }
  assert_true(equal > 0 && rounded > 0);
}

/* ---- rows ---- */

/* Sets `net` to the exact row d, by the weights that it was made with, times the power of two by which doubles differ. */
static bool exact_row(const struct piece *piece, const struct slopes *slopes, int d, struct row *row)
{
  static arf_t p[2];
  int scale[2] = {0, 0};
  bool known = true;
  for (int k = 0; k < 2; k++) {
    if (slopes->limbs[0] > 0) {
      fmpz_set_signed_ui_array(&z, slopes->exact[k][1 - d], slopes->limbs[k]);
      arf_set_fmpz(p[k], &z), arf_mul_2exp_si(p[k], p[k], piece->exponent[k]), arf_set(y, p[k]), times(y, 3);
      net_slope(x, exact[k], 1 - d, 0.5, 0.5), times(x, 32), assert_true(arf_equal(x, y)); /* times 32/3 */
    } else {
      arf_set_d(p[k], slopes->value[k][1 - d]);
      known = known && net_scale(exact[k], piece->value[k], piece->error[k], &scale[k]);
    }
  }
  for (int c = 0; c < 16; c++) {
    multiply(net[c], p[1], exact[0][c]), arf_mul_2exp_si(net[c], net[c], -scale[0]);
    multiply(x, p[0], exact[1][c]), arf_mul_2exp_si(x, x, -scale[1]), subtract(net[c], x);
  }
  if (slopes->limbs[0] == 0) return known;
  if (!net_scale(net, row->net, row->error, &scale[0])) return false;
  for (int c = 0; c < 16; c++) arf_mul_2exp_si(net[c], net[c], -scale[0]);
  return true;
}

/* By how much the derivatives of the exact row k differ from `along` and 0: a bound on the sum for both parameters. */
static double exact_turning(int k, double along)
{
  double most[2] = {0, 0};
  for (int c = 0; c < 24; c++) {
    const int axis = c % 2, at = cubic_at(axis, c / 2 % 4, c / 8), next = cubic_at(axis, c / 2 % 4, c / 8 + 1);
    arf_set(x, net[next]), subtract(x, net[at]), times(x, 3);
    most[axis] = real_max(most[axis], fabs(off_by(x, 0, axis == k ? along : 0)));
  }
  return most[0] + most[1];
}

/* Rows are within their errors. A row is said to keep its sign only if its coefficients do. The contraction bounds what
 * the rows' derivatives differ by from the identity. */
TEST(rows_are_within_their_errors)
{
  static struct slopes slopes;
  double along[2], contraction;
  int signs = 0;
  struct row row[2];
  for (int n = 0; n < 4 * CASES; n++) {
    struct piece piece = random_piece();
    const int d = below(2);
    if (below(2) && !cut_piece(&piece)) continue;
    slopes.limbs[0] = 0;
    for (int k = 0; k < 2; k++) slopes.value[k][1] = sign() * (1 + ldexp(unit(), -below(9)));
    combine_row(&piece, &slopes, 0, &row[0]);
    if (exact_row(&piece, &slopes, 0, &row[0])) assert_within(row[0].net, row[0].error, net, 0, zero);
    slopes_round(&piece, &slopes);
    const bool one_sign = make_row(&piece, &slopes, d, ldexp(1, -below(50)), &pool, &row[0]);
    signs += one_sign;
    if (exact_row(&piece, &slopes, d, &row[0])) {
      assert_within(row[0].net, row[0].error, net, 0, zero);
      assert_true(!one_sign || (keeps_sign(net) && arf_sgn(net[0]) == (row[0].net[0][0] > 0 ? 1 : -1)));
    }
    (void)make_rows(&piece, &pool, true, ROW_BITS, &slopes, row, along, &contraction);
    for (int k = 0; k < 2; k++) {
      slopes.limbs[0] = row[k].error == PIECE_ERROR ? slopes.limbs[1] : 0;
      if (contraction < 1 && exact_row(&piece, &slopes, k, &row[k]))
        assert_true(PIECE_GROWTH * exact_turning(k, along[k]) / fabs(along[k]) <= contraction * (1 + 0x1p-50));
    }
  }
  assert_true(signs > CASES / 4);
}

/* On the margin derivatives grow as much as they can. Two squares have no slopes in their root. */
TEST(rows_contract_on_the_margin)
{
  static struct slopes slopes;
  double along[2], contraction;
  struct row row[2];
  struct piece_root root;
  for (int n = 0; n <= 200; n++) {
    const int by[2] = {below(60) - 30, below(60) - 30};
    for (int c = 0; c < NETS * 16; c++) {
      const int k = c / 16, at = k ? c % 4 : c / 4 % 4;
      const int squares = at % 3 ? -1 : 1, bent = 100 * at + by[k & 1] * alternating(c % 16);
      fmpz_set_si(&integer[k][c % 16], n == 0 ? squares : bent);
    }
    struct piece piece = make_piece();
    if (n == 0) {
      assert_int_equal(piece_root(&piece, false, &pool, &root), PIECE_OPEN);
      assert_true(root.box[0][0] <= 0.5 && root.box[0][1] >= 0.5);
      continue;
    }
    (void)make_rows(&piece, &pool, true, ROW_BITS, &slopes, row, along, &contraction);
    for (int c = 0; c < 8; c++) {
      const double u = c / 4 ? 1 + PIECE_MARGIN : -PIECE_MARGIN, v = c / 2 % 2 ? 1 + PIECE_MARGIN : -PIECE_MARGIN;
      double turn = 0;
      for (int axis = 0; axis < 2; axis++)
        net_slope(x, exact[c % 2], axis, u, v), turn += fabs(off_by(x, 0, axis == c % 2 ? 300 : 0)) / 300;
      assert_true(turn <= contraction);
    }
  }
}

/* The radius of a root is at least what Banach's theorem asks for: of all polynomials within the rows' errors. */
TEST(radii_are_large_enough)
{
  struct row row[2];
  struct piece_root root;
  for (int n = 0; n < 4 * CASES; n++) {
    const double contraction = below(2) ? 0.9 * unit() : 0, along[2] = {1 - below(2) * 0.5, -1 - below(2) * 0.5};
    for (int k = 0; k < 2; k++) {
      const double end = below(2) ? 1 + PIECE_MARGIN : -PIECE_MARGIN, to = below(2) ? 1.5 * unit() - 0.25 : end;
      const double bend = below(2) ? 0.1 * unit() : 0;
      row[k].error = below(2) ? ldexp(unit(), -below(60)) : 0;
      for (int c = 0; c < 16; c++)
        row[k].net[c / 4][c % 4] = along[k] * ((k ? c % 4 : c / 4) / 3.0 - to) + bend * unit();
    }
    newton(row, along, contraction, &root);
    for (int k = 0; k < 4; k++) {
      for (int c = 0; c < 16; c++) {
        arf_set_d(net[c], row[k % 2].net[c / 4][c % 4]);
        arf_set_d(x, (k / 2 ? -1 : 1) * alternating(c) * row[k % 2].error), subtract(net[c], x);
      }
      net_value(x, net, root.at[0], root.at[1]);
      assert_true(fabs(off_by(x, 0, 0) / along[k % 2]) / (1 - contraction) <= root.radius);
    }
  }
}

/* A root beside its piece, beyond its radius, is none of it. */
TEST(roots_are_in_their_piece)
{
  struct piece_root root;
  for (int n = 0; n < 8 * CASES; n++) {
    for (int k = 0; k < 2; k++) {
      const int64_t by = (int64_t)(below(2000) - 1000) * ((int64_t)1 << 50);
      set_integers(k, RAMP, 59);
      for (int c = 0; c < 16; c++) fmpz_add_si(&integer[k][c], &integer[k][c], by);
    }
    struct piece piece = make_piece();
    const bool one = piece_root(&piece, false, &pool, &root) == PIECE_ROOT;
    for (int k = 0; k < 2 && one; k++) assert_true(root.at[k] >= -root.radius && root.at[k] <= 1 + root.radius);
  }
}

/* ---- turns and tangents ---- */

/* Where w turns along a curve on which a (or b) is zero, the Jacobian is singular: it has not one sign everywhere. */
TEST(depths_turn_only_where_that_is_not_denied)
{
  int steady[2] = {0, 0};
  for (int n = 0; n < 2 * CASES; n++) {
    const bool flat = below(4) == 0, ramp = below(2);
    const int like = below(8) == 0 ? flat : flat ? NET_W : NET_B; /* w is like a, or b */
    int signs = 0;
    (void)random_piece();
    for (int k = 0; k < NETS; k++)
      if (ramp || flat) set_integers(k, RAMP, 62);
    for (int c = 0; c < 16; c++) {
      if (flat) fmpz_zero(&integer[NET_A][c]);
      fmpz_set(&integer[NET_W][c], &integer[like][c]);
    }
    struct piece piece = make_piece();
    if (n % 4 == 0) pool.room = pool.used;
    if (!piece_depth_turns(&piece, &pool)) continue;
    for (int c = 0; c < 9; c++) {
      double d[4];
      for (int k = 0; k < 4; k++)
        net_slope(x, exact[k < 2 ? flat : NET_W], k % 2, c / 3 / 2.0, c % 3 / 2.0), d[k] = off_by(x, 0, 0);
      signs += (d[0] * d[3] > d[1] * d[2]) - (d[0] * d[3] < d[1] * d[2]);
    }
    assert_int_equal(abs(signs), 9);
    steady[flat]++;
  }
  assert_true(steady[0] > CASES / 8 && steady[1] > CASES / 8);
}

/* Makes `net` zero at a place and rounds it and what it is shifted by; returns how far that is from it. */
static double zero_at(const double to[2], double shift, double out[4][4])
{
  double error = 0;
  net_value(y, net, to[0], to[1]);
  for (int c = 0; c < 16; c++) {
    subtract(net[c], y), out[c / 4][c % 4] = arf_get_d(net[c], ARF_RND_NEAR) + shift;
    error = real_max(error, fabs(off_by(net[c], 0, out[c / 4][c % 4])));
  }
  return error;
}

/* Often 0, or a number of any size below 1. */
static double any_size(int bits) { return below(2) ? sign() * ldexp(unit(), -below(bits)) : 0; }

/* A zero of both is in the box, wherever it is and whichever polynomials within the errors have it. */
TEST(zeros_next_to_tangencies_are_in_the_box)
{
  int small = 0;
  for (int n = 0; n < 20 * CASES; n++) {
    double to[2], s[4][4], box[2][2] = {{0, 1}, {0, 1}};
    struct row row;
    const double grain = below(2) ? 0x1p-6 : 0x1p-52, angle = below(4) ? below(8) * acos(-1) / 4 : 6 * unit();
    const double e[2] = {real_coarse(cos(angle), grain), real_coarse(sin(angle), grain)};
    const double flat = any_size(40), along = any_size(40), square = below(2) ? 0.125 : any_size(50);
    const double start = (below(3) ? 0 : unit() - 0.5) - 0.5 * (e[0] - e[1]), steep = below(100) ? 0.25 : 0,
                 bend = any_size(20);
    for (int k = 0; k < 2; k++) to[k] = below(3) ? real_coarse(unit(), grain) : below(2);
    for (int c = 0; c < 16; c++)
      arf_set_d(net[c], real_coarse((e[0] * (c / 4) + e[1] * (c % 4)) * steep + flat * (unit() - 0.5), grain));
    const double s_error = zero_at(to, any_size(50), s);
    for (int c = 0; c < 16; c++) { /* a square of the place across e, and its place along e */
      const int i = c / 4, j = c % 4;
      const double uu = i * (i - 1) / 2.0, vv = j * (j - 1) / 2.0, across = e[0] * j - e[1] * i;
      const double across2 = e[1] * e[1] * uu - 2 * e[0] * e[1] * i * j / 3.0 + e[0] * e[0] * vv;
      const double other = start * across / 4 + along * (e[0] * i + e[1] * j) + bend * (unit() - 0.5);
      arf_set_d(net[c], real_coarse(square * across2 + other, grain));
    }
    row.error = zero_at(to, any_size(50), row.net);
    assert_true(tangent_box(s, s_error, &row, box));
    for (int k = 0; k < 2; k++) assert_true(box[k][0] <= to[k] && to[k] <= box[k][1]);
    small += box[0][1] - box[0][0] < 0x1p-10 || box[1][1] - box[1][0] < 0x1p-10;
  }
  assert_true(small > CASES);
}

/* ---- integers ---- */

/* Often next to what limbs or wide numbers hold, or with many zeros. */
TEST(integers_become_floating_point_numbers_and_back)
{
  enum { LONGEST = 8 };
  static fmpz_t product;
  limb a[LONGEST], out[LONGEST];
  for (int n = 0; n < 10 * CASES; n++) {
    const int bits = 1 + below(below(2) ? 250 : 120), exponent = 200 - below(3000);
    const ulong zeros = below(2) ? 0 : (ulong)below(bits);
    bool known;
    random_integer(&z, below(8) ? WORDS : DIGITS, 0, bits, 0);
    fmpz_fdiv_q_2exp(&z, &z, zeros), fmpz_mul_2exp(&z, &z, zeros);
    const int length = limbs_for((int)fmpz_bits(&z));
    fmpz_get_signed_ui_array(a, length, &z);
    if (!fmpz_is_zero(&z)) assert_int_equal(limbs_twos(a), fmpz_val2(&z));
    const limb minus = -(limb)(1 + below(9));
    limbs_product(out, LONGEST, &minus, 1, a, length), fmpz_set_signed_ui_array(product, out, LONGEST);
    fmpz_addmul_ui(product, &z, -minus), assert_true(fmpz_is_zero(product));
    arf_set_fmpz(x, &z), arf_mul_2exp_si(x, x, exponent), arf_mul_2exp_si(y, x, -111);
    set_wide(net[0], limbs_wide(a, length, exponent, &known)), subtract(x, net[0]);
    assert_true(known ? arf_is_zero(x) : arf_sgn(x) > 0 && arf_cmpabs(x, y) <= 0); /* rounded down, if at all */
    const double number = below(4) * ldexp(2 * unit() - 1, below(200) - 100);
    const int low = number == 0 ? 0 : ilogb(number) - 52 - below(200);
    limbs_double(a, LONGEST, number, low), fmpz_set_signed_ui_array(&z, a, LONGEST);
    arf_set_d(x, number), arf_mul_2exp_si(x, x, -low), arf_set_fmpz(y, &z), assert_true(arf_equal(x, y));
  }
}

/* ---- borders ---- */

/* Multiples of one vector are on a line, unless one of them is not, even if those beside it are 0. */
TEST(borders_are_on_a_line_or_not)
{
  for (int n = 0; n < CASES; n++) {
    const int border = n % 4, by[2] = {1 + below(100), sign() * (1 + below(100))}, other = n % 3 ? 1 : -1;
    for (int k = 0; k < 32; k++) fmpz_zero(&integer[k / 16][k % 16]); /* the border's are the largest */
    for (int m = 0; m < 4; m++) {
      random_integer(&z, NEAR, 0, 119 - below(2) * below(60), 0);
      if (m < 3 && other > 0) fmpz_zero(&z);
      for (int k = 0; k < 2; k++) fmpz_mul_si(&integer[k][edge_at(border, m)], &z, by[k]);
    }
    if (other > 0 && n % 2) fmpz_one_2exp(&integer[0][edge_at(border, other)], 80);
    const struct piece piece = make_piece();
    assert_int_equal(on_line(&piece, border), other < 0 || n % 2 == 0);
  }
}

/* Sums that take as many bits as they can. */
TEST(sums_have_room)
{
  static struct slopes slopes;
  const int64_t most = ((int64_t)1 << 59) - 1, word = UINT32_MAX;
  bool known;
  int limbs;
  for (int n = 0; n < 2; n++) {
    const limb p = n ? (limb)1 << 40 : INT32_MAX, q = n ? 1 : -p;
    for (int c = 0; c < 16; c++) fmpz_set_si(&integer[0][c], word), fmpz_set_si(&integer[1][c], n ? 1 : word);
    struct piece piece = make_piece();
    const limb *sum = piece_combine(&piece, (struct weight){&p, 1}, (struct weight){&q, 1}, &pool, &limbs);
    assert_true(limbs_wide(sum, limbs, 0, &known) == (wide)p * word - (wide)(int64_t)q * (n ? 1 : word));
    for (int c = 0; c < 16; c++) fmpz_set_si(&integer[0][c], c < 8 ? -most : most);
    piece = make_piece(), slopes_exact(&piece, 0, &slopes);
    assert_true(limbs_wide(slopes.exact[0][0], slopes.limbs[0], 0, &known) == 32 * (wide)most);
  }
}

TEST(memory_is_not_exceeded)
{
  static struct slopes slopes;
  struct row row;
  const struct piece huge = {.net = {room, room}, .limbs = {1, 1}, .bits = {2 * LIMB_BITS * PIECE_LIMBS_MAX - 6}};
  pool = (struct pool){room, POOL, 0, INT64_MAX};
  assert_null(pool_net(&pool, PIECE_LIMBS_MAX + 1));
  assert_false(combine_exactly(&huge, &slopes, 0, &pool, &row));
  pool.room = 16 * PIECE_LIMBS_MAX + 15;
  assert_non_null(pool_net(&pool, PIECE_LIMBS_MAX));
  assert_null(pool_net(&pool, 1));
}

/* Whether a piece has roots: by combinations of its polynomials. See piece.h. */
#include "base/real.h"
#include "geometry/patch.h"
#include "intersect/exact/piece.h"

/* ---- rows of the adjugate Jacobian ---- */

/* The derivatives of a and b by u and v in the middle, times 32/3. */
struct slopes {
  double value[2][2];
  int limbs[2];
  limb exact[2][2][PIECE_LIMBS_MAX]; /* if make_row needed them */
};

static const int64_t weight_of[4] = {1, 3, 3, 1}, sign_of[4] = {-1, -1, 1, 1};

static void slopes_round(const struct piece *piece, struct slopes *out)
{
  for (int k = 0; k < 2; k++) {
    double du = 0, dv = 0;
    for (int c = 0; c < 16; c++) {
      const double x = piece->value[k][c / 4][c % 4];
      du += x * (double)(sign_of[c / 4] * weight_of[c % 4]), dv += x * (double)(weight_of[c / 4] * sign_of[c % 4]);
    }
    out->value[k][0] = du, out->value[k][1] = dv;
  }
}

static void slopes_exact(const struct piece *piece, int k, struct slopes *out)
{
  const int limbs = out->limbs[k] = limbs_for(piece->bits[k] + 5);
  memset(out->exact[k], 0, sizeof out->exact[k]);
  for (int c = 0; c < 16; c++) {
    limb x[PIECE_LIMBS_MAX];
    for (int d = 0; d < 2; d++) {
      const limb factor = (limb)(d == 0 ? sign_of[c / 4] * weight_of[c % 4] : weight_of[c / 4] * sign_of[c % 4]);
      limbs_product(x, limbs, &factor, 1, piece->net[k] + c * piece->limbs[k], piece->limbs[k]);
      limbs_add(out->exact[k][d], out->exact[k][d], x, limbs);
    }
  }
}

/* A row of the adjugate Jacobian times (a,b), but for a common factor: its net, and how far its coefficients may be
 * off. */
struct row {
  double net[4][4], error;
};

/* Rows known to fewer bits than this in doubles are formed from the integers: to decide a piece, and to place a root.
 * Choices of speed. */
#define ROW_BITS 0x1p-10
#define ROW_BITS_FINE 0x1p-40

/* Row d: b_v a - a_v b, or b_u a - a_u b; with other weights than these it is a combination as well, so only roundings
 * of a and b count. */
static void combine_row(const struct piece *piece, const struct slopes *slopes, int d, struct row *out)
{
  const double p[2] = {slopes->value[1][1 - d], -slopes->value[0][1 - d]};
  out->error = 0;
  for (int k = 0; k < 2; k++) out->error += (piece->error[k] + 2 * UNIT_ROUNDOFF) * fabs(p[k]);
  for (int c = 0; c < 16; c++)
    out->net[c / 4][c % 4] = p[0] * piece->value[0][c / 4][c % 4] + p[1] * piece->value[1][c / 4][c % 4];
}

/* The same from the integers, and from exact slopes: as a and b may nearly be multiples of each other. */
static bool combine_exactly(const struct piece *piece, struct slopes *slopes, int d, struct pool *pool, struct row *out)
{
  const size_t before = pool->used;
  int limbs;
  if (limbs_for((piece->bits[0] > piece->bits[1] ? piece->bits[0] : piece->bits[1]) + 5) > PIECE_LIMBS_MAX)
    return false;
  for (int k = 0; k < 2; k++) slopes_exact(piece, k, slopes);
  const struct weight p = {slopes->exact[1][1 - d], slopes->limbs[1]}, q = {slopes->exact[0][1 - d], slopes->limbs[0]};
  const limb *net = piece_combine(piece, p, q, pool, &limbs);
  if (!net) return false;
  (void)net_round(net, limbs, out->net);
  pool->used = before;
  out->error = PIECE_ERROR;
  return true;
}

/* Makes the row, to that many bits at least if there is room. Returns whether it keeps one sign. */
static bool make_row(struct piece *piece, struct slopes *slopes, int d, double bits, struct pool *pool, struct row *out)
{
  for (int tries = 0;; tries++) {
    double least = INFINITY, most = -INFINITY;
    if (tries < 2) combine_row(piece, slopes, d, out);
    else if (!combine_exactly(piece, slopes, d, pool, out)) return false;
    for (int c = 0; c < 16; c++)
      least = real_min(least, out->net[c / 4][c % 4]), most = real_max(most, out->net[c / 4][c % 4]);
    if (least > out->error || most < -out->error) return true;
    const double largest = real_max(most, -least);
    if (tries == 2 || (largest > 0 && largest * bits >= out->error)) return false;
    if (tries == 0) {
      if (piece_is_exact(piece)) tries = 1;
      else if (!piece_exact(piece, pool)) return false;
      else slopes_round(piece, slopes);
    }
  }
}

/* By how much the derivatives of the row, divided by its derivative by parameter `k` in the middle, `along`, differ from
 * 1 and 0 on the piece: a bound on the sum for both parameters. */
static double turning(const struct row *row, int k, double along)
{
  double most[2] = {0, 0};
  const double inverse = 3 / along;
  for (int i = 0; i < 4 && most[0] + most[1] <= 1; i++) { /* 1 is too much already */
    for (int j = 0; j < 3; j++) {
      const double du = (row->net[j + 1][i] - row->net[j][i]) * inverse;
      const double dv = (row->net[i][j + 1] - row->net[i][j]) * inverse;
      most[0] = real_max(most[0], fabs(k == 0 ? du - 1 : du));
      most[1] = real_max(most[1], fabs(k == 0 ? dv : dv - 1));
    }
  }
  return most[0] + most[1];
}

/* The largest contraction, on the piece and its margin, with which a root is sought: more of them are found with a
 * larger one, but farther outside the piece. A choice of speed. */
#define CONTRACTION 0.9

/* Newton's method comes to rest in fewer steps, or the piece is halved. */
enum { STEPS = 12 };

/* Newton's method on the two rows, from the middle. Returns the bound on the distance of a root from out->at, infinite
 * if none is known. */
static void newton(struct row row[2], const double along[2], double contraction, struct piece_root *out)
{
  double u = 0.5, v = 0.5, off = INFINITY;
  out->radius = INFINITY;
  for (int n = 0; n < STEPS; n++) {
    const struct patch_jet f = patch_evaluate(row[0].net, u, v), g = patch_evaluate(row[1].net, u, v);
    const double here = real_max(fabs(f.value / along[0]), fabs(g.value / along[1]));
    if (!(here < off)) break;
    off = here, out->at[0] = u, out->at[1] = v;
    const double determinant = f.du * g.dv - f.dv * g.du;
    const double su = (f.value * g.dv - g.value * f.dv) / determinant,
                 sv = (g.value * f.du - f.value * g.du) / determinant;
    u -= su, v -= sv;
    if (!(fabs(u - 0.5) <= 0.5 + PIECE_MARGIN && fabs(v - 0.5) <= 0.5 + PIECE_MARGIN)) break;
  }
  double error = 0;
  for (int k = 0; k < 2; k++) {
    double most = 0;
    for (int c = 0; c < 16; c++) most = real_max(most, fabs(row[k].net[c / 4][c % 4]));
    /* of coefficients, and twenty roundings of a value, both on the margin */
    error = real_max(error, PIECE_MARGIN_OFF * (row[k].error + 20 * UNIT_ROUNDOFF * most) / fabs(along[k]));
  }
  out->radius = (off + error) / (1 - contraction);
}

/* ---- tangents ---- */

/* Value and derivatives in the middle. */
struct series {
  double value, u, v, uu, uv, vv;
};

static struct series series(const double net[4][4])
{
  static const double value[4] = {0.125, 0.375, 0.375, 0.125}, first[4] = {-0.75, -0.75, 0.75, 0.75},
                      second[4] = {3, -3, -3, 3};
  struct series f = {.value = 0};
  for (int i = 0; i < 4; i++) {
    for (int j = 0; j < 4; j++) {
      const double x = net[i][j];
      f.value += value[i] * value[j] * x, f.u += first[i] * value[j] * x, f.v += value[i] * first[j] * x;
      f.uu += second[i] * value[j] * x, f.uv += first[i] * first[j] * x, f.vv += value[i] * second[j] * x;
    }
  }
  return f;
}

/* The largest difference of a control value of the net from those of its series, of first or second order. */
static double series_off(const double net[4][4], const struct series *f, bool second)
{
  double off = 0;
  for (int i = 0; i < 4; i++) {
    for (int j = 0; j < 4; j++) {
      const double u = i / 3.0 - 0.5, v = j / 3.0 - 0.5; /* of (u - 1/2)^2 they are uu */
      const double uu = i * (i - 1) / 6.0 - u - 0.25, vv = j * (j - 1) / 6.0 - v - 0.25;
      const double bend = second ? f->uu / 2 * uu + f->uv * u * v + f->vv / 2 * vv : 0;
      off = real_max(off, fabs(net[i][j] - (f->value + f->u * u + f->v * v + bend)));
    }
  }
  return off;
}

/* Cuts the box to where centre + x[0] e + x[1] (e turned left) lies, if x[k] is in range[k]. Returns whether any is. It
 * rounds by up to 10 UNIT_ROUNDOFF, which the ranges have to spare. */
static bool cut_box(double box[2][2], const double e[2], double range[2][2])
{
  for (int axis = 0; axis < 2; axis++) {
    const double by[2] = {e[axis], axis ? e[0] : -e[1]};
    double low = 0.5, high = 0.5;
    for (int k = 0; k < 2; k++) {
      const double one = by[k] * real_clamp(range[k][0], -1, 1), two = by[k] * real_clamp(range[k][1], -1, 1);
      low += real_min(one, two), high += real_max(one, two);
    }
    box[axis][0] = real_max(box[axis][0], low), box[axis][1] = real_min(box[axis][1], high);
    if (box[axis][0] > box[axis][1]) return false;
  }
  return true;
}

/* Where c + d x + k x^2 is at most `off` in size: at least that range; [-1, 1] if nothing better is known. Returns
 * whether it is anywhere. */
static bool square_range(double c, double d, double k, double off, double range[2])
{
  range[0] = -1, range[1] = 1;
  if (fabs(c) - fabs(d) - fabs(k) > off) return false;
  if (k < 0) c = -c, d = -d, k = -k;
  const double size = d * d + 4 * k * (fabs(c) + off), most = d * d - 4 * k * (c - off) + 16 * UNIT_ROUNDOFF * size;
  if (most < 0) return false;
  const double root = sqrt(most), low = (-d - root) / (2 * k), high = (root - d) / (2 * k);
  if (low > -1) range[0] = low;
  if (high < 1) range[1] = high;
  return true;
}

/* Next to a tangency the row f is small and changes little along the curve s = 0, s one of a and b, but the piece
 * reaches to either side of that. With e along the gradient of s in the middle, the curve lies in a strip across e, as
 * wide as s differs from its tangent plane. In there f is nearly a square function of the place across e: it differs from
 * that by what contains the place along e, and by terms of third order. Where that leaves room for a zero is all that can
 * hold a common one: `box`, of a size 3/2 powers of the piece's. Returns whether there may be one. */
static bool tangent_box(const double s_net[4][4], double s_error, const struct row *row, double box[2][2])
{
  const struct series s = series(s_net), f = series(row->net);
  const double steep = hypot(s.u, s.v), e[2] = {s.u / steep, s.v / steep};
  if (!(steep > 0)) return true;
  /* the nets' errors; roundings of sums of coefficients of at most 1, times up to 24, of e, and of places: formally 130 of s
   * and 610 of f */
  const double off_s = series_off(s_net, &s, false) + s_error + 256 * UNIT_ROUNDOFF;
  double range[2][2] = {{real_max(-1, (-s.value - off_s) / steep), real_min(1, (-s.value + off_s) / steep)}};
  const double middle = (range[0][0] + range[0][1]) / 2, half = (range[0][1] - range[0][0]) / 2; /* of the strip */
  if (half < 0) return false;
  double most = 0;
  for (int c = 0; c < 16; c++) most = real_max(most, fabs(row->net[c / 4][c % 4]));
  const double along = f.u * e[0] + f.v * e[1], across = f.v * e[0] - f.u * e[1];
  const double along2 = f.uu * e[0] * e[0] + 2 * f.uv * e[0] * e[1] + f.vv * e[1] * e[1];
  const double across2 = f.uu * e[1] * e[1] - 2 * f.uv * e[0] * e[1] + f.vv * e[0] * e[0];
  const double mixed = (f.vv - f.uu) * e[0] * e[1] + f.uv * (e[0] * e[0] - e[1] * e[1]);
  const double off = series_off(row->net, &f, true) + row->error + 1024 * UNIT_ROUNDOFF * most +
                     half * (fabs(along + along2 * middle) + fabs(mixed) + fabs(along2) / 2 * half);
  const double value = f.value + (along + along2 / 2 * middle) * middle;
  return square_range(value, across + mixed * middle, across2 / 2, off, range[1]) && cut_box(box, e, range);
}

/* ---- the decision ---- */

/* The two rows, their derivatives along the parameters in the middle, and their contraction; infinite if one has no such
 * derivative. Returns whether one of them keeps its sign; what follows is then set only if it is wanted `always`. */
static bool make_rows(struct piece *piece, struct pool *pool, bool always, double bits, struct slopes *slopes,
                      struct row row[2], double along[2], double *contraction)
{
  bool misses = false;
  slopes_round(piece, slopes);
  *contraction = 0;
  for (int k = 0; k < 2; k++) {
    misses |= make_row(piece, slopes, k, bits, pool, &row[k]);
    if (misses && !always) return true;
    const struct patch_jet jet = patch_evaluate(row[k].net, 0.5, 0.5);
    along[k] = k == 0 ? jet.du : jet.dv;
    const double turn = along[k] == 0 ? INFINITY : turning(&row[k], k, along[k]) + 16 * row[k].error / fabs(along[k]);
    *contraction = real_max(*contraction, PIECE_GROWTH * turn);
  }
  return misses;
}

enum piece_verdict piece_root(struct piece *piece, bool fine, struct pool *pool, struct piece_root *out)
{
  struct row row[2];
  struct slopes slopes;
  double along[2], contraction;
  for (int k = 0; k < 2; k++) out->box[k][0] = 0, out->box[k][1] = 1;
  if (make_rows(piece, pool, false, fine ? ROW_BITS_FINE : ROW_BITS, &slopes, row, along, &contraction))
    return PIECE_EMPTY;
  if (!(contraction <= CONTRACTION)) {
    const double(*x)[2] = slopes.value;
    const int steep = fabs(x[1][0]) + fabs(x[1][1]) > fabs(x[0][0]) + fabs(x[0][1]);
    const struct row *flat = &row[fabs(x[steep][0]) > fabs(x[steep][1])];
    return tangent_box(piece->value[steep], piece->error[steep], flat, out->box) ? PIECE_OPEN : PIECE_EMPTY;
  }
  newton(row, along, contraction, out);
  double outside = 0;
  for (int k = 0; k < 2; k++) outside = real_max(outside, real_max(-out->at[k], out->at[k] - 1));
  if (outside > out->radius) return PIECE_EMPTY;
  if (!(out->radius <= PIECE_MARGIN / 2)) return PIECE_OPEN;
  return PIECE_ROOT;
}

bool piece_depth_turns(struct piece *piece, struct pool *pool)
{
  if (!piece_exact(piece, pool)) return false;
  const int limbs = limbs_for(piece->bits[NET_W] + 1), k = piece->bits[NET_A] == 0;
  const size_t before = pool->used;
  struct row row[2];
  struct slopes slopes;
  double along[2], contraction = INFINITY;
  struct piece both = *piece;
  both.net[NET_A] = piece->net[k], both.limbs[NET_A] = piece->limbs[k], both.limbs[NET_B] = limbs;
  both.net[NET_B] = pool_net(pool, limbs);
  if (both.net[NET_B]) {
    piece_depth_changes(piece, limbs, both.net[NET_B]);
    piece_measure(&both);
    (void)make_rows(&both, pool, true, ROW_BITS, &slopes, row, along, &contraction);
  }
  pool->used = before;
  return contraction <= CONTRACTION;
}

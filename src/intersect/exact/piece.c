/* Pieces of a patch. See piece.h. */
#include "intersect/exact/piece.h"

#include "base/real.h"
#include "geometry/patch.h"

/* ---- nets ---- */

/* The leading bits that net_round keeps of the largest coefficient. */
enum { WINDOW = 62 };

/* The bits of the largest coefficient, by those of all together. */
static int net_bits(const limb *net, int limbs)
{
  for (int k = limbs; k-- > 0;) {
    limb any = 0;
    for (int c = 0; c < 16; c++) any |= net[c * limbs + k] ^ limbs_fill(net + c * limbs, limbs);
    if (any) return LIMB_BITS * k + LIMB_BITS - __builtin_clzll(any);
  }
  return 0;
}

static inline int window_shift(int bits) { return bits > WINDOW ? bits - WINDOW : 0; }

int net_round(const limb *net, int limbs, double out[4][4])
{
  const int bits = net_bits(net, limbs), shift = window_shift(bits);
  const double unit = ldexp(1, shift - bits);
  for (int c = 0; c < 16; c++) out[c / 4][c % 4] = (double)limbs_window(net + c * limbs, limbs, shift) * unit;
  return bits;
}

bool piece_room(struct piece *out, struct pool *pool)
{
  size_t at = pool->used;
  for (int k = 0; k < NETS; k++) {
    if (out->limbs[k] > PIECE_LIMBS_MAX) return false;
    out->net[k] = pool->at + at;
    at += 16 * (size_t)out->limbs[k];
  }
  if (at > pool->room) return false;
  pool->used = at;
  return true;
}

void piece_measure(struct piece *piece)
{
  for (int k = 0; k < 2; k++) piece->bits[k] = net_round(piece->net[k], piece->limbs[k], piece->value[k]);
  piece->bits[NET_W] = net_bits(piece->net[NET_W], piece->limbs[NET_W]);
}

/* ---- parts ---- */

/* The index of coefficient k of the cubic number `row` that runs along u (axis 0) or v. */
static inline int cubic_at(int axis, int row, int k) { return axis == 0 ? 4 * k + row : 4 * row + k; }

/* a + b + *carry, and the carry of that. */
static inline limb add_limbs(limb a, limb b, bool *carry)
{
  limb sum;
  const bool first = __builtin_add_overflow(a, b, &sum), second = __builtin_add_overflow(sum, (limb)*carry, &sum);
  *carry = first | second;
  return sum;
}

/* The limb of 2^by x, of which `below` is the limb before. */
static inline limb shift_limbs(limb x, limb below, int by) { return x << by | below >> (LIMB_BITS - by); }

/* Both halves of a cubic, times 8, by de Casteljau's algorithm, a limb of all numbers at a time. Sums are taken modulo
 * 2^(64 limbs), in which the results fit; the limbs above the `in` limbs of an operand are those of its sign. */
static void cubic_halve(const limb *const c[4], int in, limb *const low[4], limb *const high[4], int out)
{
  bool carry[6] = {false};
  limb fill[4], p0 = 0, s0 = 0, pq0 = 0, rs0 = 0, pqr0 = 0, qrs0 = 0;
  for (int n = 0; n < 4; n++) fill[n] = limbs_fill(c[n], in);
  for (int k = 0; k < out; k++) {
    const limb p = k < in ? c[0][k] : fill[0], q = k < in ? c[1][k] : fill[1];
    const limb r = k < in ? c[2][k] : fill[2], s = k < in ? c[3][k] : fill[3];
    const limb pq = add_limbs(p, q, &carry[0]), qr = add_limbs(q, r, &carry[1]), rs = add_limbs(r, s, &carry[2]);
    const limb pqr = add_limbs(pq, qr, &carry[3]), qrs = add_limbs(qr, rs, &carry[4]);
    low[3][k] = high[0][k] = add_limbs(pqr, qrs, &carry[5]);
    low[0][k] = shift_limbs(p, p0, 3), low[1][k] = shift_limbs(pq, pq0, 2), low[2][k] = shift_limbs(pqr, pqr0, 1);
    high[1][k] = shift_limbs(qrs, qrs0, 1), high[2][k] = shift_limbs(rs, rs0, 2), high[3][k] = shift_limbs(s, s0, 3);
    p0 = p, s0 = s, pq0 = pq, rs0 = rs, pqr0 = pqr, qrs0 = qrs;
  }
}

/* The part's place: from `at` on, `part` of the piece long. `ends`: whether it reaches the piece's borders there. */
static void place(const struct piece *piece, int axis, wide at, double part, const bool ends[2], struct piece *out)
{
  for (int k = 0; k < 2; k++) out->low[k] = piece->low[k], out->size[k] = piece->size[k];
  if (!ends[0]) out->low[axis] += at * piece->size[axis];
  out->size[axis] *= part;
  out->borders = piece->borders;
  for (int end = 0; end < 2; end++)
    if (!ends[end]) out->borders &= ~(1u << (2 * axis + end));
}

bool piece_halve(const struct piece *piece, int axis, bool high_first, struct pool *pool, struct piece out[2])
{
  const size_t before = pool->used;
  for (int h = 0; h < 2; h++) {
    const int high = high_first ? 1 - h : h;
    place(piece, axis, high / (wide)2, 0.5, (const bool[2]){high == 0, high == 1}, &out[h]);
    for (int k = 0; k < NETS; k++)
      out[h].limbs[k] = limbs_for(piece->bits[k] + 4), out[h].exponent[k] = piece->exponent[k] - 3;
    if (piece_room(&out[h], pool)) continue;
    pool->used = before;
    return false;
  }
  for (int k = 0; k < NETS; k++) {
    const int in = piece->limbs[k], limbs = out[0].limbs[k];
    for (int row = 0; row < 4; row++) {
      const limb *c[4];
      limb *low[4], *high[4];
      for (int n = 0; n < 4; n++) {
        const int at = cubic_at(axis, row, n);
        c[n] = piece->net[k] + at * in;
        low[n] = out[high_first].net[k] + at * limbs, high[n] = out[!high_first].net[k] + at * limbs;
      }
      cubic_halve(c, in, low, high, limbs);
    }
  }
  return true;
}

/* The cubic over [at[0], at[1]] / of, times of^3, by blossoms. */
static void cubic_part(limb (*c)[PIECE_LIMBS_MAX], limb (*out)[PIECE_LIMBS_MAX], int limbs, const limb at[2], limb of)
{
  limb once[2][3][PIECE_LIMBS_MAX], twice[3][2][PIECE_LIMBS_MAX];
  for (int e = 0; e < 2; e++)
    for (int n = 0; n < 3; n++) limbs_blend(once[e][n], c[n], c[n + 1], limbs, of - at[e], at[e]);
  for (int e = 0; e < 3; e++) /* from and from, from and to, to and to */
    for (int n = 0; n < 2; n++)
      limbs_blend(twice[e][n], once[e / 2][n], once[e / 2][n + 1], limbs, of - at[(e + 1) / 2], at[(e + 1) / 2]);
  for (int n = 0; n < 4; n++) {
    const int e = n < 2 ? 0 : n - 1, last = n > 0;
    limbs_blend(out[n], twice[e][0], twice[e][1], limbs, of - at[last], at[last]);
  }
}

bool piece_part(const struct piece *piece, int axis, limb from, limb to, int log2, struct pool *pool, struct piece *out)
{
  const limb of = (limb)1 << log2, ends[2] = {from, to};
  place(piece, axis, (wide)from / of, ldexp((double)(to - from), -log2), (const bool[2]){from == 0, to == of}, out);
  for (int k = 0; k < NETS; k++)
    out->limbs[k] = limbs_for(piece->bits[k] + 3 * log2 + 1), out->exponent[k] = piece->exponent[k] - 3 * log2;
  if (!piece_room(out, pool)) return false;
  limb c[4][PIECE_LIMBS_MAX], to_c[4][PIECE_LIMBS_MAX];
  for (int k = 0; k < NETS; k++) {
    const int in = piece->limbs[k], limbs = out->limbs[k];
    for (int row = 0; row < 4; row++) {
      for (int n = 0; n < 4; n++) limbs_copy(c[n], limbs, piece->net[k] + cubic_at(axis, row, n) * in, in);
      cubic_part(c, to_c, limbs, ends, of);
      for (int n = 0; n < 4; n++) limbs_copy(out->net[k] + cubic_at(axis, row, n) * limbs, limbs, to_c[n], limbs);
    }
  }
  piece_measure(out);
  return true;
}

/* ---- tests ---- */

bool piece_misses(const struct piece *piece)
{
  for (int k = 0; k < 2; k++) {
    int positive = 0, negative = 0;
    for (int c = 0; c < 16; c++)
      positive += piece->value[k][c / 4][c % 4] > 0, negative += piece->value[k][c / 4][c % 4] < 0;
    if (positive == 16 || negative == 16) return true;
  }
  return false;
}

bool piece_corner_root(const struct piece *piece, int iu, int iv)
{
  const int c = 12 * iu + 3 * iv;
  for (int k = 0; k < 2; k++)
    if (!limbs_zero(piece->net[k] + c * piece->limbs[k], piece->limbs[k])) return false;
  return true;
}

int piece_longer(const struct piece *piece)
{
  double along[2] = {0, 0};
  for (int k = 0; k < 2; k++) {
    const double(*x)[4] = piece->value[k];
    for (int i = 0; i < 4; i++) {
      for (int j = 0; j < 3; j++) {
        along[0] = real_max(along[0], fabs(x[j + 1][i] - x[j][i]));
        along[1] = real_max(along[1], fabs(x[i][j + 1] - x[i][j]));
      }
    }
  }
  return along[0] == along[1] ? piece->size[1] > piece->size[0] : along[1] > along[0];
}

/* ---- combinations ---- */

limb *piece_combine(const struct piece *piece, struct weight p, struct weight q, struct pool *pool, int *out_limbs)
{
  const struct weight weight[2] = {p, q};
  limb term[PIECE_LIMBS_MAX], product[PIECE_LIMBS_MAX];
  int bits = 0;
  for (int k = 0; k < 2; k++) {
    const int here = piece->bits[k] + limbs_bits(weight[k].at, weight[k].limbs) + weight[k].shift;
    bits = here > bits ? here : bits;
  }
  const int limbs = limbs_for(bits + 2);
  if (limbs > PIECE_LIMBS_MAX || pool->used + 16 * (size_t)limbs > pool->room) return NULL;
  limb *out = pool->at + pool->used;
  pool->used += 16 * (size_t)limbs;
  for (int c = 0; c < 16; c++) {
    for (int k = 0; k < 2; k++) {
      const int in = piece->limbs[k];
      const limb *x = piece->net[k] + c * in;
      if (weight[k].limbs == 1) limbs_scale(product, limbs, x, in, (int64_t)weight[k].at[0]);
      else limbs_product(product, limbs, x, in, weight[k].at, weight[k].limbs);
      limbs_shift(term, limbs, product, limbs, weight[k].shift);
      if (k == 0) limbs_copy(out + c * limbs, limbs, term, limbs);
      else limbs_add(out + c * limbs, out + c * limbs, term, limbs);
    }
  }
  *out_limbs = limbs;
  return out;
}

bool piece_weigh(const struct piece *piece, const double p[2], struct pool *pool, double out[4][4])
{
  limb at[2];
  struct weight weight[2];
  int exponent[2], limbs;
  for (int k = 0; k < 2; k++) {
    at[k] = (limb)(int64_t)ldexp(frexp(p[k], &exponent[k]), 53);
    weight[k] = (struct weight){&at[k], 1, 0};
  }
  const int apart = (exponent[0] - piece->bits[0]) - (exponent[1] - piece->bits[1]);
  if (p[0] != 0 && p[1] != 0) weight[0].shift = apart > 0 ? apart : 0, weight[1].shift = apart < 0 ? -apart : 0;
  const size_t before = pool->used;
  const limb *net = piece_combine(piece, weight[0], weight[1], pool, &limbs);
  if (net) (void)net_round(net, limbs, out);
  pool->used = before;
  return net;
}

/* The derivatives of a and b by u and v in the middle, times 32/3: as doubles for `value`, and exactly, `limbs` long. */
struct slopes {
  double value[2][2];
  int limbs[2];
  limb exact[2][2][PIECE_LIMBS_MAX];
};

/* In doubles, from the leading bits: right to some places of 2^-59 of the net's size. */
static void slopes_round(const struct piece *piece, struct slopes *out)
{
  static const int64_t weight[4] = {1, 3, 3, 1}, sign[4] = {-1, -1, 1, 1};
  for (int k = 0; k < 2; k++) {
    const int shift = window_shift(piece->bits[k]);
    limb_sum du = 0, dv = 0;
    for (int c = 0; c < 16; c++) {
      const int64_t x = limbs_window(piece->net[k] + c * piece->limbs[k], piece->limbs[k], shift);
      du += (limb_sum)x * (sign[c / 4] * weight[c % 4]), dv += (limb_sum)x * (weight[c / 4] * sign[c % 4]);
    }
    const double unit = ldexp(1, shift - piece->bits[k]);
    out->value[k][0] = (double)du * unit, out->value[k][1] = (double)dv * unit;
  }
}

static void slopes_exact(const struct piece *piece, int k, struct slopes *out)
{
  static const int64_t weight[4] = {1, 3, 3, 1}, sign[4] = {-1, -1, 1, 1};
  const int limbs = out->limbs[k] = limbs_for(piece->bits[k] + 6);
  for (int d = 0; d < 2; d++) limbs_set(out->exact[k][d], limbs, 0);
  for (int c = 0; c < 16; c++) {
    limb x[PIECE_LIMBS_MAX];
    for (int d = 0; d < 2; d++) {
      const int64_t factor = d == 0 ? sign[c / 4] * weight[c % 4] : weight[c / 4] * sign[c % 4];
      limbs_scale(x, limbs, piece->net[k] + c * piece->limbs[k], piece->limbs[k], factor);
      limbs_add(out->exact[k][d], out->exact[k][d], x, limbs);
    }
  }
}

/* A row of the adjugate Jacobian times (a,b): its net, how far its coefficients may be off, and the sign of the common
 * factor by which it differs from the row in `value`. */
struct row {
  double net[4][4], error;
};

/* Rows known to fewer bits than this in doubles are formed from the integers. A choice of speed. */
#define ROW_BITS 0x1p-20

/* Row d: b_v a - a_v b, or a_u b - b_u a. Returns whether it keeps one sign. */
static bool make_row(const struct piece *piece, struct slopes *slopes, int d, struct pool *pool, struct row *out)
{
  const double p[2] = {d == 0 ? slopes->value[1][1] : -slopes->value[1][0],
                       d == 0 ? -slopes->value[0][1] : slopes->value[0][0]};
  double least = INFINITY, most = -INFINITY;
  out->error = 3 * PIECE_ERROR * (fabs(p[0]) + fabs(p[1]));
  for (int c = 0; c < 16; c++) {
    const double x = p[0] * piece->value[0][c / 4][c % 4] + p[1] * piece->value[1][c / 4][c % 4];
    out->net[c / 4][c % 4] = x, least = real_min(least, x), most = real_max(most, x);
  }
  if (least > out->error || most < -out->error) return true;
  if (real_max(most, -least) * ROW_BITS >= out->error) return false;
  const size_t before = pool->used;
  int limbs;
  for (int k = 0; k < 2; k++) slopes_exact(piece, k, slopes);
  limb *minus = slopes->exact[d == 0 ? 0 : 1][1 - d];
  limbs_negate(minus, slopes->limbs[d == 0 ? 0 : 1]);
  const struct weight a = {slopes->exact[1][1 - d], slopes->limbs[1], 0},
                      b = {slopes->exact[0][1 - d], slopes->limbs[0], 0};
  const limb *net = piece_combine(piece, a, b, pool, &limbs);
  if (!net) return false;
  const int bits = net_round(net, limbs, out->net);
  pool->used = before;
  if (bits == 0) return false;
  out->error = PIECE_ERROR, least = INFINITY, most = -INFINITY;
  for (int c = 0; c < 16; c++)
    least = real_min(least, out->net[c / 4][c % 4]), most = real_max(most, out->net[c / 4][c % 4]);
  return least > 0 || most < 0;
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

/* Second derivatives in the middle. */
struct hessian {
  double uu, uv, vv;
};

static struct hessian hessian(double net[4][4])
{
  static const double value[4] = {0.125, 0.375, 0.375, 0.125}, first[4] = {-0.75, -0.75, 0.75, 0.75},
                      second[4] = {3, -3, -3, 3};
  struct hessian h = {0, 0, 0};
  for (int c = 0; c < 16; c++) {
    const double x = net[c / 4][c % 4];
    h.uu += second[c / 4] * value[c % 4] * x, h.uv += first[c / 4] * first[c % 4] * x;
    h.vv += value[c / 4] * second[c % 4] * x;
  }
  return h;
}

/* h times (x[0], x[1]) */
static void hessian_times(const struct hessian *h, const double x[2], double out[2])
{
  out[0] = h->uu * x[0] + h->uv * x[1], out[1] = h->uv * x[0] + h->vv * x[1];
}

/* Whether a row plus a linear function m times s, one of a and b, keeps its sign; then they have no common zero. Next to
 * a tangency the row f is small and changes little along the curve s = 0, but the piece reaches to either side of that.
 * With e along the gradient of s in the middle, m is chosen such that f + m s has neither slope nor bend along e there,
 * nor a mixed one, so it is as small all over the piece as f is on the curve. */
static bool bent_misses(double s[4][4], struct row *f)
{
  const struct patch_jet s_jet = patch_evaluate(s, 0.5, 0.5), f_jet = patch_evaluate(f->net, 0.5, 0.5);
  const double steep = hypot(s_jet.du, s_jet.dv), e[2] = {s_jet.du / steep, s_jet.dv / steep};
  if (!(steep > 0)) return false;
  const double middle = -(f_jet.du * e[0] + f_jet.dv * e[1]) / steep;
  const struct hessian hf = hessian(f->net), hs = hessian(s);
  const struct hessian h = {hf.uu + middle * hs.uu, hf.uv + middle * hs.uv, hf.vv + middle * hs.vv};
  double he[2], most[2] = {0, 0}, least = INFINITY, largest = -INFINITY, m[2][2], most_m = 0;
  hessian_times(&h, e, he);
  const double along = (he[0] * e[0] + he[1] * e[1]) / (2 * steep);
  const double slope[2] = {-he[0] / steep + along * e[0], -he[1] / steep + along * e[1]};
  for (int c = 0; c < 4; c++) {
    m[c / 2][c % 2] = middle + slope[0] * (c / 2 - 0.5) + slope[1] * (c % 2 - 0.5);
    most_m = real_max(most_m, fabs(m[c / 2][c % 2]));
  }
  int signs = 0; /* of the product's corners */
  for (int c = 0; c < 4; c++) {
    const int u = 3 * (c / 2), v = 3 * (c % 2);
    signs += f->net[u][v] + m[c / 2][c % 2] * s[u][v] > 0;
  }
  if (signs % 4 != 0) return false;
  for (int c = 0; c < 16; c++)
    most[0] = real_max(most[0], fabs(f->net[c / 4][c % 4])), most[1] = real_max(most[1], fabs(s[c / 4][c % 4]));
  double half[2][4][5]; /* in Bernstein form, of degree 4 along v */
  for (int i = 0; i < 2; i++) {
    for (int r = 0; r < 4; r++) {
      for (int l = 0; l < 5; l++) {
        const double low = l < 4 ? (4 - l) * (f->net[r][l] + m[i][0] * s[r][l]) : 0;
        const double high = l > 0 ? l * (f->net[r][l - 1] + m[i][1] * s[r][l - 1]) : 0;
        half[i][r][l] = (low + high) / 4;
      }
    }
  }
  for (int k = 0; k < 5; k++) {
    for (int l = 0; l < 5; l++) {
      const double low = k < 4 ? (4 - k) * half[0][k][l] : 0, high = k > 0 ? k * half[1][k - 1][l] : 0;
      least = real_min(least, (low + high) / 4), largest = real_max(largest, (low + high) / 4);
    }
  }
  /* nets' errors, and less than ten roundings of each of four summands, which are means */
  const double error = f->error + most_m * PIECE_ERROR + 16 * UNIT_ROUNDOFF * (most[0] + most_m * most[1]);
  return least > error || largest < -error;
}

/* ---- the decision ---- */

/* The two rows, their derivatives along the parameters in the middle, and their contraction; infinite if one has no such
 * derivative. Returns whether one of them keeps its sign; what follows is then set only if it is wanted `always`. */
static bool make_rows(const struct piece *piece, struct pool *pool, bool always, struct slopes *slopes,
                      struct row row[2], double along[2], double *contraction)
{
  bool misses = false;
  slopes_round(piece, slopes);
  *contraction = 0;
  for (int k = 0; k < 2; k++) {
    misses |= make_row(piece, slopes, k, pool, &row[k]);
    if (misses && !always) return true;
    const struct patch_jet jet = patch_evaluate(row[k].net, 0.5, 0.5);
    along[k] = k == 0 ? jet.du : jet.dv;
    const double turn = along[k] == 0 ? INFINITY : turning(&row[k], k, along[k]) + 16 * row[k].error / fabs(along[k]);
    *contraction = real_max(*contraction, PIECE_GROWTH * turn);
  }
  return misses;
}

/* The sign of the determinant of (a,b)'s Jacobian in the middle. */
static int turn_of(const struct piece *piece)
{
  struct slopes slopes;
  limb one[2 * PIECE_LIMBS_MAX], two[2 * PIECE_LIMBS_MAX];
  for (int k = 0; k < 2; k++) slopes_exact(piece, k, &slopes);
  const int both = slopes.limbs[0] + slopes.limbs[1];
  limbs_product(one, both, slopes.exact[0][0], slopes.limbs[0], slopes.exact[1][1], slopes.limbs[1]);
  limbs_product(two, both, slopes.exact[0][1], slopes.limbs[0], slopes.exact[1][0], slopes.limbs[1]);
  limbs_subtract(one, one, two, both);
  return limbs_sign(one, both);
}

enum piece_verdict piece_root(const struct piece *piece, struct pool *pool, struct piece_root *out)
{
  struct row row[2];
  struct slopes slopes;
  double along[2], contraction, s[4][4];
  if (make_rows(piece, pool, false, &slopes, row, along, &contraction)) return PIECE_EMPTY;
  if (!(contraction <= CONTRACTION)) {
    const double(*x)[2] = slopes.value;
    const int steep = fabs(x[1][0]) + fabs(x[1][1]) > fabs(x[0][0]) + fabs(x[0][1]);
    memcpy(s, piece->value[steep], sizeof s);
    return bent_misses(s, &row[fabs(x[steep][0]) > fabs(x[steep][1])]) ? PIECE_EMPTY : PIECE_OPEN;
  }
  newton(row, along, contraction, out);
  double outside = 0;
  for (int k = 0; k < 2; k++) outside = real_max(outside, real_max(-out->at[k], out->at[k] - 1));
  if (!(outside + out->radius <= PIECE_MARGIN)) return PIECE_OPEN;
  if (outside > out->radius) return PIECE_EMPTY;
  out->turn = turn_of(piece);
  return PIECE_ROOT;
}

/* ---- along the ray ---- */

void piece_depths(const struct piece *piece, double *least, double *most)
{
  const limb *net = piece->net[NET_W];
  const int limbs = piece->limbs[NET_W], shift = window_shift(piece->bits[NET_W]);
  int64_t low = INT64_MAX, high = INT64_MIN;
  for (int c = 0; c < 16; c++) {
    const int64_t x = limbs_window(net + c * limbs, limbs, shift);
    low = x < low ? x : low, high = x > high ? x : high;
  }
  /* to a double and one unit upwards */
  const double unit = ldexp(1, shift + piece->exponent[NET_W]), slack = 2 * UNIT_ROUNDOFF;
  *least = ((double)low - slack * fabs((double)low)) * unit;
  *most = ((double)high + 1 + slack * fabs((double)high)) * unit;
}

bool piece_depth_grows(const struct piece *piece, int axis)
{
  const limb *net = piece->net[NET_W];
  const int limbs = piece->limbs[NET_W], shift = window_shift(piece->bits[NET_W] + 2);
  int64_t sum = 0;
  for (int corner = 0; corner < 4; corner++) {
    const int64_t x = limbs_window(net + (12 * (corner / 2) + 3 * (corner % 2)) * limbs, limbs, shift);
    sum += (axis ? corner % 2 : corner / 2) ? x : -x;
  }
  return sum > 0;
}

/* The net of w less its first coefficient. */
static void depth_changes(const struct piece *piece, int limbs, limb *out)
{
  const int in = piece->limbs[NET_W];
  limb from[PIECE_LIMBS_MAX + 1], to[PIECE_LIMBS_MAX + 1];
  limbs_copy(from, limbs, piece->net[NET_W], in);
  for (int c = 0; c < 16; c++) {
    limbs_copy(to, limbs, piece->net[NET_W] + c * in, in);
    limbs_subtract(out + c * limbs, to, from, limbs);
  }
}

wide piece_depth(const struct piece *piece, const double at[2], double radius, double *error, bool *exact)
{
  const int limbs = piece->limbs[NET_W], bits = piece->bits[NET_W], exponent = piece->exponent[NET_W];
  const limb *net = piece->net[NET_W];
  limb change[16 * (PIECE_LIMBS_MAX + 1)];
  const int wider = limbs_for(bits + 2);
  double rest[4][4], most = 0;
  depth_changes(piece, wider, change);
  const wide start = limbs_wide(net, limbs, exponent, exact);
  const int changes = net_round(change, wider, rest);
  if (changes == 0) {
    *error = 0;
    return start;
  }
  const double unit = ldexp(1, changes + exponent);
  const struct patch_jet jet = patch_evaluate(rest, at[0], at[1]);
  for (int c = 0; c < 16; c++) most = real_max(most, fabs(rest[c / 4][c % 4]));
  /* derivatives on the margin, of both parameters; roundings as in newton; the start's last place */
  *error = (2 * 6 * PIECE_GROWTH * most * radius + PIECE_MARGIN_OFF * 21 * UNIT_ROUNDOFF * most) * unit +
           (double)(4 * WIDE_ROUNDOFF * wide_abs(start));
  *exact = false;
  return start + (wide)(jet.value * unit);
}

bool piece_depth_turns(const struct piece *piece, struct pool *pool)
{
  const int limbs = limbs_for(piece->bits[NET_W] + 2), k = piece->bits[NET_A] == 0;
  const size_t before = pool->used;
  struct piece both = *piece;
  struct row row[2];
  struct slopes slopes;
  double along[2], contraction;
  bool turns = false;
  both.net[NET_A] = piece->net[k], both.limbs[NET_A] = piece->limbs[k], both.limbs[NET_B] = limbs;
  if (limbs <= PIECE_LIMBS_MAX && pool->used + 16 * (size_t)limbs <= pool->room) {
    both.net[NET_B] = pool->at + pool->used, pool->used += 16 * (size_t)limbs;
    depth_changes(piece, limbs, both.net[NET_B]);
    piece_measure(&both);
    (void)make_rows(&both, pool, true, &slopes, row, along, &contraction);
    turns = contraction <= CONTRACTION;
  }
  pool->used = before;
  return turns;
}

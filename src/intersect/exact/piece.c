/* Pieces of a patch. See piece.h. */
#include "intersect/exact/piece.h"

#include "base/real.h"
#include "geometry/patch.h"

/* ---- nets ---- */

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

int net_round(const limb *net, int limbs, double out[4][4])
{
  const int bits = net_bits(net, limbs), shift = net_shift(bits);
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
  for (int h = 0; h < 2; h++) piece_measure(&out[h]);
  return true;
}

/* The cubic over [from, from + length] / 2^log2, times 2^(3 log2). Let D[k] be its k-th forward differences, so it is the
 * sum of binomial(3,k) D[k] t^k; those are moved to `from` by Horner's scheme, and become coefficients again by sums. */
static void cubic_part(const limb *const c[4], int in, limb *const out[4], int limbs, limb from, limb length, int log2)
{
  limb D[4][PIECE_LIMBS_MAX];
  limb_sum borrow[6] = {0};
  for (int k = 0; k < limbs; k++) {
    const limb x[4] = {limbs_at(c[0], in, k), limbs_at(c[1], in, k), limbs_at(c[2], in, k), limbs_at(c[3], in, k)};
    limb once[3], twice[2];
    for (int n = 0; n < 3; n++)
      borrow[n] += x[n + 1], borrow[n] -= x[n], once[n] = (limb)borrow[n], borrow[n] >>= LIMB_BITS;
    for (int n = 0; n < 2; n++)
      borrow[n + 3] += once[n + 1], borrow[n + 3] -= once[n], twice[n] = (limb)borrow[n + 3],
                                                              borrow[n + 3] >>= LIMB_BITS;
    borrow[5] += twice[1], borrow[5] -= twice[0];
    D[0][k] = x[0], D[1][k] = once[0], D[2][k] = twice[0], D[3][k] = (limb)borrow[5], borrow[5] >>= LIMB_BITS;
  }
  for (int last = 2; last >= 0; last--) {
    for (int n = 0; n <= last; n++) {
      limb_pair sum = 0;
      limb below = 0;
      for (int k = 0; k < limbs; k++) {
        const limb x = D[n][k];
        sum += (limb_pair)D[n + 1][k] * from + shift_limbs(x, below, log2);
        D[n][k] = (limb)sum, sum >>= LIMB_BITS, below = x;
      }
    }
  }
  const limb by[4] = {1, length, length * length, length * length * length};
  limb_pair part[4] = {0}, sum[4] = {0};
  for (int k = 0; k < limbs; k++) {
    limb x[4];
    for (int n = 0; n < 4; n++) part[n] += (limb_pair)D[n][k] * by[n], x[n] = (limb)part[n], part[n] >>= LIMB_BITS;
    sum[1] += (limb_pair)x[0] + x[1], sum[2] += (limb_pair)x[0] + 2 * (limb_pair)x[1] + x[2];
    sum[3] += (limb_pair)x[0] + 3 * ((limb_pair)x[1] + x[2]) + x[3];
    out[0][k] = x[0];
    for (int n = 1; n < 4; n++) out[n][k] = (limb)sum[n], sum[n] >>= LIMB_BITS;
  }
}

bool piece_part(const struct piece *piece, int axis, limb from, limb to, int log2, struct pool *pool, struct piece *out)
{
  const limb of = (limb)1 << log2;
  place(piece, axis, (wide)from / of, ldexp((double)(to - from), -log2), (const bool[2]){from == 0, to == of}, out);
  for (int k = 0; k < NETS; k++)
    out->limbs[k] = limbs_for(piece->bits[k] + 3 * log2 + 1), out->exponent[k] = piece->exponent[k] - 3 * log2;
  if (!piece_room(out, pool)) return false;
  for (int k = 0; k < NETS; k++) {
    for (int row = 0; row < 4; row++) {
      const limb *c[4];
      limb *to_c[4];
      for (int n = 0; n < 4; n++) {
        const int at = cubic_at(axis, row, n);
        c[n] = piece->net[k] + at * piece->limbs[k], to_c[n] = out->net[k] + at * out->limbs[k];
      }
      cubic_part(c, piece->limbs[k], to_c, out->limbs[k], from, to - from, log2);
    }
  }
  piece_measure(out);
  return true;
}

bool piece_box(const struct piece *piece, const double box[2][2], struct pool *pool, struct piece *out)
{
  struct piece half;
  for (int axis = 0; axis < 2; axis++) {
    int exponent;
    (void)frexp(box[axis][1] - box[axis][0], &exponent);
    const int log2 = 3 - exponent < 2 ? 2 : 3 - exponent > BOX_BITS ? BOX_BITS : 3 - exponent;
    const double cells = ldexp(1, log2), from = real_clamp(floor(box[axis][0] * cells), 0, cells - 1);
    const double to = real_clamp(ceil(box[axis][1] * cells), from + 1, cells);
    if (!piece_part(axis ? &half : piece, axis, (limb)from, (limb)to, log2, pool, axis ? out : &half)) return false;
  }
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

/* ---- along the ray ---- */

void piece_depths(const struct piece *piece, double *least, double *most)
{
  const limb *net = piece->net[NET_W];
  const int limbs = piece->limbs[NET_W], shift = net_shift(piece->bits[NET_W]);
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
  const int limbs = piece->limbs[NET_W], shift = net_shift(piece->bits[NET_W] + 2);
  int64_t sum = 0;
  for (int corner = 0; corner < 4; corner++) {
    const int64_t x = limbs_window(net + (12 * (corner / 2) + 3 * (corner % 2)) * limbs, limbs, shift);
    sum += (axis ? corner % 2 : corner / 2) ? x : -x;
  }
  return sum > 0;
}

void piece_depth_changes(const struct piece *piece, int limbs, limb *out)
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
  piece_depth_changes(piece, wider, change);
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

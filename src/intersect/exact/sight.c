/* A patch as a ray sees it. See judge.h. */
#include "intersect/exact/judge.h"

#include "base/real.h"
#include "geometry/edges.h"
#include "intersect/local_ray.h"

/* ---- the ray's planes ---- */

/* Numbers as integers in units of 2^low. */
struct unit {
  int low, limbs; /* what a difference of two takes */
};

static struct unit unit_of(size_t count, const double x[])
{
  int low = INT32_MAX, high = INT32_MIN;
  for (size_t k = 0; k < count; k++) {
    int exponent;
    if (x[k] == 0) continue;
    (void)frexp(x[k], &exponent);
    low = exponent - 53 < low ? exponent - 53 : low, high = exponent > high ? exponent : high;
  }
  return high == INT32_MIN ? (struct unit){0, 1} : (struct unit){low, limbs_for(high - low + 1)};
}

/* Takes out the powers of two that all coefficients of a net have in common, and makes them as short as they can be. */
static void trim(struct piece *piece, int k)
{
  limb *net = piece->net[k];
  const int in = piece->limbs[k];
  int twos = INT32_MAX, bits = 0;
  for (int c = 0; c < 16; c++) {
    if (limbs_zero(net + c * in, in)) continue;
    const int here = limbs_twos(net + c * in), length = limbs_bits(net + c * in, in);
    twos = here < twos ? here : twos, bits = length > bits ? length : bits;
  }
  if (bits == 0) twos = 0;
  const int limbs = limbs_for(bits - twos);
  for (int c = 0; c < 16; c++) {
    limb x[PIECE_LIMBS_MAX];
    for (int n = 0; n < limbs; n++) x[n] = (limb)limbs_window(net + c * in, in, twos + LIMB_BITS * n);
    limbs_copy(net + c * limbs, limbs, x, limbs);
  }
  piece->limbs[k] = limbs, piece->exponent[k] += twos;
}

/* Sets y to the control points less the origin along an axis. Returns whether all are equal. */
static bool axis_make(double (*P)[4][3], double from, int axis, struct unit unit, limb *y)
{
  limb origin[PIECE_LIMBS_MAX];
  bool flat = true;
  limbs_double(origin, unit.limbs, from, unit.low);
  for (int c = 0; c < 16; c++) {
    limbs_double(y + c * unit.limbs, unit.limbs, P[c / 4][c % 4][axis], unit.low);
    limbs_subtract(y + c * unit.limbs, y + c * unit.limbs, origin, unit.limbs);
    flat &= P[c / 4][c % 4][axis] == P[0][0][axis];
  }
  return flat;
}

/* Sets only `plane` and `along`. */
static bool sight_plane(double (*P)[4][3], const struct ray *ray, struct pool *pool, struct sight *out)
{
  const double *d = ray->direction;
  struct piece *piece = &out->plane, both = {.net = {NULL}};
  limb *y[3], direction[3][PIECE_LIMBS_MAX];
  bool flat[3];
  double numbers[51];
  memcpy(numbers, P, 48 * sizeof *numbers), memcpy(numbers + 48, ray->origin, 3 * sizeof *numbers);
  const struct unit unit = unit_of(51, numbers), way = unit_of(3, d);
  if (unit.limbs > PIECE_LIMBS_MAX || way.limbs > PIECE_LIMBS_MAX) return false;
  *piece = (struct piece){.length = {1, 1}, .size = {1, 1}, .borders = 15};
  for (int axis = 0; axis < 3; axis++) {
    y[axis] = pool_net(pool, unit.limbs);
    if (!y[axis]) return false;
    flat[axis] = axis_make(P, ray->origin[axis], axis, unit, y[axis]);
    limbs_double(direction[axis], way.limbs, d[axis], way.low);
  }
  const int k = dominant_axis(d);
  for (int n = 0; n < 2; n++) {
    const int i = (k + 1 + n) % 3;
    for (int m = 0; m < 2; m++)
      both.net[m] = y[m ? k : i], both.limbs[m] = unit.limbs, both.bits[m] = LIMB_BITS * unit.limbs - 1;
    piece->net[n] = piece_combine(&both, (struct weight){direction[k], way.limbs},
                                  (struct weight){direction[i], way.limbs}, pool, &piece->limbs[n]);
    if (!piece->net[n]) return false;
    piece->exponent[n] = unit.low + way.low;
    trim(piece, n);
  }
  int depth = k; /* where the patch is flat across an axis, t is the same all over it */
  for (int axis = 0; axis < 3; axis++)
    if (flat[axis] && d[axis] != 0 && !flat[depth]) depth = axis;
  piece->net[NET_W] = y[depth], piece->limbs[NET_W] = unit.limbs, piece->exponent[NET_W] = unit.low;
  trim(piece, NET_W);
  out->along = d[depth];
  piece_measure(piece);
  return true;
}

/* ---- borders ---- */

static const limb *at_border(const struct piece *piece, int k, int border, int n)
{
  return piece->net[k] + edge_at(border, n) * piece->limbs[k];
}

static bool row_zero(const struct piece *piece, int k, int border)
{
  for (int n = 0; n < 4; n++)
    if (!limbs_zero(at_border(piece, k, border, n), piece->limbs[k])) return false;
  return true;
}

static double row_value(const struct piece *piece, int k, int border, int n)
{
  const int at = edge_at(border, n);
  return piece->value[k][at / 4][at % 4];
}

/* Whether the border's curve is on a line through the origin: all minors of its control values vanish. */
static bool on_line(const struct piece *piece, int border)
{
  limb one[2 * PIECE_LIMBS_MAX], two[2 * PIECE_LIMBS_MAX];
  const int limbs[2] = {piece->limbs[0], piece->limbs[1]}, both = limbs[0] + limbs[1];
  for (int n = 0; n < 4; n++) {
    for (int m = 0; m < n; m++) {
      const double minor = row_value(piece, 0, border, n) * row_value(piece, 1, border, m) -
                           row_value(piece, 0, border, m) * row_value(piece, 1, border, n);
      if (fabs(minor) > 8 * PIECE_ERROR) return false;
      limbs_product(one, both, at_border(piece, 0, border, n), limbs[0], at_border(piece, 1, border, m), limbs[1]);
      limbs_product(two, both, at_border(piece, 0, border, m), limbs[0], at_border(piece, 1, border, n), limbs[1]);
      if (memcmp(one, two, (size_t)both * sizeof *one) != 0) return false;
    }
  }
  return true;
}

/* Replaces a net that is zero along the border by 3 times its quotient by the distance from there, in the same degree:
 * in Bernstein form (c1, c2, c3) of u (c1 3 s^2 + c2 3 s u + c3 u^2) is (3 c1, 3/2 c2, c3) of degree 2. */
static bool divide(struct piece *piece, int k, int border, struct pool *pool)
{
  const int in = piece->limbs[k], limbs = in + 1, inward = edge_inward(border);
  limb *out = pool_net(pool, limbs);
  if (!out) return false;
  static const limb weight[4][2] = {{9, 0}, {3, 3}, {3, 1}, {0, 3}};
  for (int c = 0; c < 16; c++) {
    const int n = c / 4, row = c % 4, at = edge_at(border, n) + row * inward;
    const limb *from = piece->net[k] + (edge_at(border, n) + (row < 2 ? 1 : 2) * inward) * in;
    limb last[PIECE_LIMBS_MAX + 1];
    limbs_product(out + at * limbs, limbs, &weight[row][0], 1, from, in);
    limbs_product(last, limbs, &weight[row][1], 1, from + inward * in, in);
    limbs_add(out + at * limbs, out + at * limbs, last, limbs);
  }
  piece->net[k] = out, piece->limbs[k] = limbs;
  trim(piece, k);
  return true;
}

/* The pair whose roots are those of net `kept` on the border: its values there, wherever in the patch, and the distance
 * from the border. As in an exchange, exponents of a and b are not kept: only those of the plane count. */
static bool set_on(const struct piece *from, int kept, int border, struct pool *pool, struct piece *out)
{
  const int limbs = from->limbs[kept];
  *out = *from;
  out->net[NET_A] = pool_net(pool, limbs), out->limbs[NET_A] = limbs;
  out->net[NET_B] = pool_net(pool, 1), out->limbs[NET_B] = 1;
  if (!out->net[NET_A] || !out->net[NET_B]) return false;
  for (int n = 0; n < 4; n++) {
    for (int row = 0; row < 4; row++) {
      const int at = edge_at(border, n) + row * edge_inward(border);
      limbs_copy(out->net[NET_A] + at * limbs, limbs, at_border(from, kept, border, n), limbs);
      out->net[NET_B][at] = (limb)row;
    }
  }
  piece_measure(out);
  return true;
}

/* Exchanges the pair for the kept polynomial and the quotient, and lists the border. */
static bool exchange(struct sight *s, int border, struct pool *pool)
{
  struct piece *piece = &s->off;
  int kept = row_zero(piece, 0, border), largest = 0;
  for (int k = 0; k < 2; k++)
    for (int n = 0; n < 4; n++)
      if (fabs(row_value(piece, k, border, n)) > fabs(row_value(piece, kept, border, largest))) kept = k, largest = n;
  while (limbs_zero(at_border(piece, kept, border, largest), piece->limbs[kept])) largest++; /* of values of 0 */
  /* the combination b_p a - a_p b */
  int limbs;
  limb *net = piece_combine(piece, (struct weight){at_border(piece, 1, border, largest), piece->limbs[1]},
                            (struct weight){at_border(piece, 0, border, largest), piece->limbs[0]}, pool, &limbs);
  if (!net) return false;
  bool zero = true;
  for (int c = 0; c < 16 && zero; c++) zero = limbs_zero(net + c * limbs, limbs);
  s->border[s->borders] = border;
  if (!set_on(piece, kept, border, pool, &s->on[s->borders++])) return false;
  s->dependent |= zero; /* multiples of each other */
  if (!zero) {
    piece->net[NET_A] = piece->net[kept], piece->limbs[NET_A] = piece->limbs[kept];
    piece->net[NET_B] = net, piece->limbs[NET_B] = limbs;
    trim(piece, NET_B);
    do {
      if (!divide(piece, NET_B, border, pool)) return false;
    } while (row_zero(piece, NET_B, border));
    piece_measure(piece);
  }
  return true;
}

bool sight_make(double (*P)[4][3], const struct ray *ray, struct pool *pool, struct sight *out)
{
  *out = (struct sight){.borders = 0};
  if (!sight_plane(P, ray, pool, out)) return false;
  out->off = out->plane;
  out->dependent = out->plane.bits[0] == 0 && out->plane.bits[1] == 0; /* a curve or a point on the ray */
  for (int border = 0; border < 4 && !(out->plane.bits[0] == 0 && out->plane.bits[1] == 0); border++) {
    struct piece *piece = &out->off;
    while (row_zero(piece, 0, border) && row_zero(piece, 1, border)) {
      if (!divide(piece, 0, border, pool) || !divide(piece, 1, border, pool)) return false;
      out->met |= 1u << border;
      piece_measure(piece);
    }
    if (on_line(piece, border) && !exchange(out, border, pool)) return false;
  }
  /* If an exchange made a and b multiples of each other, the borders before it are on lines, too. */
  for (int border = 0; border < 4 && out->dependent && out->borders > 0; border++) {
    bool listed = false;
    for (int k = 0; k < out->borders; k++) listed |= out->border[k] == border;
    if (!listed && on_line(&out->off, border) && !exchange(out, border, pool)) return false;
  }
  return true;
}

/* Zeros of two bicubic functions by hull subdivision, preconditioning and Krawczyk's test. See reference.h. */
#include "reference/reference.h"

#include <math.h>

enum { A, B, T, FUNCTIONS };

/* A box is cut anew in quadruple precision if the error bound of a combination that decides about it exceeds this share
 * of the combination's range: well before the error decides. */
#define SLACK_SHARE 0x1p-20

/* If ||I - Y J|| is at most this on a box, no two zeros are in it, and Newton's method contracts by it. */
#define CONTRACTION 0.5

/* A root may be outside its box by this share of the box (and by REFERENCE_BORDER at most). The contraction, proven for
 * the box, grows there by less than 6 x 4 x this. */
#define OVERHANG 0x1p-10

/* 24 + 36, and a margin for points slightly outside the square. */
#define VARIATION 64

enum { STACK_SIZE = 256, NEWTON_STEPS = 12 };

struct box {
  double u0, wu, v0, wv; /* dyadic: exact */
  double c[FUNCTIONS][4][4];
  double slack[FUNCTIONS]; /* bounds |c - exact| */
};

struct search {
  const double (*P)[4][3];
  const double *origin, *direction;
  double t_max;
  struct quad_net net[FUNCTIONS]; /* of the whole patch */
  double net_error[FUNCTIONS];
  struct search_result *out;
};

/* The planes of the ray: a and b are the components of direction x (P - origin) other than that along the axis k where
 * the direction is longest. So the planes meet at 60 degrees or more. */
static int longest_axis(const double d[3])
{
  int k = 0;
  for (int axis = 1; axis < 3; axis++)
    if (fabs(d[axis]) > fabs(d[k])) k = axis;
  return k;
}

/* Sets the nets of the whole patch. A coefficient is a sum of products of a difference (one rounding) with an exact
 * number: at most 4 roundings for a and b, and 8 for t, relative to the sum of the terms' sizes. */
static void set_nets(struct search *s)
{
  const double *d = s->direction;
  const int k = longest_axis(d), i = (k + 1) % 3, j = (k + 2) % 3;
  quad square = 0, size[FUNCTIONS] = {0};
  for (int axis = 0; axis < 3; axis++) square += (quad)d[axis] * d[axis];
  for (int row = 0; row < 4; row++) {
    for (int column = 0; column < 4; column++) {
      quad p[3];
      for (int axis = 0; axis < 3; axis++) p[axis] = (quad)s->P[row][column][axis] - s->origin[axis];
      s->net[A].c[row][column] = d[k] * p[i] - d[i] * p[k];
      s->net[B].c[row][column] = d[k] * p[j] - d[j] * p[k];
      s->net[T].c[row][column] = (d[0] * p[0] + d[1] * p[1] + d[2] * p[2]) / square;
      size[A] = quad_max(size[A], quad_abs(d[k] * p[i]) + quad_abs(d[i] * p[k]));
      size[B] = quad_max(size[B], quad_abs(d[k] * p[j]) + quad_abs(d[j] * p[k]));
      size[T] = quad_max(size[T], (quad_abs(d[0] * p[0]) + quad_abs(d[1] * p[1]) + quad_abs(d[2] * p[2])) / square);
    }
  }
  s->net_error[A] = 5 * QUAD_UNIT * (double)size[A];
  s->net_error[B] = 5 * QUAD_UNIT * (double)size[B];
  s->net_error[T] = 10 * QUAD_UNIT * (double)size[T];
}

/* Cuts the box from the nets of the patch. The slack is then one rounding of the coefficients in the box. */
static void box_cut(const struct search *s, struct box *box)
{
  for (int f = 0; f < FUNCTIONS; f++) {
    struct quad_net part;
    quad_net_restrict(&s->net[f], box->u0, box->wu, box->v0, box->wv, &part);
    double size = 0;
    for (int i = 0; i < 4; i++) {
      for (int j = 0; j < 4; j++) {
        box->c[f][i][j] = (double)part.c[i][j];
        size = fmax(size, fabs(box->c[f][i][j]));
      }
    }
    const double whole = (double)quad_net_magnitude(&s->net[f]);
    box->slack[f] = 1.01 * (DOUBLE_UNIT * size + s->net_error[f] + QUAD_RESTRICT_ROUNDOFFS * QUAD_UNIT * whole);
  }
}

/* Cuts a cubic in the middle. Each of the 3 levels is a rounded sum and an exact halving. */
static void halve(const double c[4], double low[4], double high[4])
{
  const double p01 = 0.5 * (c[0] + c[1]), p12 = 0.5 * (c[1] + c[2]), p23 = 0.5 * (c[2] + c[3]);
  const double p012 = 0.5 * (p01 + p12), p123 = 0.5 * (p12 + p23), middle = 0.5 * (p012 + p123);
  low[0] = c[0], low[1] = p01, low[2] = p012, low[3] = middle;
  high[0] = middle, high[1] = p123, high[2] = p23, high[3] = c[3];
}

static void box_split(const struct box *box, bool in_u, struct box *low, struct box *high)
{
  *low = *high = *box;
  if (in_u) {
    low->wu = high->wu = 0.5 * box->wu;
    high->u0 = box->u0 + low->wu;
  } else {
    low->wv = high->wv = 0.5 * box->wv;
    high->v0 = box->v0 + low->wv;
  }
  for (int f = 0; f < FUNCTIONS; f++) {
    double size = 0;
    for (int i = 0; i < 4; i++) {
      double line[4], first[4], second[4];
      for (int k = 0; k < 4; k++) line[k] = in_u ? box->c[f][k][i] : box->c[f][i][k];
      for (int k = 0; k < 4; k++) size = fmax(size, fabs(line[k]));
      halve(line, first, second);
      for (int k = 0; k < 4; k++) {
        *(in_u ? &low->c[f][k][i] : &low->c[f][i][k]) = first[k];
        *(in_u ? &high->c[f][k][i] : &high->c[f][i][k]) = second[k];
      }
    }
    low->slack[f] = high->slack[f] = box->slack[f] + 4 * DOUBLE_UNIT * size;
  }
}

static void net_range(const double c[4][4], double *low, double *high)
{
  *low = *high = c[0][0];
  for (int i = 0; i < 4; i++) {
    for (int j = 0; j < 4; j++) {
      *low = fmin(*low, c[i][j]);
      *high = fmax(*high, c[i][j]);
    }
  }
}

/* Whether a function with these coefficients, each known to `slack`, has no zero. Otherwise sets *blurred if the slack
 * is no longer small. */
static bool excludes_zero(const double c[4][4], double slack, bool *blurred)
{
  double low, high;
  net_range(c, &low, &high);
  if (low > slack || high < -slack) return true;
  if (slack > SLACK_SHARE * (high - low)) *blurred = true;
  return false;
}

/* The largest change of a and b from one coefficient to the next, along u and along v. */
static void box_variation(const struct box *box, double variation[2])
{
  variation[0] = variation[1] = 0;
  for (int f = A; f <= B; f++) {
    for (int i = 0; i < 4; i++) {
      for (int k = 0; k < 3; k++) {
        variation[0] = fmax(variation[0], fabs(box->c[f][k + 1][i] - box->c[f][k][i]));
        variation[1] = fmax(variation[1], fabs(box->c[f][i][k + 1] - box->c[f][i][k]));
      }
    }
  }
}

/* x a + y b as a net. Returns the bound on its error. */
static double combine(const struct box *box, double x, double y, double out[4][4])
{
  double size = 0;
  for (int i = 0; i < 4; i++) {
    for (int j = 0; j < 4; j++) {
      out[i][j] = x * box->c[A][i][j] + y * box->c[B][i][j];
      size = fmax(size, fabs(x * box->c[A][i][j]) + fabs(y * box->c[B][i][j]));
    }
  }
  return 1.01 * (fabs(x) * box->slack[A] + fabs(y) * box->slack[B] + 3 * DOUBLE_UNIT * size);
}

/* Mean derivatives over the box, in the box's own coordinates. */
static void mean_jacobian(const struct box *box, double J[2][2])
{
  for (int f = A; f <= B; f++) {
    double du = 0, dv = 0;
    for (int k = 0; k < 4; k++) {
      du += box->c[f][3][k] - box->c[f][0][k];
      dv += box->c[f][k][3] - box->c[f][k][0];
    }
    J[f][0] = du / 4;
    J[f][1] = dv / 4;
  }
}

static bool invert(double J[2][2], double Y[2][2])
{
  const double determinant = J[0][0] * J[1][1] - J[0][1] * J[1][0];
  if (!(fabs(determinant) > 0)) return false;
  Y[0][0] = J[1][1] / determinant;
  Y[0][1] = -J[0][1] / determinant;
  Y[1][0] = -J[1][0] / determinant;
  Y[1][1] = J[0][0] / determinant;
  return isfinite(Y[0][0]) && isfinite(Y[0][1]) && isfinite(Y[1][0]) && isfinite(Y[1][1]);
}

/* Bounds |dF/du - x| + |dF/dv - y| on the box; the derivatives' coefficients are 3 times differences. */
static double row_distance(const double F[4][4], double slack, double x, double y)
{
  double du = 0, dv = 0;
  for (int i = 0; i < 4; i++) {
    for (int k = 0; k < 3; k++) {
      du = fmax(du, fabs(3 * (F[k + 1][i] - F[k][i]) - x));
      dv = fmax(dv, fabs(3 * (F[i][k + 1] - F[i][k]) - y));
    }
  }
  return 1.01 * (du + dv) + 13 * slack;
}

static bool outside(quad x, double low, double width)
{
  const double overhang = fmin(REFERENCE_BORDER, OVERHANG * width);
  return x < (quad)low - overhang || x > (quad)low + width + overhang;
}

/* Newton's method in quadruple precision from the middle of the box, then Krawczyk's test: with Y = J(u,v)^-1, if ||I -
 * Y J|| <= 1/2 on the square of half-width r and |Y F(u,v)| <= r/2, exactly one zero is in it. The variation of J is
 * bounded by the second derivatives, which near the unit square are at most 24 M (uu, vv) and 36 M (uv). Returns false
 * if that proves no root, or if the root is not the box's. */
static bool prove_root(const struct search *s, const struct box *box, struct search_root *root)
{
  const quad middle_u = box->u0 + 0.5 * box->wu, middle_v = box->v0 + 0.5 * box->wv;
  quad u = middle_u, v = middle_v;
  double size[2], error[2];
  for (int f = A; f <= B; f++) {
    size[f] = (double)quad_net_magnitude(&s->net[f]);
    error[f] = s->net_error[f] + QUAD_JET_ROUNDOFFS * QUAD_UNIT * size[f];
  }
  for (int step = 0; step < NEWTON_STEPS; step++) {
    struct quad_jet a = quad_net_jet(&s->net[A], u, v), b = quad_net_jet(&s->net[B], u, v);
    const quad determinant = a.du * b.dv - a.dv * b.du;
    if (determinant == 0) return false;
    const quad du = (a.value * b.dv - b.value * a.dv) / determinant,
               dv = (b.value * a.du - a.value * b.du) / determinant;
    double Y[2][2] = {{(double)(b.dv / determinant), (double)(-a.dv / determinant)},
                      {(double)(-b.du / determinant), (double)(a.du / determinant)}};
    double rounding = 0, variation = 0;
    for (int row = 0; row < 2; row++) {
      rounding = fmax(rounding, fabs(Y[row][0]) * error[A] + fabs(Y[row][1]) * error[B]);
      variation = fmax(variation, fabs(Y[row][0]) * size[A] + fabs(Y[row][1]) * size[B]);
    }
    const double change = fmax(fabs((double)du), fabs((double)dv));
    double radius = 2.02 * (change + rounding);
    const bool contracts = 6 * rounding + 2 * VARIATION * variation * radius <= CONTRACTION && radius <= OVERHANG;
    if (contracts && (change <= 4 * rounding || step == NEWTON_STEPS - 1)) {
      struct quad_jet t = quad_net_jet(&s->net[T], u, v);
      const double whole = (double)quad_net_magnitude(&s->net[T]);
      *root = (struct search_root){.u = u, .v = v, .t = t.value, .radius = radius};
      root->t_radius = 1.01 * ((fabs((double)t.du) + fabs((double)t.dv)) * radius + s->net_error[T] +
                               (QUAD_JET_ROUNDOFFS * QUAD_UNIT + VARIATION * radius * radius) * whole);
      return !outside(u, box->u0, box->wu) && !outside(v, box->v0, box->wv);
    }
    u -= du;
    v -= dv;
    if (!(quad_abs(u - middle_u) < box->wu && quad_abs(v - middle_v) < box->wv)) return false; /* it leads elsewhere */
  }
  return false;
}

/* Neighbouring boxes both find a root on their common side. */
static void add_root(struct search_result *out, const struct search_root *root)
{
  for (int k = 0; k < out->count; k++) {
    const struct search_root *known = &out->root[k];
    const double reach = 4 * (known->radius + root->radius);
    if (quad_abs(known->u - root->u) <= reach && quad_abs(known->v - root->v) <= reach) return;
  }
  if (out->count == SEARCH_MAX_ROOTS) { /* more than the 18 that are possible without a curve in common */
    out->undecided = true;
    out->t_undecided = -INFINITY;
    return;
  }
  out->root[out->count++] = *root;
}

static void give_up(struct search *s, const struct box *box)
{
  double low, high;
  net_range(box->c[T], &low, &high);
  s->out->undecided = true;
  s->out->t_undecided = fmin(s->out->t_undecided, low - box->slack[T]);
}

/* Whether the box is done: it has no zero, or its only one is known. Otherwise *blurred says that rounding may be the
 * reason. */
static bool settle(struct search *s, const struct box *box, bool *blurred)
{
  *blurred = false;
  double low, high;
  net_range(box->c[T], &low, &high);
  if (low - box->slack[T] > s->t_max || high + box->slack[T] < 0) return true;
  bool ignored;
  for (int f = A; f <= B; f++)
    if (excludes_zero(box->c[f], box->slack[f], &ignored)) return true;

  double J[2][2], Y[2][2], F[2][4][4], slack[2];
  mean_jacobian(box, J);
  /* The combinations along the left singular vectors of J. Near a tangency, one of them varies only quadratically. */
  const double angle = 0.5 * atan2(2 * (J[0][0] * J[1][0] + J[0][1] * J[1][1]),
                                   J[0][0] * J[0][0] + J[0][1] * J[0][1] - J[1][0] * J[1][0] - J[1][1] * J[1][1]);
  const double cosine = cos(angle), sine = sin(angle);
  slack[0] = combine(box, cosine, sine, F[0]);
  slack[1] = combine(box, -sine, cosine, F[1]);
  if (excludes_zero(F[0], slack[0], blurred) || excludes_zero(F[1], slack[1], blurred)) return true;

  if (!invert(J, Y)) return false;
  for (int row = 0; row < 2; row++) {
    slack[row] = combine(box, Y[row][0], Y[row][1], F[row]);
    if (excludes_zero(F[row], slack[row], blurred)) return true;
  }
  if (row_distance(F[0], slack[0], 1, 0) > CONTRACTION) return false;
  if (row_distance(F[1], slack[1], 0, 1) > CONTRACTION) return false;

  struct search_root root;
  if (!prove_root(s, box, &root)) return false;
  add_root(s->out, &root);
  return true;
}

void search_patch(const double P[4][4][3], const double origin[3], const double direction[3], double t_max,
                  struct search_result *out)
{
  struct search s = {.P = P, .origin = origin, .direction = direction, .t_max = t_max, .out = out};
  *out = (struct search_result){.t_undecided = INFINITY};
  struct box stack[STACK_SIZE];
  int depth = 1, visited = 0;
  set_nets(&s);
  stack[0] = (struct box){.wu = 1, .wv = 1};
  box_cut(&s, &stack[0]);
  while (depth > 0) {
    struct box box = stack[--depth];
    bool blurred;
    if (settle(&s, &box, &blurred)) continue;
    if (blurred) {
      box_cut(&s, &box);
      if (settle(&s, &box, &blurred)) continue;
    }
    double variation[2];
    box_variation(&box, variation);
    const bool small_u = box.wu <= REFERENCE_SMALLEST_BOX, small_v = box.wv <= REFERENCE_SMALLEST_BOX;
    if ((small_u && small_v) || ++visited > SEARCH_BUDGET || depth + 2 > STACK_SIZE) {
      give_up(&s, &box);
      continue;
    }
    const bool in_u = small_v || (!small_u && variation[0] >= variation[1]);
    struct box low, high;
    box_split(&box, in_u, &low, &high);
    stack[depth++] = high;
    stack[depth++] = low;
  }
}

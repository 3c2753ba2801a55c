/* The search of subdivide.c, for one number type.
 *
 * Included once per type: SEARCH_REAL is the type, SEARCH_NAME makes its names, SEARCH_ROUNDOFF its unit roundoff,
 * SEARCH_RESOLUTION the fraction of the leaf's extent along the ray below which an undecidable box is not halved further,
 * SEARCH_HALVINGS how often a box may halve in all, SEARCH_BOXES how many boxes may be looked at, SEARCH_LAST whether a box that can
 * not be decided ends it.
 */
#define REAL SEARCH_REAL
#define NAME SEARCH_NAME

struct NAME(box) {
  REAL net[3][4][4];         /* a, b, w */
  REAL u, v, size_u, size_v; /* in leaf parameters */
  double near, far;          /* hull of t */
  int halvings;
};

struct NAME(search) {
  const struct leaf *leaf;
  REAL start[2], to_t; /* t = ((w + start[1]) + start[0]) to_t */
  REAL error;          /* bound on the error of a net's coefficient before any halving */
  double t_min, t_max, resolution;
  bool found;
  bool hopeless; /* the last search met a box it can not decide; what it has found means nothing */
  bool edge_on; /* the root found is undecided in one direction only: a tangency or a curve of roots, not a point of the net */
  double best_t;
  struct leaf_hit best;
};

static REAL NAME(abs)(REAL a) { return a < 0 ? -a : a; }
static REAL NAME(min)(REAL a, REAL b) { return a < b ? a : b; }
static REAL NAME(max)(REAL a, REAL b) { return a > b ? a : b; }

struct NAME(jet) {
  REAL value, du, dv;
};

static void NAME(weights)(REAL t, REAL w[4], REAL dw[4])
{
  const REAL s = 1 - t, ss = s * s, tt = t * t, st = s * t;
  w[0] = ss * s, w[1] = 3 * ss * t, w[2] = 3 * st * t, w[3] = tt * t;
  dw[0] = -3 * ss, dw[1] = 3 * (ss - 2 * st), dw[2] = 3 * (2 * st - tt), dw[3] = 3 * tt;
}

static struct NAME(jet) NAME(evaluate)(REAL net[4][4], REAL u, REAL v)
{
  REAL wu[4], du[4], wv[4], dv[4];
  NAME(weights)(u, wu, du);
  NAME(weights)(v, wv, dv);
  struct NAME(jet) jet = {0, 0, 0};
  for (int i = 0; i < 4; i++) {
    REAL row = 0, row_dv = 0;
    for (int j = 0; j < 4; j++) row += net[i][j] * wv[j], row_dv += net[i][j] * dv[j];
    jet.value += wu[i] * row, jet.du += du[i] * row, jet.dv += wu[i] * row_dv;
  }
  return jet;
}

static double NAME(place_to_t)(const struct NAME(search) *s, REAL w)
{
  return (double)(((w + s->start[1]) + s->start[0]) * s->to_t);
}

/* The bound on rounding in a coefficient of the box's nets: each halving adds three additions on values of the leaf's size. */
static REAL NAME(box_error)(const struct NAME(search) *s, const struct NAME(box) *box)
{
  return s->error + box->halvings * 4 * SEARCH_ROUNDOFF;
}

static void NAME(box_place)(const struct NAME(search) *s, struct NAME(box) *box)
{
  REAL lo = box->net[2][0][0], hi = lo;
  for (int n = 1; n < 16; n++)
    lo = NAME(min)(lo, box->net[2][n / 4][n % 4]), hi = NAME(max)(hi, box->net[2][n / 4][n % 4]);
  const double p = NAME(place_to_t)(s, lo), q = NAME(place_to_t)(s, hi);
  box->near = real_min(p, q), box->far = real_max(p, q);
}

/* Where p a + q b stands on the box: its hull in units of its error bound. */
static void NAME(combination)(struct NAME(box) *box, REAL p, REAL q, REAL error, REAL out[2])
{
  const REAL unit = 1 / ((NAME(abs)(p) + NAME(abs)(q)) * (error + SEARCH_ROUNDOFF * 4));
  for (int n = 0; n < 16; n++) {
    const REAL value = (p * box->net[0][n / 4][n % 4] + q * box->net[1][n / 4][n % 4]) * unit;
    out[0] = n ? NAME(min)(out[0], value) : value, out[1] = n ? NAME(max)(out[1], value) : value;
  }
}

/* Tries the combinations a, b and the two rows of the adjugate Jacobian in the middle, which aim along the parameters, or, where
 * the Jacobian is singular, at the one direction in which the surface is seen edge-on. */
static enum verdict NAME(box_test)(struct NAME(box) *box, REAL error)
{
  const struct NAME(jet) a = NAME(evaluate)(box->net[0], (REAL)0.5, (REAL)0.5);
  const struct NAME(jet) b = NAME(evaluate)(box->net[1], (REAL)0.5, (REAL)0.5);
  const REAL rows[4][2] = {{1, 0}, {0, 1}, {b.dv, -a.dv}, {-b.du, a.du}};
  bool flat = false, steep = false;
  for (int k = 0; k < 4; k++) {
    if (rows[k][0] == 0 && rows[k][1] == 0) continue;
    REAL range[2] = {0, 0};
    NAME(combination)(box, rows[k][0], rows[k][1], error, range);
    if (range[0] > 1 || range[1] < -1) return VERDICT_EMPTY;
    if (range[0] > -FLAT_ERRORS && range[1] < FLAT_ERRORS) flat = true;
    else steep = true;
  }
  return !flat ? VERDICT_OPEN : steep ? VERDICT_FLAT : VERDICT_POINT;
}

/* The largest |(p a + q b)''| of each kind on the box. */
static void NAME(second_bounds)(struct NAME(box) *box, REAL p, REAL q, REAL out[3])
{
  REAL n[4][4];
  for (int k = 0; k < 16; k++) n[k / 4][k % 4] = p * box->net[0][k / 4][k % 4] + q * box->net[1][k / 4][k % 4];
  out[0] = out[1] = out[2] = 0;
  for (int i = 0; i < 4; i++) {
    for (int j = 0; j < 4; j++) {
      if (i < 2) out[0] = NAME(max)(out[0], 6 * NAME(abs)(n[i + 2][j] - 2 * n[i + 1][j] + n[i][j]));
      if (i < 3 && j < 3) out[1] = NAME(max)(out[1], 9 * NAME(abs)(n[i + 1][j + 1] - n[i + 1][j] - n[i][j + 1] + n[i][j]));
      if (j < 2) out[2] = NAME(max)(out[2], 6 * NAME(abs)(n[i][j + 2] - 2 * n[i][j + 1] + n[i][j]));
    }
  }
}

/* Newton from the middle, then the test of refine.h in the box's own parameters, with the second derivatives of the plane
 * polynomials themselves. Writes the root in box parameters with its radii; returns whether it is proven and alone. */
static bool NAME(box_solve)(struct NAME(box) *box, REAL error, REAL root[2], REAL radius[2])
{
  REAL u = (REAL)0.5, v = (REAL)0.5, step = 2, m[2][2] = {{0}};
  for (int n = 0; n < 12 && step > LAST_STEP; n++) {
    const struct NAME(jet) a = NAME(evaluate)(box->net[0], u, v), b = NAME(evaluate)(box->net[1], u, v);
    const REAL determinant = a.du * b.dv - a.dv * b.du;
    if (determinant == 0) return false;
    const REAL inverse = 1 / determinant;
    m[0][0] = b.dv * inverse, m[0][1] = -a.dv * inverse, m[1][0] = -b.du * inverse, m[1][1] = a.du * inverse;
    const REAL su = m[0][0] * a.value + m[0][1] * b.value, sv = m[1][0] * a.value + m[1][1] * b.value;
    step = NAME(max)(NAME(abs)(su), NAME(abs)(sv));
    u -= su, v -= sv;
    if (!(NAME(abs)(u - (REAL)0.5) < 2 && NAME(abs)(v - (REAL)0.5) < 2)) return false;
  }
  if (!(step <= LAST_STEP)) return false;
  const REAL out_u = NAME(max)(-u, u - 1), out_v = NAME(max)(-v, v - 1);
  if (!(out_u < BOX_MARGIN && out_v < BOX_MARGIN)) return false;
  const REAL growth = out_u > 0 || out_v > 0 ? BOX_MARGIN_GROWTH : 1;
  const REAL reach_u = (REAL)0.5 + NAME(abs)(u - (REAL)0.5), reach_v = (REAL)0.5 + NAME(abs)(v - (REAL)0.5);
  REAL lipschitz = 0, q = 0, size = 0;
  for (int k = 0; k < 2; k++) {
    REAL s[3];
    NAME(second_bounds)(box, m[k][0], m[k][1], s);
    lipschitz = NAME(max)(lipschitz, growth * (s[0] + 2 * s[1] + s[2]));
    q = NAME(max)(q, growth * ((s[0] + s[1]) * reach_u + (s[1] + s[2]) * reach_v));
    radius[k] = 2 * (NAME(abs)(m[k][0]) + NAME(abs)(m[k][1])) * error;
    size = NAME(max)(size, radius[k] / 2);
  }
  for (int k = 0; k < 2; k++) radius[k] += 2 * lipschitz * step * step;
  root[0] = u, root[1] = v;
  return lipschitz * (step + size) <= 0.125 && q < 1.9;
}

static void NAME(offer)(struct NAME(search) *s, const struct leaf_hit *hit, bool edge_on)
{
  const double t = hit->t;
  /* As the packet judges it: a root it would refuse at t_min must not stand in the way of the next one. */
  if (!(t > s->t_min + hit->t_error && t < s->t_max) || (s->found && t >= s->best_t)) return;
  s->found = true, s->best_t = t, s->best = *hit, s->edge_on = edge_on;
}

/* Offers the box's root, where it lies in the leaf; one just outside the box is the neighbour's as well, and the same. */
static void NAME(box_offer)(struct NAME(search) *s, struct NAME(box) *box, const REAL root[2], const REAL radius[2])
{
  const REAL u = box->u + box->size_u * root[0], v = box->v + box->size_v * root[1];
  const REAL radius_u = radius[0] * box->size_u + SEARCH_ROUNDOFF, radius_v = radius[1] * box->size_v + SEARCH_ROUNDOFF;
  if (u < -radius_u || u > 1 + radius_u || v < -radius_v || v > 1 + radius_v) return;
  const REAL w = NAME(evaluate)(box->net[2], root[0], root[1]).value;
  struct leaf_hit hit = {(double)u, (double)v, (double)radius_u, (double)radius_v,
                               (double)w, NAME(place_to_t)(s, w), 0, true};
  hit.t_error = leaf_hit_t_error(s->leaf, &hit, (double)s->to_t);
  NAME(offer)(s, &hit, false);
}

/* Offers the middle of a box that cannot be decided. */
static void NAME(box_offer_undecided)(struct NAME(search) *s, struct NAME(box) *box, bool edge_on)
{
  if (SEARCH_LAST) {
    s->hopeless = true;
    return;
  }
  const REAL w = NAME(evaluate)(box->net[2], (REAL)0.5, (REAL)0.5).value;
  const double t = NAME(place_to_t)(s, w), error = box->far - box->near + 8 * UNIT_ROUNDOFF * fabs(t);
  const struct leaf_hit hit = {(double)(box->u + box->size_u / 2), (double)(box->v + box->size_v / 2), (double)box->size_u,
                               (double)box->size_v, (double)w, t, error, false};
  NAME(offer)(s, &hit, edge_on);
}

static void NAME(cubic_halves)(const REAL *c, int stride, REAL *low, REAL *high)
{
  const REAL half = (REAL)0.5, c1 = c[stride], c2 = c[2 * stride];
  const REAL q0 = half * (c[0] + c1), q1 = half * (c1 + c2), q2 = half * (c2 + c[3 * stride]);
  const REAL r0 = half * (q0 + q1), r1 = half * (q1 + q2);
  low[0] = c[0], low[stride] = q0, low[2 * stride] = r0;
  low[3 * stride] = high[0] = half * (r0 + r1);
  high[stride] = r1, high[2 * stride] = q2, high[3 * stride] = c[3 * stride];
}

/* The largest change of the nets first..last from one coefficient to the next, along u and along v. */
static void NAME(variation)(const struct NAME(box) *box, int first, int last, REAL *along_u, REAL *along_v)
{
  *along_u = *along_v = 0;
  for (int k = first; k <= last; k++) {
    for (int i = 0; i < 4; i++) {
      for (int j = 0; j < 3; j++) {
        *along_v = NAME(max)(*along_v, NAME(abs)(box->net[k][i][j + 1] - box->net[k][i][j]));
        *along_u = NAME(max)(*along_u, NAME(abs)(box->net[k][j + 1][i] - box->net[k][j][i]));
      }
    }
  }
}

/* Halves across the parameter along which the box is longer as seen along the ray, for that is what hull tests and Newton's
 * process need: at a tangency boxes get long along the ray and narrow across it. Where it is seen as a point, across the one along
 * which it is longer on the ray. */
static void NAME(box_halve)(const struct NAME(search) *s, struct NAME(box) *box, struct NAME(box) out[2])
{
  REAL along_u, along_v;
  NAME(variation)(box, 0, 1, &along_u, &along_v);
  if (NAME(max)(along_u, along_v) <= FLAT_ERRORS * NAME(box_error)(s, box)) NAME(variation)(box, 2, 2, &along_u, &along_v);
  const bool across_u = along_u == along_v ? box->size_u >= box->size_v : along_u > along_v;
  for (int h = 0; h < 2; h++) {
    out[h].u = box->u, out[h].v = box->v, out[h].size_u = box->size_u, out[h].size_v = box->size_v;
    if (across_u) out[h].size_u /= 2, out[h].u += h * out[h].size_u;
    else out[h].size_v /= 2, out[h].v += h * out[h].size_v;
    out[h].halvings = box->halvings + 1;
  }
  for (int k = 0; k < 3; k++)
    for (int n = 0; n < 4; n++)
      if (across_u) NAME(cubic_halves)(&box->net[k][0][n], 4, &out[0].net[k][0][n], &out[1].net[k][0][n]);
      else NAME(cubic_halves)(box->net[k][n], 1, out[0].net[k][n], out[1].net[k][n]);
  for (int h = 0; h < 2; h++) NAME(box_place)(s, &out[h]);
}

/* Whether the box lies at a border of the leaf that is one point, or so near to it that it is one in double precision. */
static bool NAME(box_has_pole)(const struct NAME(search) *s, const struct NAME(box) *box)
{
  const bool at[4] = {box->u == 0 || box->u + box->size_u <= POLE_REACH, box->u + box->size_u == 1 || box->u >= 1 - POLE_REACH,
                      box->v == 0 || box->v + box->size_v <= POLE_REACH, box->v + box->size_v == 1 || box->v >= 1 - POLE_REACH};
  for (int border = 0; border < 4; border++) {
    const int first = border == 1 ? 12 : border == 3 ? 3 : 0, stride = border < 2 ? 1 : 4;
    bool equal = at[border];
    for (int c = 0; equal && c < 3; c++)
      for (int n = 1; n < 4; n++) equal &= s->leaf->x[c][first + n * stride] == s->leaf->x[c][first];
    if (equal) return true;
  }
  return false;
}

/* Decides the box: true where nothing is left to do with it. */
static bool NAME(box_decide)(struct NAME(search) *s, struct NAME(box) *box)
{
  if (box->near >= s->t_max || box->far <= s->t_min || (s->found && box->near >= s->best_t)) return true;
  const REAL error = NAME(box_error)(s, box);
  const enum verdict verdict = NAME(box_test)(box, error);
  if (verdict == VERDICT_EMPTY) return true;
  if (SEARCH_LAST && verdict == VERDICT_FLAT) s->hopeless = true;
  REAL root[2], radius[2];
  if (verdict == VERDICT_OPEN && NAME(box_solve)(box, error, root, radius)) {
    NAME(box_offer)(s, box, root, radius);
    return true;
  }
  if ((verdict != VERDICT_OPEN && box->far - box->near <= s->resolution) || box->halvings >= SEARCH_HALVINGS) {
    /* At a pole there is no more to be had in wide arithmetic: the edge is as degenerate there. */
    NAME(box_offer_undecided)(s, box, !NAME(box_has_pole)(s, box));
    return true;
  }
  return false;
}

/* Searches the box `whole`, whose nets, and the search's start, to_t, error, t_min and t_max are set. */
static void NAME(run)(struct NAME(search) *s, const struct NAME(box) *whole)
{
  struct NAME(box) stack[SEARCH_HALVINGS + 2];
  stack[0] = *whole;
  NAME(box_place)(s, &stack[0]);
  s->resolution = real_max((stack[0].far - stack[0].near) * SEARCH_RESOLUTION,
                           8 * UNIT_ROUNDOFF * real_max(fabs(stack[0].near), fabs(stack[0].far)));
  int top = 1;
  for (int n = 0; top > 0; n++) {
    struct NAME(box) box = stack[--top];
    const bool decided = NAME(box_decide)(s, &box);
    if (s->hopeless) return;
    if (decided) continue;
    if (n >= SEARCH_BOXES) {
      NAME(box_offer_undecided)(s, &box, true);
      return;
    }
    struct NAME(box) half[2];
    NAME(box_halve)(s, &box, half);
    const int nearer = half[1].near < half[0].near;
    stack[top++] = half[!nearer];
    stack[top++] = half[nearer];
  }
}

#undef REAL
#undef NAME
#undef SEARCH_REAL
#undef SEARCH_NAME
#undef SEARCH_ROUNDOFF
#undef SEARCH_RESOLUTION
#undef SEARCH_HALVINGS
#undef SEARCH_BOXES
#undef SEARCH_LAST

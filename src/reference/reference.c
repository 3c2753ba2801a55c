/* The closest hit over a list of patches, classified; the search inside a patch is search.c. See reference.h. */
#include "reference/reference.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "reference/search.h"

struct patch {
  double P[4][4][3];
  double low[3], high[3];
};

struct reference {
  size_t count;
  struct patch *patches;
};

enum { MAX_CANDIDATES = 128, FOOT_STEPS = 6 };

/* A zero found on a patch. */
struct candidate {
  struct search_root root;
  uint32_t patch;
  bool border; /* within REFERENCE_BORDER of the border */
  bool inside; /* not proven to be outside [0,1]^2 */
};

struct candidates {
  int count;
  struct candidate list[MAX_CANDIDATES];
  bool undecided;
  double t_undecided;
};

struct reference *reference_create(const double (*P)[4][4][3], size_t count)
{
  struct reference *reference = calloc(1, sizeof *reference);
  if (!reference) return NULL;
  reference->patches = calloc(count ? count : 1, sizeof *reference->patches);
  if (!reference->patches) {
    free(reference);
    return NULL;
  }
  reference->count = count;
  for (size_t n = 0; n < count; n++) {
    struct patch *patch = &reference->patches[n];
    memcpy(patch->P, P[n], sizeof patch->P);
    for (int axis = 0; axis < 3; axis++) {
      patch->low[axis] = INFINITY;
      patch->high[axis] = -INFINITY;
      for (int k = 0; k < 16; k++) {
        patch->low[axis] = fmin(patch->low[axis], P[n][k / 4][k % 4][axis]);
        patch->high[axis] = fmax(patch->high[axis], P[n][k / 4][k % 4][axis]);
      }
    }
  }
  return reference;
}

void reference_destroy(struct reference *reference)
{
  if (!reference) return;
  free(reference->patches);
  free(reference);
}

/* The slab test on the box of the control points, widened by its rounding errors: a difference and a quotient, 3
 * units each way. Where the ray meets the box it enters it at `out_t` or later. */
static bool patch_box_met(const struct patch *patch, const double origin[3], const double direction[3], double *out_t)
{
  double enter = 0, leave = INFINITY;
  for (int axis = 0; axis < 3; axis++) {
    double low = patch->low[axis] - origin[axis], high = patch->high[axis] - origin[axis];
    if (direction[axis] == 0) {
      if (low > 0 || high < 0) return false; /* the sign of a rounded difference is exact */
      continue;
    }
    double near = low / direction[axis], far = high / direction[axis];
    if (near > far) {
      double swap = near;
      near = far;
      far = swap;
    }
    enter = fmax(enter, near - 4 * DOUBLE_UNIT * fabs(near));
    leave = fmin(leave, far + 4 * DOUBLE_UNIT * fabs(far));
  }
  *out_t = enter;
  return enter <= leave;
}

/* Where x lies beside [0,1], known to `radius`. */
static void judge_parameter(quad x, double radius, bool *border, bool *inside)
{
  quad within = x < (quad)0.5 ? x : 1 - x; /* distance to the nearer end, negative outside */
  if (within < REFERENCE_BORDER) *border = true;
  if (within < -(quad)radius) *inside = false;
}

/* The nearest candidate inside its patch and away from the border; -1 for none. */
static int nearest_plain(const struct candidates *all)
{
  int best = -1;
  for (int n = 0; n < all->count; n++) {
    if (all->list[n].border) continue;
    if (best < 0 || all->list[n].root.t < all->list[best].root.t) best = n;
  }
  return best;
}

static int nearest_border(const struct candidates *all)
{
  int best = -1;
  for (int n = 0; n < all->count; n++) {
    if (!all->list[n].border) continue;
    if (best < 0 || all->list[n].root.t < all->list[best].root.t) best = n;
  }
  return best;
}

static bool same_point(const struct candidate *x, const struct candidate *y)
{
  return quad_abs(x->root.t - y->root.t) <= REFERENCE_SAME_POINT * quad_max(quad_abs(x->root.t), quad_abs(y->root.t));
}

static void collect(const struct reference *reference, const double origin[3], const double direction[3],
                    struct candidates *all)
{
  all->count = 0;
  all->undecided = false;
  all->t_undecided = INFINITY;
  double t_max = INFINITY; /* a proven hit, beyond which nothing matters */
  for (size_t n = 0; n < reference->count; n++) {
    const struct patch *patch = &reference->patches[n];
    double enter;
    if (!patch_box_met(patch, origin, direction, &enter) || enter > t_max) continue;
    struct search_result found;
    search_patch(patch->P, origin, direction, t_max, &found);
    if (found.undecided) {
      all->undecided = true;
      all->t_undecided = fmin(all->t_undecided, found.t_undecided);
    }
    double size = 0; /* for REFERENCE_ORIGIN */
    for (int axis = 0; axis < 3; axis++)
      size = fmax(size, fmax(fabs(origin[axis]), fmax(fabs(patch->low[axis]), fabs(patch->high[axis]))));
    double length = sqrt(direction[0] * direction[0] + direction[1] * direction[1] + direction[2] * direction[2]);
    double at_origin = REFERENCE_ORIGIN * size / length;
    for (int k = 0; k < found.count; k++) {
      struct candidate c = {.root = found.root[k], .patch = (uint32_t)n, .inside = true};
      judge_parameter(c.root.u, c.root.radius, &c.border, &c.inside);
      judge_parameter(c.root.v, c.root.radius, &c.border, &c.inside);
      if (c.root.t < -(quad)at_origin || (!c.inside && !c.border)) continue;
      if (c.root.t < at_origin || all->count == MAX_CANDIDATES) {
        all->undecided = true;
        all->t_undecided = fmin(all->t_undecided, 0);
        continue;
      }
      all->list[all->count++] = c;
      if (!c.border) t_max = fmin(t_max, (double)c.root.t * (1 + 2 * REFERENCE_SAME_POINT));
    }
  }
}

/* out = x, y, z components of M^-1's absolute values times terms, in double from a quadruple-precision inverse. */
static void floor_bound(quad M[3][3], const double terms[3], double t, double u, double v, struct reference_floor *out)
{
  quad determinant = 0;
  for (int k = 0; k < 3; k++)
    determinant += M[0][k] * (M[1][(k + 1) % 3] * M[2][(k + 2) % 3] - M[1][(k + 2) % 3] * M[2][(k + 1) % 3]);
  double moved[3] = {0};
  for (int row = 0; row < 3; row++) {
    for (int column = 0; column < 3; column++) {
      int r1 = (column + 1) % 3, r2 = (column + 2) % 3, c1 = (row + 1) % 3, c2 = (row + 2) % 3;
      quad cofactor = M[r1][c1] * M[r2][c2] - M[r1][c2] * M[r2][c1];
      moved[row] += fabs((double)(cofactor / determinant)) * terms[column];
    }
  }
  out->u = DOUBLE_UNIT * (moved[0] + fabs(u));
  out->v = DOUBLE_UNIT * (moved[1] + fabs(v));
  out->t = DOUBLE_UNIT * (moved[2] + fabs(t));
}

static void describe(const struct reference *reference, const struct candidate *c, const double origin[3],
                     const double direction[3], struct reference_answer *out)
{
  const struct patch *patch = &reference->patches[c->patch];
  out->patch = c->patch;
  out->t = c->root.t;
  out->u = c->root.u;
  out->v = c->root.v;
  out->radius = c->root.radius;
  out->t_radius = c->root.t_radius;
  quad M[3][3], point[3], normal[3];
  double data[3], local[3], whole[3];
  for (int axis = 0; axis < 3; axis++) {
    struct quad_net net, sizes, spread;
    for (int k = 0; k < 16; k++) net.c[k / 4][k % 4] = patch->P[k / 4][k % 4][axis];
    struct quad_jet jet = quad_net_jet(&net, out->u, out->v);
    for (int k = 0; k < 16; k++) {
      sizes.c[k / 4][k % 4] = quad_abs(net.c[k / 4][k % 4]);
      spread.c[k / 4][k % 4] = quad_abs(net.c[k / 4][k % 4] - jet.value);
    }
    point[axis] = jet.value;
    M[axis][0] = jet.du;
    M[axis][1] = jet.dv;
    M[axis][2] = -(quad)direction[axis];
    data[axis] = (double)quad_net_jet(&sizes, out->u, out->v).value + fabs(origin[axis]) +
                 fabs((double)out->t * direction[axis]);
    local[axis] = (double)quad_net_jet(&spread, out->u, out->v).value;
    whole[axis] = (double)quad_net_magnitude(&spread);
  }
  floor_bound(M, data, (double)out->t, (double)out->u, (double)out->v, &out->data);
  floor_bound(M, local, (double)out->t, (double)out->u, (double)out->v, &out->local);
  floor_bound(M, whole, (double)out->t, (double)out->u, (double)out->v, &out->whole);

  quad square = 0, along = 0, length = 0, tangents[2] = {0};
  for (int axis = 0; axis < 3; axis++) {
    int i = (axis + 1) % 3, j = (axis + 2) % 3;
    normal[axis] = M[i][0] * M[j][1] - M[j][0] * M[i][1];
    square += normal[axis] * normal[axis];
    along += normal[axis] * direction[axis];
    length += (quad)direction[axis] * direction[axis];
    for (int k = 0; k < 2; k++) tangents[k] += M[axis][k] * M[axis][k];
  }
  (void)point;
  quad norm = quad_sqrt(square);
  out->has_normal = norm > (quad)0x1p-60 * quad_max(tangents[0], tangents[1]);
  out->incidence = out->has_normal ? (double)(quad_abs(along) / (norm * quad_sqrt(length))) : 0;
  for (int axis = 0; axis < 3; axis++)
    out->normal[axis] = out->has_normal ? (double)((along > 0 ? -normal[axis] : normal[axis]) / norm) : 0;
}

void reference_closest(const struct reference *reference, const double origin[3], const double direction[3],
                       struct reference_answer *out)
{
  struct candidates all;
  collect(reference, origin, direction, &all);
  *out = (struct reference_answer){.verdict = REFERENCE_MISS, .t_first = INFINITY, .patch = REFERENCE_NONE};

  int answer = nearest_plain(&all), border = nearest_border(&all);
  if (answer >= 0) {
    out->verdict = REFERENCE_HIT;
    out->t_first = (double)all.list[answer].root.t;
  }
  if (border >= 0) {
    const struct candidate *first = &all.list[border];
    bool sooner = answer < 0 || first->root.t < all.list[answer].root.t;
    if (sooner && !(answer >= 0 && same_point(first, &all.list[answer]))) {
      int members = 0, inside = -1;
      for (int n = 0; n < all.count; n++) {
        if (!all.list[n].border || !same_point(first, &all.list[n])) continue;
        members++;
        if (all.list[n].inside && inside < 0) inside = n;
      }
      out->t_first = (double)first->root.t;
      if (members > 1 && inside >= 0) {
        out->verdict = REFERENCE_HIT;
        out->shared = true;
        answer = inside;
      } else {
        out->verdict = REFERENCE_GRAZING;
      }
    }
  }
  if (all.undecided && all.t_undecided <= out->t_first) {
    out->verdict = REFERENCE_GRAZING;
    out->t_first = fmax(0, all.t_undecided);
  }
  if (answer >= 0) describe(reference, &all.list[answer], origin, direction, out);
}

void reference_floors_at(const struct reference *reference, uint32_t patch, const double origin[3],
                         const double direction[3], double t, double u, double v, struct reference_floor *out_data,
                         struct reference_floor *out_whole)
{
  const struct candidate at = {.root = {.u = u, .v = v, .t = t}, .patch = patch};
  struct reference_answer answer;
  describe(reference, &at, origin, direction, &answer);
  *out_data = answer.data, *out_whole = answer.whole;
}

double reference_residual(const struct reference *reference, uint32_t patch, const double origin[3],
                          const double direction[3], double t, double u, double v)
{
  quad square = 0;
  for (int axis = 0; axis < 3; axis++) {
    struct quad_net net;
    for (int k = 0; k < 16; k++) net.c[k / 4][k % 4] = reference->patches[patch].P[k / 4][k % 4][axis];
    quad difference = quad_net_jet(&net, u, v).value - ((quad)origin[axis] + (quad)t * direction[axis]);
    square += difference * difference;
  }
  return (double)quad_sqrt(square);
}

static quad clamp(quad x) { return x < 0 ? 0 : x > 1 ? 1 : x; }

double reference_distance(const struct reference *reference, uint32_t patch, const double point[3], double u, double v)
{
  struct quad_net net[3];
  for (int k = 0; k < 48; k++) net[k % 3].c[k / 12][k / 3 % 4] = reference->patches[patch].P[k / 12][k / 3 % 4][k % 3];
  quad x = u, y = v, least = -1;
  for (int step = 0; step < FOOT_STEPS; step++) {
    quad square = 0, uu = 0, uv = 0, vv = 0, ru = 0, rv = 0;
    for (int axis = 0; axis < 3; axis++) {
      const struct quad_jet jet = quad_net_jet(&net[axis], x, y);
      const quad off = jet.value - point[axis];
      square += off * off, ru += off * jet.du, rv += off * jet.dv;
      uu += jet.du * jet.du, uv += jet.du * jet.dv, vv += jet.dv * jet.dv;
    }
    if (least < 0 || square < least) least = square;
    const quad determinant = uu * vv - uv * uv;
    if (!(determinant > 0)) break;
    x = clamp(x - (vv * ru - uv * rv) / determinant), y = clamp(y - (uu * rv - uv * ru) / determinant);
  }
  return (double)quad_sqrt(least);
}

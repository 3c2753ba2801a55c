/* The closest hit over a list of patches, with its verdict. search.c does the search inside a patch. See
 * reference.h. */
#include "reference/reference.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct patch {
  double P[4][4][3];
  double low[3], high[3];
};

struct reference {
  size_t count;
  struct patch *patches;
};

enum { MAX_CANDIDATES = 128 };

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
  double t_undecided; /* a hit that is not decided is not before this; INFINITY if there is none */
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

const double (*reference_net(const struct reference *reference, uint32_t patch))[4][3]
{
  return (const double(*)[4][3])reference->patches[patch].P;
}

/* The slab test on the box of the control points, widened by its rounding errors: a difference and a quotient, 3 units
 * each way. A ray that meets the box enters it at `out_t` or later. */
static bool patch_box_met(const struct patch *patch, const double origin[3], const double direction[3], double *out_t)
{
  double enter = 0, leave = INFINITY;
  for (int axis = 0; axis < 3; axis++) {
    const double low = patch->low[axis] - origin[axis], high = patch->high[axis] - origin[axis];
    if (direction[axis] == 0) {
      if (low > 0 || high < 0) return false; /* the sign of a rounded difference is exact */
      continue;
    }
    const double a = low / direction[axis], b = high / direction[axis], near = fmin(a, b), far = fmax(a, b);
    enter = fmax(enter, near - 4 * DOUBLE_UNIT * fabs(near));
    leave = fmin(leave, far + 4 * DOUBLE_UNIT * fabs(far));
  }
  *out_t = enter;
  return enter <= leave;
}

/* Where x lies relative to [0,1], if it is known to `radius`. */
static void judge_parameter(quad x, double radius, bool *border, bool *inside)
{
  const quad within = x < (quad)0.5 ? x : 1 - x; /* distance to the nearer end, negative outside */
  if (within < REFERENCE_BORDER) *border = true;
  if (within < -(quad)radius) *inside = false;
}

/* The nearest candidate, at a border of its patch or away from all of them; -1 for none. */
static int nearest(const struct candidates *all, bool border)
{
  int best = -1;
  for (int n = 0; n < all->count; n++) {
    if (all->list[n].border != border) continue;
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
  all->t_undecided = INFINITY;
  double t_max = INFINITY; /* a proven hit, beyond which nothing matters */
  for (size_t n = 0; n < reference->count; n++) {
    const struct patch *patch = &reference->patches[n];
    double enter;
    if (!patch_box_met(patch, origin, direction, &enter) || enter > t_max) continue;
    struct search_result found;
    search_patch(patch->P, origin, direction, t_max, &found);
    all->t_undecided = fmin(all->t_undecided, found.t_undecided);
    double size = 0; /* for REFERENCE_ORIGIN */
    for (int axis = 0; axis < 3; axis++)
      size = fmax(size, fmax(fabs(origin[axis]), fmax(fabs(patch->low[axis]), fabs(patch->high[axis]))));
    const double length = sqrt(direction[0] * direction[0] + direction[1] * direction[1] + direction[2] * direction[2]);
    const double at_origin = REFERENCE_ORIGIN * size / length;
    for (int k = 0; k < found.count; k++) {
      struct candidate c = {.root = found.root[k], .patch = (uint32_t)n, .inside = true};
      judge_parameter(c.root.u, c.root.radius, &c.border, &c.inside);
      judge_parameter(c.root.v, c.root.radius, &c.border, &c.inside);
      if (c.root.t < -(quad)at_origin || (!c.inside && !c.border)) continue;
      if (c.root.t < at_origin || all->count == MAX_CANDIDATES) {
        all->t_undecided = fmin(all->t_undecided, 0);
        continue;
      }
      all->list[all->count++] = c;
      if (!c.border) t_max = fmin(t_max, (double)c.root.t * (1 + 2 * REFERENCE_SAME_POINT));
    }
  }
}

void reference_closest(const struct reference *reference, const double origin[3], const double direction[3],
                       struct reference_answer *out)
{
  struct candidates all;
  collect(reference, origin, direction, &all);
  *out = (struct reference_answer){.verdict = REFERENCE_MISS, .t_first = INFINITY, .patch = REFERENCE_NONE};

  int answer = nearest(&all, false), border = nearest(&all, true);
  if (answer >= 0) {
    out->verdict = REFERENCE_HIT;
    out->t_first = (double)all.list[answer].root.t;
  }
  if (border >= 0) {
    const struct candidate *first = &all.list[border];
    const bool sooner = answer < 0 || first->root.t < all.list[answer].root.t;
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
  if (all.t_undecided < INFINITY && all.t_undecided <= out->t_first) {
    out->verdict = REFERENCE_GRAZING;
    out->t_first = fmax(0, all.t_undecided);
  }
  if (answer < 0) return;
  const struct candidate *hit = &all.list[answer];
  out->patch = hit->patch;
  out->t = hit->root.t, out->u = hit->root.u, out->v = hit->root.v;
  out->radius = hit->root.radius, out->t_radius = hit->root.t_radius;
}

/* Answers against the exact roots of all patches; see certificate.h. */
#include "accuracy/certificate.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "accuracy/trial.h"
#include "base/wide.h"
#include "cmocka_test.h"

/* How near to its patch a grazing hit must be, relative to the largest coordinate: TRIAL_NEAR for each of three, and
 * some. */
#define GRAZING_NEAR (4 * TRIAL_NEAR)

/* A grazing answer may overlook a root this near to an end of the ray, relative to the largest coordinate or the
 * patch's extent. */
#define AT_END 0x1p-46

/* The square of a normal's length is 1 up to some roundings. */
#define UNIT_NORMAL 0x1p-48

/* The allowed error of U and V of a certain hit inside a patch, in floors. */
#define PLACE_FLOORS 16

/* How far the place of a certain hit may be from the ray, as a line, in roundings of the patch's extent. Those of U and
 * V move it by at most 3 each. */
#define LINE_ROUNDINGS 16

/* A patch smaller than this, or than this part of the scene, is judged as if it were that large. */
#define LEAST_PATCH 0x1p-1000
#define LEAST_PART 0x1p-100

/* Roots are sought this much farther than a hit, relative: the next solver's hit may differ in its last places. */
#define SPARE 0x1p-20

/* A hit this near to a root, in U, V and relative T, has the root's floor. */
#define SAME_PLACE 0x1p-40

/* However ill-conditioned a certain hit is, T is right within this fraction. */
#define MOST_ALLOWED 0x1p-10

const char *const finding_names[FINDINGS] = {"proven", "undecided", "lost", "later", "invented", "bad surface"};

void certifier_create(struct certifier *certifier, const struct scene *scene, struct reference *reference)
{
  *certifier = (struct certifier){.scene = scene, .reference = reference};
  certifier->boxes = calloc(scene->patch_count ? scene->patch_count : 1, sizeof *certifier->boxes);
  assert_non_null(certifier->boxes);
  for (size_t n = 0; n < scene->patch_count; n++) {
    for (int axis = 0; axis < 3; axis++) {
      double low = INFINITY, high = -INFINITY;
      for (int k = 0; k < 16; k++) {
        const double x = scene->patches[n].P[k / 4][k % 4][axis];
        low = fmin(low, x), high = fmax(high, x);
      }
      certifier->boxes[n][0][axis] = low, certifier->boxes[n][1][axis] = high;
      certifier->size = fmax(certifier->size, fmax(-low, high));
    }
  }
}

void certifier_destroy(struct certifier *certifier) { free(certifier->boxes), free(certifier->truth.root); }

/* False only if the line certainly misses the box: in the plane of any two axes all corners lie on one side, by more
 * than 8 roundings. */
static bool may_meet(const double box[2][3], const struct ray *ray)
{
  for (int k = 0; k < 3; k++) {
    const int i = (k + 1) % 3;
    const double di = ray->direction[i], dk = ray->direction[k];
    double low = INFINITY, high = -INFINITY, size = 0;
    for (int corner = 0; corner < 4; corner++) {
      const double x = box[corner & 1][i] - ray->origin[i], y = box[corner >> 1][k] - ray->origin[k];
      const double side = dk * x - di * y;
      if (!isfinite(side)) return true;
      low = fmin(low, side), high = fmax(high, side);
      size = fmax(size, fabs(dk * x) + fabs(di * y));
    }
    const double error = 8 * DOUBLE_UNIT * size + 0x1p-1060;
    if (low > error || high < -error) return false;
  }
  return true;
}

/* ---- the roots of a ray ---- */

static double extent_of(const struct certifier *certifier, uint32_t patch)
{
  const double(*box)[3] = (const double(*)[3])certifier->boxes[patch];
  double extent = 0;
  for (int axis = 0; axis < 3; axis++) extent = fmax(extent, box[1][axis] - box[0][axis]);
  return extent;
}

static void add_truth(struct truth *truth, uint32_t patch, const struct exact_root *root)
{
  if (truth->count == truth->capacity) {
    truth->capacity = 2 * truth->capacity + EXACT_MOST_ROOTS;
    truth->root = realloc(truth->root, truth->capacity * sizeof *truth->root);
    assert_non_null(truth->root);
  }
  truth->root[truth->count++] = (struct truth_root){.at = *root, .patch = patch};
}

static bool same_ray(const struct ray *a, const struct ray *b)
{
  return !memcmp(a->origin, b->origin, sizeof a->origin) && !memcmp(a->direction, b->direction, sizeof a->direction) &&
         a->t_min == b->t_min && a->t_max == b->t_max;
}

/* Provides all roots of the ray up to `end` at least: the known ones, or new ones up to somewhat beyond that. */
static void find_truth(struct certifier *certifier, const struct ray *ray, double end)
{
  struct truth *truth = &certifier->truth;
  if (end > ray->t_max) end = ray->t_max;
  if (truth->known && same_ray(&truth->ray, ray) && end <= truth->end) return;
  end += SPARE * end;
  if (end > ray->t_max) end = ray->t_max;
  *truth = (struct truth){.known = true, .ray = *ray, .end = end, .root = truth->root, .capacity = truth->capacity};
  for (size_t n = 0; n < certifier->scene->patch_count; n++) {
    if (!may_meet((const double(*)[3])certifier->boxes[n], ray)) continue;
    struct exact_roots roots;
    exact_patch_roots(certifier->scene->patches[n].P, ray->origin, ray->direction, ray->t_min, end, &roots);
    truth->boxes += roots.boxes;
    for (size_t k = 0; k < roots.count; k++) add_truth(truth, (uint32_t)n, &roots.root[k]);
  }
}

static const struct facts_floor *floor_of(struct certifier *certifier, struct truth_root *root)
{
  if (!root->floored)
    root->floor = trial_floor(certifier->reference, &certifier->truth.ray, root->patch, root->at.t, root->at.u,
                              root->at.v);
  root->floored = true;
  return &root->floor;
}

/* ---- an answer ---- */

struct judging {
  struct certifier *certifier;
  const struct ray *ray;
  const struct hit *hit;
  struct certificate *out;
  double allowed;                 /* the allowed error of T, at the answer's own place */
  struct truth_root *at, *before; /* the root at T (if several, the one next to U, V); the first before it; or NULL */
  double aside;                   /* how far U and V are from those of the root at T on the same patch */
  bool doubt_at, doubt_before;
};

/* t of the root minus T, to all digits: the difference of the leading parts is exact if they are next to each other. */
static double t_off(const struct judging *j, const struct truth_root *root)
{
  return root->at.t - j->hit->t + root->at.t_rest;
}

/* The floor at the hit: that of the root there, or its own. */
static double floor_at_hit(const struct judging *j)
{
  const struct hit *hit = j->hit;
  struct truth *truth = &j->certifier->truth;
  for (size_t n = 0; n < truth->count && same_ray(&truth->ray, j->ray); n++) {
    struct truth_root *root = &truth->root[n];
    if (root->patch == hit->patch && root->at.proven && fabs(root->at.u - hit->u) <= SAME_PLACE &&
        fabs(root->at.v - hit->v) <= SAME_PLACE && fabs(t_off(j, root)) <= SAME_PLACE * hit->t)
      return floor_of(j->certifier, root)->t;
  }
  return trial_floor(j->certifier->reference, j->ray, hit->patch, hit->t, hit->u, hit->v).t;
}

/* Whether a root is so near to an end of the ray that roundings of the input could move it across. */
static bool at_an_end(const struct judging *j, struct truth_root *root)
{
  const double length = facts_length(j->ray->direction), t = root->at.t;
  const double moved = TRIAL_SAME_FLOORS * floor_of(j->certifier, root)->t;
  const double near = AT_END * fmax(trial_size(j->ray, t), extent_of(j->certifier, root->patch) / length);
  return t - j->ray->t_min <= fmax(near, moved) || j->ray->t_max - t <= fmax(near, moved);
}

/* Judges a hit by one root. */
static void judge_root(struct judging *j, struct truth_root *root)
{
  const double off_t = t_off(j, root);
  if (!root->at.proven) {
    j->doubt_before |= off_t < -j->allowed;
    j->doubt_at |= off_t <= j->allowed && root->at.t_end - j->hit->t >= -j->allowed;
    return;
  }
  if (off_t >= 2 * j->allowed) return;
  const double off = fabs(off_t) / floor_of(j->certifier, root)->t;
  const double aside = root->patch != j->hit->patch ? INFINITY
                                                    : fmax(fabs(root->at.u - j->hit->u), fabs(root->at.v - j->hit->v));
  if (off <= CERTIFICATE_FLOORS && (!j->at || aside < j->aside)) j->at = root, j->aside = aside;
  if (!(off_t < 0 && off > CERTIFICATE_FLOORS)) return;
  const bool certain = j->hit->certainty == CERTAINTY_CERTAIN;
  if (!certain && (-off_t <= j->allowed || at_an_end(j, root))) return;
  if (!j->before || off_t < t_off(j, j->before)) j->before = root;
}

static void tell_root(struct judging *j, struct truth_root *root)
{
  struct certificate *out = j->out;
  out->t = root->at.t, out->u = root->at.u, out->v = root->at.v, out->patch = root->patch;
  if (j->hit->patch != HIT_NONE) out->off = fabs(t_off(j, root)) / floor_of(j->certifier, root)->t;
}

/* Tells the nearest proven root, if there is none at T. */
static void nearest_root(struct judging *j)
{
  struct truth_root *nearest = NULL;
  find_truth(j->certifier, j->ray, j->ray->t_max);
  for (size_t n = 0; n < j->certifier->truth.count; n++) {
    struct truth_root *root = &j->certifier->truth.root[n];
    if (root->at.proven && (!nearest || fabs(t_off(j, root)) < fabs(t_off(j, nearest)))) nearest = root;
  }
  if (nearest) tell_root(j, nearest);
}

static void judge_hit(struct judging *j)
{
  const struct hit *hit = j->hit;
  const bool certain = hit->certainty == CERTAINTY_CERTAIN;
  const double length = facts_length(j->ray->direction);
  double size = length * trial_size(j->ray, hit->t); /* includes the patch's */
  for (int k = 0; k < 6; k++) size = fmax(size, fabs(j->certifier->boxes[hit->patch][k / 3][k % 3]));
  const double near = TRIAL_NEAR * size / length;
  const double floor = floor_at_hit(j);
  j->allowed = certain ? CERTIFICATE_FLOORS * floor : near + TRIAL_SAME_FLOORS * floor;
  const double most = (certain ? MOST_ALLOWED * hit->t : 0x1p10 * near) + DBL_TRUE_MIN;
  if (!(j->allowed <= most)) j->allowed = most;
  find_truth(j->certifier, j->ray, hit->t + 2 * j->allowed);
  for (size_t n = 0; n < j->certifier->truth.count; n++) judge_root(j, &j->certifier->truth.root[n]);
  struct certificate *out = j->out;
  const bool exists = j->at, before = j->before && !(exists && t_off(j, j->at) <= t_off(j, j->before));
  out->sure = exists && !before && !j->doubt_before;
  if (exists) tell_root(j, j->at);
  if (before) {
    tell_root(j, j->before);
    out->finding = FINDING_LATER;
  } else if (!certain) {
    const double off = facts_residual(reference_net(j->certifier->reference, hit->patch), j->ray->origin,
                                      j->ray->direction, hit->t, hit->u, hit->v);
    out->finding = off <= GRAZING_NEAR * size ? FINDING_PROVEN : FINDING_INVENTED;
  } else if (!exists && !j->doubt_at) {
    out->finding = FINDING_INVENTED;
  } else {
    out->finding = exists && !j->doubt_before ? FINDING_PROVEN : FINDING_UNDECIDED;
  }
  if (out->finding == FINDING_INVENTED) nearest_root(j);
}

static void judge_miss(struct judging *j)
{
  const bool grazing = j->hit->certainty == CERTAINTY_GRAZING;
  bool doubt = false;
  find_truth(j->certifier, j->ray, j->ray->t_max);
  for (size_t n = 0; n < j->certifier->truth.count; n++) {
    struct truth_root *root = &j->certifier->truth.root[n];
    doubt |= !root->at.proven;
    if (!root->at.proven || root->at.t >= j->out->t) continue;
    if (grazing && at_an_end(j, root)) continue;
    j->out->finding = FINDING_LOST;
    tell_root(j, root);
  }
  if (j->out->finding == FINDING_LOST) return;
  j->out->sure = !doubt;
  j->out->finding = doubt && !grazing ? FINDING_UNDECIDED : FINDING_PROVEN;
}

/* S(u,v) of the hit's patch. */
static void surface_of(const struct judging *j, wide u, wide v, wide out[3])
{
  double(*P)[4][3] = j->certifier->scene->patches[j->hit->patch].P;
  const wide bu[4] = {(1 - u) * (1 - u) * (1 - u), 3 * u * (1 - u) * (1 - u), 3 * u * u * (1 - u), u * u * u},
             bv[4] = {(1 - v) * (1 - v) * (1 - v), 3 * v * (1 - v) * (1 - v), 3 * v * v * (1 - v), v * v * v};
  for (int axis = 0; axis < 3; axis++) {
    out[axis] = 0;
    for (int i = 0; i < 4; i++) {
      wide row = 0;
      for (int k = 0; k < 4; k++) row += bv[k] * P[i][k][axis];
      out[axis] += bu[i] * row;
    }
  }
}

/* The size that the patch is judged by. */
static double counted_extent(const struct judging *j)
{
  const double least = fmax(LEAST_PATCH, LEAST_PART * j->certifier->size);
  return fmax(extent_of(j->certifier, j->hit->patch), least);
}

static bool at_border(double u, double v) { return fmin(u, v) <= SAME_PLACE || fmax(u, v) >= 1 - SAME_PLACE; }

/* Whether the hit's place is another one of the root's point: two borders of the patch meet there, or a border is one
 * point. */
static bool across_seam(const struct judging *j)
{
  const struct hit *hit = j->hit;
  const struct exact_root *root = &j->at->at;
  wide here[3], there[3];
  double off = 0;
  if (!at_border(hit->u, hit->v) || !at_border(root->u, root->v)) return false;
  surface_of(j, hit->u, hit->v, here), surface_of(j, root->u, root->v, there);
  for (int axis = 0; axis < 3; axis++) off = fmax(off, fabs((double)(here[axis] - there[axis])));
  return off <= LINE_ROUNDINGS * DOUBLE_UNIT * counted_extent(j);
}

/* Whether U and V of a certain hit are near those of the root at T, if that is on the same patch. They need only be
 * near, because floors are of the first order. */
static bool place_good(const struct judging *j)
{
  const struct hit *hit = j->hit;
  if (hit->certainty == CERTAINTY_GRAZING || !j->at || j->at->patch != hit->patch) return true;
  const struct facts_floor *floor = floor_of(j->certifier, j->at);
  const bool off = fabs(hit->u - j->at->at.u) > PLACE_FLOORS * (floor->u + DOUBLE_UNIT) ||
                   fabs(hit->v - j->at->at.v) > PLACE_FLOORS * (floor->v + DOUBLE_UNIT);
  return !off || across_seam(j);
}

/* How far the hit's point is from S(U,V). */
static double off_surface(const struct judging *j, const wide at[3])
{
  double off[3];
  for (int axis = 0; axis < 3; axis++) off[axis] = (double)(at[axis] - j->hit->point[axis]);
  return facts_length(off);
}

/* The largest coordinate of (S(U,V) - origin) x direction/|direction|: the distance of the hit's place from the ray as
 * a line. */
static double off_line(const struct judging *j, const wide at[3])
{
  const double *o = j->ray->origin, *d = j->ray->direction;
  double most = 0, longest = fmax(fmax(fabs(d[0]), fabs(d[1])), fabs(d[2]));
  for (int i = 0, k = 1; i < 3; i++, k = (i + 1) % 3) {
    const wide line = (wide)o[i] * d[k] - (wide)o[k] * d[i]; /* exact products: a far start loses nothing */
    most = fmax(most, fabs((double)((at[i] * d[k] - at[k] * d[i] - line) / longest)));
  }
  return most;
}

/* Whether a certain hit's place is on the ray, up to what the rounding of U and V moves it. */
static bool line_good(const struct judging *j, const wide at[3])
{
  return j->hit->certainty == CERTAINTY_GRAZING || off_line(j, at) <= LINE_ROUNDINGS * DOUBLE_UNIT * counted_extent(j);
}

/* Whether what a hit says of the surface is right; its place on the ray is judged elsewhere. */
static bool surface_good(const struct judging *j)
{
  const struct hit *hit = j->hit;
  const double *n = hit->normal;
  if (!(hit->u >= 0 && hit->u <= 1 && hit->v >= 0 && hit->v <= 1)) return false;
  if (!(hit->t > j->ray->t_min && hit->t < j->ray->t_max) || !place_good(j)) return false;
  wide at[3];
  surface_of(j, hit->u, hit->v, at);
  if (!line_good(j, at) || !(off_surface(j, at) <= hit->point_error)) return false;
  return hit->certainty == CERTAINTY_GRAZING || fabs(n[0] * n[0] + n[1] * n[1] + n[2] * n[2] - 1) < UNIT_NORMAL;
}

static bool same_answer(const struct hit *a, const struct hit *b)
{
  if (a->patch != b->patch || a->certainty != b->certainty) return false;
  return a->patch == HIT_NONE ||
         (a->t == b->t && a->u == b->u && a->v == b->v && a->point_error == b->point_error &&
          !memcmp(a->point, b->point, sizeof a->point) && !memcmp(a->normal, b->normal, sizeof a->normal));
}

void certify(struct certifier *certifier, const struct ray *ray, const struct hit *hit, struct certificate *out)
{
  struct truth *truth = &certifier->truth;
  if (truth->judged && same_ray(&truth->ray, ray) && same_answer(&truth->hit, hit)) {
    *out = truth->certificate;
    return;
  }
  *out = (struct certificate){.finding = FINDING_PROVEN, .t = INFINITY, .patch = REFERENCE_NONE};
  struct judging j = {.certifier = certifier, .ray = ray, .hit = hit, .out = out};
  (hit->patch == HIT_NONE ? judge_miss : judge_hit)(&j);
  out->boxes = truth->boxes;
  if (hit->patch != HIT_NONE && out->finding <= FINDING_UNDECIDED && !surface_good(&j)) out->finding = FINDING_SURFACE;
  truth->judged = true, truth->hit = *hit, truth->certificate = *out;
}

/* ---- all hits ---- */

const char *const list_finding_names[LIST_FINDINGS] = {"right",    "undecided",        "lost",
                                                       "invented", "lost on a border", "out of order"};

/* The allowed error of a hit's t, in floors. Next to a tangency floors are only of the first order; roots nearer to
 * each other than this are told apart by their order. */
#define LIST_FLOORS 16

/* The parameter is the nearest double to a root's. A root that 113 bits cannot tell from a border counts as a hit on
 * it, of the first of the patches that share it, although it may be in the other one. */
#define ON_BORDER 0x1p-90

static bool on_border(double u, double v) { return fmin(u, v) <= ON_BORDER || fmax(u, v) >= 1; }

/* Whether a hit may be at the place of a root. Any place will do if the root is on a border, where others may be the
 * same point, or if the floors are NaN, because the patch is singular there. */
static bool same_place(const struct hit *hit, const struct truth_root *root, const struct facts_floor *floor)
{
  return on_border(root->at.u, root->at.v) || !(fabs(hit->u - root->at.u) > PLACE_FLOORS * (floor->u + DOUBLE_UNIT) ||
                                                fabs(hit->v - root->at.v) > PLACE_FLOORS * (floor->v + DOUBLE_UNIT));
}

/* The root that a hit is: the nearest one not met yet, of the hit's patch, or on a border if the hit is. NULL if none
 * is near enough. */
static struct truth_root *root_of(struct certifier *certifier, const struct hit *hit)
{
  struct truth_root *best = NULL;
  double least = INFINITY;
  for (size_t k = 0; k < certifier->truth.count; k++) {
    struct truth_root *root = &certifier->truth.root[k];
    const bool own = root->patch == hit->patch;
    if (root->met || !root->at.proven) continue;
    const struct facts_floor *floor = floor_of(certifier, root);
    if (!(fabs(root->at.t - hit->t) <= LIST_FLOORS * floor->t)) continue;
    if (own ? !same_place(hit, root, floor) : !(on_border(hit->u, hit->v) && on_border(root->at.u, root->at.v)))
      continue;
    /* Of two that t cannot tell apart, takes the one whose parameters are nearer. */
    const double aside = own ? fmax(fabs(root->at.u - hit->u), fabs(root->at.v - hit->v)) : 1;
    if (aside < least) best = root, least = aside;
  }
  return best;
}

/* Whether some hit of the list is at the root's t. */
static bool any_at(const struct hit_list *list, const struct truth_root *root)
{
  for (size_t n = 0; n < list->count; n++)
    if (fabs(list->hits[n].t - root->at.t) <= LIST_FLOORS * root->floor.t) return true;
  return false;
}

enum list_finding certify_list(struct certifier *certifier, const struct ray *ray, const struct hit_list *list)
{
  struct truth *truth = &certifier->truth;
  bool doubt = false;
  find_truth(certifier, ray, ray->t_max);
  for (size_t k = 0; k < truth->count; k++) {
    truth->root[k].met = false, doubt |= !truth->root[k].at.proven;
    floor_of(certifier, &truth->root[k]);
  }
  for (size_t k = 0; k < list->count; k++) {
    const struct hit *hit = &list->hits[k];
    if (k > 0 && !(hit[-1].t <= hit->t)) return LIST_ORDER;
    if (hit->certainty != CERTAINTY_CERTAIN) continue;
    struct truth_root *root = root_of(certifier, hit);
    if (root) root->met = true;
    else if (!doubt) return LIST_INVENTED;
  }
  if (list->certainty != CERTAINTY_CERTAIN) return LIST_RIGHT;
  for (size_t k = 0; k < truth->count; k++) {
    const struct truth_root *root = &truth->root[k];
    if (!root->at.proven || root->met) continue;
    if (!on_border(root->at.u, root->at.v)) return LIST_LOST;
    if (!any_at(list, root)) return LIST_BORDER_LOST;
  }
  return doubt ? LIST_UNDECIDED : LIST_RIGHT;
}

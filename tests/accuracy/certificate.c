/* Answers against the exact roots of all patches; see certificate.h. */
#include "accuracy/certificate.h"

#include <math.h>
#include <stdlib.h>

#include "accuracy/exact.h"
#include "accuracy/trial.h"
#include "base/wide.h"
#include "cmocka_test.h"

/* How near to its patch a grazing hit must be, relative to the largest coordinate: TRIAL_NEAR for each of three, and
 * some. */
#define GRAZING_NEAR (4 * TRIAL_NEAR)

/* A grazing answer may overlook a root this near to the ray's origin, relative to the same or the patch's extent. */
#define AT_ORIGIN 0x1p-46

/* The square of a normal's length is 1 but for some roundings. */
#define UNIT_NORMAL 0x1p-48

/* How far U and V of a certain hit may be off, in floors. */
#define PLACE_FLOORS 16

/* How far from the ray, as a line, the place of a certain hit may be, in roundings of the patch's extent: those of U and V
 * move it by no more than 3 each. */
#define LINE_ROUNDINGS 16

/* However ill-conditioned a certain hit is, T is right to this share. */
#define MOST_ALLOWED 0x1p-10

const char *const finding_names[FINDINGS] = {"proven", "undecided", "lost", "later", "invented", "bad surface"};

void certifier_create(struct certifier *certifier, const struct scene *scene, struct reference *reference)
{
  *certifier = (struct certifier){scene, reference, NULL};
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
    }
  }
}

void certifier_destroy(struct certifier *certifier) { free(certifier->boxes); }

/* False only where the line surely passes the box by: in the plane of any two axes the corners lie all on one side,
 * by more than 8 roundings. */
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

struct judging {
  const struct certifier *certifier;
  const struct ray *ray;
  const struct hit *hit;
  struct certificate *out;
  double allowed;                  /* what T may be off by, at the answer's own place */
  struct exact_root at, before;    /* the root at T, of several the one next to U and V; the first before it */
  uint32_t at_patch, before_patch; /* or REFERENCE_NONE */
  double aside;                    /* how far U and V are from those of the root at T, on the same patch */
  bool doubt_at, doubt_before;
};

static double floor_at(const struct judging *j, uint32_t patch, double t, double u, double v)
{
  return trial_floor(j->certifier->reference, j->ray, patch, t, u, v).t;
}

static double extent_of(const struct certifier *certifier, uint32_t patch)
{
  const double(*box)[3] = (const double(*)[3])certifier->boxes[patch];
  double extent = 0;
  for (int axis = 0; axis < 3; axis++) extent = fmax(extent, box[1][axis] - box[0][axis]);
  return extent;
}

/* Where on the ray a root of the patch is too near to its origin to be told from it. */
static double end_of_origin(const struct certifier *certifier, const struct ray *ray, uint32_t patch)
{
  const double *d = ray->direction, length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
  return AT_ORIGIN * fmax(trial_size(ray, 0), extent_of(certifier, patch) / length);
}

/* All roots of a patch that matter to a hit. */
static void judge_patch(struct judging *j, uint32_t patch)
{
  const double T = j->hit->t, end = T + 2 * j->allowed;
  const bool certain = j->hit->certainty == CERTAINTY_CERTAIN;
  const double at_origin = end_of_origin(j->certifier, j->ray, patch);
  struct exact_roots roots;
  exact_patch_roots(j->certifier->scene->patches[patch].P, j->ray->origin, j->ray->direction, j->ray->t_min,
                    j->ray->t_max < end ? j->ray->t_max : end, T, &roots);
  j->out->boxes += roots.boxes;
  for (size_t n = 0; n < roots.count; n++) {
    const struct exact_root *root = &roots.root[n];
    if (!root->proven) {
      j->doubt_before |= root->t_off < -j->allowed;
      j->doubt_at |= root->t_off <= j->allowed && root->t_end >= -j->allowed;
      continue;
    }
    const double off = fabs(root->t_off) / floor_at(j, patch, T + root->t_off, root->u, root->v);
    const double aside = patch != j->hit->patch ? INFINITY : fmax(fabs(root->u - j->hit->u), fabs(root->v - j->hit->v));
    if (off <= CERTIFICATE_FLOORS && (j->at_patch == REFERENCE_NONE || aside < j->aside))
      j->at = *root, j->at_patch = patch, j->aside = aside;
    const bool before = root->t_off < 0 && off > CERTIFICATE_FLOORS &&
                        (certain || (-root->t_off > j->allowed && T + root->t_off > at_origin));
    if (before && (j->before_patch == REFERENCE_NONE || root->t_off < j->before.t_off))
      j->before = *root, j->before_patch = patch;
  }
}

static void tell_root(struct judging *j, const struct exact_root *root, uint32_t patch)
{
  struct certificate *out = j->out;
  out->t = j->hit->t + root->t_off, out->u = root->u, out->v = root->v, out->patch = patch;
  out->off = fabs(root->t_off) / floor_at(j, patch, out->t, root->u, root->v);
}

/* Where there is no root at T: the nearest one there is. */
static void nearest_root(struct judging *j)
{
  const struct certifier *c = j->certifier;
  double nearest = INFINITY;
  for (size_t n = 0; n < c->scene->patch_count; n++) {
    if (!may_meet((const double(*)[3])c->boxes[n], j->ray)) continue;
    struct exact_roots roots;
    exact_patch_roots(c->scene->patches[n].P, j->ray->origin, j->ray->direction, j->ray->t_min, j->ray->t_max,
                      j->hit->t, &roots);
    for (size_t k = 0; k < roots.count; k++) {
      const struct exact_root *root = &roots.root[k];
      if (!root->proven || fabs(root->t_off) >= nearest) continue;
      nearest = fabs(root->t_off);
      tell_root(j, root, (uint32_t)n);
    }
  }
}

static void judge_hit(struct judging *j)
{
  const struct hit *hit = j->hit;
  const bool certain = hit->certainty == CERTAINTY_CERTAIN;
  const double *d = j->ray->direction, length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
  double size = length * trial_size(j->ray, hit->t); /* the patch's included */
  for (int k = 0; k < 6; k++) size = fmax(size, fabs(j->certifier->boxes[hit->patch][k / 3][k % 3]));
  const double near = TRIAL_NEAR * size / length;
  const double floor = floor_at(j, hit->patch, hit->t, hit->u, hit->v);
  j->allowed = certain ? CERTIFICATE_FLOORS * floor : near + TRIAL_SAME_FLOORS * floor;
  const double most = certain ? MOST_ALLOWED * hit->t : 0x1p10 * near;
  if (!(j->allowed <= most)) j->allowed = most;
  for (size_t n = 0; n < j->certifier->scene->patch_count; n++)
    if (may_meet((const double(*)[3])j->certifier->boxes[n], j->ray)) judge_patch(j, (uint32_t)n);
  struct certificate *out = j->out;
  const bool exists = j->at_patch != REFERENCE_NONE;
  const bool before = j->before_patch != REFERENCE_NONE && !(exists && j->at.t_off <= j->before.t_off);
  out->sure = exists && !before && !j->doubt_before;
  if (exists) tell_root(j, &j->at, j->at_patch);
  if (before) {
    tell_root(j, &j->before, j->before_patch);
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
  const struct certifier *c = j->certifier;
  const bool grazing = j->hit->certainty == CERTAINTY_GRAZING;
  bool doubt = false;
  for (size_t n = 0; n < c->scene->patch_count; n++) {
    if (!may_meet((const double(*)[3])c->boxes[n], j->ray)) continue;
    struct exact_roots roots;
    exact_patch_roots(c->scene->patches[n].P, j->ray->origin, j->ray->direction, j->ray->t_min, j->ray->t_max, 0,
                      &roots);
    j->out->boxes += roots.boxes;
    for (size_t k = 0; k < roots.count; k++) {
      const struct exact_root *root = &roots.root[k];
      doubt |= !root->proven;
      if (!root->proven || root->t_off >= j->out->t) continue;
      if (grazing && root->t_off < end_of_origin(c, j->ray, (uint32_t)n)) continue;
      j->out->finding = FINDING_LOST;
      j->out->t = root->t_off, j->out->u = root->u, j->out->v = root->v, j->out->patch = (uint32_t)n;
    }
  }
  if (j->out->finding == FINDING_LOST) return;
  j->out->sure = !doubt;
  j->out->finding = doubt && !grazing ? FINDING_UNDECIDED : FINDING_PROVEN;
}

/* Whether U and V of a certain hit are those of the root at T, where that is of the same patch; near, for a border that
 * two edges of one patch share has two places for it, and the floors are of the first order. */
static bool place_good(const struct judging *j)
{
  const struct hit *hit = j->hit;
  if (hit->certainty == CERTAINTY_GRAZING || j->at_patch != hit->patch) return true;
  const struct facts_floor floor = trial_floor(j->certifier->reference, j->ray, hit->patch, hit->t, j->at.u, j->at.v);
  return !(fabs(hit->u - j->at.u) > PLACE_FLOORS * (floor.u + DOUBLE_UNIT)) &&
         !(fabs(hit->v - j->at.v) > PLACE_FLOORS * (floor.v + DOUBLE_UNIT));
}

/* S(U,V). */
static void surface_of(const struct judging *j, wide out[3])
{
  double(*P)[4][3] = j->certifier->scene->patches[j->hit->patch].P;
  const wide u = j->hit->u, v = j->hit->v,
             bu[4] = {(1 - u) * (1 - u) * (1 - u), 3 * u * (1 - u) * (1 - u), 3 * u * u * (1 - u), u * u * u},
             bv[4] = {(1 - v) * (1 - v) * (1 - v), 3 * v * (1 - v) * (1 - v), 3 * v * v * (1 - v), v * v * v};
  for (int axis = 0; axis < 3; axis++) {
    out[axis] = 0;
    for (int k = 0; k < 16; k++) out[axis] += bu[k / 4] * bv[k % 4] * P[k / 4][k % 4][axis];
  }
}

/* How far the hit's point is from it. */
static double off_surface(const struct judging *j)
{
  wide at[3];
  double square = 0;
  surface_of(j, at);
  for (int axis = 0; axis < 3; axis++) {
    const double off = (double)(at[axis] - j->hit->point[axis]);
    square += off * off;
  }
  return sqrt(square);
}

/* The largest coordinate of (S(U,V) - origin) x direction/|direction|: how far the hit's place is from the ray, as a
 * line. */
static double off_line(const struct judging *j)
{
  const double *o = j->ray->origin, *d = j->ray->direction;
  wide at[3];
  surface_of(j, at);
  double most = 0, longest = fmax(fmax(fabs(d[0]), fabs(d[1])), fabs(d[2]));
  for (int i = 0, k = 1; i < 3; i++, k = (i + 1) % 3) {
    const wide line = (wide)o[i] * d[k] - (wide)o[k] * d[i]; /* of exact products: a far start loses nothing */
    most = fmax(most, fabs((double)((at[i] * d[k] - at[k] * d[i] - line) / longest)));
  }
  return most;
}

/* Whether a certain hit's place is on the ray, but for what the rounding of U and V moves it. */
static bool line_good(const struct judging *j)
{
  const double extent = extent_of(j->certifier, j->hit->patch);
  return j->hit->certainty == CERTAINTY_GRAZING || off_line(j) <= LINE_ROUNDINGS * DOUBLE_UNIT * extent;
}

/* What a hit says of the surface, but for its place on the ray. */
static bool surface_good(const struct judging *j)
{
  const struct hit *hit = j->hit;
  const double *n = hit->normal;
  if (!(hit->u >= 0 && hit->u <= 1 && hit->v >= 0 && hit->v <= 1)) return false;
  if (!(hit->t > j->ray->t_min && hit->t < j->ray->t_max) || !place_good(j) || !line_good(j)) return false;
  if (!(off_surface(j) <= hit->point_error)) return false;
  return hit->certainty == CERTAINTY_GRAZING || fabs(n[0] * n[0] + n[1] * n[1] + n[2] * n[2] - 1) < UNIT_NORMAL;
}

void certify(const struct certifier *certifier, const struct ray *ray, const struct hit *hit, struct certificate *out)
{
  *out = (struct certificate){.finding = FINDING_PROVEN, .t = INFINITY, .patch = REFERENCE_NONE};
  struct judging j = {.certifier = certifier, .ray = ray, .hit = hit, .out = out};
  j.at_patch = j.before_patch = REFERENCE_NONE;
  (hit->patch == HIT_NONE ? judge_miss : judge_hit)(&j);
  if (hit->patch != HIT_NONE && out->finding <= FINDING_UNDECIDED && !surface_good(&j)) out->finding = FINDING_SURFACE;
}

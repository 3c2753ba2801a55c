/* Newton's method on two planes through the ray (J. Kajiya, "Ray tracing parametric patches", SIGGRAPH 1982, for the planes). */
#include "chart/plain_newton.h"

#include <math.h>
#include <stdlib.h>

#include "geometry/bvh.h"
#include "geometry/patch.h"

#define LAST_STEP 1e-12 /* of a parameter: the step that still stands is its square */
#define EDGE 1e-9       /* of a parameter: roots so far outside a part still count, so that none falls between two */

enum { STEPS = 7 };

struct part {
  uint32_t patch;
  double u, v; /* its middle */
};

struct plain_newton {
  const struct ray_list *rays;
  double (*x)[3][4][4]; /* of each patch */
  struct part *parts;
  struct bvh bvh;
  volatile double sink;
};

static bool build(struct plain_newton *plain, const struct scene *scene)
{
  const size_t side = PLAIN_NEWTON_SPLIT, count = scene->patch_count * side * side;
  struct bvh_box *boxes = calloc(count + 1, sizeof *boxes);
  plain->x = calloc(scene->patch_count + 1, sizeof *plain->x);
  plain->parts = calloc(count + 1, sizeof *plain->parts);
  bool built = boxes != NULL && plain->x != NULL && plain->parts != NULL;
  for (size_t n = 0; built && n < scene->patch_count; n++)
    for (int k = 0; k < 48; k++) plain->x[n][k % 3][k / 12][k / 3 % 4] = scene->patches[n].P[k / 12][k / 3 % 4][k % 3];
  for (size_t n = 0; built && n < count; n++) {
    const size_t patch = n / (side * side), i = n / side % side, j = n % side;
    const double step = 1.0 / PLAIN_NEWTON_SPLIT, u = (double)i * step, v = (double)j * step;
    plain->parts[n] = (struct part){ (uint32_t)patch, u + step / 2, v + step / 2 };
    for (int axis = 0; axis < 3; axis++) {
      double net[4][4];
      patch_subnet(plain->x[patch][axis], u, u + step, v, v + step, net);
      boxes[n].lo[axis] = boxes[n].hi[axis] = net[0][0];
      for (int k = 1; k < 16; k++) {
        boxes[n].lo[axis] = fmin(boxes[n].lo[axis], net[k / 4][k % 4]);
        boxes[n].hi[axis] = fmax(boxes[n].hi[axis], net[k / 4][k % 4]);
      }
    }
  }
  built = built && bvh_build(boxes, count, &plain->bvh) == STATUS_OK;
  free(boxes);
  return built;
}

struct plain_newton *plain_newton_create(const struct scene *scene, const struct ray_list *rays)
{
  struct plain_newton *plain = calloc(1, sizeof *plain);
  if (plain == NULL) return NULL;
  plain->rays = rays;
  if (build(plain, scene)) return plain;
  plain_newton_destroy(plain);
  return NULL;
}

void plain_newton_destroy(struct plain_newton *plain)
{
  if (plain == NULL) return;
  bvh_free(&plain->bvh);
  free(plain->parts);
  free(plain->x);
  free(plain);
}

/* t of the root that Newton's method comes to from the middle of the part, or INFINITY. */
static double try_part(const struct plain_newton *plain, const struct part *part, const struct ray *ray)
{
  const double *d = ray->direction, *o = ray->origin;
  double(*x)[4][4] = plain->x[part->patch];
  const int k = fabs(d[0]) > fabs(d[1]) ? (fabs(d[0]) > fabs(d[2]) ? 0 : 2) : (fabs(d[1]) > fabs(d[2]) ? 1 : 2);
  const int i = (k + 1) % 3, j = (k + 2) % 3;
  const double pi = d[i] / d[k], pj = d[j] / d[k], half = 0.5 / PLAIN_NEWTON_SPLIT + EDGE;
  double a[4][4], b[4][4], u = part->u, v = part->v, step = INFINITY;
  for (int r = 0; r < 4; r++) {
    for (int c = 0; c < 4; c++) {
      const double along = x[k][r][c] - o[k];
      a[r][c] = (x[i][r][c] - o[i]) - pi * along;
      b[r][c] = (x[j][r][c] - o[j]) - pj * along;
    }
  }
  for (int n = 0; n < STEPS && step > LAST_STEP; n++) {
    const struct patch_jet fa = patch_evaluate(a, u, v), fb = patch_evaluate(b, u, v);
    const double determinant = fa.du * fb.dv - fa.dv * fb.du;
    const double du = (fa.value * fb.dv - fb.value * fa.dv) / determinant;
    const double dv = (fb.value * fa.du - fa.value * fb.du) / determinant;
    u -= du, v -= dv;
    if (!(fabs(u - part->u) < 8 * half && fabs(v - part->v) < 8 * half)) return INFINITY;
    step = fmax(fabs(du), fabs(dv));
  }
  if (!(step <= 1e-6 && fabs(u - part->u) <= half && fabs(v - part->v) <= half)) return INFINITY;
  return (patch_evaluate(x[k], u, v).value - o[k]) / d[k];
}

static double enter_box(const struct bvh_node *node, int side, const double o[3], const double inverse[3], double t_min,
                        double t_max)
{
  for (int k = 0; k < 3; k++) {
    const double p = ((double)node->lo[side][k] - o[k]) * inverse[k], q = ((double)node->hi[side][k] - o[k]) * inverse[k];
    t_min = fmax(t_min, fmin(p, q) * (1 - 1e-15));
    t_max = fmin(t_max, fmax(p, q) * (1 + 1e-15));
  }
  return t_min <= t_max ? t_min : INFINITY;
}

struct answer plain_newton_answer(const struct plain_newton *plain, const struct ray *ray, bool any)
{
  struct answer best = { INFINITY, HIT_NONE };
  double inverse[3], t_max = ray->t_max;
  uint32_t stack[2 * BVH_MAX_DEPTH];
  size_t top = 0;
  for (int k = 0; k < 3; k++) inverse[k] = 1 / ray->direction[k];
  if (plain->bvh.node_count > 0) stack[top++] = 0;
  while (top > 0 && !(any && isfinite(best.t))) {
    const uint32_t at = stack[--top];
    if (at & (uint32_t)BVH_LEAF) {
      const struct part *part = &plain->parts[at & ~(uint32_t)BVH_LEAF];
      const double t = try_part(plain, part, ray);
      if (t > ray->t_min && t < t_max) best = (struct answer){ t, part->patch }, t_max = t;
      continue;
    }
    const struct bvh_node *node = &plain->bvh.nodes[at];
    double enter[2];
    for (int side = 0; side < 2; side++) enter[side] = enter_box(node, side, ray->origin, inverse, ray->t_min, t_max);
    const int nearer = enter[1] < enter[0];
    if (isfinite(enter[!nearer])) stack[top++] = node->child[!nearer];
    if (isfinite(enter[nearer])) stack[top++] = node->child[nearer];
  }
  return best;
}

static void run(void *context, enum ray_kind kind)
{
  struct plain_newton *plain = context;
  const struct ray_list *list = &plain->rays[kind];
  double sum = 0;
  for (size_t k = 0; k < list->count; k++) {
    const struct answer answer = plain_newton_answer(plain, &list->rays[k], kind == RAYS_SHADOW);
    if (isfinite(answer.t)) sum += answer.t;
  }
  plain->sink = sum;
}

struct runner plain_newton_face(struct plain_newton *plain) { return (struct runner){ run, plain, { true, true } }; }

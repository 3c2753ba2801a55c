/* The hierarchy that all rivals walk. See rivals.h. */
#include "chart/rivals.h"

#include <float.h>
#include <stdlib.h>

#include "geometry/bvh.h"
#include "geometry/vector.h"

struct part {
  double x[3][4][4];
  uint32_t patch;
};

struct rivals {
  const struct ray_list *rays;
  struct part *parts;
  struct bvh bvh;
  rival_seek *seek;
  volatile double sink;
};

/* A ray with a direction of length 1, and the normals of two planes through it that run along an axis (Kajiya 1982). */
struct line {
  double origin[3], direction[3], inverse[3], normal[2][3], t_min, t; /* t: of the nearest hit so far */
  uint32_t patch;
};

static bool build(struct rivals *rivals, const struct scene *scene)
{
  const size_t side = RIVAL_SPLIT, count = scene->patch_count * side * side;
  struct bvh_box *boxes = calloc(count + 1, sizeof *boxes);
  rivals->parts = calloc(count + 1, sizeof *rivals->parts);
  bool built = boxes != NULL && rivals->parts != NULL;
  for (size_t n = 0; built && n < count; n++) {
    struct part *part = &rivals->parts[n];
    const double u = (double)(n / side % side) / RIVAL_SPLIT, v = (double)(n % side) / RIVAL_SPLIT;
    part->patch = (uint32_t)(n / (side * side));
    for (int k = 0; k < 3; k++) {
      double net[4][4];
      for (int i = 0; i < 16; i++) net[i / 4][i % 4] = scene->patches[part->patch].P[i / 4][i % 4][k];
      patch_subnet(net, u, u + 1.0 / RIVAL_SPLIT, v, v + 1.0 / RIVAL_SPLIT, part->x[k]);
      boxes[n].lo[k] = INFINITY, boxes[n].hi[k] = -INFINITY;
      for (int i = 0; i < 16; i++) {
        boxes[n].lo[k] = fmin(boxes[n].lo[k], part->x[k][i / 4][i % 4]);
        boxes[n].hi[k] = fmax(boxes[n].hi[k], part->x[k][i / 4][i % 4]);
      }
    }
  }
  built = built && bvh_build(boxes, count, NULL, &rivals->bvh) == STATUS_OK;
  free(boxes);
  return built;
}

struct rivals *rivals_create(const struct scene *scene, const struct ray_list *rays)
{
  struct rivals *rivals = calloc(1, sizeof *rivals);
  if (rivals == NULL) return NULL;
  rivals->rays = rays;
  if (build(rivals, scene)) return rivals;
  rivals_destroy(rivals);
  return NULL;
}

void rivals_destroy(struct rivals *rivals)
{
  if (rivals == NULL) return;
  bvh_free(&rivals->bvh);
  free(rivals->parts);
  free(rivals);
}

static void try_part(const struct rivals *rivals, struct part *part, struct line *line)
{
  double net[2][4][4];
  struct rival_root root[RIVAL_ROOTS];
  for (int plane = 0; plane < 2; plane++) {
    for (int n = 0; n < 16; n++) {
      net[plane][n / 4][n % 4] = 0;
      for (int k = 0; k < 3; k++)
        net[plane][n / 4][n % 4] += line->normal[plane][k] * (part->x[k][n / 4][n % 4] - line->origin[k]);
    }
    if (rival_keeps_sign(net[plane])) return;
  }
  const int count = rivals->seek(net[0], net[1], root);
  for (int n = 0; n < count; n++) {
    double t = 0;
    for (int k = 0; k < 3; k++)
      t += line->direction[k] * (patch_evaluate(part->x[k], root[n].u, root[n].v).value - line->origin[k]);
    if (t > line->t_min && t < line->t) line->t = t, line->patch = part->patch;
  }
}

/* t at which the ray enters a child's box, or INFINITY. Six roundings may make a touch a miss. */
static double enter_box(const struct bvh_node *node, int side, const struct line *line)
{
  double first = line->t_min, last = line->t;
  for (int k = 0; k < 3; k++) {
    const double p = ((double)node->lo[k][side] - line->origin[k]) * line->inverse[k];
    const double q = ((double)node->hi[k][side] - line->origin[k]) * line->inverse[k];
    first = fmax(fmin(p, q), first), last = fmin(fmax(p, q), last);
  }
  return first <= last * (1 + 6 * DBL_EPSILON) ? first : INFINITY;
}

static void walk(const struct rivals *rivals, bool any, struct line *line)
{
  struct {
    uint32_t at;
    double enter;
  } stack[BVH_STACK];
  size_t top = 0;
  const double end = line->t;
  if (rivals->bvh.node_count > 0) stack[top].at = 0, stack[top++].enter = 0;
  while (top > 0 && !(any && line->t < end)) {
    const uint32_t at = stack[--top].at;
    if (!(stack[top].enter < line->t)) continue;
    if (at & BVH_LEAF) {
      try_part(rivals, &rivals->parts[at & ~BVH_LEAF], line);
      continue;
    }
    const struct bvh_node *node = &rivals->bvh.nodes[at];
    const size_t first = top;
    for (int side = 0; side < BVH_WIDTH && node->child[side] != 0; side++) {
      const double enter = enter_box(node, side, line);
      if (!isfinite(enter)) continue;
      size_t n = top++; /* the nearest on top */
      for (; n > first && stack[n - 1].enter < enter; n--) stack[n] = stack[n - 1];
      stack[n].at = node->child[side], stack[n].enter = enter;
    }
  }
}

static struct answer trace(const struct rivals *rivals, const struct ray *ray, bool any)
{
  const double *d = ray->direction, length = vector_length(d);
  const int axis = fabs(d[0]) > fabs(d[1]) ? (fabs(d[0]) > fabs(d[2]) ? 0 : 2) : fabs(d[1]) > fabs(d[2]) ? 1 : 2;
  struct line line = {.t_min = ray->t_min * length, .t = ray->t_max * length, .patch = HIT_NONE};
  for (int k = 0; k < 3; k++)
    line.origin[k] = ray->origin[k], line.direction[k] = d[k] / length, line.inverse[k] = length / d[k];
  for (int plane = 0; plane < 2; plane++) {
    const int other = (axis + 1 + plane) % 3;
    line.normal[plane][other] = 1, line.normal[plane][axis] = -d[other] / d[axis];
  }
  walk(rivals, any, &line);
  return (struct answer){line.patch == HIT_NONE ? INFINITY : line.t / length, line.patch};
}

static void run(void *context, enum ray_kind kind, struct answer *answers)
{
  struct rivals *rivals = context;
  const struct ray_list *list = &rivals->rays[kind];
  double sum = 0;
  for (size_t n = 0; n < list->count; n++) {
    const struct answer answer = trace(rivals, &list->rays[n], kind == RAYS_SHADOW);
    if (answers != NULL) answers[n] = answer;
    sum += isfinite(answer.t) ? answer.t : 0;
  }
  rivals->sink = sum;
}

struct runner rivals_face(struct rivals *rivals, rival_seek *seek)
{
  rivals->seek = seek;
  return (struct runner){run, rivals};
}

/* The model for Newton's method alone; plain_newton_kernel.c traverses it. */
#include "chart/plain_newton.h"

#include <math.h>
#include <stdlib.h>

#include "base/kernel.h"
#include "chart/plain_newton_kernel.h"
#include "geometry/patch.h"

struct plain_newton {
  const struct ray_list *rays;
  struct plain_model model;
  plain_newton_packet *packet;
  volatile double sink;
};

static bool build(struct plain_model *plain, const struct scene *scene)
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
    plain->parts[n] = (struct plain_part){(uint32_t)patch, u + step / 2, v + step / 2};
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
  built = built && bvh_build(boxes, count, NULL, &plain->bvh) == STATUS_OK;
  free(boxes);
  return built;
}

struct plain_newton *plain_newton_create(const struct scene *scene, const struct ray_list *rays)
{
  struct plain_newton *plain = calloc(1, sizeof *plain);
  if (plain == NULL) return NULL;
  plain->rays = rays;
  plain->packet = KERNEL_BEST(plain_newton);
  if (build(&plain->model, scene)) return plain;
  plain_newton_destroy(plain);
  return NULL;
}

void plain_newton_destroy(struct plain_newton *plain)
{
  if (plain == NULL) return;
  bvh_free(&plain->model.bvh);
  free(plain->model.parts);
  free(plain->model.x);
  free(plain);
}

static void run(void *context, enum ray_kind kind, struct answer *answers)
{
  struct plain_newton *plain = context;
  const struct ray_list *list = &plain->rays[kind];
  struct answer own[PACKET_SIZE];
  double sum = 0;
  for (size_t p = 0; p < list->packet_count; p++) {
    const struct ray_packet *packet = &list->packets[p];
    struct answer *out = answers == NULL ? own : answers + packet->first;
    plain->packet(&plain->model, packet->count, &list->rays[packet->first], kind == RAYS_SHADOW, out);
    for (size_t k = 0; k < packet->count; k++) sum += isfinite(out[k].t) ? out[k].t : 0;
  }
  plain->sink = sum;
}

struct runner plain_newton_face(struct plain_newton *plain) { return (struct runner){run, plain}; }

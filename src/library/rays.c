/* Rays of pscn.h, a packet at a time. */
#include <math.h>
#include <string.h>

#include "base/number.h"
#include "geometry/patch.h"
#include "intersect/tracer.h"
#include "library/library.h"

/* Up to PACKET_SIZE valid rays, and their numbers in the call. */
struct packet {
  size_t count, number[PACKET_SIZE];
  struct ray rays[PACKET_SIZE];
};

/* One call: how rays that can be traced are answered, what is written for one ray, the tracer, and where rays and
 * answers are stored. */
struct call {
  void (*answer)(struct call *call, const struct packet *packet);
  /* The answer of the tracer, or if `from` is NULL this verdict on a ray that is not traced. */
  void (*write)(struct call *call, size_t number, enum pscn_verdict verdict, const struct hit *from);
  struct tracer *tracer;
  const struct scene *scene;
  const struct pscn_ray *rays;
  void *answers;
  ptrdiff_t ray_stride, answer_stride;
  struct pscn_hit *hits; /* of pscn_all: rows of `most`, row_stride bytes apart */
  ptrdiff_t row_stride;
  size_t most;
  bool failed, short_of_memory; /* `failed`: some ray was invalid */
};

static void *answer_at(const struct call *call, size_t number)
{
  return (char *)call->answers + (ptrdiff_t)number * call->answer_stride;
}

/* Copies the ray. Returns false if it is invalid. */
static bool take_ray(const struct pscn_ray *ray, struct ray *out)
{
  bool in_range = true, moves = false;
  memcpy(out->origin, ray->origin, sizeof out->origin);
  memcpy(out->direction, ray->direction, sizeof out->direction);
  for (int k = 0; k < 3; k++) {
    in_range &= number_in_range(&out->origin[k]);
    in_range &= number_in_range(&out->direction[k]);
    moves |= out->direction[k] != 0;
  }
  out->t_min = ray->t_min;
  out->t_max = ray->t_max;
  return in_range && moves && ray->t_min >= 0 && !isnan(ray->t_max);
}

/* ---- answers ---- */

static bool is_certain(enum pscn_verdict verdict, const struct hit *from)
{
  return from ? from->certainty == CERTAINTY_CERTAIN : verdict == PSCN_MISS;
}

static struct pscn_hit make_hit(const struct call *call, enum pscn_verdict verdict, const struct hit *from)
{
  struct pscn_hit hit = {
    .t = INFINITY, .patch = PSCN_NO_PATCH, .verdict = (int32_t)verdict, .certain = is_certain(verdict, from)};
  if (!from || from->patch == HIT_NONE) return hit;
  hit.verdict = PSCN_HIT;
  hit.t = from->t, hit.u = from->u, hit.v = from->v;
  hit.point_error = from->point_error;
  hit.clearance = from->clearance;
  hit.patch = from->patch;
  memcpy(hit.point, from->point, sizeof hit.point);
  memcpy(hit.normal, from->normal, sizeof hit.normal);
  points_tangents(call->scene->patches[hit.patch].P, hit.u, hit.v, hit.du, hit.dv);
  return hit;
}

static void write_nearest(struct call *call, size_t number, enum pscn_verdict verdict, const struct hit *from)
{
  const struct pscn_hit hit = make_hit(call, verdict, from);
  memcpy(answer_at(call, number), &hit, sizeof hit);
}

static void write_short(struct call *call, size_t number, enum pscn_verdict verdict, const struct hit *from)
{
  struct pscn_answer answer = {
    .t = INFINITY, .patch = PSCN_NO_PATCH, .verdict = (int32_t)verdict, .certain = is_certain(verdict, from)};
  if (from && from->patch != HIT_NONE) {
    answer.t = from->t, answer.u = from->u, answer.v = from->v;
    answer.patch = from->patch, answer.verdict = PSCN_HIT;
  }
  memcpy(answer_at(call, number), &answer, sizeof answer);
}

/* Both of the above. */
static void answer_nearest(struct call *call, const struct packet *packet)
{
  struct hit hits[PACKET_SIZE];
  tracer_closest(call->tracer, packet->count, packet->rays, hits);
  for (size_t k = 0; k < packet->count; k++) call->write(call, packet->number[k], PSCN_MISS, &hits[k]);
}

static void write_occluded(struct call *call, size_t number, enum pscn_verdict verdict, const struct hit *from)
{
  (void)from;
  *(uint8_t *)answer_at(call, number) = (uint8_t)verdict;
}

static void answer_occluded(struct call *call, const struct packet *packet)
{
  bool occluded[PACKET_SIZE];
  tracer_occluded(call->tracer, packet->count, packet->rays, occluded);
  for (size_t k = 0; k < packet->count; k++)
    write_occluded(call, packet->number[k], occluded[k] ? PSCN_HIT : PSCN_MISS, NULL);
}

/* Writes the count of a ray and its row: the hits of `list` that there is room for, then misses. */
static void write_list(struct call *call, size_t number, const struct pscn_hits *counts, const struct hit list[])
{
  const size_t written = counts->count < call->most ? counts->count : call->most;
  struct pscn_hit rest = make_hit(call, counts->verdict == PSCN_NO_ANSWER ? PSCN_NO_ANSWER : PSCN_MISS, NULL);
  rest.certain = counts->certain;
  if (call->answers) memcpy(answer_at(call, number), counts, sizeof *counts);
  if (call->most == 0) return;
  char *row = (char *)call->hits + (ptrdiff_t)number * call->row_stride;
  for (size_t k = 0; k < call->most; k++) {
    const struct pscn_hit hit = k < written ? make_hit(call, PSCN_HIT, &list[k]) : rest;
    memcpy(row + k * sizeof hit, &hit, sizeof hit);
  }
}

static void write_all(struct call *call, size_t number, enum pscn_verdict verdict, const struct hit *from)
{
  const struct pscn_hits none = {.verdict = (int32_t)verdict, .certain = is_certain(verdict, from)};
  write_list(call, number, &none, NULL);
}

static void answer_all(struct call *call, const struct packet *packet)
{
  struct hit_list lists[PACKET_SIZE];
  call->short_of_memory = call->short_of_memory ||
                          tracer_all(call->tracer, packet->count, packet->rays, lists) != STATUS_OK;
  for (size_t k = 0; k < packet->count; k++) {
    if (call->short_of_memory) {
      write_all(call, packet->number[k], PSCN_NO_ANSWER, NULL);
      continue;
    }
    const struct pscn_hits counts = {.count = lists[k].count,
                                     .verdict = lists[k].count > 0 ? PSCN_HIT : PSCN_MISS,
                                     .certain = lists[k].certainty == CERTAINTY_CERTAIN};
    write_list(call, packet->number[k], &counts, lists[k].hits);
  }
}

/* ---- calls ---- */

static void answer_rays(struct call *call, size_t count)
{
  struct packet packet;
  packet.count = 0;
  for (size_t number = 0; number < count; number++) {
    struct pscn_ray ray;
    memcpy(&ray, (const char *)call->rays + (ptrdiff_t)number * call->ray_stride, sizeof ray);
    const size_t k = packet.count;
    if (!take_ray(&ray, &packet.rays[k])) {
      call->write(call, number, PSCN_NO_ANSWER, NULL);
      call->failed = true;
    } else if (!(packet.rays[k].t_min < packet.rays[k].t_max)) {
      call->write(call, number, PSCN_MISS, NULL);
    } else {
      packet.number[k] = number;
      packet.count++;
    }
    if (packet.count == PACKET_SIZE || (packet.count > 0 && number == count - 1)) {
      call->answer(call, &packet);
      packet.count = 0;
    }
  }
}

static enum pscn_status ask(const struct pscn_scene *scene, size_t count, struct call *call)
{
  if (count == 0) return pscn_scene_status(scene) == PSCN_OK ? PSCN_OK : PSCN_USAGE;
  if (!call->answers && !call->hits) return PSCN_USAGE;
  if (pscn_scene_status(scene) != PSCN_OK || !call->rays || !call->answers) {
    for (size_t k = 0; k < count; k++) call->write(call, k, PSCN_NO_ANSWER, NULL);
    return PSCN_USAGE;
  }
  struct calm calm;
  struct tracer tracer;
  calm_begin(&calm);
  const struct memory_hooks before = memory_use(scene->hooks);
  tracer_begin(scene->intersector, &tracer);
  call->scene = scene->scene;
  call->tracer = &tracer;
  answer_rays(call, count);
  tracer_end(&tracer);
  (void)memory_use(before);
  calm_end(&calm);
  if (call->short_of_memory) return PSCN_LIMIT;
  return call->failed ? PSCN_INPUT : PSCN_OK;
}

enum pscn_status pscn_nearest(const struct pscn_scene *scene, size_t count, const struct pscn_ray *rays,
                              ptrdiff_t ray_stride, struct pscn_hit *hits, ptrdiff_t hit_stride)
{
  struct call call = {.answer = answer_nearest, .write = write_nearest, .rays = rays, .ray_stride = ray_stride};
  call.answers = hits, call.answer_stride = hit_stride;
  return ask(scene, count, &call);
}

enum pscn_status pscn_nearest_answer(const struct pscn_scene *scene, size_t count, const struct pscn_ray *rays,
                                     ptrdiff_t ray_stride, struct pscn_answer *answers, ptrdiff_t answer_stride)
{
  struct call call = {.answer = answer_nearest, .write = write_short, .rays = rays, .ray_stride = ray_stride};
  call.answers = answers, call.answer_stride = answer_stride;
  return ask(scene, count, &call);
}

enum pscn_status pscn_occluded(const struct pscn_scene *scene, size_t count, const struct pscn_ray *rays,
                               ptrdiff_t ray_stride, uint8_t *verdicts, ptrdiff_t verdict_stride)
{
  struct call call = {.answer = answer_occluded, .write = write_occluded, .rays = rays, .ray_stride = ray_stride};
  call.answers = verdicts, call.answer_stride = verdict_stride;
  return ask(scene, count, &call);
}

enum pscn_status pscn_all(const struct pscn_scene *scene, size_t count, const struct pscn_ray *rays,
                          ptrdiff_t ray_stride, struct pscn_hits *counts, ptrdiff_t counts_stride,
                          struct pscn_hit *hits, ptrdiff_t row_stride, size_t most)
{
  struct call call = {.answer = answer_all, .write = write_all, .rays = rays, .ray_stride = ray_stride};
  call.answers = counts, call.answer_stride = counts_stride;
  call.hits = hits, call.row_stride = row_stride, call.most = hits ? most : 0;
  if (!hits && most > 0) call.rays = NULL; /* refused, as other wrong arguments are */
  return ask(scene, count, &call);
}

enum pscn_status pscn_leave(const struct pscn_scene *scene, const struct pscn_ray *ray, const struct pscn_hit *hit,
                            const double direction[3], double out_origin[3])
{
  struct ray on;
  if (!out_origin) return PSCN_USAGE;
  for (int k = 0; k < 3; k++) out_origin[k] = NAN;
  if (pscn_scene_status(scene) != PSCN_OK || !ray || !hit || !direction || hit->verdict != PSCN_HIT) return PSCN_USAGE;
  if (!take_ray(ray, &on)) return PSCN_INPUT;
  struct hit from = {.certainty = hit->certain ? CERTAINTY_CERTAIN : CERTAINTY_GRAZING,
                     .t = hit->t,
                     .u = hit->u,
                     .v = hit->v,
                     .clearance = hit->clearance};
  memcpy(from.point, hit->point, sizeof from.point);
  memcpy(from.normal, hit->normal, sizeof from.normal);
  struct calm calm;
  struct tracer tracer;
  calm_begin(&calm);
  tracer_begin(scene->intersector, &tracer);
  tracer_leave(&tracer, &on, &from, direction, out_origin);
  calm_end(&calm);
  return PSCN_OK;
}

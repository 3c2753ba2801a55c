/* Rays of pscn.h, a packet at a time. */
#include <math.h>
#include <string.h>

#include "base/number.h"
#include "geometry/patch.h"
#include "intersect/tracer.h"
#include "library/library.h"

/* One call: the tracer, and where rays and answers are stored. `failed`: some ray was invalid. */
struct call {
  struct tracer *tracer;
  const struct scene *scene;
  const char *rays;
  char *answers;
  ptrdiff_t ray_stride, answer_stride;
  char *hits; /* of pscn_all: rows of `most`, row_stride bytes apart */
  ptrdiff_t row_stride;
  size_t most;
  bool failed, short_of_memory;
};

/* Up to PACKET_SIZE valid rays, and their numbers in the call. */
struct packet {
  size_t count, number[PACKET_SIZE];
  struct ray rays[PACKET_SIZE];
};

static const struct pscn_hit NO_HIT = {.t = INFINITY, .patch = PSCN_NO_PATCH};

static void *answer_at(const struct call *call, size_t number)
{
  return call->answers + (ptrdiff_t)number * call->answer_stride;
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

/* ---- the nearest hit ---- */

static struct pscn_hit make_hit(const struct call *call, const struct hit *from)
{
  struct pscn_hit hit = NO_HIT;
  hit.certain = from->certainty == CERTAINTY_CERTAIN;
  if (from->patch == HIT_NONE) return hit;
  hit.verdict = PSCN_HIT;
  hit.t = from->t;
  hit.u = from->u;
  hit.v = from->v;
  hit.point_error = from->point_error;
  hit.clearance = from->clearance;
  hit.patch = from->patch;
  for (int k = 0; k < 3; k++) {
    hit.point[k] = from->point[k];
    hit.normal[k] = from->normal[k];
  }
  points_tangents(call->scene->patches[hit.patch].P, hit.u, hit.v, hit.du, hit.dv);
  return hit;
}

static void answer_nearest(struct call *call, const struct packet *packet)
{
  struct hit hits[PACKET_SIZE];
  tracer_closest(call->tracer, packet->count, packet->rays, hits);
  for (size_t k = 0; k < packet->count; k++) {
    const struct pscn_hit hit = make_hit(call, &hits[k]);
    memcpy(answer_at(call, packet->number[k]), &hit, sizeof hit);
  }
}

static void write_nearest(struct call *call, size_t number, enum pscn_verdict verdict)
{
  struct pscn_hit hit = NO_HIT;
  hit.verdict = (int32_t)verdict;
  hit.certain = verdict == PSCN_MISS;
  memcpy(answer_at(call, number), &hit, sizeof hit);
}

/* ---- the same in short ---- */

static void write_short(struct call *call, size_t number, enum pscn_verdict verdict)
{
  const struct pscn_answer answer = {
    .t = INFINITY, .patch = PSCN_NO_PATCH, .verdict = (int32_t)verdict, .certain = verdict == PSCN_MISS};
  memcpy(answer_at(call, number), &answer, sizeof answer);
}

static void answer_short(struct call *call, const struct packet *packet)
{
  struct hit hits[PACKET_SIZE];
  tracer_closest(call->tracer, packet->count, packet->rays, hits);
  for (size_t k = 0; k < packet->count; k++) {
    struct pscn_answer answer = {
      .t = INFINITY, .patch = PSCN_NO_PATCH, .certain = hits[k].certainty == CERTAINTY_CERTAIN};
    if (hits[k].patch != HIT_NONE) {
      answer.t = hits[k].t, answer.u = hits[k].u, answer.v = hits[k].v;
      answer.patch = hits[k].patch, answer.verdict = PSCN_HIT;
    }
    memcpy(answer_at(call, packet->number[k]), &answer, sizeof answer);
  }
}

/* ---- any hit ---- */

static void write_occluded(struct call *call, size_t number, enum pscn_verdict verdict)
{
  *(uint8_t *)answer_at(call, number) = (uint8_t)verdict;
}

static void answer_occluded(struct call *call, const struct packet *packet)
{
  bool occluded[PACKET_SIZE];
  tracer_occluded(call->tracer, packet->count, packet->rays, occluded);
  for (size_t k = 0; k < packet->count; k++)
    write_occluded(call, packet->number[k], occluded[k] ? PSCN_HIT : PSCN_MISS);
}

/* ---- all hits ---- */

/* Writes the count of a ray and its row: the hits of `list` that there is room for, then misses. */
static void write_list(struct call *call, size_t number, const struct pscn_hits *counts, const struct hit list[])
{
  const size_t written = counts->count < call->most ? counts->count : call->most;
  struct pscn_hit rest = NO_HIT;
  if (counts->verdict == PSCN_NO_ANSWER) rest.verdict = PSCN_NO_ANSWER;
  else rest.certain = counts->certain;
  if (call->answers) memcpy(answer_at(call, number), counts, sizeof *counts);
  if (call->most == 0) return;
  char *row = call->hits + (ptrdiff_t)number * call->row_stride;
  for (size_t k = 0; k < written; k++) {
    const struct pscn_hit hit = make_hit(call, &list[k]);
    memcpy(row + k * sizeof hit, &hit, sizeof hit);
  }
  for (size_t k = written; k < call->most; k++) memcpy(row + k * sizeof rest, &rest, sizeof rest);
}

static void write_all(struct call *call, size_t number, enum pscn_verdict verdict)
{
  write_list(call, number, &(struct pscn_hits){.verdict = (int32_t)verdict, .certain = verdict == PSCN_MISS}, NULL);
}

static void answer_all(struct call *call, const struct packet *packet)
{
  struct hit_list lists[PACKET_SIZE];
  const bool answered = !call->short_of_memory &&
                        tracer_all(call->tracer, packet->count, packet->rays, lists) == STATUS_OK;
  call->short_of_memory = !answered;
  for (size_t k = 0; k < packet->count; k++) {
    if (!answered) {
      write_all(call, packet->number[k], PSCN_NO_ANSWER);
      continue;
    }
    const struct pscn_hits counts = {.count = lists[k].count,
                                     .verdict = lists[k].count > 0 ? PSCN_HIT : PSCN_MISS,
                                     .certain = lists[k].certainty == CERTAINTY_CERTAIN};
    write_list(call, packet->number[k], &counts, lists[k].hits);
  }
}

/* ---- calls ---- */

/* A query: how rays that can be traced are answered, and what is written for the others. */
struct asked {
  void (*answer)(struct call *call, const struct packet *packet);
  void (*write)(struct call *call, size_t number, enum pscn_verdict verdict);
  bool takes_memory;
};

static void answer_rays(struct call *call, const struct asked *asked, size_t count)
{
  struct packet packet;
  packet.count = 0;
  for (size_t number = 0; number < count; number++) {
    struct pscn_ray ray;
    memcpy(&ray, call->rays + (ptrdiff_t)number * call->ray_stride, sizeof ray);
    const size_t k = packet.count;
    if (!take_ray(&ray, &packet.rays[k])) {
      asked->write(call, number, PSCN_NO_ANSWER);
      call->failed = true;
    } else if (!(packet.rays[k].t_min < packet.rays[k].t_max)) {
      asked->write(call, number, PSCN_MISS);
    } else {
      packet.number[k] = number;
      packet.count++;
    }
    if (packet.count == PACKET_SIZE || (packet.count > 0 && number == count - 1)) {
      asked->answer(call, &packet);
      packet.count = 0;
    }
  }
}

static enum pscn_status ask(const struct pscn_scene *scene, const struct asked *asked, size_t count, struct call *call)
{
  if (count == 0) return pscn_scene_status(scene) == PSCN_OK ? PSCN_OK : PSCN_USAGE;
  if (!call->answers && !call->hits) return PSCN_USAGE;
  if (pscn_scene_status(scene) != PSCN_OK || !call->rays || !call->answers) {
    for (size_t k = 0; k < count; k++) asked->write(call, k, PSCN_NO_ANSWER);
    return PSCN_USAGE;
  }
  struct calm calm;
  struct tracer tracer;
  calm_begin(&calm);
  tracer_begin(scene->intersector, &tracer);
  call->scene = scene->scene;
  call->tracer = &tracer;
  if (asked->takes_memory) {
    const struct memory_hooks before = memory_use(scene->hooks);
    answer_rays(call, asked, count);
    tracer_end(&tracer);
    (void)memory_use(before);
  } else {
    answer_rays(call, asked, count);
  }
  calm_end(&calm);
  if (call->short_of_memory) return PSCN_LIMIT;
  return call->failed ? PSCN_INPUT : PSCN_OK;
}

static enum pscn_status ask_each(const struct pscn_scene *scene, const struct asked *asked, size_t count,
                                 const struct pscn_ray *rays, ptrdiff_t ray_stride, void *answers, ptrdiff_t stride)
{
  struct call call = {
    .rays = (const char *)rays, .answers = answers, .ray_stride = ray_stride, .answer_stride = stride};
  return ask(scene, asked, count, &call);
}

enum pscn_status pscn_nearest(const struct pscn_scene *scene, size_t count, const struct pscn_ray *rays,
                              ptrdiff_t ray_stride, struct pscn_hit *hits, ptrdiff_t hit_stride)
{
  static const struct asked asked = {answer_nearest, write_nearest, false};
  return ask_each(scene, &asked, count, rays, ray_stride, hits, hit_stride);
}

enum pscn_status pscn_nearest_answer(const struct pscn_scene *scene, size_t count, const struct pscn_ray *rays,
                                     ptrdiff_t ray_stride, struct pscn_answer *answers, ptrdiff_t answer_stride)
{
  static const struct asked asked = {answer_short, write_short, false};
  return ask_each(scene, &asked, count, rays, ray_stride, answers, answer_stride);
}

enum pscn_status pscn_occluded(const struct pscn_scene *scene, size_t count, const struct pscn_ray *rays,
                               ptrdiff_t ray_stride, uint8_t *verdicts, ptrdiff_t verdict_stride)
{
  static const struct asked asked = {answer_occluded, write_occluded, false};
  return ask_each(scene, &asked, count, rays, ray_stride, verdicts, verdict_stride);
}

enum pscn_status pscn_all(const struct pscn_scene *scene, size_t count, const struct pscn_ray *rays,
                          ptrdiff_t ray_stride, struct pscn_hits *counts, ptrdiff_t counts_stride,
                          struct pscn_hit *hits, ptrdiff_t row_stride, size_t most)
{
  static const struct asked asked = {answer_all, write_all, true};
  struct call call = {.rays = (const char *)rays,
                      .answers = (char *)counts,
                      .ray_stride = ray_stride,
                      .answer_stride = counts_stride,
                      .hits = (char *)hits,
                      .row_stride = row_stride,
                      .most = hits ? most : 0};
  if (!hits && most > 0) call.rays = NULL; /* refused, as other wrong arguments are */
  return ask(scene, &asked, count, &call);
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

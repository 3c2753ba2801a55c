/* A picture of a scene: threads take tiles from a common counter, while the calling thread watches. */
#define _GNU_SOURCE 1 /* sched_getaffinity, CPU_COUNT, sem_clockwait */
#include "render/render.h"

#include <errno.h>
#include <sched.h>
#include <semaphore.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "base/clock.h"
#include "render/threads.h"

enum {
  WATCH_NANOSECONDS = 100 * 1000 * 1000, /* between two looks at progress */
  NANOSECONDS = 1000 * 1000 * 1000
};

/* Shared by the threads: atomic or read-only. */
struct crew {
  const struct tile_job *job;
  const struct render_watch *watch;
  const struct tile_list *tiles;
  size_t pixels_total;
  atomic_size_t next, pixels;
  atomic_uint_fast64_t rays;
  atomic_bool aborted;
  sem_t ended; /* counts workers */
  struct worker *workers;
};

struct worker {
  struct tracer *tracer, *certified; /* certified: NULL unless needed */
};

static uint64_t count_rays(const struct tracer *tracer)
{
  const struct intersect_counts *counts = tracer_counts(tracer);
  return counts->rays[0] + counts->rays[1];
}

static bool stopped(const struct crew *crew) { return atomic_load(&crew->aborted) || tile_stopped(crew->job); }

/* Renders what is left of a tile, row by row. With warm starts, that is all of it. */
static void render_tile(struct crew *crew, const struct worker *worker, size_t k)
{
  const struct tile_list *tiles = crew->tiles;
  size_t row = crew->job->every_pixel ? 0 : atomic_load(&tiles->rows[k]);
  uint64_t rays = count_rays(worker->tracer);
  tracer_forget(worker->tracer);
  for (; row < TILE_ROWS && tile_render_row(crew->job, worker->tracer, worker->certified, &tiles->tile[k], row);
       row++) {
    const uint64_t before = rays;
    rays = count_rays(worker->tracer);
    atomic_fetch_add(&crew->rays, rays - before);
    if (row < atomic_load(&tiles->rows[k])) continue;
    atomic_fetch_add(&crew->pixels,
                     tiles->tile[k].width * (tile_top(tiles, k, row + 1).height - tile_top(tiles, k, row).height));
    atomic_store(&tiles->rows[k], (unsigned char)(row + 1));
  }
}

static enum status work(void *context, size_t index)
{
  struct crew *crew = context;
  const struct worker *worker = &crew->workers[index];
  while (!stopped(crew)) {
    const size_t k = atomic_fetch_add(&crew->next, 1);
    if (k >= crew->tiles->count) break;
    if (!tile_is_done(crew->tiles, k)) render_tile(crew, worker, k);
  }
  (void)sem_post(&crew->ended);
  return STATUS_OK;
}

/* Waits for `count` workers to end, and reports progress. */
static void watch_crew(struct crew *crew, size_t count, double start)
{
  const struct render_watch *watch = crew->watch;
  for (size_t ended = 0; ended < count;) {
    struct timespec until;
    clock_gettime(CLOCK_MONOTONIC, &until);
    until.tv_nsec += WATCH_NANOSECONDS;
    until.tv_sec += until.tv_nsec / NANOSECONDS;
    until.tv_nsec %= NANOSECONDS;
    if (sem_clockwait(&crew->ended, CLOCK_MONOTONIC, &until) == 0) {
      ended++;
    } else if (errno == ETIMEDOUT && watch->progress != NULL) {
      const struct render_progress progress = {.pixels = atomic_load(&crew->pixels),
                                               .pixels_total = crew->pixels_total,
                                               .rays = atomic_load(&crew->rays),
                                               .seconds = clock_seconds(CLOCK_MONOTONIC) - start};
      watch->progress(watch->context, &progress);
    }
  }
}

/* Runs the workers to their end. */
static enum status run_crew(struct crew *crew, size_t count, double start)
{
  struct thread *threads = calloc(count + 1, sizeof *threads);
  if (threads == NULL) return STATUS_LIMIT;
  const size_t started = threads_start(threads, 0, count, work, crew);
  if (started < count) atomic_store(&crew->aborted, true);
  watch_crew(crew, started, start);
  const enum status status = threads_join(threads, started);
  free(threads);
  if (started < count) return STATUS_LIMIT;
  return status == STATUS_OK && stopped(crew) ? STATUS_INTERRUPTED : status;
}

/* The same scene with the default solver, whose answers are proven. Borrows the scene. */
struct certified {
  struct scene scene;
  struct method method;
  struct intersector *intersector;
};

static enum status certified_create(const struct scene *scene, const struct team *team, struct certified *out)
{
  out->scene = *scene;
  out->scene.patches = calloc(scene->patch_count + 1, sizeof *scene->patches);
  if (out->scene.patches == NULL) return STATUS_LIMIT;
  memcpy(out->scene.patches, scene->patches, scene->patch_count * sizeof *scene->patches);
  method_default(solver_at(0), &out->method);
  out->scene.solvers = &out->method;
  scene_override_solver(&out->scene, &out->method);
  return intersector_create_by(&out->scene, team, &out->intersector);
}

static void certified_destroy(struct certified *certified)
{
  intersector_destroy(certified->intersector);
  free(certified->scene.patches);
}

static void add_counts(struct intersect_counts *sum, const struct intersect_counts *counts)
{
  sum->rays[0] += counts->rays[0];
  sum->rays[1] += counts->rays[1];
  sum->patches_tested += counts->patches_tested;
  sum->roots_found += counts->roots_found;
  sum->roots_accepted += counts->roots_accepted;
  for (int k = 0; k < STAGE_COUNT; k++) sum->stages[k] += counts->stages[k];
  sum->escalated += counts->escalated;
  sum->work += counts->work;
  sum->certain += counts->certain;
  sum->grazing += counts->grazing;
}

/* Makes a tracer for each worker, and one of the certified scene if there is one. */
static enum status workers_create(struct worker workers[], size_t count, const struct intersector *intersector,
                                  const struct intersector *certified, const atomic_int *stop)
{
  enum status status = STATUS_OK;
  for (size_t k = 0; k < count && status == STATUS_OK; k++) {
    status = tracer_create(intersector, &workers[k].tracer);
    if (status == STATUS_OK && certified != NULL) status = tracer_create(certified, &workers[k].certified);
    if (status == STATUS_OK) tracer_stop_at(workers[k].tracer, stop);
  }
  return status;
}

/* Also adds up their counts. */
static void workers_destroy(struct worker workers[], size_t count, struct intersect_counts *sum)
{
  for (size_t k = 0; k < count && workers[k].tracer != NULL; k++) {
    add_counts(sum, tracer_counts(workers[k].tracer));
    tracer_destroy(workers[k].tracer);
    tracer_destroy(workers[k].certified);
  }
}

enum status render_scene(const struct scene *scene, const struct intersector *intersector,
                         const struct render_options *options, const struct render_watch *watch, float *out,
                         struct render_stats *out_stats)
{
  const double start = clock_seconds(CLOCK_MONOTONIC);
  *out_stats = (struct render_stats){0};
  struct tile_seen seen = {0};
  const struct tile_job job = {.scene = scene,
                               .options = options,
                               .every_pixel = scene_starts_warm(scene),
                               .out = out,
                               .stop = {watch->stop, watch->failed},
                               .seen = &seen};
  struct tile_list all = {0};
  struct crew crew = {.job = &job, .watch = watch, .tiles = options->tiles == NULL ? &all : options->tiles};
  enum status status = options->tiles == NULL ? tile_list_create(&options->crop, 1, 1, &all) : STATUS_OK;
  crew.pixels_total = tile_list_pixels(crew.tiles, false) - tile_list_pixels(crew.tiles, true);
  const size_t count = options->threads < crew.tiles->count ? options->threads : crew.tiles->count;
  struct worker *workers = calloc(count + 1, sizeof *workers);
  const struct team team = threads_team(options->threads);
  struct certified certified = {.intersector = NULL};
  crew.workers = workers;
  if (workers == NULL) status = STATUS_LIMIT;
  if (status == STATUS_OK && channel_list_has(&options->channels, CHANNEL_DEVIATION))
    status = certified_create(scene, &team, &certified);
  if (status == STATUS_OK) status = workers_create(workers, count, intersector, certified.intersector, watch->stop);
  if (status == STATUS_OK && sem_init(&crew.ended, 0, 0) != 0) status = STATUS_LIMIT;
  if (status == STATUS_OK) {
    status = run_crew(&crew, count, start);
    (void)sem_destroy(&crew.ended);
  }
  if (workers != NULL) workers_destroy(workers, count, &out_stats->counts);
  free(workers);
  certified_destroy(&certified);
  tile_list_destroy(&all);
  out_stats->threads = count;
  out_stats->seen = atomic_load(&seen.patch), out_stats->lit = atomic_load(&seen.light);
  return status;
}

size_t render_processors(void)
{
  cpu_set_t set;
  CPU_ZERO(&set);
  if (sched_getaffinity(0, sizeof set, &set) == 0 && CPU_COUNT(&set) > 0) return (size_t)CPU_COUNT(&set);
  const long online = sysconf(_SC_NPROCESSORS_ONLN);
  return online > 0 ? (size_t)online : 1;
}

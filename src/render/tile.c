/* Tiles: packets of rays, their colours, and the values stored for them. */
#include "render/tile.h"

#include <math.h>

#include "geometry/vector.h"
#include "render/camera.h"
#include "render/measure.h"
#include "render/render.h"
#include "render/shade.h"

/* A pixel while its samples are gathered. */
struct pixel {
  size_t x, y;
  double rgb[3];  /* sum over the samples */
  size_t hits;    /* samples that hit */
  bool lit;       /* one of them is not black */
  struct hit hit; /* of the middle sample, with its distance */
  double distance;
  struct solver_numbers solver; /* if needed */
  double deviation;
};

static bool inside(const struct rectangle *r, size_t x, size_t y)
{
  return x >= r->x && x - r->x < r->width && y >= r->y && y - r->y < r->height;
}

/* The pixels of the packet at (x0, y0) that are rendered. */
static size_t gather(const struct tile_job *job, const struct rectangle *kept, size_t x0, size_t y0,
                     struct pixel out[PACKET_SIZE])
{
  size_t count = 0;
  for (size_t k = 0; k < PACKET_SIZE; k++) {
    const size_t x = x0 + k % PACKET_WIDTH, y = y0 + k / PACKET_WIDTH;
    if (!(x < job->options->width && y < job->options->height && (job->every_pixel || inside(kept, x, y)))) continue;
    /* Of the rest, a hundred bytes, only what is needed is written. */
    struct pixel *pixel = &out[count++];
    pixel->x = x, pixel->y = y, pixel->hits = 0, pixel->lit = false, pixel->hit.patch = HIT_NONE;
    pixel->rgb[0] = pixel->rgb[1] = pixel->rgb[2] = 0;
  }
  return count;
}

/* Sets the pixels' deviations from the certified hits. */
static void deviations(struct tracer *certified, size_t count, const struct ray rays[], const struct hit hits[],
                       struct pixel pixels[])
{
  struct hit exact[PACKET_SIZE];
  tracer_closest(certified, count, rays, exact);
  for (size_t k = 0; k < count; k++) {
    const bool missed = hits[k].patch == HIT_NONE, misses = exact[k].patch == HIT_NONE;
    if (missed || misses) pixels[k].deviation = missed == misses ? 0 : INFINITY;
    else pixels[k].deviation = fabs(hits[k].t - exact[k].t) / exact[k].t;
  }
}

/* Adds sample (i, j) to every pixel. */
static void sample(const struct tile_job *job, struct tracer *tracer, struct tracer *certified, size_t i, size_t j,
                   size_t count, struct pixel pixels[])
{
  const struct render_options *options = job->options;
  const double n = (double)options->samples;
  const bool plain = channel_list_is_rgb(&options->channels); /* needs no sample's hit */
  const bool middle = !plain && i == options->samples / 2 && j == options->samples / 2;
  struct ray rays[PACKET_SIZE];
  struct hit hits[PACKET_SIZE];
  double rgb[PACKET_SIZE][3];
  for (size_t k = 0; k < count; k++) {
    const double s = ((double)pixels[k].x + ((double)i + 0.5) / n) / (double)options->width;
    const double t = ((double)pixels[k].y + ((double)j + 0.5) / n) / (double)options->height;
    camera_ray(&job->scene->camera, s, t, &rays[k]);
  }
  if (middle && channel_list_measures(&options->channels))
    for (size_t k = 0; k < count; k++) measure_ray(tracer, &rays[k], &hits[k], &pixels[k].solver);
  else tracer_closest(tracer, count, rays, hits);
  if (middle && certified != NULL) deviations(certified, count, rays, hits, pixels);
  shade_packet(job->scene, tracer, count, rays, hits, rgb);
  for (size_t k = 0; k < count; k++) {
    vector_add_scaled(pixels[k].rgb, 1, rgb[k], pixels[k].rgb);
    pixels[k].hits += hits[k].patch != HIT_NONE;
    pixels[k].lit |= hits[k].patch != HIT_NONE && (rgb[k][0] != 0 || rgb[k][1] != 0 || rgb[k][2] != 0);
    if (middle) {
      pixels[k].hit = hits[k];
      pixels[k].distance = hits[k].patch == HIT_NONE ? INFINITY : hits[k].t * vector_length(rays[k].direction);
    }
  }
}

static double status_value(const struct hit *hit)
{
  const bool missed = hit->patch == HIT_NONE, certain = hit->certainty == CERTAINTY_CERTAIN;
  if (missed) return certain ? CHANNEL_MISS_CERTAIN : CHANNEL_MISS_GRAZING;
  return certain ? CHANNEL_HIT_CERTAIN : CHANNEL_HIT_GRAZING;
}

/* The values of one channel; `samples` is the pixel's number of rays. */
static void channel_values(enum channel_kind kind, const struct pixel *pixel, double samples, double out[3])
{
  const struct hit *hit = &pixel->hit;
  const bool missed = hit->patch == HIT_NONE;
  switch (kind) {
  case CHANNEL_RGB: vector_scale(1 / samples, pixel->rgb, out); break;
  case CHANNEL_COVERAGE: out[0] = (double)pixel->hits / samples; break;
  case CHANNEL_DEPTH: out[0] = pixel->distance; break;
  case CHANNEL_U: out[0] = missed ? 0 : hit->u; break;
  case CHANNEL_V: out[0] = missed ? 0 : hit->v; break;
  case CHANNEL_PATCH: out[0] = missed ? -1 : (double)hit->patch; break;
  case CHANNEL_NORMAL:
    for (int k = 0; k < 3; k++) out[k] = missed ? 0 : hit->normal[k];
    break;
  case CHANNEL_STATUS: out[0] = status_value(hit); break;
  case CHANNEL_ITERATIONS: out[0] = pixel->solver.iterations; break;
  case CHANNEL_ROOTS: out[0] = pixel->solver.roots; break;
  case CHANNEL_RESIDUAL: out[0] = pixel->solver.residual; break;
  case CHANNEL_DEVIATION: out[0] = pixel->deviation; break;
  case CHANNEL_KINDS: break;
  }
}

static void keep(const struct tile_job *job, const struct pixel *pixel)
{
  const struct render_options *options = job->options;
  const size_t index = (pixel->y - options->crop.y) * options->crop.width + (pixel->x - options->crop.x);
  const double samples = (double)options->samples * (double)options->samples;
  float *out = job->out + index * options->channels.width;
  for (size_t c = 0; c < options->channels.count; c++) {
    const enum channel_kind kind = options->channels.kind[c];
    double values[3] = {0};
    channel_values(kind, pixel, samples, values);
    for (size_t k = 0; k < channel_traits(kind)->width; k++) *out++ = (float)values[k];
  }
}

bool tile_render_row(const struct tile_job *job, struct tracer *tracer, struct tracer *certified,
                     const struct rectangle *kept, size_t row)
{
  const struct render_options *options = job->options;
  const size_t x0 = kept->x / TILE_SIZE * TILE_SIZE, y = kept->y / TILE_SIZE * TILE_SIZE + row * PACKET_HEIGHT;
  for (size_t x = x0; x < x0 + TILE_SIZE; x += PACKET_WIDTH) {
    struct pixel pixels[PACKET_SIZE];
    const size_t count = gather(job, kept, x, y, pixels);
    for (size_t k = 0; k < options->samples * options->samples && count > 0; k++) {
      if (tile_stopped(job)) return false;
      sample(job, tracer, certified, k % options->samples, k / options->samples, count, pixels);
    }
    for (size_t k = 0; k < count; k++) {
      if (!inside(kept, pixels[k].x, pixels[k].y)) continue;
      keep(job, &pixels[k]);
      if (pixels[k].hits > 0 && !atomic_load(&job->seen->patch)) atomic_store(&job->seen->patch, true);
      if (pixels[k].lit && !atomic_load(&job->seen->light)) atomic_store(&job->seen->light, true);
    }
  }
  return !tile_stopped(job);
}

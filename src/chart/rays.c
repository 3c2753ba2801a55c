/* Rays for the chart, in the order of src/render/tile.c and as src/render/shade.c sends them. */
#include "chart/rays.h"

#include <assert.h>

#include "render/camera.h"
#include "render/shade.h"
#include "render/tile.h"

static_assert((int)STRIP_HEIGHT == (int)PACKET_HEIGHT && (int)STRIP_WIDTH == (int)TILE_SIZE,
              "a strip is a row of packets in a tile");

/* The picture as strips, numbered in the renderer's order: tile by tile, and in a tile from the top. */
struct strips {
  size_t width, height, columns, per_tile;
};

static size_t ceiling(size_t a, size_t b) { return (a + b - 1) / b; }

static void add_strip(const struct scene *scene, const struct strips *strips, size_t index, struct ray_list *out)
{
  const size_t tile = index / strips->per_tile, row = index % strips->per_tile;
  const size_t x0 = tile % strips->columns * STRIP_WIDTH, y0 = tile / strips->columns * TILE_SIZE + row * STRIP_HEIGHT;
  bool new_run = true;
  for (size_t at = x0; at < x0 + STRIP_WIDTH; at += PACKET_WIDTH) {
    const size_t first = out->count;
    for (size_t k = 0; k < PACKET_SIZE; k++) {
      const size_t x = at + k % PACKET_WIDTH, y = y0 + k / PACKET_WIDTH;
      if (x >= strips->width || y >= strips->height) continue;
      camera_ray(&scene->camera, ((double)x + 0.5) / (double)strips->width, ((double)y + 0.5) / (double)strips->height,
                 &out->rays[out->count++]);
    }
    if (out->count == first) continue;
    out->packets[out->packet_count++] = (struct ray_packet){first, out->count - first, new_run};
    new_run = false;
  }
}

static enum status list_create(struct arena *arena, size_t rays, size_t packets, struct ray_list *out)
{
  *out = (struct ray_list){.rays = arena_alloc(arena, rays + 1, sizeof *out->rays),
                           .packets = arena_alloc(arena, packets + 1, sizeof *out->packets)};
  return out->rays == NULL || out->packets == NULL ? STATUS_LIMIT : STATUS_OK;
}

enum status rays_of_camera(const struct scene *scene, size_t width, size_t height, size_t wanted, struct arena *arena,
                           struct ray_list *out)
{
  const struct strips strips = {width, height, ceiling(width, STRIP_WIDTH), TILE_SIZE / STRIP_HEIGHT};
  const size_t total = strips.columns * ceiling(height, TILE_SIZE) * strips.per_tile;
  size_t chosen = ceiling(wanted, STRIP_WIDTH * STRIP_HEIGHT);
  if (wanted >= width * height || chosen > total) chosen = total;
  const size_t rays = chosen * STRIP_WIDTH * STRIP_HEIGHT, packets = chosen * STRIP_WIDTH / PACKET_WIDTH;
  const enum status status = list_create(arena, rays, packets, out);
  if (status != STATUS_OK) return status;
  for (size_t k = 0; k < chosen; k++) /* the middles of `chosen` equal parts */
    add_strip(scene, &strips, (size_t)(((double)k + 0.5) * (double)total / (double)chosen), out);
  return STATUS_OK;
}

enum status rays_of_shadows(const struct scene *scene, struct tracer *tracer, const struct ray_list *camera,
                            const struct hit *hits, struct arena *arena, struct ray_list *out)
{
  size_t lights = 0;
  for (size_t l = 0; l < scene->light_count; l++) lights += !scene->lights[l].shadowless;
  const enum status status = list_create(arena, camera->count * lights, camera->packet_count * lights, out);
  if (status != STATUS_OK) return status;
  bool new_run = false;
  for (size_t p = 0; p < camera->packet_count; p++) {
    const struct ray_packet *packet = &camera->packets[p];
    new_run = new_run || packet->new_run;
    for (size_t l = 0; l < scene->light_count; l++) {
      if (scene->lights[l].shadowless) continue;
      const size_t first = out->count;
      bool sent[PACKET_SIZE];
      out->count += shade_shadow_rays(&scene->lights[l], tracer, packet->count, &camera->rays[packet->first],
                                      &hits[packet->first], &out->rays[first], sent);
      if (out->count == first) continue;
      out->packets[out->packet_count++] = (struct ray_packet){first, out->count - first, new_run};
      new_run = false;
    }
  }
  return STATUS_OK;
}

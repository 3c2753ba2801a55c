/* The rays of a chart: a fixed, even choice of a scene's camera rays, and the shadow rays of their hits.
 *
 * Rays are in the order in which the renderer traces them, in packets of neighbouring pixels. A run is one row of
 * packets of a tile, STRIP_WIDTH x STRIP_HEIGHT pixels. Runs are chosen whole, so that packets and warm starts have the
 * coherence of a picture.
 */
#ifndef PSCN_CHART_RAYS_H
#define PSCN_CHART_RAYS_H

#include <stddef.h>

#include "base/arena.h"
#include "base/status.h"
#include "intersect/intersect.h"
#include "scene/scene.h"

enum { STRIP_WIDTH = 32, STRIP_HEIGHT = 4 };

/* A packet: rays[first .. first + count - 1]. new_run: nothing is kept from the packet before it. */
struct ray_packet {
  size_t first, count;
  bool new_run;
};

struct ray_list {
  struct ray *rays;
  size_t count;
  struct ray_packet *packets;
  size_t packet_count;
};

/* Camera rays of a picture of width x height pixels, through the middles of pixels: about `wanted` of them, or all if
 * wanted is at least their number. STATUS_LIMIT if memory is short. Everything lives in `arena`. */
enum status rays_of_camera(const struct scene *scene, size_t width, size_t height, size_t wanted, struct arena *arena,
                           struct ray_list *out) STATUS_MUST_CHECK;

/* The shadow rays that the renderer sends from the hits of `camera`, where hits[] are the answers to its rays: packet
 * by packet, one light after the other. `tracer` is of that scene. */
enum status rays_of_shadows(const struct scene *scene, struct tracer *tracer, const struct ray_list *camera,
                            const struct hit *hits, struct arena *arena, struct ray_list *out) STATUS_MUST_CHECK;

#endif

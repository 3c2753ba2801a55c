/* Tiles, a thread's unit of work.
 *
 * The grid of tiles, and the grid of packets in each tile, are fixed to the picture, and a tracer starts each tile
 * without memory. A pixel therefore depends neither on the crop nor on the thread that renders it.
 */
#ifndef PSCN_RENDER_TILE_H
#define PSCN_RENDER_TILE_H

#include <stdbool.h>
#include <stddef.h>

#include "base/rectangle.h"
#include "intersect/explain.h"
#include "render/channels.h"
#include "scene/scene.h"

/* Sides in pixels of a tile, and of a packet, which divides it evenly. */
enum { TILE_SIZE = 32, PACKET_WIDTH = 4, PACKET_HEIGHT = PACKET_SIZE / PACKET_WIDTH };

/* What to render. Pointers are borrowed. */
struct tile_job {
  const struct scene *scene;
  size_t width, height;  /* of the whole picture, pixels */
  size_t samples;        /* N: N x N rays per pixel, on a regular grid */
  struct rectangle crop; /* the pixels that `out` holds */
  bool every_pixel;      /* render whole tiles, because a ray may depend on the previous one (`start previous`) */
  struct channel_list channels;
  float *out; /* [crop.height][crop.width][channels.width] */
};

/* Renders the tile that contains the pixels `kept`, and stores those. `certified` answers for CHANNEL_DEVIATION; NULL
 * if that is not needed. */
void tile_render(const struct tile_job *job, struct tracer *tracer, struct tracer *certified,
                 const struct rectangle *kept);

#endif

/* Tiles: the unit of work of a thread.
 *
 * The grid of tiles, and in each tile the grid of packets, is fixed to the picture, and a tracer starts
 * each tile without memory. So a pixel depends neither on the crop nor on which thread renders it.
 */
#ifndef PSCN_RENDER_TILE_H
#define PSCN_RENDER_TILE_H

#include <stdbool.h>
#include <stddef.h>

#include "base/rectangle.h"
#include "intersect/explain.h"
#include "render/channels.h"
#include "scene/scene.h"

/* Pixels a side of a tile, which is a multiple of a packet's, and of a packet. */
enum { TILE_SIZE = 32, PACKET_WIDTH = 4, PACKET_HEIGHT = PACKET_SIZE / PACKET_WIDTH };

/* What is to be rendered. Borrowed pointers. */
struct tile_job {
  const struct scene *scene;
  size_t width, height;  /* of the whole picture, pixels */
  size_t samples;        /* N: N x N rays a pixel, on a regular grid */
  struct rectangle crop; /* the pixels that `out` holds */
  bool every_pixel;      /* render whole tiles, because a ray may depend on the one before it (`start previous`) */
  struct channel_list channels;
  float *out; /* [crop.height][crop.width][channels.width] */
};

/* Renders the tile in which the pixels `kept` lie, all in one, and stores those. `certified` answers for
 * CHANNEL_DEVIATION; NULL where nobody asks. */
void tile_render(const struct tile_job *job, struct tracer *tracer, struct tracer *certified,
                 const struct rectangle *kept);

#endif

/* Tiles, a thread's unit of work.
 *
 * The grid of tiles, and the grid of packets in each tile, are fixed to the picture, and a tracer starts each tile
 * without memory. A pixel therefore depends neither on the crop nor on the thread that renders it.
 */
#ifndef PSCN_RENDER_TILE_H
#define PSCN_RENDER_TILE_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>

#include "base/rectangle.h"
#include "base/status.h"
#include "intersect/intersect.h"
#include "scene/scene.h"

struct render_options;

/* Sides in pixels of a tile, and of a packet, which divides it evenly. */
enum { TILE_SIZE = 32, PACKET_WIDTH = 4, PACKET_HEIGHT = PACKET_SIZE / PACKET_WIDTH };
enum { TILE_ROWS = TILE_SIZE / PACKET_HEIGHT }; /* rows of packets in a tile */

/* What to render. Pointers are borrowed. */
struct tile_job {
  const struct scene *scene;
  const struct render_options *options; /* (render/render.h) */
  bool every_pixel;          /* render whole tiles, because a ray may depend on the previous one (`start previous`) */
  float *out;                /* [crop.height][crop.width][channels.width] */
  const atomic_int *stop[2]; /* the work ends when one turns nonzero; NULL: never */
  struct tile_seen *seen;
};

/* What any ray of the picture has seen: a patch, and one that is not black. */
struct tile_seen {
  atomic_bool patch, light;
};

static inline bool tile_stopped(const struct tile_job *job)
{
  return (job->stop[0] != NULL && atomic_load(job->stop[0]) != 0) ||
         (job->stop[1] != NULL && atomic_load(job->stop[1]) != 0);
}

/* Renders one row of packets, 0 ... TILE_ROWS-1, of the tile that contains the pixels `kept`, and stores those of them.
 * `certified` answers for CHANNEL_DEVIATION; NULL if that is not needed. Returns false if the work was stopped; then
 * some of the row's pixels are not stored. */
bool tile_render_row(const struct tile_job *job, struct tracer *tracer, struct tracer *certified,
                     const struct rectangle *kept, size_t row);

/* The tiles of a picture, or every N-th of them, in an order that keeps neighbours together.
 *
 * The order follows D. Hilbert's curve ("Über die stetige Abbildung einer Linie auf ein Flächenstück", Math. Ann. 38,
 * 1891). Any N consecutive tiles are therefore a small spot of the picture, and each of N pieces gets one tile of each
 * such spot. Expensive regions are thus shared out evenly, whatever N is.
 */
struct tile_list {
  size_t count;
  struct rectangle *tile; /* the crop's pixels in each tile; never empty */
  /* how many rows of packets of each are in the picture, from the top: TILE_ROWS, all; counted up by rendering threads
   * after a row's last pixel */
  atomic_uchar *rows;
};

/* Piece `piece` (from 1) of `pieces` of the crop; {1, 1} is all of it. The caller destroys the list. Returns
 * STATUS_LIMIT if memory is short; then *out is zero. */
enum status tile_list_create(const struct rectangle *crop, size_t piece, size_t pieces,
                             struct tile_list *out) STATUS_MUST_CHECK;
void tile_list_destroy(struct tile_list *list); /* and zeroes it */

static inline bool tile_is_done(const struct tile_list *list, size_t k)
{
  return atomic_load(&list->rows[k]) == TILE_ROWS;
}

/* The pixels of tile k in its first `rows` rows of packets; perhaps none. */
struct rectangle tile_top(const struct tile_list *list, size_t k, size_t rows);

/* The number of pixels, of all tiles or of those rows that are done. */
size_t tile_list_pixels(const struct tile_list *list, bool done_only);

#endif

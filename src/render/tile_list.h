/* The tiles of a picture, or every N-th of them, in an order that keeps neighbours together.
 *
 * The order follows D. Hilbert's curve ("Über die stetige Abbildung einer Linie auf ein Flächenstück", Math. Ann. 38,
 * 1891). Any N consecutive tiles are therefore a small spot of the picture, and each of N pieces gets one tile of each
 * such spot. Expensive regions are thus shared out evenly, whatever N is.
 */
#ifndef PSCN_RENDER_TILE_LIST_H
#define PSCN_RENDER_TILE_LIST_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"
#include "render/tile.h"

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

/* Tiles in the order of Hilbert's curve. */
#include "render/tile.h"

#include <stdlib.h>

static size_t least(size_t a, size_t b) { return a < b ? a : b; }

/* The pixels of tile number `tile` in a row or column, within the `length` pixels from `begin` on. */
static void cut(size_t begin, size_t length, size_t tile, size_t *out_begin, size_t *out_length)
{
  *out_begin = tile * TILE_SIZE > begin ? tile * TILE_SIZE : begin;
  *out_length = least((tile + 1) * TILE_SIZE, begin + length) - *out_begin;
}

/* Tiles a side of the square that the curve fills, more than any picture has. The same curve fills its upper left part
 * if that is smaller by an even power of two. */
static const size_t CURVE_SIDE = (size_t)1 << 30;

/* The way along the curve: the tiles that meet the crop, and those of them that the list gets. */
struct way {
  const struct rectangle *crop;
  size_t left, top, right, bottom; /* columns and rows of tiles, the last two behind the end */
  size_t skip, pieces;             /* tiles to pass by before the next one; one of so many is the list's */
  struct tile_list *list;
};

static void take_tile(struct way *way, size_t column, size_t row)
{
  const bool ours = way->skip == 0;
  way->skip = (ours ? way->pieces : way->skip) - 1;
  if (!ours) return;
  struct rectangle *tile = &way->list->tile[way->list->count++];
  cut(way->crop->x, way->crop->width, column, &tile->x, &tile->width);
  cut(way->crop->y, way->crop->height, row, &tile->y, &tile->height);
}

/* Follows the curve through a square of tiles. It comes to the quarters upper left, lower left, lower right and upper
 * right, if it is neither `swapped` (x and y) nor `turned` (by 180 degrees); and it runs through the lower two as
 * through the whole square, through the upper ones swapped, and through the last turned as well. */
static void follow(struct way *way, size_t column, size_t row, size_t side, bool swapped, bool turned)
{
  if (column >= way->right || row >= way->bottom || column + side <= way->left || row + side <= way->top) return;
  if (side == 1) {
    take_tile(way, column, row);
    return;
  }
  for (int quarter = 0; quarter < 4; quarter++) {
    const bool right = quarter >= 2, low = quarter == 1 || quarter == 2;
    const bool x = (swapped ? low : right) != turned, y = (swapped ? right : low) != turned;
    follow(way, column + (x ? side / 2 : 0), row + (y ? side / 2 : 0), side / 2, low ? swapped : !swapped,
           turned != (right && !low));
  }
}

enum status tile_list_create(const struct rectangle *crop, size_t piece, size_t pieces, struct tile_list *out)
{
  struct tile_list list = {0};
  struct way way = {.crop = crop,
                    .left = crop->x / TILE_SIZE,
                    .top = crop->y / TILE_SIZE,
                    .right = (crop->x + crop->width - 1) / TILE_SIZE + 1,
                    .bottom = (crop->y + crop->height - 1) / TILE_SIZE + 1,
                    .skip = piece - 1,
                    .pieces = pieces,
                    .list = &list};
  const size_t most = (way.right - way.left) * (way.bottom - way.top) / pieces + 1;
  *out = (struct tile_list){0};
  list.tile = calloc(most, sizeof *list.tile);
  list.rows = calloc(most, sizeof *list.rows);
  const bool enough = list.tile != NULL && list.rows != NULL;
  if (enough) follow(&way, 0, 0, CURVE_SIDE, false, false);
  if (enough) *out = list;
  else tile_list_destroy(&list);
  return enough ? STATUS_OK : STATUS_LIMIT;
}

void tile_list_destroy(struct tile_list *list)
{
  free(list->tile);
  free(list->rows);
  *list = (struct tile_list){0};
}

struct rectangle tile_top(const struct tile_list *list, size_t k, size_t rows)
{
  struct rectangle part = list->tile[k];
  const size_t end = part.y / TILE_SIZE * TILE_SIZE + rows * PACKET_HEIGHT;
  if (end < part.y + part.height) part.height = end > part.y ? end - part.y : 0;
  return part;
}

size_t tile_list_pixels(const struct tile_list *list, bool done_only)
{
  size_t pixels = 0;
  for (size_t k = 0; k < list->count; k++)
    pixels += list->tile[k].width * tile_top(list, k, done_only ? atomic_load(&list->rows[k]) : TILE_ROWS).height;
  return pixels;
}

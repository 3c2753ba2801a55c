/* Tiles in the order of Hilbert's curve. */
#include "render/tile_list.h"

#include <stdint.h>
#include <stdlib.h>

/* A tile during sorting. */
struct place {
  uint64_t way; /* distance along the curve */
  size_t column, row;
};

/* The distance along the curve through a square of 2^32 tiles a side. Each step finds the quarter of the square that
 * contains the tile, and turns that quarter so that its curve runs as the whole one does. */
static uint64_t hilbert(uint32_t x, uint32_t y)
{
  uint64_t way = 0;
  for (uint32_t half = UINT32_C(1) << 31; half != 0; half /= 2) {
    const bool right = (x & half) != 0, low = (y & half) != 0;
    way += (uint64_t)half * half * (uint64_t)(right ? 3 - low : low);
    if (!low) {
      const uint32_t old = right ? ~x : x;
      x = right ? ~y : y;
      y = old;
    }
  }
  return way;
}

static int compare(const void *a, const void *b)
{
  const uint64_t x = ((const struct place *)a)->way, y = ((const struct place *)b)->way;
  return (x > y) - (x < y);
}

static size_t least(size_t a, size_t b) { return a < b ? a : b; }

/* The pixels of tile number `tile` in a row or column, within the `length` pixels from `begin` on. */
static void cut(size_t begin, size_t length, size_t tile, size_t *out_begin, size_t *out_length)
{
  *out_begin = tile * TILE_SIZE > begin ? tile * TILE_SIZE : begin;
  *out_length = least((tile + 1) * TILE_SIZE, begin + length) - *out_begin;
}

/* All tiles that meet the crop, in order; NULL if memory is short. */
static struct place *all_places(const struct rectangle *crop, size_t *out_count)
{
  const size_t x = crop->x / TILE_SIZE, y = crop->y / TILE_SIZE;
  const size_t columns = (crop->x + crop->width - 1) / TILE_SIZE - x + 1;
  const size_t rows = (crop->y + crop->height - 1) / TILE_SIZE - y + 1;
  struct place *places = calloc(columns * rows, sizeof *places);
  *out_count = columns * rows;
  if (places == NULL) return NULL;
  for (size_t k = 0; k < columns * rows; k++) {
    const size_t column = x + k % columns, row = y + k / columns;
    places[k] = (struct place){hilbert((uint32_t)column, (uint32_t)row), column, row};
  }
  qsort(places, columns * rows, sizeof *places, compare);
  return places;
}

enum status tile_list_create(const struct rectangle *crop, size_t piece, size_t pieces, struct tile_list *out)
{
  size_t all;
  *out = (struct tile_list){0};
  struct place *places = all_places(crop, &all);
  if (places == NULL) return STATUS_LIMIT;
  struct tile_list list = {.tile = calloc(all / pieces + 1, sizeof *list.tile),
                           .done = calloc(all / pieces + 1, sizeof *list.done)};
  const bool enough = list.tile != NULL && list.done != NULL;
  for (size_t k = piece - 1; enough && k < all; k += pieces) {
    struct rectangle *tile = &list.tile[list.count++];
    cut(crop->x, crop->width, places[k].column, &tile->x, &tile->width);
    cut(crop->y, crop->height, places[k].row, &tile->y, &tile->height);
  }
  free(places);
  if (enough) *out = list;
  else tile_list_destroy(&list);
  return enough ? STATUS_OK : STATUS_LIMIT;
}

void tile_list_destroy(struct tile_list *list)
{
  free(list->tile);
  free(list->done);
  *list = (struct tile_list){0};
}

size_t tile_list_pixels(const struct tile_list *list, bool done_only)
{
  size_t pixels = 0;
  for (size_t k = 0; k < list->count; k++)
    if (!done_only || atomic_load(&list->done[k])) pixels += list->tile[k].width * list->tile[k].height;
  return pixels;
}

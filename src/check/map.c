/* The map of a check: where the pixels over the limit are, and the edges. */
#include "check/measure.h"

const float CHECK_EDGE_COLOR[CHECK_EDGES][3] = {
  {0, 0, 0}, {0.45f, 0.3f, 0.55f}, {0.2f, 0.5f, 0.3f}, {0.25f, 0.4f, 0.7f}};
const float CHECK_SPOT_COLOR[CHECK_EDGES][3] = {{1, 0.15f, 0.15f}, {1, 0.5f, 1}, {0.4f, 1, 0.5f}, {1, 0.85f, 0.2f}};

static const float DARK = 0.22f; /* brightness of our picture under the map */

static void put_color(struct image *image, size_t x, size_t y, const float color[3])
{
  for (int k = 0; k < 3; k++) image_pixel(image, x, y)[k] = color[k];
}

/* Marks the pixels over the limit, those on edges or those off them, by spots large enough to be seen. */
static void put_spots(const struct check *check, const struct check_row *row, bool off_edges, struct image *map)
{
  const size_t reach = check->request->width / 500 + (off_edges && check->request->width > 100);
  for (size_t y = 0; y < check->request->height; y++) {
    for (size_t x = 0; x < check->request->width; x++) {
      const bool off = check->ours.pixel[y * check->request->width + x].edge == CHECK_EDGE_NONE;
      if (off != off_edges || !(check_pixel_difference(check, row, x, y) > check_limit(check))) continue;
      for (size_t v = y < reach ? 0 : y - reach; v <= y + reach && v < check->request->height; v++)
        for (size_t u = x < reach ? 0 : x - reach; u <= x + reach && u < check->request->width; u++)
          put_color(map, u, v, CHECK_SPOT_COLOR[check->ours.pixel[y * check->request->width + x].edge]);
    }
  }
}

enum status check_map(const struct check *check, const struct check_row *row, struct image *out)
{
  const enum status status = image_create(check->request->width, check->request->height, 3, out);
  if (status != STATUS_OK) return status;
  for (int k = 0; k < 3; k++) out->channel[k] = check->ours.picture.channel[k];
  for (size_t y = 0; y < check->request->height; y++) {
    for (size_t x = 0; x < check->request->width; x++) {
      const enum check_edge edge = check->ours.pixel[y * check->request->width + x].edge;
      float color[3];
      for (int k = 0; k < 3; k++) color[k] = DARK * image_pixel(&check->ours.picture, x, y)[k];
      put_color(out, x, y, edge == CHECK_EDGE_NONE ? color : CHECK_EDGE_COLOR[edge]);
    }
  }
  put_spots(check, row, false, out);
  put_spots(check, row, true, out);
  return STATUS_OK;
}

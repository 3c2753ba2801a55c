/* Where POV-Ray's triangles can differ in colour from the surface they approximate. At silhouettes, shadow edges,
 * creases and borders between textures, half a pixel's difference in shape changes the whole colour. */
#include "check/measure.h"

#include <math.h>

#include "geometry/vector.h"

const char *const CHECK_EDGE_NAME[CHECK_EDGES] = {"no edge", "crease", "shadow", "silhouette"};

const float CHECK_EDGE_COLOR[CHECK_EDGES][3] = {
  {0, 0, 0}, {0.45f, 0.3f, 0.55f}, {0.2f, 0.5f, 0.3f}, {0.25f, 0.4f, 0.7f}};
const float CHECK_SPOT_COLOR[CHECK_EDGES][3] = {{1, 0.15f, 0.15f}, {1, 0.5f, 1}, {0.4f, 1, 0.5f}, {1, 0.85f, 0.2f}};

static const float DARK = 0.22f; /* brightness of our picture under the map */

/* Whether the distance jumps between two pixels: it changes far more than on the less obliquely seen of the two
 * surfaces. On a smooth surface, the other one is at most a few times as oblique. */
static bool jumps(const double location[3], const struct check_sight *a, const struct check_sight *b)
{
  static const double MANY = 8;
  double step[3], view[3];
  vector_subtract(b->hit.point, a->hit.point, step);
  vector_subtract(a->hit.point, location, view);
  const double jump = fabs(a->distance - b->distance), length = vector_length(step);
  const double aside = sqrt(fmax(0, length * length - jump * jump));
  const double facing = fmax(fabs(vector_dot(view, a->hit.normal)), fabs(vector_dot(view, b->hit.normal)));
  return jump * facing / a->distance > MANY * aside;
}

static bool have_one_texture(const struct scene *scene, uint32_t a, uint32_t b)
{
  return a == b || scene->patches[a].texture == scene->patches[b].texture;
}

/* The edge between two pixels, if any. Between neighbouring pixels, a smooth surface turns little and stays near both
 * tangent planes. A border between textures counts as a crease. */
static enum check_edge edge_between(const struct check *check, const struct check_sight *a, const struct check_sight *b)
{
  static const double TURN = 0.9;  /* cosine of 26 degrees */
  static const double RISE = 0.34; /* sine of 20 degrees: the slope out of a tangent plane */
  const bool a_missed = a->hit.patch == HIT_NONE, b_missed = b->hit.patch == HIT_NONE;
  if (a_missed || b_missed) return a_missed == b_missed ? CHECK_EDGE_NONE : CHECK_EDGE_SILHOUETTE;
  double step[3];
  vector_subtract(b->hit.point, a->hit.point, step);
  const double far = RISE * vector_length(step);
  if (fabs(vector_dot(step, a->hit.normal)) > far || fabs(vector_dot(step, b->hit.normal)) > far ||
      jumps(check->scene->camera.location, a, b))
    return CHECK_EDGE_SILHOUETTE;
  if (a->lights != b->lights) return CHECK_EDGE_SHADOW;
  const bool creased = vector_dot(a->hit.normal, b->hit.normal) < TURN ||
                       !have_one_texture(check->scene, a->hit.patch, b->hit.patch);
  return creased ? CHECK_EDGE_CREASE : CHECK_EDGE_NONE;
}

void check_find_edges(struct check *check, const struct check_sight *window, size_t y)
{
  const size_t width = check->request->width;
  for (size_t x = 0; x < width; x++) {
    enum check_edge *edge = &check->ours.pixel[y * width + x].edge;
    for (size_t v = y == 0 ? 0 : y - 1; v <= y + 1 && v < check->request->height; v++) {
      for (size_t u = x == 0 ? 0 : x - 1; u <= x + 1 && u < width; u++) {
        const enum check_edge found = edge_between(check, &window[y % 3 * width + x], &window[v % 3 * width + u]);
        *edge = found > *edge ? found : *edge;
      }
    }
  }
}

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

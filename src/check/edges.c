/* Where POV-Ray's triangles can differ in colour from the surface they approximate. At silhouettes, shadow edges,
 * creases and borders between textures, half a pixel's difference in shape changes the whole colour. */
#include "check/measure.h"

#include <math.h>

#include "geometry/vector.h"

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

/* What two pixels beside each other lie on, given what is known of their centres; and whether a picture is within its
 * limits. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "check/measure.h"
#include "cmocka_test.h"

/* A hit at this point, seen from the origin. The normal need not have unit length. */
static struct check_sight sight(double x, double y, double z, double nx, double ny, double nz)
{
  const double length = sqrt(nx * nx + ny * ny + nz * nz);
  return (struct check_sight){
    .hit = {.point = {x, y, z}, .normal = {nx / length, ny / length, nz / length}, .patch = 0},
    .distance = sqrt(x * x + y * y + z * z),
    .lights = 1};
}

/* The edge between both, the same in a row and in a column, and in either order. */
static enum check_edge between(struct check_sight a, struct check_sight b)
{
  enum check_edge found = CHECK_EDGES;
  for (int way = 0; way < 4; way++) {
    const struct check_sight window[2] = {way % 2 ? b : a, way % 2 ? a : b};
    struct check_pixel pixels[2] = {0};
    struct scene_patch patches[] = {{.texture = 0}, {.texture = 0}, {.texture = 1}};
    struct scene scene = {.has_camera = true, .patches = patches};
    const struct check_request request = {.width = way < 2 ? 2 : 1, .height = way < 2 ? 1 : 2};
    struct check check = {.request = &request, .scene = &scene, .ours = {.pixel = pixels}};
    for (size_t y = 0; y < request.height; y++) check_find_edges(&check, window, y);
    assert_int_equal(pixels[0].edge, pixels[1].edge);
    if (way > 0) assert_int_equal(pixels[0].edge, found);
    found = pixels[0].edge;
  }
  return found;
}

TEST(one_surface_has_no_edge)
{
  assert_int_equal(between(sight(0, 0, 5, 0, 0, -1), sight(0.01, 0, 5, 0, 0, -1)), CHECK_EDGE_NONE);
  /* seen nearly edge-on: the distance changes by five times the step */
  assert_int_equal(between(sight(0, 0, 5, 1, 0, 0.2), sight(0.01, 0, 4.95, 1, 0, 0.2)), CHECK_EDGE_NONE);
  /* curved by some degrees a pixel */
  assert_int_equal(between(sight(0, 0, 5, 0, 0, -1), sight(0.01, 0, 5.0005, 0.1, 0, -1)), CHECK_EDGE_NONE);
}

TEST(what_stands_before_another_is_a_silhouette)
{
  struct check_sight miss = sight(0, 0, 5, 0, 0, -1);
  miss.hit.patch = HIT_NONE, miss.distance = INFINITY;
  assert_int_equal(between(miss, miss), CHECK_EDGE_NONE);
  assert_int_equal(between(miss, sight(0.01, 0, 5, 0, 0, -1)), CHECK_EDGE_SILHOUETTE);
  /* off the tangent plane */
  assert_int_equal(between(sight(0, 0, 5, 0, 0, -1), sight(0.01, 0, 6, 0, 0, -1)), CHECK_EDGE_SILHOUETTE);
  /* off one of the two tangent planes */
  assert_int_equal(between(sight(0, 0, 5, 0, 0, -1), sight(0.01, 0, 5, 0.5, 0, -1)), CHECK_EDGE_SILHOUETTE);
  /* near both tangent planes, but farther away than one surface would be */
  assert_int_equal(between(sight(0, 0, 5, 1, 0, 0.2), sight(0.01, 0, 9, 1, 0, 0.2)), CHECK_EDGE_SILHOUETTE);
  /* farther away than the surface of the less oblique pixel would be */
  assert_int_equal(between(sight(0, 0, 5, 1, 0, 0.02), sight(0.01, 0, 6, 1, 0, 0.3)), CHECK_EDGE_SILHOUETTE);
}

/* The edge at the ridge of a roof that falls by `degrees` on each side. */
static enum check_edge ridge(double degrees)
{
  const double fall = degrees * acos(-1.0) / 180;
  return between(sight(0, 0, 5, 0, 0, -1), sight(0.01, 0, 5 + 0.01 * tan(fall), tan(2 * fall), 0, -1));
}

TEST(shadows_and_creases_are_told_apart)
{
  struct check_sight lit = sight(0, 0, 5, 0, 0, -1), dark = sight(0.01, 0, 5, 0, 0, -1);
  dark.lights = 0;
  assert_int_equal(between(lit, dark), CHECK_EDGE_SHADOW);
  const struct check_sight turned = sight(0.01, 0, 5.002, 0.6, 0, -1);
  assert_int_equal(between(lit, turned), CHECK_EDGE_CREASE);
  dark.hit = turned.hit, dark.distance = turned.distance;
  assert_int_equal(between(lit, dark), CHECK_EDGE_SHADOW);
  assert_int_equal(ridge(12.5), CHECK_EDGE_NONE);
  assert_int_equal(ridge(14), CHECK_EDGE_CREASE);
  assert_int_equal(ridge(19), CHECK_EDGE_CREASE);
  assert_int_equal(ridge(21), CHECK_EDGE_SILHOUETTE);
  struct check_sight other = sight(0.01, 0, 5, 0, 0, -1); /* on another patch, of the same texture, then of another */
  other.hit.patch = 1;
  assert_int_equal(between(lit, other), CHECK_EDGE_NONE);
  other.hit.patch = 2;
  assert_int_equal(between(lit, other), CHECK_EDGE_CREASE);
}

/* Silhouettes surround a miss, its corners included, and outrank another edge there. */
TEST(a_miss_has_edges_all_round)
{
  enum { WIDTH = 5, HEIGHT = 3 };
  for (size_t miss = 0; miss < WIDTH * HEIGHT; miss++) {
    struct check_sight sights[WIDTH * HEIGHT];
    struct check_pixel pixels[WIDTH * HEIGHT] = {0};
    struct scene scene = {.has_camera = true};
    const struct check_request request = {.width = WIDTH, .height = HEIGHT};
    struct check check = {.request = &request, .scene = &scene, .ours = {.pixel = pixels}};
    for (size_t k = 0; k < WIDTH * HEIGHT; k++) {
      sights[k] = sight(0.01 * (double)(k % WIDTH), 0.01 * (double)(k / WIDTH), 5, 0, 0, -1);
      sights[k].lights = k % 2;
    }
    sights[miss].hit.patch = HIT_NONE;
    for (size_t y = 0; y < HEIGHT; y++) check_find_edges(&check, sights, y);
    for (size_t k = 0; k < WIDTH * HEIGHT; k++) {
      const bool near = labs((long)(k % WIDTH) - (long)(miss % WIDTH)) <= 1 &&
                        labs((long)(k / WIDTH) - (long)(miss / WIDTH)) <= 1;
      assert_int_equal(pixels[k].edge, near ? CHECK_EDGE_SILHOUETTE : CHECK_EDGE_SHADOW);
    }
  }
}

/* Of 1,000 pixels. Each limit is exceeded by the least possible amount, and not by its own value. */
TEST(limits_are_what_they_are)
{
  const struct check_request request = {.fail = {.each = 0.5, .percent = 1}, .fail_psnr = 40, .fail_mask = 0.5};
  struct check check = {.request = &request, .row_count = 1};
  struct check_row *row = &check.row[0];
  char said[200] = "";
  row->result.pixels = 1000, row->result.psnr = 40, row->over_limit = 10, row->mask_ours = 3, row->mask_theirs = 2;
  assert_true(check_within_limits(&check, said, sizeof said));
  row->mask_theirs = 3;
  assert_false(check_within_limits(&check, said, sizeof said));
  assert_non_null(strstr(said, "0.6 %"));
  row->mask_ours = 2, row->over_limit = 11;
  assert_false(check_within_limits(&check, said, sizeof said));
  assert_non_null(strstr(said, "1.1 %"));
  row->over_limit = 10, row->result.psnr = nextafter(40, 0);
  assert_false(check_within_limits(&check, said, sizeof said));
  assert_non_null(strstr(said, "PSNR"));
}

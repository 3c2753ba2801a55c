/* The chart's figure: which points it has, where, and in which look. The values are taken where gnuplot would draw them.
 * And memory that jansson does not get. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "chart/work.h"
#include "page/page.h"
#include "cmocka_test.h"
#include "unit/drawn.h"
#include "unit/expect_json.h"

static bool failed; /* a page is not whole */

enum status __wrap_page_write(const struct listener *listener, const char *folder, size_t count,
                              const char *const names[], const struct text_buffer content[]);
enum status __wrap_page_write(const struct listener *listener, const char *folder, size_t count,
                              const char *const names[], const struct text_buffer content[])
{
  (void)listener, (void)folder, (void)names;
  failed = false;
  for (size_t k = 0; k < count; k++) failed = failed || content[k].failed;
  return STATUS_OK;
}

static struct chart_point point(enum family family, double ns, double error, size_t wrong, const char *label)
{
  struct chart_point p = {.family = family,
                          .camera = {.rays = 100, .hits = 10, .wrong = wrong, .p99 = error, .p99_of_all = error}};
  p.time[RAYS_CAMERA].median = ns;
  snprintf(p.label, sizeof p.label, "%s", label);
  return p;
}

/* The values that the figure of these points is drawn from. The caller frees them. NULL if memory is short. */
static json_t *values_of(struct chart_point *points, size_t count)
{
  double yard[RAY_KINDS] = {0};
  const struct chart_request request = {.path = "folder/scene", .folder = "out", .command_line = ""};
  const struct chart chart = {
    .request = &request, .yard = {&yard[0], &yard[1]}, .yard_count = 1, .points = points, .point_count = count};
  struct text_buffer table = {0};
  drawn = NULL;
  assert_int_equal(chart_write(&chart, &table), STATUS_OK);
  text_buffer_free(&table);
  return drawn;
}

static json_t *figure_of(struct chart_point *points, size_t count)
{
  json_t *values = values_of(points, count);
  assert_false(failed);
  assert_non_null(values);
  return values;
}

/* Each number of a point, all different, stands under its name; a solver's choices are words; a peer has none. */
TEST(numbers_are_in_their_place)
{
  struct chart_point points[] = {{.family = FAMILY_ABERTH,
                                  .name = "aberth",
                                  .ours = true,
                                  .time = {{1, 2, 3, 4, 5, 6}, {11, 12, 13, 14, 15, 16}},
                                  .camera = {122, 22, 23, 24, 25, 26, 27, 0.5, 0.25, NAN, 0.125},
                                  .shadow = {.rays = 31, .undecided = 32, .hits = 33, .lost = 34, .invented = 35},
                                  .has_shadow = true},
                                 point(FAMILY_EMBREE, 1, 0.5, 0, "8")};
  method_default(solver_find("aberth", 6), &points[0].options);
  points[0].options.basis = BASIS_POWER, points[0].options.polish = false, points[0].options.split = 3;
  points[0].options.roots.start = START_COLD, points[0].options.roots.tolerance = 0.5;
  json_t *values = figure_of(points, 2), *all = json_object_get(values, "points");
  expect_json(
    json_array_get(all, 0),
    "{\"color\":12024095,\"error\":0.25,\"family\":\"aberth\",\"front\":false,\"hits\":23,\"invented\":25,\"label\":"
    "\"\","
    "\"lost\":24,\"method\":{\"basis\":\"power\",\"polish\":\"off\",\"solver\":\"aberth\","
    "\"split\":\"3\",\"start\":\"cold\",\"tolerance\":0.5},\"name\":\"aberth\",\"other_patch\":27,\"rays\":122,"
    "\"shadow\":{\"hits\":33,\"invented\":35,\"lost\":34,\"rays\":31,\"undecided\":32},\"shadow_ns\":13.0,"
    "\"share\":0.75,\"symbol\":9,\"t_99\":0.25,\"t_99_of_all\":0.125,\"t_max\":null,\"t_median\":0.5,\"time\":{"
    "\"least\":1.0,\"lower\":2.0,"
    "\"median\":3.0,\"most\":5.0,\"ratio\":6.0,\"upper\":4.0},\"times\":[{\"least\":1.0,\"lower\":2.0,"
    "\"median\":3.0,\"most\":5.0,\"ratio\":6.0,\"upper\":4.0},{\"least\":11.0,\"lower\":12.0,\"median\":13.0,"
    "\"most\":15.0,\"ratio\":16.0,\"upper\":14.0}],\"undecided\":22,\"wrong\":26}");
  const json_t *peer = json_array_get(all, 1);
  assert_true(json_is_null(json_object_get(peer, "method")) && json_is_null(json_object_get(peer, "shadow")));
  assert_int_equal(json_array_size(json_object_get(values, "first")),
                   1); /* the default's, although it is not on the front */
  expect_json(json_object_get(values, "scene"), "\"scene\"");
  json_decref(values);
  points[0].options.basis = BASIS_BERNSTEIN, points[0].options.polish = true, points[0].options.split = 0;
  points[0].options.roots.start = START_PREVIOUS;
  values = figure_of(points, 2);
  expect_json(json_object_get(json_array_get(json_object_get(values, "points"), 0), "method"),
              "{\"basis\":\"bernstein\",\"polish\":\"on\",\"solver\":\"aberth\",\"split\":\"auto\","
              "\"start\":\"previous\",\"tolerance\":0.5}");
  json_decref(values);
}

static double number(const json_t *from, const char *key) { return json_number_value(json_object_get(from, key)); }

/* Colour tells the solver, shape the form; the legend has those in use. A point without a time, or of a peer without a
 * label, is not drawn. An error of 0 is drawn as the least; where no answer is right there is none. */
TEST(points_have_their_looks)
{
  struct chart_point points[] = {point(FAMILY_DEFAULT, 100, 0, 0, ""),       point(FAMILY_NEWTON, 90, 1e-9, 1, ""),
                                 point(FAMILY_PAPER, 120, NAN, 100, "0.01"), point(FAMILY_EMBREE, 50, 1e-5, 0, "8"),
                                 point(FAMILY_EMBREE, 60, 1e-5, 0, ""),      point(FAMILY_LAGUERRE, NAN, 1e-5, 0, "")};
  static const char *const solver[] = {"bernstein", "newton", "laguerre"};
  for (int k = 0; k < 3; k++) {
    points[k].ours = true;
    method_default(solver_find(solver[k], strlen(solver[k])), &points[k].options);
  }
  points[1].options.split = 1;
  snprintf(points[2].name, sizeof points[2].name, "laguerre { form paper }");
  json_t *values = figure_of(points, 6);
  const json_t *list = json_object_get(values, "drawn");
  const struct {
    double error, share;
    int color, symbol;
  } expected[] = {
    {1e-17, 1e-4, 0xc02020, 7}, {1e-9, 0.01, 0x2b6cb0, 5}, {0, 1, 0x2f855a, 12}, {1e-5, 1e-4, 0x6b46c1, 6}};
  assert_int_equal(json_array_size(list), 4);
  for (size_t k = 0; k < 4; k++) {
    const json_t *value = json_array_get(list, k), *error = json_object_get(value, "error");
    assert_true(expected[k].error == 0 ? json_is_null(error) : json_number_value(error) == expected[k].error);
    assert_true(number(value, "share") == expected[k].share);
    assert_true(number(value, "color") == expected[k].color && number(value, "symbol") == expected[k].symbol);
  }
  expect_json(json_object_get(values, "colors"),
              "[{\"look\":12591136,\"title\":\"bernstein (default)\"},{\"look\":2845872,\"title\":\"newton\"},"
              "{\"look\":3114330,\"title\":\"laguerre\"},{\"look\":7030465,\"title\":\"Embree\"}]");
  expect_json(
    json_object_get(values, "shapes"),
    "[{\"look\":7,\"title\":\"leaves, polish\"},{\"look\":5,\"title\":\"whole patches, polish\"},"
    "{\"look\":12,\"title\":\"form paper, by tolerance\"},{\"look\":6,\"title\":\"triangles a side, 8 rays\"}]");
  json_decref(values);
}

static long left; /* blocks until jansson does not get one; negative: it has not got one */

static void *json_block(size_t size) { return left-- == 0 ? NULL : malloc(size); }

/* A page that lacks anything because memory is short fails: the block that is missing is any of the values' or of the
 * figure's, or of the copy that the figure is drawn from here. */
TEST(pages_are_whole)
{
  struct chart_point points[] = {point(FAMILY_ABERTH, 1, 0.5, 0, "1"), point(FAMILY_EMBREE, 2, 0.25, 0, "8")};
  points[0].front = points[1].front = true;
  bool whole = false;
  json_malloc_t get;
  json_free_t release;
  json_get_alloc_funcs(&get, &release);
  json_set_alloc_funcs(json_block, free);
  for (long n = 0; !whole; n++) {
    left = n;
    json_t *values = values_of(points, 2);
    whole = left >= 0;
    assert_true(whole ? !failed && values != NULL : failed || values == NULL);
    json_decref(values);
  }
  json_set_alloc_funcs(get, release);
}

/* What the chart's figure shows: which points stand together under which look and title, the steps of the front, and
 * where labels stand. The values are taken where gnuplot would draw them. */
#include <math.h>
#include <stdio.h>

#include "chart/work.h"
#include "check/page.h"
#include "cmocka_test.h"
#include "unit/drawn.h"

enum status __wrap_page_write(const struct listener *listener, size_t count, char (*paths)[PAGE_PATH_SIZE],
                              const struct text_buffer content[]);
enum status __wrap_page_write(const struct listener *listener, size_t count, char (*paths)[PAGE_PATH_SIZE],
                              const struct text_buffer content[])
{
  (void)listener, (void)paths;
  for (size_t k = 0; k < count; k++) assert_false(content[k].failed);
  return STATUS_OK;
}

static struct chart_point point(enum family family, double ns, double error, size_t wrong, const char *label)
{
  struct chart_point p = {.family = family, .camera = {.hits = 10, .wrong = wrong, .p99_of_all = error}};
  p.time[RAYS_CAMERA].median = ns;
  snprintf(p.label, sizeof p.label, "%s", label);
  return p;
}

/* The values that the figure of these points is drawn from, to be freed. */
static json_t *figure_of(struct chart_point *points, size_t count)
{
  double yard[RAY_KINDS] = {0};
  const struct chart_request request = {.path = "scene", .folder = "out", .command_line = ""};
  const struct chart chart = {
    .request = &request, .yard = {&yard[0], &yard[1]}, .yard_count = 1, .points = points, .point_count = count};
  struct text_buffer table = {0};
  drawn = NULL;
  assert_int_equal(chart_write(&chart, &table), STATUS_OK);
  assert_non_null(drawn);
  text_buffer_free(&table);
  return drawn;
}

static double number(const json_t *from, const char *key) { return json_number_value(json_object_get(from, key)); }

/* A family's points that are all right come first, with its title; those that are not are hollow, and have the title
 * where no others have it. */
static void each_family_is_titled_once(void **state)
{
  (void)state;
  struct chart_point points[] = {point(FAMILY_DEFAULT, 100, 1e-15, 0, ""), point(FAMILY_DEFAULT, 90, 1, 1, ""),
                                 point(FAMILY_NEWTON, 120, 1, 3, ""), point(FAMILY_LAGUERRE, NAN, 1e-15, 0, ""),
                                 point(FAMILY_DEFAULT, 80, 1e-9, 0, "")};
  const struct {
    const char *title;
    int symbol, count;
  } expected[] = {{"bernstein (default)", 7, 2}, {NULL, 6, 1}, {"newton", 8, 1}};
  json_t *values = figure_of(points, 5), *sets = json_object_get(values, "sets");
  assert_int_equal(json_array_size(sets), 3);
  for (size_t k = 0; k < 3; k++) {
    const json_t *set = json_array_get(sets, k), *title = json_object_get(set, "title");
    if (expected[k].title == NULL) assert_true(json_is_null(title));
    else assert_string_equal(json_string_value(title), expected[k].title);
    assert_true(number(set, "symbol") == expected[k].symbol);
    assert_int_equal(json_array_size(json_object_get(set, "points")), expected[k].count);
  }
  json_decref(values);
}

/* From the most exact to the fastest; pale where one of the two is not all right. */
static void steps_join_the_front(void **state)
{
  (void)state;
  struct chart_point points[] = {point(FAMILY_NEWTON, 10, 0.1, 1, ""), point(FAMILY_DEFAULT, 100, 0, 0, ""),
                                 point(FAMILY_ABERTH, 70, 1e-12, 0, ""), point(FAMILY_EMBREE, 50, 1e-5, 0, "")};
  points[0].front = points[1].front = points[3].front = true;
  json_t *values = figure_of(points, 4);
  const json_t *steps = json_object_get(values, "steps"), *pale = json_object_get(values, "pale_steps");
  assert_true(json_array_size(steps) == 1 && json_array_size(pale) == 1);
  const json_t *first = json_array_get(steps, 0), *second = json_array_get(pale, 0);
  assert_true(number(first, "x1") == 1e-17 && number(first, "y1") == 100); /* no error has no place on the axis */
  assert_true(number(first, "x2") == 1e-5 && number(first, "y2") == 50);
  assert_true(number(second, "x1") == 1e-5 && number(second, "x2") == 0.1);
  json_decref(values);
}

/* A label that would stand on one before it stands to the right, and on two farther to the right. */
static void labels_make_way(void **state)
{
  (void)state;
  struct chart_point points[] = {point(FAMILY_EMBREE, 100, 1e-5, 0, "16"),  point(FAMILY_EMBREE, 101, 1e-5, 0, ""),
                                 point(FAMILY_EMBREE, 102, 1e-5, 0, "32"),  point(FAMILY_EMBREE, 104, 1e-5, 0, "64"),
                                 point(FAMILY_EMBREE, 150, 1e-5, 0, "128"), point(FAMILY_EMBREE, 100, 1e-4, 0, "256")};
  const double places[] = {-5, -4.7, -4.7, -4.4, -5, -4};
  json_t *values = figure_of(points, 6);
  for (size_t k = 0; k < 6; k++) {
    const json_t *value = json_array_get(json_object_get(values, "points"), k);
    assert_true(fabs(log10(number(value, "label_at")) - places[k]) < 1e-9);
  }
  json_decref(values);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(each_family_is_titled_once),
                                     cmocka_unit_test(steps_join_the_front), cmocka_unit_test(labels_make_way)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}

/* The files of a chart: the values that fill the templates beside this file. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/json_text.h"
#include "chart/templates.h"
#include "chart/work.h"
#include "page/fill.h"
#include "page/page.h"
#include "page/plot.h"

/* ---- the figure ---- */

/* Smaller errors are drawn as this: 0 has no place on a logarithmic axis. */
#define LEAST_ERROR 1e-17

/* Labels nearer than this, in powers of ten across and up, would overlap; and the width of a digit. */
#define LABEL_NEAR_X 0.5
#define LABEL_NEAR_Y 0.06
#define LABEL_WIDTH 0.3

static const struct look {
  const char *title, *color;
  int symbol, hollow; /* gnuplot's point types: for points with all answers right, and with some wrong */
} LOOKS[FAMILIES] = {
  [FAMILY_DEFAULT] = {"bernstein (default)", "#c02020", 7, 6},
  [FAMILY_NEWTON] = {"newton", "#2b6cb0", 9, 8},
  [FAMILY_LAGUERRE] = {"laguerre", "#2f855a", 11, 10},
  [FAMILY_ABERTH] = {"aberth", "#b7791f", 13, 12},
  [FAMILY_PAPER] = {"as in the paper", "#718096", 15, 14},
  [FAMILY_OTHER] = {"durand\\\\_kerner", "#9d174d", 15, 14},
  [FAMILY_RIVAL] = {"rivals, scalar", "#000000", 7, 6},
  [FAMILY_EMBREE] = {"Embree (triangles a side)", "#6b46c1", 5, 4},
  [FAMILY_POVRAY] = {"POV-Ray (u\\\\_steps)", "#0891b2", 5, 4},
};

static bool drawn(const struct chart_point *point)
{
  return isfinite(point->time[RAYS_CAMERA].median) && isfinite(point->camera.p99_of_all);
}

static bool all_right(const struct chart_point *point)
{
  return point->camera.lost + point->camera.invented + point->camera.wrong == 0;
}

static double error_of(const struct chart_point *point) { return fmax(point->camera.p99_of_all, LEAST_ERROR); }

/* The place of a point's label: at the point, or right of the earlier labels that are there. */
static double label_place(const struct chart *chart, size_t index)
{
  const struct chart_point *point = &chart->points[index];
  double place = log10(error_of(point));
  for (size_t k = 0; k < index; k++) {
    const struct chart_point *other = &chart->points[k];
    if (drawn(other) && other->label[0] != '\0' && fabs(log10(error_of(other) / error_of(point))) < LABEL_NEAR_X &&
        fabs(log10(other->time[RAYS_CAMERA].median / point->time[RAYS_CAMERA].median)) < LABEL_NEAR_Y)
      place += LABEL_WIDTH;
  }
  return pow(10, place);
}

static json_t *time_value(const struct timing *time)
{
  return json_pack("{s:o,s:o,s:o,s:o,s:o,s:o}", "least", page_of_number(time->least), "lower",
                   page_of_number(time->lower), "median", page_of_number(time->median), "upper",
                   page_of_number(time->upper), "most", page_of_number(time->most), "ratio",
                   page_of_number(time->ratio));
}

static json_t *shadow_value(const struct judgement *shadow)
{
  return json_pack("{s:o,s:o,s:o,s:o,s:o}", "rays", json_count(shadow->rays), "hits", json_count(shadow->hits),
                   "undecided", json_count(shadow->undecided), "lost", json_count(shadow->lost), "invented",
                   json_count(shadow->invented));
}

static json_t *method_value(const struct method *method)
{
  return json_pack("{s:s,s:s,s:f,s:s,s:s,s:o}", "solver", method->roots.solver->name, "basis",
                   method->basis == BASIS_POWER ? "power" : "bernstein", "tolerance", method->roots.tolerance, "polish",
                   method->polish ? "on" : "off", "start", method->roots.start == START_PREVIOUS ? "previous" : "cold",
                   "split", method->split == 0 ? json_string("auto") : json_sprintf("%d", method->split));
}

/* A point, for all files; NULL if memory is short. */
static json_t *point_value(const struct chart *chart, size_t index)
{
  const struct chart_point *point = &chart->points[index];
  const struct judgement *camera = &point->camera;
  json_t *time = time_value(&point->time[RAYS_CAMERA]), *shadow_time = time_value(&point->time[RAYS_SHADOW]);
  return json_pack(
    "{s:s,s:s,s:s,s:b,s:o,s:[O,o],s:o,s:o,s:o,s:o,s:o,s:o,s:o,s:o,s:o,s:o,s:o,s:o,s:o,s:o,s:o,s:o}", "family",
    family_name(point->family), "name", point->name, "label", point->label, "front", point->front, "time", time,
    "times", time, shadow_time, "shadow_ns", page_of_number(point->time[RAYS_SHADOW].median), "t_median",
    page_of_number(camera->median), "t_99", page_of_number(camera->p99), "t_max", page_of_number(camera->max),
    "t_99_of_all", page_of_number(camera->p99_of_all), "rays", json_count(camera->rays), "hits",
    json_count(camera->hits), "undecided", json_count(camera->undecided), "lost", json_count(camera->lost), "invented",
    json_count(camera->invented), "wrong", json_count(camera->wrong), "other_patch", json_count(camera->other_patch),
    "shadow", point->has_shadow ? shadow_value(&point->shadow) : json_null(), "method",
    point->ours ? method_value(&point->options) : json_null(), "error", page_of_number(error_of(point)), "label_at",
    page_of_number(label_place(chart, index)));
}

/* The points of a family that are all right, or that are not, with their look. JSON's null if there are none, NULL if
 * memory is short. */
static json_t *set_value(const struct chart *chart, const json_t *points, enum family family, bool right, bool titled)
{
  json_t *list = json_array();
  for (size_t k = 0; k < chart->point_count; k++) {
    const struct chart_point *point = &chart->points[k];
    if (point->family == family && drawn(point) && all_right(point) == right)
      list = json_append(list, json_incref(json_array_get(points, k)));
  }
  if (list != NULL && json_array_size(list) == 0) {
    json_decref(list);
    return json_null();
  }
  const struct look *look = &LOOKS[family];
  return json_pack("{s:o,s:s,s:i,s:o,s:o}", "id", json_sprintf("family%d%d", (int)family, right), "color", look->color,
                   "symbol", right ? look->symbol : look->hollow, "title",
                   titled ? json_string(look->title) : json_null(), "points", list);
}

static json_t *sets_value(const struct chart *chart, const json_t *points)
{
  json_t *sets = json_array();
  for (int family = 0; family < FAMILIES; family++) {
    bool titled = true;
    for (int right = 1; right >= 0; right--) {
      json_t *set = set_value(chart, points, (enum family)family, right != 0, titled);
      titled = titled && json_is_null(set);
      if (!json_is_null(set)) sets = json_append(sets, set);
    }
  }
  return sets;
}

static int by_error(const void *a, const void *b)
{
  const struct chart_point *const *p = a, *const *q = b;
  const double x = (*p)->camera.p99_of_all, y = (*q)->camera.p99_of_all;
  return (x > y) - (x < y);
}

/* The front from the most exact to the fastest point, step by step: steps between points that are all right, and
 * others. */
static json_t *front_value(const struct chart *chart)
{
  const struct chart_point **front = calloc(chart->point_count + 1, sizeof *front);
  size_t count = 0;
  if (front == NULL) return NULL;
  json_t *lists[2] = {json_array(), json_array()};
  for (size_t k = 0; k < chart->point_count; k++)
    if (chart->points[k].front) front[count++] = &chart->points[k];
  qsort(front, count, sizeof *front, by_error);
  for (size_t k = 0; k + 1 < count; k++) {
    const bool right = all_right(front[k]) && all_right(front[k + 1]);
    json_t *step = json_pack("{s:f,s:f,s:f,s:f}", "x1", error_of(front[k]), "y1", front[k]->time[RAYS_CAMERA].median,
                             "x2", error_of(front[k + 1]), "y2", front[k + 1]->time[RAYS_CAMERA].median);
    lists[right] = json_append(lists[right], step);
  }
  free(front);
  return json_pack("{s:o,s:o}", "pale_steps", lists[0], "steps", lists[1]);
}

/* ---- the page ---- */

/* All that figure and page show; NULL if memory is short. */
static json_t *make_values(const struct chart *chart)
{
  const struct chart_request *request = chart->request;
  json_t *points = json_array(), *first = json_array(), *notes = json_array();
  for (size_t k = 0; k < chart->point_count; k++) {
    points = json_append(points, point_value(chart, k));
    if (chart->points[k].front || k == 0) first = json_append(first, json_incref(json_array_get(points, k)));
  }
  for (size_t k = 0; k < chart->note_count; k++)
    notes = json_append(notes, json_pack("{s:o}", "note", page_of_text(chart->notes[k])));
  json_t *root = json_pack("{s:o,s:o,s:o,s:o,s:o,s:o,s:o,s:i,s:i,s:o,s:o,s:o,s:O,s:O,s:o,s:[{s:b,s:o},{s:b,s:o}]}",
                           "scene", page_of_file(request->path), "width", json_count(request->width), "height",
                           json_count(request->height), "rays", json_count(chart->rays[RAYS_CAMERA].count), "shadows",
                           json_count(chart->rays[RAYS_SHADOW].count), "rounds", json_count(chart->rounds), "undecided",
                           json_count(chart->points[0].camera.undecided), "strip_width", (int)STRIP_WIDTH,
                           "strip_height", (int)STRIP_HEIGHT, "yard_least", page_of_number(chart->yard[RAYS_CAMERA][0]),
                           "yard_most", page_of_number(chart->yard[RAYS_CAMERA][chart->yard_count - 1]), "notes", notes,
                           "first", first, "points", points, "sets", sets_value(chart, points), "tables", "all", 0,
                           "points", first, "all", 1, "points", points);
  return json_join(json_join(root, front_value(chart)), page_of_head(request->command_line));
}

enum { CSV, SVG, PAGE, FILES = CHART_FILES };

const char *const chart_files[FILES] = {"chart.csv", "chart.svg", "chart.html"};

/* The figure of an earlier chart is removed if this one has none. */
enum status chart_write(const struct chart *chart, struct text_buffer *out_text)
{
  struct text_buffer content[FILES] = {{0}};
  char path[FILES][PAGE_PATH_SIZE];
  json_t *values = make_values(chart);
  enum status status = STATUS_OK;
  if (values != NULL && chart->points[0].camera.hits > 0)
    status = plot_draw(chart->listener, TEMPLATE_CHART_FIGURE, values, &content[SVG]);
  if (values != NULL && content[SVG].length > 0)
    content[PAGE].failed = json_object_set_new(values, "figure",
                                               json_stringn(content[SVG].text, content[SVG].length)) != 0;
  fill_template(&content[CSV], TEMPLATE_CHART_CSV, values);
  fill_template(&content[PAGE], TEMPLATE_CHART_PAGE, values);
  fill_template(out_text, TEMPLATE_CHART_TABLE, values);
  for (int k = 0; k < FILES; k++) snprintf(path[k], sizeof path[k], "%s/%s", chart->request->folder, chart_files[k]);
  content[PAGE].failed = content[PAGE].failed || out_text->failed;
  if (status == STATUS_OK) status = page_write(chart->listener, FILES, path, content);
  for (int k = 0; k < FILES; k++) text_buffer_free(&content[k]);
  json_decref(values);
  return status;
}

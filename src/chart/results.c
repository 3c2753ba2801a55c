/* The files of a chart: the values that fill the templates beside this file. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/json_text.h"
#include "chart/templates.h"
#include "chart/work.h"
#include "page/page.h"

/* ---- the figure ---- */

/* An error, or a share of wrong answers, below this is drawn as this: 0 has no place on a logarithmic axis. */
#define LEAST_ERROR 1e-17
#define LEAST_SHARE 1e-4

/* Colour tells the solver, shape the form. */
struct look {
  const char *title;
  int value; /* 0xRRGGBB, or gnuplot's point type */
};

enum { RIVALS = 5, EMBREE, POVRAY, COLORS };

static const struct look COLOR[COLORS] = {
  {"bernstein (default)", 0xc02020}, {"newton", 0x2b6cb0}, {"laguerre", 0x2f855a}, {"aberth", 0xb7791f},
  {"durand_kerner", 0x9d174d},       {"rivals", 0x000000}, {"Embree", 0x6b46c1},   {"POV-Ray", 0x0891b2}};

enum shape { LEAVES, WHOLE, UNPOLISHED, PAPER, SCALAR, TRIANGLES, STEPS, SHAPES };

static const struct look SHAPE[SHAPES] = {
  [LEAVES] = {"leaves, polish", 7},  [WHOLE] = {"whole patches, polish", 5},
  [UNPOLISHED] = {"polish off", 9},  [PAPER] = {"form paper, by tolerance", 12},
  [SCALAR] = {"rivals, scalar", 13}, [TRIANGLES] = {"triangles a side, 8 rays", 6},
  [STEPS] = {"u_steps, type 1", 4}};

static int color_of(const struct chart_point *point)
{
  if (!point->ours) return point->family == FAMILY_RIVAL ? RIVALS : point->family == FAMILY_EMBREE ? EMBREE : POVRAY;
  int color = 0;
  while (color + 1 < RIVALS &&
         strncmp(COLOR[color].title, point->options.roots.solver->name, strlen(point->options.roots.solver->name)) != 0)
    color++;
  return color;
}

static enum shape shape_of(const struct chart_point *point)
{
  if (!point->ours) return (enum shape)(SCALAR + color_of(point) - RIVALS);
  if (strstr(point->name, "form paper") != NULL) return PAPER;
  if (!point->options.polish) return UNPOLISHED;
  return point->options.split == 1 ? WHOLE : LEAVES;
}

/* Of a peer that is measured in several ways, only that with labels is drawn. */
static bool drawn(const struct chart_point *point)
{
  return isfinite(point->time[RAYS_CAMERA].median) && (point->ours || point->label[0] != '\0');
}

static double share_of_wrong(const struct judgement *camera)
{
  const size_t wrong = camera->lost + camera->invented + camera->wrong, decided = camera->rays - camera->undecided;
  return wrong == 0 ? LEAST_SHARE : fmax((double)wrong / (double)decided, LEAST_SHARE);
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
    "{s:s,s:s,s:s,s:b,s:o,s:[O,o],s:o,s:o,s:o,s:o,s:o,s:o,s:o,s:o,s:o,s:o,s:o,s:o,s:o,s:o,s:o,s:o,s:i,s:i}", "family",
    family_name(point->family), "name", point->name, "label", point->label, "front", point->front, "time", time,
    "times", time, shadow_time, "shadow_ns", page_of_number(point->time[RAYS_SHADOW].median), "t_median",
    page_of_number(camera->median), "t_99", page_of_number(camera->p99), "t_max", page_of_number(camera->max),
    "t_99_of_all", page_of_number(camera->p99_of_all), "rays", json_count(camera->rays), "hits",
    json_count(camera->hits), "undecided", json_count(camera->undecided), "lost", json_count(camera->lost), "invented",
    json_count(camera->invented), "wrong", json_count(camera->wrong), "other_patch", json_count(camera->other_patch),
    "shadow", point->has_shadow ? shadow_value(&point->shadow) : json_null(), "method",
    point->ours ? method_value(&point->options) : json_null(), "error",
    page_of_number(isfinite(camera->p99) ? fmax(camera->p99, LEAST_ERROR) : NAN), "share",
    page_of_number(share_of_wrong(camera)), "color", COLOR[color_of(point)].value, "symbol",
    SHAPE[shape_of(point)].value);
}

/* The looks in use, for the legend. */
static json_t *legend(const struct look looks[], size_t count, const bool used[])
{
  json_t *list = json_array();
  for (size_t k = 0; k < count; k++)
    if (used[k]) list = json_append(list, json_pack("{s:s,s:i}", "title", looks[k].title, "look", looks[k].value));
  return list;
}

static json_t *figure_value(const struct chart *chart, const json_t *points)
{
  bool color[COLORS] = {false}, shape[SHAPES] = {false};
  json_t *list = json_array();
  for (size_t k = 0; k < chart->point_count; k++) {
    if (!drawn(&chart->points[k])) continue;
    color[color_of(&chart->points[k])] = shape[shape_of(&chart->points[k])] = true;
    list = json_append(list, json_incref(json_array_get(points, k)));
  }
  return json_pack("{s:o,s:o,s:o}", "drawn", list, "colors", legend(COLOR, COLORS, color), "shapes",
                   legend(SHAPE, SHAPES, shape));
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
  json_t *root = json_pack(
    "{s:o,s:o,s:o,s:o,s:o,s:o,s:o,s:i,s:i,s:o,s:o,s:o,s:O,s:O,s:[{s:b,s:o},{s:b,s:o}]}", "scene",
    page_of_file(request->path), "width", json_count(request->width), "height", json_count(request->height), "rays",
    json_count(chart->rays[RAYS_CAMERA].count), "shadows", json_count(chart->rays[RAYS_SHADOW].count), "rounds",
    json_count(chart->rounds), "undecided", json_count(chart->points[0].camera.undecided), "strip_width",
    (int)STRIP_WIDTH, "strip_height", (int)STRIP_HEIGHT, "yard_least", page_of_number(chart->yard[RAYS_CAMERA][0]),
    "yard_most", page_of_number(chart->yard[RAYS_CAMERA][chart->yard_count - 1]), "notes", notes, "first", first,
    "points", points, "tables", "all", 0, "points", first, "all", 1, "points", points);
  return json_join(json_join(root, figure_value(chart, points)), page_of_head(request->command_line));
}

enum { CSV, SVG, PAGE, FILES = CHART_FILES };

const char *const chart_files[FILES] = {"chart.csv", "chart.svg", "chart.html"};

/* The figure of an earlier chart is removed if this one has none. */
enum status chart_write(const struct chart *chart, struct text_buffer *out_text)
{
  struct text_buffer content[FILES] = {{0}};
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
  content[PAGE].failed = content[PAGE].failed || out_text->failed;
  if (status == STATUS_OK) status = page_write(chart->listener, chart->request->folder, FILES, chart_files, content);
  for (int k = 0; k < FILES; k++) text_buffer_free(&content[k]);
  json_decref(values);
  return status;
}

/* The files of a check: its pictures, its numbers, and its page. The page works without scripts: its slider is a box
 * that the reader widens; where scripts run, a control below it does the same. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/json_text.h"
#include "page/fill.h"
#include "check/measure.h"
#include "page/page.h"
#include "page/plot.h"
#include "check/templates.h"

/* The factor by which differences are magnified: 16 codes become full light. */
#define MAGNIFIED 16.0

enum { CROP = 15 }; /* size of the crop around one of the worst pixels */

/* The files, in this order: our picture, two for each possible row, the numbers, the page. */
enum { ROWS = CHECK_MAX_STEPS + 1, FILE_JSON = 1 + 2 * ROWS, FILE_PAGE, FILES = CHECK_FILES };

struct results {
  struct check *check;
  char path[FILES][PAGE_PATH_SIZE];
  bool failed; /* memory was short */
};

static void set(struct results *results, json_t *object, const char *key, json_t *value)
{
  results->failed = json_object_set_new(object, key, value) != 0 || results->failed;
}

static void append(struct results *results, json_t *list, json_t *value)
{
  results->failed = json_array_append_new(list, value) != 0 || results->failed;
}

/* ---- pictures ---- */

enum status check_make_pictures(struct check *check)
{
  const size_t last = check->row_count - 1;
  struct text_buffer *file = &check->file[1 + 2 * last];
  struct image difference;
  page_png(&check->row[last].picture.image, &file[0]);
  file[1].failed = check_difference(check, &check->row[last], MAGNIFIED, &difference) != STATUS_OK;
  if (!file[1].failed) {
    page_png(&difference, &file[1]);
    image_destroy(&difference);
  }
  return file[0].failed || file[1].failed ? listener_out_of_memory(check->listener) : STATUS_OK;
}

void check_file_name(size_t number, char out[CHECK_NAME_SIZE])
{
  const size_t row = (number - 1) / 2;
  const char *name = number % 2 ? "povray" : "difference";
  if (number == 0) snprintf(out, CHECK_NAME_SIZE, "pscn.png");
  else if (number == FILE_JSON) snprintf(out, CHECK_NAME_SIZE, "check.json");
  else if (number == FILE_PAGE) snprintf(out, CHECK_NAME_SIZE, "check.html");
  else if (row == 0) snprintf(out, CHECK_NAME_SIZE, "%s.png", name);
  else snprintf(out, CHECK_NAME_SIZE, "%s-%zu.png", name, row);
}

static void name_files(struct results *results)
{
  for (size_t k = 0; k < FILES; k++) {
    char name[CHECK_NAME_SIZE];
    check_file_name(k, name);
    snprintf(results->path[k], PAGE_PATH_SIZE, "%s/%s", results->check->request->folder, name);
  }
}

/* Turns a picture into a value, and destroys it. */
static json_t *take_picture(struct image *image)
{
  struct text_buffer png;
  page_png(image, &png);
  json_t *value = page_of_png(&png);
  text_buffer_free(&png);
  image_destroy(image);
  return value;
}

/* CROP x CROP pixels around (x, y), black outside the picture. */
static json_t *crop_of(const struct image *image, size_t x, size_t y)
{
  struct image crop;
  if (image_create(CROP, CROP, 3, &crop) != STATUS_OK) return NULL;
  for (size_t k = 0; k < CROP * CROP; k++) {
    const size_t u = k % CROP, v = k / CROP;
    const size_t from_x = x + u - CROP / 2, from_y = y + v - CROP / 2; /* negative numbers wrap to large ones */
    for (size_t c = 0; c < 3 && from_x < image->width && from_y < image->height; c++)
      image_pixel(&crop, u, v)[c] = image_pixel(image, from_x, from_y)[c];
  }
  for (int c = 0; c < 3; c++) snprintf(crop.channel[c].name, IMAGE_NAME_SIZE, "%c", "RGB"[c]);
  return take_picture(&crop);
}

/* ---- what the page shows beside the numbers of check.json ---- */

static json_t *color_of(const float color[3], const char *name, size_t count)
{
  return json_pack("{s:o,s:s,s:o}", "color",
                   json_sprintf("rgb(%d, %d, %d)", (int)lroundf(255 * color[0]), (int)lroundf(255 * color[1]),
                                (int)lroundf(255 * color[2])),
                   "name", name, "count", json_count(count));
}

static json_t *codes_of(const struct image *image, size_t x, size_t y)
{
  const float *value = image_pixel(image, x, y);
  return json_sprintf("%d %d %d", (int)lroundf(255 * value[0]), (int)lroundf(255 * value[1]),
                      (int)lroundf(255 * value[2]));
}

static void add_rows(struct results *results, json_t *rows)
{
  for (size_t k = 0; k < results->check->row_count; k++) {
    const struct check_row *row = &results->check->row[k];
    json_t *value = json_array_get(rows, k), *percent = json_array();
    for (int c = 0; c < CHECK_CODES; c++)
      append(results, percent, json_pack("{s:f}", "value", 100 * (double)row->over[c] / (double)row->result.pixels));
    set(results, value, "percent", percent);
    set(results, value, "codes", json_count((size_t)lround(255 * row->result.max)));
    set(results, value, "difference", page_of_png(&results->check->file[2 + 2 * k]));
    set(results, value, "last", json_boolean(k + 1 == results->check->row_count));
  }
}

/* Adds the pixels over the limit in the last row, by kind of edge. */
static void add_places(struct results *results, json_t *root)
{
  static const char *const NAME[CHECK_EDGES] = {"not on an edge", "on creases", "on edges of shadows",
                                                "on silhouettes"};
  const struct check_row *last = &results->check->row[results->check->row_count - 1];
  struct image map;
  json_t *spots = json_array(), *edges = json_array();
  for (int edge = CHECK_EDGES - 1; edge >= 0; edge--)
    append(results, spots, color_of(CHECK_SPOT_COLOR[edge], NAME[edge], last->over_limit_on[edge]));
  for (int edge = CHECK_EDGES - 1; edge > CHECK_EDGE_NONE; edge--)
    append(results, edges, color_of(CHECK_EDGE_COLOR[edge], CHECK_EDGE_NAME[edge], 0));
  set(results, root, "spots", spots);
  set(results, root, "edges", edges);
  set(results, root, "map", check_map(results->check, last, &map) == STATUS_OK ? take_picture(&map) : NULL);
}

static void add_worst(struct results *results, json_t *list)
{
  const struct check *check = results->check;
  const struct check_row *last = &check->row[check->row_count - 1];
  struct image difference = {0};
  results->failed = results->failed || check_difference(check, last, MAGNIFIED, &difference) != STATUS_OK;
  for (size_t k = 0; k < check->worst_count && !results->failed; k++) {
    const struct check_worst *worst = &check->worst[k];
    const struct {
      const char *name;
      const struct image *image;
    } pictures[] = {{"pscn", &check->ours.picture}, {"POV-Ray", &last->picture.image}, {"difference", &difference}};
    json_t *value = json_array_get(list, k), *crops = json_array();
    for (size_t p = 0; p < sizeof pictures / sizeof pictures[0]; p++)
      append(
        results, crops,
        json_pack("{s:s,s:o}", "name", pictures[p].name, "picture", crop_of(pictures[p].image, worst->x, worst->y)));
    set(results, value, "crops", crops);
    set(results, value, "x", json_count(worst->x));
    set(results, value, "y", json_count(worst->y));
    set(results, value, "codes", json_count((size_t)lround(255 * worst->difference)));
    set(results, value, "our_color", codes_of(&check->ours.picture, worst->x, worst->y));
    set(results, value, "their_color", codes_of(&last->picture.image, worst->x, worst->y));
  }
  image_destroy(&difference);
}

/* Draws how POV-Ray's answer approaches ours, if there is anything to draw. */
static enum status add_figure(struct results *results, json_t *root)
{
  const struct check *check = results->check;
  struct text_buffer figure;
  bool pixels = false, distances = false;
  for (size_t k = 1; k < check->row_count; k++) {
    pixels = pixels || check->row[k].over[0] > 0;
    distances = distances || check->row[k].distances.p99 > 0;
  }
  set(results, root, "pixels", json_boolean(pixels));
  set(results, root, "converging", json_boolean(distances));
  if (results->failed || !(pixels || distances)) return STATUS_OK;
  const enum status status = plot_draw(check->listener, TEMPLATE_CHECK_FIGURE, root, &figure);
  if (figure.length > 0) set(results, root, "figure", json_stringn(figure.text, figure.length));
  text_buffer_free(&figure);
  return status;
}

static enum status make_page(struct results *results, const char *verdict, struct text_buffer *out_text)
{
  struct check *check = results->check;
  const struct check_request *request = check->request;
  const struct text_buffer *theirs = &check->file[1 + 2 * (check->row_count - 1)];
  json_t *root = json_join(check_json(check), page_of_head(request->command_line));
  set(results, root, "name", page_of_file(request->path));
  set(results, root, "verdict", json_string(verdict));
  set(results, root, "width", json_count(request->width));
  set(results, root, "height", json_count(request->height));
  set(results, root, "grid", request->grid == 0 ? json_null() : json_count(request->grid));
  set(results, root, "limit", json_real(255 * request->fail.each));
  set(results, root, "magnified", json_real(MAGNIFIED));
  set(results, root, "ours", page_of_png(&check->file[0]));
  set(results, root, "theirs", page_of_png(theirs));
  set(results, root, "last_name",
      json_copy(json_object_get(json_array_get(json_object_get(root, "rows"), check->row_count - 1), "name")));
  set(results, root, "warnings", check->warnings.length == 0 ? json_null() : json_string(check->warnings.text));
  add_rows(results, json_object_get(root, "rows"));
  add_places(results, root);
  add_worst(results, json_object_get(root, "worst"));
  const enum status status = add_figure(results, root);
  fill_template(out_text, TEMPLATE_CHECK_TABLE, root);
  fill_template(&check->file[FILE_PAGE], TEMPLATE_CHECK_PAGE, root);
  json_decref(root);
  return status;
}

static void make_json(struct results *results)
{
  json_t *root = check_json(results->check);
  char *text = json_text(root, JSON_INDENT(2) | JSON_REAL_PRECISION(15));
  json_decref(root);
  results->failed = results->failed || text == NULL;
  text_buffer_format(&results->check->file[FILE_JSON], "%s\n", text == NULL ? "" : text);
  free(text);
}

enum status check_write(struct check *check, const char *verdict, struct text_buffer *out_text)
{
  struct results *results = calloc(1, sizeof *results);
  if (results == NULL) return listener_out_of_memory(check->listener);
  results->check = check;
  name_files(results);
  page_png(&check->ours.picture, &check->file[0]);
  make_json(results);
  enum status status = results->failed ? STATUS_OK : make_page(results, verdict, out_text);
  check->file[FILE_PAGE].failed = check->file[FILE_PAGE].failed || results->failed || out_text->failed;
  if (status == STATUS_OK) status = page_write(check->listener, FILES, results->path, check->file);
  free(results);
  return status;
}

/* The files of a check: its pictures, its numbers, and its page. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/json_text.h"
#include "check/measure.h"
#include "check/templates.h"
#include "library/pscn.h"
#include "page/page.h"

/* The factor by which differences are magnified: 16 codes become full light. */
#define MAGNIFIED 16.0

/* The files: our picture, two for each possible row, the numbers, the page. */
enum { FILE_OURS, FILE_ROWS, FILE_JSON = CHECK_FILES - 2, FILE_PAGE };

const char *const check_files[CHECK_FILES] = {
  "pscn.png",         "povray.png",   "difference.png",   "povray-1.png", "difference-1.png", "povray-2.png",
  "difference-2.png", "povray-3.png", "difference-3.png", "povray-4.png", "difference-4.png", "povray-5.png",
  "difference-5.png", "povray-6.png", "difference-6.png", "povray-7.png", "difference-7.png", "povray-8.png",
  "difference-8.png", "check.json",   "check.html"};

enum status check_make_pictures(struct check *check)
{
  const size_t last = check->row_count - 1;
  struct text_buffer *file = &check->file[FILE_ROWS + 2 * last];
  struct image difference;
  page_png(&check->row[last].picture.image, &file[0]);
  file[1].failed = check_difference(check, &check->row[last], MAGNIFIED, &difference) != STATUS_OK;
  if (!file[1].failed) {
    page_png(&difference, &file[1]);
    image_destroy(&difference);
  }
  return file[0].failed || file[1].failed ? listener_out_of_memory(check->listener) : STATUS_OK;
}

/* ---- the numbers; NULL if memory is short ---- */

static json_t *name_of(const struct check *check, const struct check_row *row)
{
  if (row->steps > 0) return json_sprintf("u_steps %zu", row->steps);
  return json_string(check->dumped[0] == '\0' ? "as written" : "dump");
}

static json_t *distances_value(const struct check_distances *d)
{
  return json_pack("{s:o,s:o,s:o,s:o,s:o,s:o,s:o}", "rays", json_count(d->rays), "both", json_count(d->both),
                   "only_here", json_count(d->only_ours), "only_there", json_count(d->only_theirs), "median",
                   page_of_number(d->median), "percent_99", page_of_number(d->p99), "max", page_of_number(d->max));
}

static json_t *row_value(const struct check *check, const struct check_row *row)
{
  const struct compare_result *r = &row->result;
  const size_t *on = row->over_limit_on;
  json_t *root = json_pack(
    "{s:o,s:o,s:{s:o,s:o,s:o,s:o},s:o,s:o,s:o,s:o,s:o,s:[i,i],s:{s:o,s:o,s:o},s:{s:o,s:o},s:{s:f,s:f}}", "u_steps",
    row->steps == 0 ? json_null() : json_count(row->steps), "name", name_of(check, row), "over", "1/255",
    json_count(row->over[0]), "4/255", json_count(row->over[1]), "16/255", json_count(row->over[2]), "limit",
    json_count(row->over_limit), "over_limit_off_edges", json_count(on[CHECK_EDGE_NONE]), "mean",
    page_of_number(r->mean), "rms", page_of_number(r->rms), "psnr", page_of_number(r->psnr), "max",
    page_of_number(r->max), "worst", (int)r->worst_x, (int)r->worst_y, "over_limit_on", "crease",
    json_count(on[CHECK_EDGE_CREASE]), "shadow", json_count(on[CHECK_EDGE_SHADOW]), "silhouette",
    json_count(on[CHECK_EDGE_SILHOUETTE]), "mask", "only_here", json_count(row->mask_ours), "only_there",
    json_count(row->mask_theirs), "time", "wall", row->picture.time.wall, "cpu", row->picture.time.cpu);
  if (check->request->grid == 0) return root;
  return json_join(root, json_pack("{s:o}", "distances", distances_value(&row->distances)));
}

static json_t *check_value(const struct check *check)
{
  const struct check_request *request = check->request;
  json_t *rows = json_array();
  char message[256];
  for (size_t k = 0; k < check->row_count; k++) rows = json_append(rows, row_value(check, &check->row[k]));
  return json_pack("{s:s,s:s,s:o,s:o,s:[i,i],s:{s:o,s:o,s:o,s:o,s:o,s:o},s:b,s:o,s:{s:f,s:f}}", "version", PSCN_VERSION,
                   "povray", check->povray.version, "scene", page_of_text(request->path), "dumped",
                   check->dumped[0] == '\0' ? json_null() : page_of_text(check->dumped), "size", (int)request->width,
                   (int)request->height, "limits", "fail", page_of_number(request->fail.each), "failpercent",
                   page_of_number(request->fail.percent), "allowfailures", page_of_number(request->fail.allowed_pixels),
                   "hardfail", page_of_number(request->fail.any), "failpsnr", page_of_number(request->fail_psnr),
                   "failmask", page_of_number(request->fail_mask), "within_limits",
                   check_within_limits(check, message, sizeof message), "rows", rows, "time", "wall",
                   check->ours.time.wall, "cpu", check->ours.time.cpu);
}

/* ---- what the page shows beside them ---- */

/* Adds to a row's numbers. Returns false if memory is short. */
static bool add_to_row(const struct check *check, size_t index, json_t *value)
{
  const struct check_row *row = &check->row[index];
  json_t *percent = json_array();
  for (int c = 0; c < CHECK_CODES; c++)
    percent = json_append(percent,
                          json_pack("{s:f}", "value", 100 * (double)row->over[c] / (double)row->result.pixels));
  return json_object_update_new(value, json_pack("{s:o,s:i,s:o,s:b}", "percent", percent, "codes",
                                                 (int)lround(255 * row->result.max), "difference",
                                                 page_of_png(&check->file[FILE_ROWS + 2 * index + 1]), "last",
                                                 index + 1 == check->row_count)) == 0;
}

/* All values of figure, page and table; NULL if memory is short. */
static json_t *page_value(const struct check *check, const char *verdict)
{
  const struct check_request *request = check->request;
  const size_t last = check->row_count - 1;
  bool pixels = false, distances = false;
  for (size_t k = 1; k <= last; k++) {
    pixels = pixels || check->row[k].over[0] > 0;
    distances = distances || check->row[k].distances.p99 > 0;
  }
  json_t *root = json_join(
    json_join(check_value(check), page_of_head(request->command_line)),
    json_pack("{s:o,s:s,s:o,s:o,s:o,s:f,s:f,s:o,s:o,s:o,s:b,s:b}", "name", page_of_file(request->path), "verdict",
              verdict, "width", json_count(request->width), "height", json_count(request->height), "grid",
              request->grid == 0 ? json_null() : json_count(request->grid), "limit", 255 * request->fail.each,
              "magnified", MAGNIFIED, "ours", page_of_png(&check->file[FILE_OURS]), "theirs",
              page_of_png(&check->file[FILE_ROWS + 2 * last]), "last_name", name_of(check, &check->row[last]), "pixels",
              pixels, "converging", distances));
  for (size_t k = 0; k <= last && root != NULL; k++)
    if (!add_to_row(check, k, json_array_get(json_object_get(root, "rows"), k))) json_decref(root), root = NULL;
  return root;
}

/* Draws how POV-Ray's answer approaches ours, if there is anything to draw, and adds the figure to the values. */
static enum status add_figure(const struct check *check, json_t **values)
{
  struct text_buffer figure;
  if (!json_is_true(json_object_get(*values, "pixels")) && !json_is_true(json_object_get(*values, "converging")))
    return STATUS_OK;
  const enum status status = plot_draw(check->listener, TEMPLATE_CHECK_FIGURE, *values, &figure);
  if (figure.length > 0) *values = json_join(*values, json_pack("{s:s%}", "figure", figure.text, figure.length));
  text_buffer_free(&figure);
  return status;
}

enum status check_write(struct check *check, const char *verdict, struct text_buffer *out_text)
{
  struct text_buffer *json = &check->file[FILE_JSON], *page = &check->file[FILE_PAGE];
  page_png(&check->ours.picture, &check->file[FILE_OURS]);
  json_t *numbers = check_value(check), *values = page_value(check, verdict);
  char *text = json_text(numbers, JSON_INDENT(2) | JSON_REAL_PRECISION(15));
  json->failed = text == NULL;
  text_buffer_format(json, "%s\n", text == NULL ? "" : text);
  enum status status = add_figure(check, &values);
  fill_template(out_text, TEMPLATE_CHECK_TABLE, values);
  fill_template(page, TEMPLATE_CHECK_PAGE, values);
  page->failed = page->failed || out_text->failed;
  if (status == STATUS_OK)
    status = page_write(check->listener, check->request->folder, CHECK_FILES, check_files, check->file);
  json_decref(numbers);
  json_decref(values);
  free(text);
  return status;
}

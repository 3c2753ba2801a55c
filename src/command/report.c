/* A run's report. See report.h. */
#include "command/report.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "base/json_text.h"
#include "base/number.h"
#include "command/output.h"
#include "library/pscn.h"
#include "page/page.h"

enum { JSON_DIGITS = 15 }; /* of numbers in the statistics: 1e-12 stays 1e-12 */

/* "1,234,567" */
static void group(uint64_t number, char out[32])
{
  char digits[24];
  const int length = snprintf(digits, sizeof digits, "%" PRIu64, number);
  for (int k = 0; k < length; k++) {
    *out++ = digits[k];
    if (k < length - 1 && (length - 1 - k) % 3 == 0) *out++ = ',';
  }
  *out = '\0';
}

/* A line with up to three numbers. */
__attribute__((format(printf, 1, 0))) static void print_counts(const char *format, uint64_t a, uint64_t b, uint64_t c)
{
  char text[3][32];
  group(a, text[0]), group(b, text[1]), group(c, text[2]);
  fprintf(stderr, format, text[0], text[1], text[2]);
}

void report_print(const struct report *report)
{
  const struct intersect_counts *counts = &report->counts;
  char solver[METHOD_TEXT_SIZE];
  method_text(&report->scene->solvers[0], solver, sizeof solver);
  if (report->picture_path != NULL) {
    command_print(stderr, report->picture_path);
    fprintf(stderr, ": %zu x %zu pixels, %zu x %zu samples each\n", report->crop.width, report->crop.height,
            report->samples, report->samples);
  }
  fprintf(stderr, "solver   %s, %zu patch%s, %zu thread%s\n", solver, report->scene->patch_count,
          report->scene->patch_count == 1 ? "" : "es", report->threads, report->threads == 1 ? "" : "s");
  print_counts("rays     %s primary, %s shadow\n", counts->rays[0], counts->rays[1], 0);
  print_counts("answers  %s certain, %s grazing (of primary rays)\n", counts->certain, counts->grazing, 0);
  print_counts("leaves   %s ray-leaf pairs, %s of them solved by a resultant of full degree, %s in exact arithmetic\n",
               counts->patches_tested, counts->stages[STAGE_RESULTANT], counts->escalated);
  print_counts("roots    %s found, %s accepted as hits\n", counts->roots_found, counts->roots_accepted, 0);
  fprintf(stderr, "time     %.3f s parse, %.3f s build, %.3f s render, %.3f s write\n", report->parse.wall,
          report->build.wall, report->render.wall, report->write.wall);
}

json_t *report_statistics(const struct report *report)
{
  const struct intersect_counts *counts = &report->counts;
  char solver[METHOD_TEXT_SIZE];
  method_text(&report->scene->solvers[0], solver, sizeof solver);
  json_t *root = json_pack(
    "{s:s, s:o, s:s, s:f, s:o, s:o, s:o, s:{s:o, s:o}, s:o, s:{s:o, s:o, s:o, s:o}, s:o, s:{s:o, s:o}, s:{s:o, s:o}, "
    "s:{s:f, s:f, s:f, s:f}, s:{s:f, s:f, s:f, s:f, s:f}}",
    "version", PSCN_VERSION, "scene", page_of_text(report->scene_path), "solver", solver, "tolerance",
    report->scene->solvers[0].roots.tolerance, "threads", json_count(report->threads), "patches",
    json_count(report->scene->patch_count), "lights", json_count(report->scene->light_count), "rays", "primary",
    json_count(counts->rays[0]), "shadow", json_count(counts->rays[1]), "patches_tested",
    json_count(counts->patches_tested), "stages", "bilinear", json_count(counts->stages[STAGE_BILINEAR]), "planes",
    json_count(counts->stages[STAGE_PLANES]), "resultant", json_count(counts->stages[STAGE_RESULTANT]), "roots",
    json_count(counts->stages[STAGE_ROOTS]), "subdivided", json_count(counts->escalated), "roots", "found",
    json_count(counts->roots_found), "accepted", json_count(counts->roots_accepted), "answers", "certain",
    json_count(counts->certain), "grazing", json_count(counts->grazing), "time", "parse", report->parse.wall, "build",
    report->build.wall, "render", report->render.wall, "write", report->write.wall, "cpu", "parse", report->parse.cpu,
    "build", report->build.cpu, "render", report->render.cpu, "write", report->write.cpu, "load", report->loading);
  if (root == NULL || report->picture_path == NULL) return root;
  const struct rectangle *crop = &report->crop;
  json_t *picture = json_pack("{s:o, s:[o, o], s:[o, o, o, o], s:o}", "picture", page_of_text(report->picture_path),
                              "size", json_count(report->width), json_count(report->height), "crop",
                              json_count(crop->x), json_count(crop->y), json_count(crop->width),
                              json_count(crop->height), "samples", json_count(report->samples));
  return json_join(root, picture);
}

enum status report_text(const struct command *command, json_t *statistics, char **out_text)
{
  char *text = json_text(statistics, JSON_INDENT(2) | JSON_REAL_PRECISION(JSON_DIGITS));
  json_decref(statistics);
  *out_text = text;
  if (text != NULL) {
    strcat(text, "\n");
    return STATUS_OK;
  }
  command_error(command, "out of memory for the statistics");
  return STATUS_LIMIT;
}

enum status report_write(const struct command *command, json_t *statistics, const char *path)
{
  char *text;
  enum status status = report_text(command, statistics, &text);
  if (status == STATUS_OK) status = output_write(command, &(struct atomic_file){path, text, strlen(text)}, 1);
  free(text);
  return status;
}

bool report_sign(struct image *picture)
{
  const time_t now = time(NULL);
  char date[32] = "";
  struct tm calendar;
  if (gmtime_r(&now, &calendar) != NULL) (void)strftime(date, sizeof date, "%Y:%m:%d %H:%M:%S", &calendar);
  return image_add_text(picture, "Software", "pscn " PSCN_VERSION) && image_add_text(picture, "DateTime", "%s", date);
}

bool report_describe(const struct report *report, struct image *picture)
{
  const struct method *method = &report->scene->solvers[0];
  const struct rectangle *crop = &report->crop;
  char solver[METHOD_TEXT_SIZE], tolerance[NUMBER_TEXT_SIZE];
  method_text(method, solver, sizeof solver);
  number_write(method->roots.tolerance, tolerance);
  picture->texts_size = 0;
  return report_sign(picture) && image_add_text(picture, "pscn:version", PSCN_VERSION) &&
         image_add_text(picture, "pscn:scene", "%s", report->scene_path) &&
         image_add_text(picture, "pscn:solver", "%s", solver) &&
         image_add_text(picture, "pscn:tolerance", "%s", tolerance) &&
         image_add_text(picture, "pscn:size", "%zux%zu", report->width, report->height) &&
         image_add_text(picture, "pscn:crop", "%zu,%zu,%zu,%zu", crop->x, crop->y, crop->width, crop->height) &&
         image_add_text(picture, "pscn:samples", "%zu", report->samples) &&
         image_add_text(picture, "pscn:channels", "%s", report->channels) &&
         image_add_text(picture, "pscn:options", "%s", report->options) &&
         image_add_text(picture, "pscn:text", "%s", report->scene->text_hash) &&
         image_add_text(picture, "pscn:arithmetic", "%s", intersector_arithmetic()) &&
         image_add_text(picture, "pscn:render_seconds", "%.3f", report->render.wall);
}

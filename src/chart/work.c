/* The points of a chart, measured and judged. */
#include "chart/work.h"

#include <assert.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

void chart_note(struct chart *chart, const char *format, ...)
{
  if (chart->note_count == CHART_NOTES) return;
  char *note = chart->notes[chart->note_count++];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(note, sizeof chart->notes[0], format, arguments);
  va_end(arguments);
  listener_tell(chart->listener, TOLD_PROGRESS, "%s", note);
}

struct chart_point *chart_add(struct chart *chart, const struct chart_point *said, const struct timing time[RAY_KINDS])
{
  assert(chart->point_count < chart->point_room);
  struct chart_point *point = &chart->points[chart->point_count++];
  *point = *said;
  memcpy(point->time, time, sizeof point->time);
  judge_answers(chart->rays[RAYS_CAMERA].count, chart->truths[RAYS_CAMERA], chart->answers, chart->errors,
                &point->camera);
  return point;
}

enum status chart_measure(struct chart *chart, size_t count, const struct runner runners[],
                          const struct chart_point said[], struct timing out_yard[RAY_KINDS])
{
  struct runner turns[1 + CHART_BATCH] = {pscn_runner_face(&chart->yardstick)};
  struct timing time[1 + CHART_BATCH][RAY_KINDS];
  const struct ray_list *shadow = &chart->rays[RAYS_SHADOW];
  const size_t counts[RAY_KINDS] = {chart->rays[RAYS_CAMERA].count, shadow->count};
  assert(count <= CHART_BATCH);
  memcpy(turns + 1, runners, count * sizeof *runners);
  const enum status status = measure_rounds(turns, 1 + count, counts, chart->rounds, chart->listener->stop, time);
  if (status != STATUS_OK) return status;
  for (size_t k = 0; k < count; k++) {
    runners[k].run(runners[k].context, RAYS_CAMERA, chart->answers);
    struct chart_point *point = chart_add(chart, &said[k], time[1 + k]);
    runners[k].run(runners[k].context, RAYS_SHADOW, chart->answers);
    judge_occluded(shadow->count, shadow->rays, chart->truths[RAYS_SHADOW], chart->answers, &point->shadow);
    point->has_shadow = true;
  }
  if (out_yard != NULL) memcpy(out_yard, time[0], sizeof time[0]);
  return STATUS_OK;
}

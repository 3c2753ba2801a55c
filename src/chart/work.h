/* Shared by the parts of a chart: chart.c runs it and adds points, peers.c asks others, results.c writes the
 * results. Internal to this folder. */
#ifndef PSCN_CHART_WORK_H
#define PSCN_CHART_WORK_H

#include "base/arena.h"
#include "chart/chart.h"
#include "chart/judge.h"
#include "chart/measure.h"
#include "chart/point.h"

enum { CHART_NOTES = 6, CHART_NOTE_SIZE = 320 };

struct chart {
  const struct chart_request *request;
  const struct listener *listener;
  size_t wanted, rounds; /* about how many camera rays; turns of each runner */
  struct scene *scene;   /* every patch has solver 0 */
  struct arena *arena;   /* of all below */
  struct ray_list rays[RAY_KINDS];
  struct truth *truths[RAY_KINDS];
  struct answer *answers;       /* room for those to the rays of a kind */
  double *errors;               /* room for judge_answers */
  struct pscn_runner yardstick; /* the default solver */
  double *yard[RAY_KINDS];      /* its medians of the batches, in ns a ray; sorted at the end */
  size_t yard_count;
  struct chart_point *points;
  size_t point_count, point_room;
  char notes[CHART_NOTES][CHART_NOTE_SIZE]; /* on peers: their version, or why they are missing */
  size_t note_count;
};

/* Adds a point like `said`, which was measured and answered elsewhere: chart->answers are those to the camera rays.
 * There is always room. */
struct chart_point *chart_add(struct chart *chart, const struct chart_point *said, const struct timing time[RAY_KINDS]);

/* Adds a point like said[k] for each of `count` <= CHART_BATCH runners, measured in turns with the yardstick. The
 * yardstick's own times go to out_yard unless that is NULL. */
enum { CHART_BATCH = 24 };
enum status chart_measure(struct chart *chart, size_t count, const struct runner runners[],
                          const struct chart_point said[], struct timing out_yard[RAY_KINDS]) STATUS_MUST_CHECK;

/* Reports progress, and keeps the sentence for the page. */
void chart_note(struct chart *chart, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* ---- peers.c ---- */

/* Adds the points of the peers that exist, at most CHART_PEER_POINTS, with a note on each. A peer that is missing or
 * fails is noted, and is no error; STATUS_INTERRUPTED and STATUS_LIMIT are. */
enum { CHART_PEER_POINTS = 64 };
enum status chart_peers(struct chart *chart) STATUS_MUST_CHECK;

/* ---- results.c ---- */

/* Writes the files. *out_text receives the front and the default as a table. Errors are reported. */
enum status chart_write(const struct chart *chart, struct text_buffer *out_text) STATUS_MUST_CHECK;

#endif

/* `pscn chart`: what its parts share. chart.c runs it; chart_peers.c asks other programs; chart_table.c writes the CSV
 * and the summary, chart_plot.c the figure, chart_page.c the page. */
#ifndef PSCN_COMMAND_CHART_H
#define PSCN_COMMAND_CHART_H

#include "base/arena.h"
#include "chart/judge.h"
#include "chart/measure.h"
#include "chart/point.h"
#include "command/command.h"
#include "command/page.h"
#include "command/povray.h"
#include "command/scene_file.h"
#include "scene/method.h"

enum { CHART_NOTES = 4 };

struct chart {
  const struct command *command;
  struct scene_request scene_request;
  const char *output, *program; /* the folder of the results; POV-Ray */
  size_t wanted, rounds;        /* 0: the default of quick or not */
  bool quick, peers, quiet;
  struct scene *scene;          /* every patch has solver 0 */
  struct arena *arena;          /* of all below */
  struct ray_list rays[RAY_KINDS];
  struct truth *truths[RAY_KINDS];
  struct answer *answers;       /* room for the camera rays' */
  bool *occluded;               /* room for the shadow rays' */
  double *errors;               /* room for judge_answers */
  struct pscn_runner yardstick; /* the default solver */
  double *yard[RAY_KINDS];      /* its medians in the batches, in ns a ray; sorted in the end */
  size_t yard_count;
  struct chart_point *points;
  size_t point_count, point_room;
  char notes[CHART_NOTES][256]; /* on peers: which version, or why they are missing */
  size_t note_count;
};

/* A new point, all of whose numbers are unknown; there is always room. */
struct chart_point *chart_add(struct chart *chart, enum family family);

/* Judges chart->answers and, where point->has_shadow, chart->occluded. */
void chart_judge(struct chart *chart, struct chart_point *point);

/* Says what is going on, unless quiet; and keeps a sentence for the page. */
void chart_tell(const struct chart *chart, const char *format, ...) __attribute__((format(printf, 2, 3)));
void chart_note(struct chart *chart, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* ---- chart_peers.c ---- */

/* Adds the points of the peers that are there, with a note on each. How many there are at most is CHART_PEER_POINTS. A
 * peer that is missing or fails is noted, no error; STATUS_INTERRUPTED and STATUS_LIMIT are. */
enum { CHART_PEER_POINTS = 64 };
enum status chart_peers(struct chart *chart) STATUS_MUST_CHECK;

/* ---- chart_table.c, chart_plot.c, chart_page.c ---- */

/* All points, one a line; to be finished and freed by the caller. */
void chart_csv(const struct chart *chart, struct page *out);

/* The front on standard output. */
void chart_print(const struct chart *chart);

/* The figure as SVG text in *out, to be freed. Where gnuplot is missing or fails, or the rays hit nothing, a warning is
 * told, *out is NULL and the status STATUS_OK all the same. */
enum status chart_plot(struct chart *chart, char **out, size_t *out_length) STATUS_MUST_CHECK;

/* The page; svg may be NULL. The caller finishes and frees it. */
void chart_page(const struct chart *chart, const char *svg, struct page *out);

#endif

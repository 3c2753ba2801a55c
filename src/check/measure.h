/* The measurements of a check, and the functions that present them. Internal to this folder. */
#ifndef PSCN_CHECK_MEASURE_H
#define PSCN_CHECK_MEASURE_H

#include <stdint.h>

#include "check/check.h"
#include "intersect/intersect.h"

enum { CHECK_CODES = 3 }; /* the limits 1, 4 and 16 of 255 */

/* The kind of edge at a pixel or next to it; of several, the last in this order. */
enum check_edge { CHECK_EDGE_NONE, CHECK_EDGE_CREASE, CHECK_EDGE_SHADOW, CHECK_EDGE_SILHOUETTE, CHECK_EDGES };

/* The lights whose shadow edges are recognized as edges: the first ones of the scene. */
enum { CHECK_LIGHTS = 64 };

/* Our answer for a pixel's centre. */
struct check_sight {
  struct hit hit;
  double distance; /* scene units; INFINITY on a miss */
  uint64_t lights; /* bit k: light k of CHECK_LIGHTS reaches the point */
};

/* What is kept of it. */
struct check_pixel {
  double distance;
  enum check_edge edge;
};

struct check_ours {
  struct image picture;      /* R G B, display codes of 8 bits as k/255 */
  struct check_pixel *pixel; /* [height][width] */
  struct seconds time;       /* of reading, building, rendering and encoding, on one thread */
};

/* Differences of distances, relative to ours, over the rays that both call hits; NaN if there are none. */
struct check_distances {
  size_t rays, both, only_ours, only_theirs;
  double median, p99, max; /* p99: 99 % are at most this */
};

struct check_row {
  size_t steps;                  /* 0: as written */
  struct povray_picture picture; /* its image is kept until the next row is measured */
  struct compare_result result;
  size_t over[CHECK_CODES], over_limit;
  size_t over_limit_on[CHECK_EDGES]; /* the pixels over the limit, by kind of edge */
  size_t mask_ours, mask_theirs;     /* pixels that only one of both hits */
  struct check_distances distances;
};

struct check {
  const struct check_request *request;
  const struct listener *listener;
  struct povray povray;
  struct scene *scene; /* its steps change from row to row */
  struct check_ours ours;
  struct check_row row[CHECK_MAX_STEPS + 1];
  size_t row_count;
  char dumped[POVRAY_WORD_SIZE + 64];   /* why the first row is of the dump; "": it is of the file as written */
  struct text_buffer file[CHECK_FILES]; /* what is written; empty: the file must not exist */
};

/* ---- check.c ---- */

/* Renders, and examines every pixel. Errors go to the listener. */
enum status check_measure_ours(struct check *check) STATUS_MUST_CHECK;
void check_ours_free(struct check_ours *ours);

/* Adds a row for the scene in check->scene or, if steps is 0, for its file. */
enum status check_measure_row(struct check *check, size_t steps) STATUS_MUST_CHECK;

/* The difference of a row as a picture, multiplied by `scale`. STATUS_LIMIT if memory is short. */
enum status check_difference(const struct check *check, const struct check_row *row, double scale,
                             struct image *out) STATUS_MUST_CHECK;

/* Whether the last row is within the limits; if not, `out` says which one it exceeds. */
bool check_within_limits(const struct check *check, char *out, size_t size);

/* ---- edges.c ---- */

/* Finds the edges in a row of our pixels. `window` has the row and those beside it, row y at window[y % 3][width]. */
void check_find_edges(struct check *check, const struct check_sight *window, size_t y);

/* ---- results.c ---- */

/* Makes the files of the last row's pictures. Errors go to the listener. */
enum status check_make_pictures(struct check *check) STATUS_MUST_CHECK;

/* Writes all results; `verdict` is one sentence. *out_text receives the numbers as a table. Errors go to the
 * listener. */
enum status check_write(struct check *check, const char *verdict, struct text_buffer *out_text) STATUS_MUST_CHECK;

#endif

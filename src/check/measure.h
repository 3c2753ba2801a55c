/* The measurements of a check, and the functions that present them. Internal to this folder. */
#ifndef PSCN_CHECK_MEASURE_H
#define PSCN_CHECK_MEASURE_H

#include <jansson.h>
#include <stdint.h>

#include "check/check.h"
#include "intersect/intersect.h"
#include "page/povray.h"

enum {
  CHECK_CODES = 3, /* the limits 1, 4 and 16 of 255 */
  CHECK_WORST = 8  /* pixels that are shown magnified */
};

/* The kind of edge at a pixel or next to it; of several, the last in this order. */
enum check_edge { CHECK_EDGE_NONE, CHECK_EDGE_CREASE, CHECK_EDGE_SHADOW, CHECK_EDGE_SILHOUETTE, CHECK_EDGES };
extern const char *const CHECK_EDGE_NAME[CHECK_EDGES];

/* The lights whose shadow edges are recognized as edges: the first ones of the scene. */
enum { CHECK_LIGHTS = 64 };

/* Our answer for a pixel's centre. */
struct check_sight {
  struct hit hit;
  double distance; /* scene units; INFINITY on a miss */
  uint64_t lights; /* bit k: light k of CHECK_LIGHTS reaches the point */
};

/* What is kept of it. On a miss u and v are unspecified. */
struct check_pixel {
  double distance, u, v;
  uint32_t patch; /* or HIT_NONE */
  enum certainty certainty;
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

/* One of the worst pixels. */
struct check_worst {
  size_t x, y;
  double difference; /* the largest of R G B; 1 is full light */
  double distance;   /* POV-Ray's; INFINITY on a miss */
};

struct check {
  const struct check_request *request;
  const struct listener *listener;
  struct povray povray;
  struct scene *scene; /* its steps change from row to row */
  struct check_ours ours;
  struct check_row row[CHECK_MAX_STEPS + 1];
  size_t row_count;
  struct check_worst worst[CHECK_WORST]; /* of the last row */
  size_t worst_count;
  char dumped[POVRAY_WORD_SIZE + 64];   /* why the first row is of the dump; "": it is of the file as written */
  struct text_buffer warnings;          /* POV-Ray's warnings on the scene as written */
  struct text_buffer file[CHECK_FILES]; /* what is written; empty: the file must not exist */
};

/* ---- measure.c ---- */

/* Renders, and examines every pixel. Errors go to the listener. */
enum status check_measure_ours(struct check *check) STATUS_MUST_CHECK;
void check_ours_free(struct check_ours *ours);

/* Adds a row for the scene in check->scene or, if steps is 0, for its file. */
enum status check_measure_row(struct check *check, size_t steps) STATUS_MUST_CHECK;

/* Finds the worst pixels of the last row, and asks POV-Ray for their distances. */
enum status check_find_worst(struct check *check) STATUS_MUST_CHECK;

/* The difference of a row as a picture, multiplied by `scale`. STATUS_LIMIT if memory is short. */
enum status check_difference(const struct check *check, const struct check_row *row, double scale,
                             struct image *out) STATUS_MUST_CHECK;

/* A pixel's largest difference in R G B, and the limit of that. */
double check_pixel_difference(const struct check *check, const struct check_row *row, size_t x, size_t y);
double check_limit(const struct check *check);

/* Whether the last row is within the limits; if not, `out` says which one it exceeds. */
bool check_within_limits(const struct check *check, char *out, size_t size);

/* ---- edges.c ---- */

/* Finds the edges in a row of our pixels. `window` has the row and those beside it, row y at window[y % 3][width]. */
void check_find_edges(struct check *check, const struct check_sight *window, size_t y);

/* ---- map.c ---- */

/* A map of our picture, darkened, with its edges, and with the pixels over the limit as spots. The colours are R G B, 0
 * to 1, of the edges, and of the spots by kind of edge. STATUS_LIMIT if memory is short. */
extern const float CHECK_EDGE_COLOR[CHECK_EDGES][3], CHECK_SPOT_COLOR[CHECK_EDGES][3];
enum status check_map(const struct check *check, const struct check_row *row, struct image *out) STATUS_MUST_CHECK;

/* ---- report.c ---- */

/* All numbers, for check.json; NULL if memory is short. */
json_t *check_json(const struct check *check);

/* ---- results.c ---- */

/* Makes the files of the last row's pictures. Errors go to the listener. */
enum status check_make_pictures(struct check *check) STATUS_MUST_CHECK;

/* Writes all results; `verdict` is one sentence. *out_text receives the numbers as a table. Errors go to the
 * listener. */
enum status check_write(struct check *check, const char *verdict, struct text_buffer *out_text) STATUS_MUST_CHECK;

#endif

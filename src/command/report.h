/* A run's summary, its statistics as JSON, and the metadata of its picture. */
#ifndef PSCN_COMMAND_REPORT_H
#define PSCN_COMMAND_REPORT_H

#include <jansson.h>

#include "base/clock.h"
#include "command/command.h"
#include "command/scene_file.h"
#include "image/image_file.h"
#include "intersect/intersect.h"
#include "render/tile.h"
#include "scene/method.h"

struct report {
  const char *scene_path;
  const char *picture_path; /* NULL: no picture was made, and its sizes mean nothing */
  const struct scene *scene;
  size_t width, height, samples, threads;
  struct rectangle crop; /* the part of width x height that the picture shows */
  const char *channels,
    *options; /* as on the command line: --channels LIST, and the other options on reading the scene */
  struct intersect_counts counts;
  struct seconds parse, build, render, write; /* write: of the picture's bytes */
  double loading;                             /* CPU seconds of image_loading.h, in none of these */
};

/* Prints a few lines to stderr. */
void report_print(const struct report *report);

/* The statistics, or NULL if memory is short. Release them by json_decref, or pass them to a function that takes
 * them. */
json_t *report_statistics(const struct report *report);

/* Statistics of any origin, as a text that the caller frees, and written (output.h). Both take ownership; NULL means
 * that memory was short, which they print. */
enum status report_text(const struct command *command, json_t *statistics, char **out_text) STATUS_MUST_CHECK;
enum status report_write(const struct command *command, json_t *statistics, const char *path) STATUS_MUST_CHECK;

/* Adds the two lines of metadata that say when a picture was written, and by what. Returns false if memory is short. */
bool report_sign(struct image *picture) STATUS_MUST_CHECK;

/* Replaces the picture's metadata. Returns false if memory is short. */
bool report_describe(const struct report *report, struct image *picture) STATUS_MUST_CHECK;

#endif

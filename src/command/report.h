/* What a run was and did: its summary, its statistics as JSON, the metadata of its picture. */
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
  const char *picture_path; /* NULL: no picture was made, and the sizes mean nothing */
  const struct scene *scene;
  size_t width, height, samples, threads;
  struct rectangle crop; /* the part of width x height that the picture shows */
  const char *channels,
    *options; /* as on the command line: --channels LIST, and what else says how the scene is read */
  struct intersect_counts counts;
  struct seconds parse, build, render, write; /* write: what the bytes of the picture took */
  double loading; /* CPU seconds that image_loading.h has taken beside them, and are in none */
};

/* A few lines on stderr. */
void report_print(const struct report *report);

/* The statistics, or NULL where memory is short. To be released by json_decref, or by what takes them over. */
json_t *report_statistics(const struct report *report);

/* Statistics, from here or elsewhere, as a text, to be freed, and written (output.h). Both take them over; NULL means
 * that memory was short, which is told. */
enum status report_text(const struct command *command, json_t *statistics, char **out_text) STATUS_MUST_CHECK;
enum status report_write(const struct command *command, json_t *statistics, const char *path) STATUS_MUST_CHECK;

/* Now, as pictures have it. */
enum { REPORT_DATE_SIZE = 32 };
void report_date(char out[REPORT_DATE_SIZE]);

/* The metadata of the picture, in `out`; texts live in *out. */
struct report_metadata {
  struct image_attribute attribute[16];
  size_t count;
  char size[64], crop[96], samples[32], tolerance[32], seconds[32], date[REPORT_DATE_SIZE];
  char solver[METHOD_TEXT_SIZE];
};
void report_metadata_fill(const struct report *report, struct report_metadata *out);

#endif

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
  struct intersect_counts counts;
  struct seconds parse, build, render, write;
};

/* A few lines on stderr. */
void report_print(const struct report *report);

/* Writes the statistics (output.h). */
enum status report_write(const struct command *command, const struct report *report,
                         const char *path) STATUS_MUST_CHECK;

/* Writes statistics made elsewhere the same way. Takes root over; NULL means that memory was short. */
enum status report_write_json(const struct command *command, json_t *root, const char *path) STATUS_MUST_CHECK;

/* The metadata of the picture, in `out`; texts live in *out. */
struct report_metadata {
  struct image_attribute attribute[16];
  size_t count;
  char size[64], crop[96], samples[32], tolerance[32], seconds[32], date[32];
  char solver[METHOD_TEXT_SIZE];
};
void report_metadata_fill(const struct report *report, struct report_metadata *out);

#endif

/* Speed against accuracy: solvers and peers on the camera and shadow rays of a scene. */
#ifndef PSCN_CHART_CHART_H
#define PSCN_CHART_CHART_H

#include <stdbool.h>
#include <stddef.h>

#include "base/listener.h"
#include "base/text_buffer.h"
#include "page/povray.h"
#include "scene/scene.h"

struct chart_request {
  const char *path;         /* of the scene */
  const char *folder;       /* receives the results; exists */
  const char *command_line; /* shown on the page */
  size_t width, height;     /* pixels of the picture that the rays belong to */
  size_t rays, rounds;      /* about how many camera rays; how often each is measured. 0: the usual number, with or
                               without `quick` */
  struct povray povray;     /* without the listener and the size */
  bool quick, peers;        /* fewer points; with Embree and POV-Ray */
  struct method *solvers;   /* instead of the usual points: these, besides the default; solver_count of them */
  size_t solver_count;
};

/* The names of the files that chart_scene writes, or removes if it has none. */
enum { CHART_FILES = 3 };
extern const char *const chart_files[CHART_FILES];

/* Measures, judges, and writes chart.csv, chart.svg and chart.html: all of them, or none if something fails or the
 * listener stops it. `scene` gets the default solver, and the steps of its patches are changed. *out_text, to be freed
 * in any case, receives the front as a table. A peer that is missing or fails is reported, and is no error. */
enum status chart_scene(const struct chart_request *request, struct scene *scene, const struct listener *listener,
                        struct text_buffer *out_text) STATUS_MUST_CHECK;

#endif

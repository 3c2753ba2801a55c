/* Renders a picture of a scene by several threads. */
#ifndef PSCN_RENDER_RENDER_H
#define PSCN_RENDER_RENDER_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/status.h"
#include "intersect/intersect.h"
#include "render/channels.h"
#include "render/tile.h"
#include "scene/scene.h"

struct render_options {
  size_t width, height;  /* pixels, >= 1 */
  size_t samples;        /* N >= 1: N x N rays per pixel */
  struct rectangle crop; /* the pixels of `out`; inside the picture, not empty */
  size_t threads;        /* >= 1 */
  /* The tiles that are not done are rendered; the pixels of the others stay unchanged. NULL: all. */
  const struct tile_list *tiles;
  struct channel_list channels;
};

struct render_progress {
  size_t pixels, pixels_total; /* done, and in total, of the tiles that were not done before */
  uint64_t rays;               /* primary and shadow rays so far */
  double seconds;              /* wall time since render_scene was called */
};

/* How the caller observes and stops the rendering. progress is called about ten times a second, on the thread that
 * called render_scene; NULL: never. The rendering ends early when *stop or *failed turns nonzero, set by a signal
 * handler or another thread; NULL: never. */
struct render_watch {
  void (*progress)(void *context, const struct render_progress *progress);
  void *context;
  const atomic_int *stop, *failed;
};

struct render_stats {
  struct intersect_counts counts; /* rays[0] primary rays, rays[1] shadow rays */
  size_t threads;                 /* that took part */
  bool seen, lit;                 /* some ray has hit a patch, and one where it is not black */
};

/* Renders into out[crop.height][crop.width][channels.width]. The same options give the same values, bit for bit, for
 * any number of threads and in every crop. `intersector` is the scene's. Returns STATUS_LIMIT if memory or threads are
 * short, STATUS_INTERRUPTED if stopped; then `out` has the tiles that are done. */
enum status render_scene(const struct scene *scene, const struct intersector *intersector,
                         const struct render_options *options, const struct render_watch *watch, float *out,
                         struct render_stats *out_stats) STATUS_MUST_CHECK;

/* The number of processors that this process may use, at least 1: those of its affinity mask, which containers and
 * taskset(1) restrict. */
size_t render_processors(void);

#endif

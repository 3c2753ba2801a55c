/* A picture of a scene, by threads. */
#ifndef PSCN_RENDER_RENDER_H
#define PSCN_RENDER_RENDER_H

#include <stdatomic.h>
#include <stddef.h>
#include <stdint.h>

#include "base/status.h"
#include "intersect/intersect.h"
#include "render/channels.h"
#include "render/tile.h"
#include "render/tile_list.h"
#include "scene/scene.h"

struct render_options {
  size_t width, height;  /* pixels, >= 1 */
  size_t samples;        /* N >= 1: N x N rays a pixel */
  struct rectangle crop; /* the pixels of `out`; inside the picture, not empty */
  size_t threads;        /* >= 1 */
  /* What is rendered of it: the tiles that are not done; the others' pixels stay as they are. NULL: all. */
  const struct tile_list *tiles;
  struct channel_list channels;
};

struct render_progress {
  size_t pixels, pixels_total; /* done, and to do, of all tiles that were not done before */
  uint64_t rays;               /* primary and shadow rays so far */
  double seconds;              /* of the clock since render_scene was called */
};

/* How the caller watches. progress is called on the thread that called render_scene, about ten times a second; NULL for
 * none. When *stop or *failed turns nonzero (a signal handler or another thread may set it) the rendering ends early;
 * NULL for never. */
struct render_watch {
  void (*progress)(void *context, const struct render_progress *progress);
  void *context;
  const atomic_int *stop, *failed;
};

struct render_stats {
  struct intersect_counts counts; /* rays[0] primary rays, rays[1] shadow rays */
  size_t threads;                 /* that took part */
};

/* Renders into out[crop.height][crop.width][channels.width]. The same options give the same values, bit for bit, for
 * any number of threads and in every crop. STATUS_LIMIT where memory or threads are short, STATUS_INTERRUPTED where
 * stopped; then `out` has the tiles that are done. `intersector` is the scene's. */
enum status render_scene(const struct scene *scene, const struct intersector *intersector,
                         const struct render_options *options, const struct render_watch *watch, float *out,
                         struct render_stats *out_stats) STATUS_MUST_CHECK;

/* How many processors this process may use, at least 1. */
size_t render_processors(void);

#endif

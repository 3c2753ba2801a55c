/* The channels of a picture: colour, and numbers of the hit that each pixel stands for. */
#ifndef PSCN_RENDER_CHANNELS_H
#define PSCN_RENDER_CHANNELS_H

#include <stdbool.h>
#include <stddef.h>

enum channel_kind {
  CHANNEL_RGB,      /* linear colour, the mean of the pixel's samples */
  CHANNEL_COVERAGE, /* share of the pixel's samples that hit a patch, 0 to 1 */
  /* From here on, numbers of one sample: the middle one, (N/2, N/2) of N x N, which is the pixel's centre if N is
   * odd. */
  CHANNEL_DEPTH, /* distance from the camera in scene units; infinite on a miss */
  CHANNEL_U,     /* parameters of the whole patch; 0 on a miss */
  CHANNEL_V,
  CHANNEL_PATCH,  /* the patch's number, from 0; -1 on a miss */
  CHANNEL_NORMAL, /* unit normal facing the camera; 0 on a miss */
  CHANNEL_STATUS, /* enum channel_status */
  /* The work of the scene's solver for the sample, over all leaves that its ray came to (render/measure.h). */
  CHANNEL_ITERATIONS, /* of all roots */
  CHANNEL_ROOTS,      /* how many roots it found */
  CHANNEL_RESIDUAL,   /* eq 11's ratio |P|/delta of the root that is the hit; 0 on a miss */
  CHANNEL_DEVIATION,  /* |T - T'|/T', T' by the default solver, certified; 0 if both miss, infinite if one does */
  CHANNEL_KINDS
};

/* The values of CHANNEL_STATUS. */
enum channel_status {
  CHANNEL_MISS_CERTAIN = 0,
  CHANNEL_HIT_CERTAIN = 1,
  CHANNEL_MISS_GRAZING = 2,
  CHANNEL_HIT_GRAZING = 3
};

struct channel_traits {
  const char *name;           /* as in --channels */
  const char *summary;        /* one line for `pscn help channels` */
  size_t width;               /* values per pixel */
  const char *value_names[3]; /* their names in the file */
  bool data;                  /* numbers, not light */
};

const struct channel_traits *channel_traits(enum channel_kind kind);

/* Channels of a picture, in order, each at most once. */
struct channel_list {
  size_t count, width; /* width: values per pixel, of all channels */
  enum channel_kind kind[CHANNEL_KINDS];
};

/* Whether any channel of the list is about the solver's work, and whether the list has this channel. */
bool channel_list_measures(const struct channel_list *list);
bool channel_list_has(const struct channel_list *list, enum channel_kind kind);

/* Whether the list is rgb alone, all that a PNG holds. */
bool channel_list_is_rgb(const struct channel_list *list);

/* Reads names separated by commas. On false, *out_bad .. + *out_bad_length is the name (possibly empty) that is unknown
 * or appears twice, and *out is unchanged. */
bool channel_list_parse(const char *text, struct channel_list *out, const char **out_bad, size_t *out_bad_length);

#endif

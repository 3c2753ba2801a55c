/* The difference of two pictures in numbers, by the definitions of OpenImageIO's idiff.
 *
 * Errors are absolute differences of values as stored (integers scaled to [0,1]). A pixel is over a limit if one of its
 * values differs by more than the limit. Two values that are both NaN, or the same infinity, are equal; any other pair
 * that is not finite differs by infinity.
 */
#ifndef PSCN_IMAGE_COMPARE_H
#define PSCN_IMAGE_COMPARE_H

#include <stdbool.h>
#include <stddef.h>

#include "image/image.h"

/* The pictures, of the same size, and their channels: channel first_channel[k] of `first` is compared with channel
 * second_channel[k] of `second`. Borrowed. */
struct compare_pair {
  const struct image *first, *second;
  size_t channel_count;
  const size_t *first_channel, *second_channel;
};

/* One level of limits. It is passed if more pixels than allowed are over `each`, or if one value differs by more than
 * `any`. */
struct compare_limit {
  double each;           /* >= 0 */
  double percent;        /* percentage of pixels that may be over `each` */
  double allowed_pixels; /* the same as a number; the larger of both counts */
  double any;            /* INFINITY: no such limit */
};

struct compare_result {
  size_t pixels;
  double mean, rms; /* over all values */
  double psnr;      /* 20 log10(peak / rms) dB, peak the largest value of both, at least 1; INFINITY if equal */
  double max;
  size_t worst_x, worst_y, worst_channel; /* where max is; worst_channel is an index in the pair; 0 if equal */
  float worst_first, worst_second;
};

/* Compares the pair. If `out_difference` is not NULL, it is a picture of the pair's size and channel count, and
 * receives the absolute differences times `scale`. */
void compare_images(const struct compare_pair *pair, struct compare_result *out, struct image *out_difference,
                    double scale);

/* The number of pixels that are over a limit. */
size_t compare_count_over(const struct compare_pair *pair, double limit);

/* Whether the limit is passed, given the pixels that are over `limit->each`. */
bool compare_limit_passed(const struct compare_limit *limit, const struct compare_result *result, size_t over);

#endif

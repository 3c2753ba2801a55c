/* The difference of two pictures in numbers. */
#include "image/compare.h"

#include <math.h>

static double difference(float first, float second)
{
  if (isfinite(first) && isfinite(second)) return fabs((double)first - (double)second);
  return first == second || (isnan(first) && isnan(second)) ? 0 : INFINITY;
}

void compare_images(const struct compare_pair *pair, struct compare_result *out, struct image *out_difference,
                    double scale)
{
  const struct image *first = pair->first, *second = pair->second;
  *out = (struct compare_result){.pixels = first->width * first->height};
  double sum = 0, square_sum = 0, peak = 1;
  for (size_t y = 0; y < first->height; y++) {
    double row_sum = 0, row_square_sum = 0; /* a sum per row keeps rounding errors small on large pictures */
    for (size_t x = 0; x < first->width; x++) {
      const float *a = image_pixel(first, x, y), *b = image_pixel(second, x, y);
      for (size_t k = 0; k < pair->channel_count; k++) {
        const float p = a[pair->first_channel[k]], q = b[pair->second_channel[k]];
        const double error = difference(p, q);
        row_sum += error;
        row_square_sum += error * error;
        peak = isfinite(p) && (double)p > peak ? (double)p : peak;
        peak = isfinite(q) && (double)q > peak ? (double)q : peak;
        if (error > out->max) {
          out->max = error;
          out->worst_x = x;
          out->worst_y = y;
          out->worst_channel = k;
          out->worst_first = p;
          out->worst_second = q;
        }
        if (out_difference != NULL) image_pixel(out_difference, x, y)[k] = (float)(error * scale);
      }
    }
    sum += row_sum;
    square_sum += row_square_sum;
  }
  const double values = (double)out->pixels * (double)pair->channel_count;
  out->mean = sum / values;
  out->rms = sqrt(square_sum / values);
  out->psnr = out->rms == 0 ? INFINITY : 20 * log10(peak / out->rms);
}

size_t compare_count_over(const struct compare_pair *pair, double limit)
{
  const struct image *first = pair->first, *second = pair->second;
  size_t over = 0;
  for (size_t y = 0; y < first->height; y++) {
    for (size_t x = 0; x < first->width; x++) {
      const float *a = image_pixel(first, x, y), *b = image_pixel(second, x, y);
      size_t k = 0;
      while (k < pair->channel_count && !(difference(a[pair->first_channel[k]], b[pair->second_channel[k]]) > limit))
        k++;
      over += k < pair->channel_count;
    }
  }
  return over;
}

bool compare_limit_passed(const struct compare_limit *limit, const struct compare_result *result, size_t over)
{
  const double by_percent = limit->percent / 100 * (double)result->pixels;
  const double allowed = by_percent > limit->allowed_pixels ? by_percent : limit->allowed_pixels;
  return (double)over > allowed || result->max > limit->any;
}

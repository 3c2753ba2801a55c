/* The difference of two pictures in numbers. */
#include "image/compare.h"

#include <math.h>

#include "cmocka_test.h"

/* Two pictures of 2 x 2 pixels and two channels; the second has its channels in the other order. */
static const size_t FIRST[] = {0, 1}, SECOND[] = {1, 0};

static struct image images[2];

static int make_images(void **state)
{
  (void)state;
  return image_create(2, 2, 2, &images[0]) != STATUS_OK || image_create(2, 2, 2, &images[1]) != STATUS_OK;
}

static int destroy_images(void **state)
{
  (void)state;
  image_destroy(&images[0]), image_destroy(&images[1]);
  return 0;
}

#define WITH_IMAGES(test) TEST_WITH(test, make_images, destroy_images)

static const struct compare_pair pair = {&images[0], &images[1], 2, FIRST, SECOND};

WITH_IMAGES(equal_pictures)
{
  struct compare_result result;
  compare_images(&pair, &result, NULL, 1);
  assert_int_equal(result.pixels, 4);
  assert_true(result.mean == 0 && result.rms == 0 && result.max == 0 && isinf(result.psnr));
  assert_int_equal(compare_count_over(&pair, 0), 0);
}

WITH_IMAGES(numbers_by_definition)
{
  image_pixel(pair.first, 1, 0)[0] = 0.5f;   /* differs by 0.5 */
  image_pixel(pair.second, 1, 0)[0] = 0.25f; /* channel 1 of the first differs by 0.25, in the same pixel */
  image_pixel(pair.first, 0, 1)[1] = 2;      /* the peak, equal in both */
  image_pixel(pair.second, 0, 1)[0] = 2;
  struct image difference;
  assert_int_equal(image_create(2, 2, 2, &difference), STATUS_OK);
  struct compare_result result;
  compare_images(&pair, &result, &difference, 3);
  assert_true(result.mean == 0.75 / 8);
  assert_true(fabs(result.rms - sqrt(0.3125 / 8)) < 1e-15);
  assert_true(fabs(result.psnr - 20 * log10(2 / result.rms)) < 1e-12);
  assert_true(result.max == 0.5);
  assert_int_equal(result.worst_x, 1);
  assert_int_equal(result.worst_y, 0);
  assert_int_equal(result.worst_channel, 0);
  assert_true(result.worst_first == 0.5f && result.worst_second == 0);
  assert_true(image_pixel(&difference, 1, 0)[0] == 1.5f && image_pixel(&difference, 1, 0)[1] == 0.75f);
  assert_true(image_pixel(&difference, 0, 1)[1] == 0);
  assert_int_equal(compare_count_over(&pair, 0.25), 1);
  assert_int_equal(compare_count_over(&pair, 0.5), 0); /* over, not equal */
  image_destroy(&difference);
}

/* Of equal differences the first one is reported, row by row. */
WITH_IMAGES(the_first_worst_is_told)
{
  struct compare_result result;
  image_pixel(pair.first, 1, 0)[0] = image_pixel(pair.first, 1, 0)[1] = image_pixel(pair.first, 0, 1)[0] = 0.5f;
  compare_images(&pair, &result, NULL, 1);
  assert_true(result.worst_x == 1 && result.worst_y == 0 && result.worst_channel == 0);
  image_pixel(pair.first, 0, 1)[1] = 1;
  compare_images(&pair, &result, NULL, 1);
  assert_true(result.worst_x == 0 && result.worst_y == 1 && result.worst_channel == 1);
}

/* The peak is the largest value of either picture. */
WITH_IMAGES(peak_of_both)
{
  const struct image *const both[] = {pair.first, pair.second};
  for (int k = 0; k < 2; k++) {
    struct compare_result result;
    image_pixel(both[k], 1, 1)[0] = 4;
    compare_images(&pair, &result, NULL, 1);
    assert_true(result.max == 4 && fabs(result.psnr - 20 * log10(4 / result.rms)) < 1e-12);
    image_pixel(both[k], 1, 1)[0] = 0;
  }
}

WITH_IMAGES(values_that_are_not_finite)
{
  image_pixel(pair.first, 0, 0)[0] = INFINITY;
  image_pixel(pair.second, 0, 0)[1] = INFINITY;
  image_pixel(pair.first, 1, 1)[0] = NAN;
  image_pixel(pair.second, 1, 1)[1] = NAN;
  assert_int_equal(compare_count_over(&pair, 0), 0);
  struct compare_result result;
  image_pixel(pair.first, 1, 0)[0] = 0.5f;
  compare_images(&pair, &result, NULL, 1);
  assert_true(fabs(result.psnr - 20 * log10(1 / result.rms)) < 1e-12); /* infinity does not count as a peak */
  image_pixel(pair.first, 1, 0)[0] = 0;
  image_pixel(pair.second, 0, 0)[1] = -INFINITY;
  image_pixel(pair.second, 1, 1)[1] = 0;
  assert_int_equal(compare_count_over(&pair, 1e30), 2);
  compare_images(&pair, &result, NULL, 1);
  assert_true(isinf(result.max));
}

TEST(limits)
{
  const struct compare_result result = {.pixels = 200, .max = 0.3};
  const struct compare_limit none = {.any = INFINITY};
  assert_false(compare_limit_passed(&none, &result, 0));
  assert_true(compare_limit_passed(&none, &result, 1));
  const struct compare_limit percent = {.percent = 1, .any = INFINITY};
  assert_false(compare_limit_passed(&percent, &result, 2));
  assert_true(compare_limit_passed(&percent, &result, 3));
  const struct compare_limit both = {.percent = 1, .allowed_pixels = 5, .any = INFINITY};
  assert_false(compare_limit_passed(&both, &result, 5));
  assert_true(compare_limit_passed(&both, &result, 6));
  const struct compare_limit any = {.percent = 100, .any = 0.25};
  assert_true(compare_limit_passed(&any, &result, 0));
  const struct compare_limit same = {.any = 0.3};
  assert_false(compare_limit_passed(&same, &result, 0));
}

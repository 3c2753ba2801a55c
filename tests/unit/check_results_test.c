/* Each number and picture that check writes is in its place; the numbers of the check are all different. */
#include <math.h>
#include <string.h>

#include "check/measure.h"
#include "page/page.h"
#include "cmocka_test.h"
#include "unit/drawn.h"
#include "unit/expect_json.h"

enum { WIDTH = 12, HEIGHT = 2, ROWS = 2, MOST_PICTURES = 20 };

/* What was written: the numbers, the page, and of each picture the red of the first pixel. */
static json_t *numbers;
static char page[1 << 16];
static float picture[MOST_PICTURES];
static size_t pictures;

enum status __wrap_page_write(const struct listener *listener, const char *folder, size_t count,
                              const char *const names[], const struct text_buffer pages[]);
enum status __wrap_page_write(const struct listener *listener, const char *folder, size_t count,
                              const char *const names[], const struct text_buffer pages[])
{
  (void)listener, (void)folder;
  for (size_t k = 0; k < count; k++) {
    assert_false(pages[k].failed);
    if (strstr(names[k], "html")) snprintf(page, sizeof page, "%s", pages[k].text);
    if (strstr(names[k], "json")) numbers = json_loadb(pages[k].text, pages[k].length, 0, NULL);
  }
  return STATUS_OK;
}

void __wrap_page_png(const struct image *image, struct text_buffer *out);
void __wrap_page_png(const struct image *image, struct text_buffer *out)
{
  *out = (struct text_buffer){0};
  assert_true(pictures < MOST_PICTURES);
  text_buffer_format(out, "%zu", pictures); /* in place of its bytes */
  picture[pictures++] = image->value[0];
}

static struct check_row row_of(size_t steps, size_t number, float value)
{
  struct check_row row = {.steps = steps,
                          .picture.time = {1.5, 2.5},
                          .result = {.pixels = WIDTH * HEIGHT, .mean = 0.25, .rms = 0.5, .psnr = INFINITY, .max = 0.2},
                          .mask_ours = number + 10,
                          .mask_theirs = number + 11,
                          .distances = {number + 20, number + 21, number + 22, number + 23, 0.125, 0.375, NAN}};
  for (size_t k = 0; k < CHECK_CODES; k++) row.over[k] = number + k;
  row.over_limit = number + 5;
  for (size_t k = 0; k < CHECK_EDGES; k++) row.over_limit_on[k] = number + 6 + k;
  row.result.worst_x = number + 4, row.result.worst_y = 1;
  assert_int_equal(image_create(WIDTH, HEIGHT, 3, &row.picture.image), STATUS_OK);
  for (size_t k = 0; k < 3 * WIDTH * HEIGHT; k++) row.picture.image.value[k] = value;
  return row;
}

static void add_row(struct check *check, struct check_row row)
{
  check->row[check->row_count++] = row;
  assert_int_equal(check_make_pictures(check), STATUS_OK);
}

static void free_check(struct check *check)
{
  image_destroy(&check->row[check->row_count - 1].picture.image);
  for (size_t k = 0; k < CHECK_FILES; k++) text_buffer_free(&check->file[k]);
  image_destroy(&check->ours.picture);
}

TEST(everything_is_in_its_place)
{
  static struct check_pixel pixels[WIDTH * HEIGHT];
  const struct check_request request = {.path = "scene",
                                        .folder = "out",
                                        .command_line = "",
                                        .width = WIDTH,
                                        .height = HEIGHT,
                                        .grid = 8,
                                        .fail = {0.5, 100, 3, INFINITY},
                                        .fail_psnr = 40,
                                        .fail_mask = 200};
  struct check check = {.request = &request, .ours = {.pixel = pixels, .time = {3.5, 4.5}}};
  struct text_buffer table = {0};
  assert_int_equal(image_create(WIDTH, HEIGHT, 3, &check.ours.picture), STATUS_OK);
  image_pixel(&check.ours.picture, 2, 1)[0] = image_pixel(&check.ours.picture, 2, 1)[2] = 1;
  add_row(&check, row_of(0, 30, 0.5f));
  image_destroy(&check.row[0].picture.image); /* as the next row does */
  add_row(&check, row_of(3, 1, 0.75f));
  check.row[1].over[1] = check.row[1].over[2] = 0;
  assert_int_equal(check_write(&check, "verdict", &table), STATUS_OK);

  expect_json(
    json_array_get(json_object_get(numbers, "rows"), 1),
    "{\"distances\":{\"both\":22,\"max\":null,\"median\":0.125,\"only_here\":23,\"only_there\":24,"
    "\"percent_99\":0.375,\"rays\":21},\"mask\":{\"only_here\":11,\"only_there\":12},\"max\":0.2,\"mean\":0.25,"
    "\"name\":\"u_steps 3\",\"over\":{\"1/255\":1,\"16/255\":0,\"4/255\":0,\"limit\":6},"
    "\"over_limit_off_edges\":7,\"over_limit_on\":{\"crease\":8,\"shadow\":9,\"silhouette\":10},\"psnr\":null,"
    "\"rms\":0.5,\"time\":{\"cpu\":2.5,\"wall\":1.5},\"u_steps\":3,\"worst\":[5,1]}");
  const json_t *written = json_array_get(json_object_get(numbers, "rows"), 0);
  expect_json(json_object_get(written, "name"), "\"as written\"");
  expect_json(json_object_get(written, "over"), "{\"1/255\":30,\"16/255\":32,\"4/255\":31,\"limit\":35}");
  expect_json(json_object_get(numbers, "limits"),
              "{\"allowfailures\":3.0,\"fail\":0.5,\"failmask\":200.0,\"failpercent\":100.0,\"failpsnr\":40.0,"
              "\"hardfail\":null}");

  expect_json(json_object_get(numbers, "dumped"), "null");
  expect_json(json_object_get(numbers, "within_limits"), "true");
  expect_json(json_object_get(numbers, "time"), "{\"cpu\":4.5,\"wall\":3.5}");

  expect_json(json_object_get(drawn, "pixels"), "true");
  expect_json(json_object_get(drawn, "grid"), "8");
  expect_json(json_object_get(drawn, "limit"), "127.5");
  const json_t *last = json_array_get(json_object_get(drawn, "rows"), 1);
  expect_json(json_object_get(last, "percent"), "[{\"value\":4.16666666667},{\"value\":0.0},{\"value\":0.0}]");
  expect_json(json_object_get(last, "codes"), "51");
  expect_json(json_object_get(last, "last"), "true");
  expect_json(json_object_get(drawn, "last_name"), "\"u_steps 3\"");
  expect_json(json_object_get(drawn, "ours"), "\"data:image/png;base64,NA==\"");   /* of 4 */
  expect_json(json_object_get(drawn, "theirs"), "\"data:image/png;base64,Mg==\""); /* of 2 */
  expect_json(json_object_get(last, "difference"), "\"data:image/png;base64,Mw==\"");

  /* Two of each row, then ours. */
  static const float firsts[] = {0.5f, 8, 0.75f, 12, 0};
  assert_int_equal(pictures, sizeof firsts / sizeof *firsts);
  for (size_t k = 0; k < pictures; k++) assert_true(picture[k] == firsts[k]);
  text_buffer_free(&table);
  json_decref(numbers), json_decref(drawn);
  free_check(&check);
}

/* There is no figure without distances, or if none of POV-Ray's finer pictures has a differing pixel. */
TEST(what_is_not_there_is_left_out)
{
  static struct check_pixel pixels[WIDTH * HEIGHT];
  const struct check_request request = {
    .path = "scene", .folder = "out", .command_line = "", .width = WIDTH, .height = HEIGHT};
  struct check check = {.request = &request, .dumped = "no <file>", .ours = {.pixel = pixels}};
  struct text_buffer table = {0};
  assert_int_equal(image_create(WIDTH, HEIGHT, 3, &check.ours.picture), STATUS_OK);
  pictures = 0;
  add_row(&check, row_of(0, 30, 0.5f));
  drawn = NULL;
  assert_int_equal(check_write(&check, "verdict", &table), STATUS_OK);
  assert_null(drawn);
  expect_json(json_object_get(numbers, "dumped"), "\"no <file>\"");
  assert_non_null(strstr(page, "that text for the first row, too: no &lt;file&gt;."));
  expect_json(json_object_get(numbers, "within_limits"), "false");
  assert_null(strstr(page, "<h2>Hits"));
  assert_null(json_object_get(json_array_get(json_object_get(numbers, "rows"), 0), "distances"));
  text_buffer_free(&table);
  json_decref(numbers);
  free_check(&check);
}

/* Parts of a picture: what they say of their tiles is believed only where it can be. */
#include "command/piece.h"

#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cmocka_test.h"

/* 3 x 2 tiles, the last ones of a row or column not whole. */
enum { WIDTH = 70, HEIGHT = 45, TILES = 6 };

static const char path[] = "part.exr";

/* Writes a part that says so of itself, and reads what it says. */
static enum status read_part(const char *tile, const char *done, struct piece *out)
{
  const struct image_attribute said[] = {{"pscn:tile", tile}, {"pscn:channels", "rgb"}, {"pscn:done", done}};
  const struct image_encoding encoding = {
    .format = IMAGE_EXR, .bits = 32, .attributes = said, .attribute_count = sizeof said / sizeof *said};
  char message[IMAGE_MESSAGE_SIZE];
  struct image image;
  unsigned char *bytes;
  size_t size;
  assert_int_equal(image_create(WIDTH, HEIGHT, 3, &image), STATUS_OK);
  for (int c = 0; c < 3; c++) (void)snprintf(image.channel[c].name, IMAGE_NAME_SIZE, "%c", "RGB"[c]);
  memset(image.value, 0, sizeof(float) * WIDTH * HEIGHT * 3);
  image.full_width = WIDTH, image.full_height = HEIGHT;
  assert_int_equal(image_encode(&image, &encoding, &bytes, &size, message), STATUS_OK);
  FILE *file = fopen(path, "wb");
  assert_non_null(file);
  assert_int_equal(fwrite(bytes, 1, size, file), size);
  assert_int_equal(fclose(file), 0);
  free(bytes), image_destroy(&image);
  const enum status status = piece_read(path, false, out, message);
  assert_int_equal(remove(path), 0);
  return status;
}

static void a_part_tells_which_tiles_it_has(void **state)
{
  (void)state;
  static const struct {
    const char *text;
    unsigned done; /* bit k: tile k */
  } lists[] = {{"0", 1}, {"5", 32}, {"0-5", 63}, {"0,2-3,5", 45}, {"1,2", 6}, {"", 63} /* nothing is said: all */};
  for (size_t k = 0; k < sizeof lists / sizeof *lists; k++) {
    struct piece piece;
    assert_int_equal(read_part("1/1", lists[k].text, &piece), STATUS_OK);
    assert_int_equal(piece.tiles.count, TILES);
    for (size_t n = 0; n < TILES; n++) assert_int_equal(atomic_load(&piece.tiles.done[n]), lists[k].done >> n & 1);
    piece_destroy(&piece);
  }
}

static void what_cannot_be_is_no_part(void **state)
{
  (void)state;
  static const char *const lists[] = {"6",    "0-6", "3-9999999", "5-4",  "2,1", "2,2", "0-2,2",
                                      "1,",   ",1",  "1-",        "-1",   "1 ",  "one", "0,99999999999999999999",
                                      "0--1", "1;2", "0x1",       "1,,2", "+1",  "1.0"};
  static const char *const pieces[] = {"0/1", "2/1", "1/0", "1", "1/", "/1", "1/1 ", "1/1000001", "-1/2", "a/b"};
  struct piece piece;
  for (size_t k = 0; k < sizeof lists / sizeof *lists; k++) {
    if (read_part("1/1", lists[k], &piece) != STATUS_INPUT) fail_msg("tiles '%s' are believed", lists[k]);
    assert_true(piece.tiles.count == 0 && piece.image.width == 0);
  }
  for (size_t k = 0; k < sizeof pieces / sizeof *pieces; k++)
    if (read_part(pieces[k], "0", &piece) != STATUS_INPUT) fail_msg("piece '%s' is believed", pieces[k]);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(a_part_tells_which_tiles_it_has),
                                     cmocka_unit_test(what_cannot_be_is_no_part)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}

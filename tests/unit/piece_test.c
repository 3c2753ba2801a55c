/* Parts of a picture: their claims about their tiles are believed only where they can be true. */
#include "command/piece.h"

#include <inttypes.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cmocka_test.h"
#include "files.h"

/* 3 x 2 tiles; the last of a row or column are cut off. */
enum { WIDTH = 70, HEIGHT = 45, TILES = 6 };

static const char path[] = "part.exr";

static void write_file(unsigned char *bytes, size_t size)
{
  put_bytes(path, bytes, size);
  free(bytes);
}

/* Writes a part with these claims, which also claims to be all of its picture. That is true if x = 0 and the picture's
 * width is WIDTH. Reads its claims, or all of it. */
static enum status read_part_at(size_t x, size_t width, bool pixels, const char *tile, const char *done,
                                struct piece *out)
{
  const struct image_encoding encoding = {.format = IMAGE_EXR, .bits = 32};
  char message[IMAGE_MESSAGE_SIZE];
  struct image image;
  unsigned char *bytes;
  size_t size;
  assert_int_equal(image_create(WIDTH, HEIGHT, 3, &image), STATUS_OK);
  for (int c = 0; c < 3; c++) (void)snprintf(image.channel[c].name, IMAGE_NAME_SIZE, "%c", "RGB"[c]);
  memset(image.value, 0, sizeof(float) * WIDTH * HEIGHT * 3);
  image.x = x, image.full_width = width, image.full_height = HEIGHT;
  assert_true(image_add_text(&image, "pscn:size", "70x45") && image_add_text(&image, "pscn:crop", "0,0,70,45") &&
              image_add_text(&image, "pscn:tile", "%s", tile) && image_add_text(&image, "pscn:channels", "rgb") &&
              image_add_text(&image, "pscn:done", "%s", done));
  assert_int_equal(image_encode(&image, &encoding, &bytes, &size, message), STATUS_OK);
  write_file(bytes, size);
  image_destroy(&image);
  const enum status status = piece_read(path, pixels, out, message);
  assert_int_equal(remove(path), 0);
  return status;
}

static enum status read_part(const char *tile, const char *done, struct piece *out)
{
  return read_part_at(0, WIDTH, false, tile, done, out);
}

TEST(a_part_tells_which_tiles_it_has)
{
  static const char rows[] = "083700";
  struct piece piece;
  assert_int_equal(read_part("1/1", rows, &piece), STATUS_OK);
  assert_int_equal(piece.tiles.count, TILES);
  for (size_t n = 0; n < TILES; n++) assert_int_equal(atomic_load(&piece.tiles.rows[n]), rows[n] - '0');
  piece_destroy(&piece);
}

TEST(what_cannot_be_is_no_part)
{
  static const char none[] = "000000";
  static const char *const lists[] = {"", "00000", "0000000", "00000 ", "000009", "00000/", "-00000"};
  static const char *const pieces[] = {"", "0/1", "2/1", "1/0", "1", "1/", "/1", "1/1 ", "1/1000001", "-1/2", "a/b"};
  struct piece piece;
  for (size_t k = 0; k < sizeof lists / sizeof *lists; k++) {
    if (read_part("1/1", lists[k], &piece) != STATUS_INPUT) fail_msg("tiles '%s' are believed", lists[k]);
    assert_true(piece.tiles.count == 0 && piece.image.width == 0);
  }
  for (size_t k = 0; k < sizeof pieces / sizeof *pieces; k++)
    if (read_part(pieces[k], none, &piece) != STATUS_INPUT) fail_msg("piece '%s' is believed", pieces[k]);
  assert_int_equal(read_part_at(1, WIDTH, false, "1/1", none, &piece), STATUS_INPUT); /* it lies outside its picture */
  assert_int_equal(read_part_at(0, WIDTH, true, "1/1", none, &piece), STATUS_INPUT);  /* it has no sum */
  /* Its windows contradict its claims. */
  assert_int_equal(read_part_at(0, WIDTH + 1, false, "1/1", none, &piece), STATUS_INPUT);
  assert_int_equal(read_part_at(1, WIDTH + 1, false, "1/1", none, &piece), STATUS_INPUT);
}

/* Parts belong together if they have certain texts in common. A message names the one that differs. */
TEST(parts_of_one_picture_belong_together)
{
  static const struct {
    const char *name, *what;
  } common[] = {{"pscn:size", "size"},         {"pscn:crop", "crop"},
                {"pscn:samples", "samples"},   {"pscn:channels", "channels"},
                {"pscn:text", "scene's text"}, {"pscn:options", "options"},
                {"pscn:version", "version"},   {"pscn:arithmetic", "arithmetic"}};
  enum { COMMON = sizeof common / sizeof *common };
  char message[IMAGE_MESSAGE_SIZE], expected[64];
  for (size_t k = 0; k <= COMMON; k++) { /* the last time, only the scene's file has another name */
    struct image one = {0}, two = {0};
    assert_true(image_add_text(&one, "pscn:scene", "one") && image_add_text(&two, "pscn:scene", "two"));
    for (size_t n = 0; n < COMMON; n++)
      assert_true(image_add_text(&one, common[n].name, "%zu", n) &&
                  image_add_text(&two, common[n].name, n == k ? "%zux" : "%zu", n));
    assert_int_equal(piece_belongs(&one, &two, message, sizeof message), k == COMMON);
    if (k < COMMON) {
      (void)snprintf(expected, sizeof expected, "its %s: '%zu', not '%zux'", common[k].what, k, k);
      assert_string_equal(message, expected);
    }
    image_destroy(&one), image_destroy(&two);
  }
}

/* The tiles that are done are copied and written, and no others; none if a channel is missing. */
TEST(what_is_done_is_copied)
{
  const struct render_options options = {.width = WIDTH,
                                         .height = HEIGHT,
                                         .crop = {0, 0, WIDTH, HEIGHT},
                                         .channels = {.count = 1, .width = 3, .kind = {CHANNEL_RGB}}};
  struct piece from, to;
  assert_int_equal(piece_create(&options, 1, 1, &from), STATUS_OK);
  assert_int_equal(piece_create(&options, 1, 1, &to), STATUS_OK);
  for (size_t k = 0; k < WIDTH * HEIGHT * 3; k++) from.image.value[k] = (float)(k + 1);
  memset(to.image.value, 0, sizeof(float) * WIDTH * HEIGHT * 3);
  atomic_store(&from.tiles.rows[1], TILE_ROWS);
  assert_true(piece_copy(&from, &to.image));
  const struct rectangle *tile = &from.tiles.tile[1];
  for (size_t y = 0; y < HEIGHT; y++) {
    for (size_t x = 0; x < WIDTH; x++) {
      const size_t k = 3 * (y * WIDTH + x);
      const bool in = x - tile->x < tile->width && y - tile->y < tile->height;
      for (size_t c = 0; c < 3; c++) assert_true(to.image.value[k + c] == (in ? from.image.value[k + c] : 0));
    }
  }
  from.image.channel[2].name[0] = 'Z';
  assert_false(piece_copy(&from, &to.image));
  from.image.channel[2].name[0] = 'B';
  unsigned char *bytes;
  size_t size;
  char message[IMAGE_MESSAGE_SIZE];
  assert_true(image_add_text(&from.image, "pscn:size", "70x45") &&
              image_add_text(&from.image, "pscn:crop", "0,0,70,45") &&
              image_add_text(&from.image, "pscn:channels", "rgb"));
  assert_int_equal(piece_encode(&from, &bytes, &size, message), STATUS_OK);
  piece_destroy(&from);
  write_file(bytes, size);
  assert_int_equal(piece_read(path, true, &from, message), STATUS_OK);
  assert_int_equal(remove(path), 0);
  assert_string_equal(image_text(&from.image, "pscn:done"), "080000");
  for (size_t k = 0; k < TILES; k++) assert_int_equal(atomic_load(&from.tiles.rows[k]), k == 1 ? TILE_ROWS : 0);
  assert_memory_equal(from.image.value, to.image.value, sizeof(float) * WIDTH * HEIGHT * 3);
  piece_destroy(&from), piece_destroy(&to);
}

/* Data are kept as floats, whatever the bits of colours are. */
TEST(channels_are_colours_or_data)
{
  static const char *const names[] = {"R", "G", "B", "depth", "normal.x", "normal.y", "normal.z"};
  const struct render_options options = {
    .width = WIDTH,
    .height = HEIGHT,
    .crop = {0, 0, WIDTH, HEIGHT},
    .channels = {.count = 3, .width = 7, .kind = {CHANNEL_RGB, CHANNEL_DEPTH, CHANNEL_NORMAL}}};
  struct piece piece;
  assert_int_equal(piece_create(&options, 1, 1, &piece), STATUS_OK);
  for (size_t c = 0; c < 7; c++) {
    assert_string_equal(piece.image.channel[c].name, names[c]);
    assert_int_equal(piece.image.channel[c].data, c >= 3);
  }
  piece_destroy(&piece);
}

static uint64_t hash(uint64_t start, const void *bytes, size_t count, size_t size)
{
  for (size_t k = 0; k < count; k++) {
    uint32_t word = 0;
    memcpy(&word, (const unsigned char *)bytes + k * size, size);
    start = (start ^ word) * UINT64_C(0x100000001b3);
  }
  return start;
}

static uint64_t fold(uint64_t sum) { return sum ^ sum >> 32; }

/* The sum covers the pixels of what is done, tile by tile, and no others, one channel after the other. */
TEST(the_sum_is_of_what_is_done)
{
  static const char *const done[] = {"888888", "080000", "000000", "873100"};
  const uint64_t start = UINT64_C(0xcbf29ce484222325);
  const struct render_options options = {.width = 100,
                                         .height = 80,
                                         .crop = {17, 20, WIDTH, HEIGHT},
                                         .channels = {.count = 1, .width = 3, .kind = {CHANNEL_RGB}}};
  char message[IMAGE_MESSAGE_SIZE], expected[32];
  for (size_t n = 0; n < sizeof done / sizeof *done; n++) {
    struct piece piece;
    struct image whole;
    unsigned char *bytes;
    size_t size;
    assert_int_equal(piece_create(&options, 1, 1, &piece), STATUS_OK);
    const size_t tiles = piece.tiles.count;
    for (size_t k = 0; k < WIDTH * HEIGHT * 3; k++) piece.image.value[k] = (float)(k + 1);
    for (size_t k = 0; k < tiles; k++)
      atomic_store(&piece.tiles.rows[k], k < 6 ? (unsigned char)(done[n][k] - '0') : 0);
    assert_int_equal(piece_encode(&piece, &bytes, &size, message), STATUS_OK);
    write_file(bytes, size);
    assert_int_equal(image_read(path, &whole, message), STATUS_OK);
    const char *text = image_text(&whole, "pscn:done");
    uint64_t sum = fold(hash(start, "1/1", 3, 1)) + 2 * fold(hash(start, text, strlen(text), 1));
    for (size_t c = 0; c < 3; c++) {
      uint64_t channel = fold(hash(start, whole.channel[c].name, 1, 1));
      for (size_t k = 0; k < tiles; k++) {
        const struct rectangle part = tile_top(&piece.tiles, k, atomic_load(&piece.tiles.rows[k]));
        for (size_t p = 0; p < part.width * part.height; p++)
          channel = hash(channel, image_pixel(&whole, part.x - 17 + p % part.width, part.y - 20 + p / part.width) + c,
                         1, sizeof(float));
      }
      sum += fold(channel);
    }
    (void)snprintf(expected, sizeof expected, "%016" PRIx64, sum);
    assert_string_equal(image_text(&whole, "pscn:sum"), expected);
    image_destroy(&whole), piece_destroy(&piece);
  }
  assert_int_equal(remove(path), 0);
}

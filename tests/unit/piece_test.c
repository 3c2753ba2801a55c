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
  const struct image_attribute said[] = {{"pscn:size", "70x45"},
                                         {"pscn:crop", "0,0,70,45"},
                                         {"pscn:tile", tile},
                                         {"pscn:channels", "rgb"},
                                         {"pscn:done", done}};
  const struct image_encoding encoding = {
    .format = IMAGE_EXR, .bits = 32, .attributes = said, .attribute_count = sizeof said / sizeof *said};
  char message[IMAGE_MESSAGE_SIZE];
  struct image image;
  unsigned char *bytes;
  size_t size;
  assert_int_equal(image_create(WIDTH, HEIGHT, 3, &image), STATUS_OK);
  for (int c = 0; c < 3; c++) (void)snprintf(image.channel[c].name, IMAGE_NAME_SIZE, "%c", "RGB"[c]);
  memset(image.value, 0, sizeof(float) * WIDTH * HEIGHT * 3);
  image.x = x, image.full_width = width, image.full_height = HEIGHT;
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
  static const struct {
    const char *text;
    unsigned done;        /* bit k: tile k */
    unsigned begun, rows; /* of that tile so many rows */
  } lists[] = {{"0", 1, 0, 0},   {"5", 32, 0, 0},      {"0-5", 63, 0, 0}, {"0,2-3,5", 45, 0, 0},
               {"1,2", 6, 0, 0}, {"1,2,0:3", 6, 0, 3}, {"4:7", 0, 4, 7},  {"", 0, 0, 0} /* which is not in the file */};
  for (size_t k = 0; k < sizeof lists / sizeof *lists; k++) {
    struct piece piece;
    assert_int_equal(read_part("1/1", lists[k].text, &piece), STATUS_OK);
    assert_int_equal(piece.tiles.count, TILES);
    for (size_t n = 0; n < TILES; n++) {
      const unsigned rows = atomic_load(&piece.tiles.rows[n]);
      assert_int_equal(rows, lists[k].done >> n & 1 ? TILE_ROWS : n == lists[k].begun ? lists[k].rows : 0);
    }
    piece_destroy(&piece);
  }
}

TEST(what_cannot_be_is_no_part)
{
  static const char *const lists[] = {
    "6",    "0-6", "3-9999999", "5-4",     "2,1",   "2,2",    "0-2,2",
    "1,",   ",1",  "1-",        "-1",      "1 ",    "one",    "0,99999999999999999999",
    "0--1", "1;2", "0x1",       "1,,2",    "+1",    "1.0",    "1:8",
    "1:",   "6:1", "1,1:2",     "2:1,1:2", "1:2,2", "1:1,1:2"};
  static const char *const pieces[] = {"0/1", "2/1", "1/0", "1", "1/", "/1", "1/1 ", "1/1000001", "-1/2", "a/b"};
  struct piece piece;
  for (size_t k = 0; k < sizeof lists / sizeof *lists; k++) {
    if (read_part("1/1", lists[k], &piece) != STATUS_INPUT) fail_msg("tiles '%s' are believed", lists[k]);
    assert_true(piece.tiles.count == 0 && piece.image.width == 0);
  }
  for (size_t k = 0; k < sizeof pieces / sizeof *pieces; k++)
    if (read_part(pieces[k], "0", &piece) != STATUS_INPUT) fail_msg("piece '%s' is believed", pieces[k]);
  assert_int_equal(read_part_at(1, WIDTH, false, "1/1", "0", &piece), STATUS_INPUT); /* it lies outside its picture */
  assert_int_equal(read_part_at(0, WIDTH, true, "1/1", "0", &piece), STATUS_INPUT);  /* it has no sum */
  /* Its windows contradict its claims. */
  assert_int_equal(read_part_at(0, WIDTH + 1, false, "1/1", "0", &piece), STATUS_INPUT);
  assert_int_equal(read_part_at(1, WIDTH + 1, false, "1/1", "0", &piece), STATUS_INPUT);
}

/* Parts belong together if they have certain texts in common. A message names the one that differs. */
TEST(parts_of_one_picture_belong_together)
{
  static char texts[] = "pscn:size=9x9\npscn:crop=0,0,7,5\npscn:samples=1\npscn:channels=rgb\npscn:text=a\n"
                        "pscn:options= --solver 'a b'\npscn:version=2\npscn:arithmetic=avx2\npscn:scene=one.pscn\n";
  static const struct {
    const char *from, *what;
  } changes[] = {{"9x9", "size"},          {"0,0", "crop"},   {"=1", "samples"}, {"rgb", "channels"},
                 {"=a\n", "scene's text"}, {"b'", "options"}, {"=2", "version"}, {"avx2", "arithmetic"}};
  const struct image picture = {.metadata = texts};
  struct image part = picture;
  char message[IMAGE_MESSAGE_SIZE], expected[64], changed[sizeof texts];
  assert_int_equal(piece_compare(&part, &picture, message, sizeof message), 0);
  part.metadata = changed;
  for (size_t k = 0; k < sizeof changes / sizeof *changes; k++) {
    memcpy(changed, texts, sizeof texts);
    changed[strstr(texts, changes[k].from) - texts + 1] = '7';
    const int order = piece_compare(&part, &picture, message, sizeof message);
    (void)snprintf(expected, sizeof expected, "its %s: '", changes[k].what);
    assert_memory_equal(message, expected, strlen(expected));
    assert_true(order != 0 && (order < 0) == (piece_compare(&picture, &part, message, sizeof message) > 0));
  }
  strcpy(changed, "pscn:size=9x9\npscn:crop=1\n"); /* a shorter text comes first, from either side */
  assert_true(piece_compare(&part, &picture, message, sizeof message) < 0);
  assert_true(piece_compare(&picture, &part, message, sizeof message) > 0);
  memcpy(changed, texts, sizeof texts);
  *strstr(changed, "one") = '7'; /* the scene's file may have another name */
  assert_int_equal(piece_compare(&part, &picture, message, sizeof message), 0);
}

/* The tiles that are done are copied and written, and no others; none if a channel is missing. A line of text stays one
 * line. */
TEST(what_is_done_is_copied)
{
  const struct render_options options = {.width = WIDTH,
                                         .height = HEIGHT,
                                         .crop = {0, 0, WIDTH, HEIGHT},
                                         .channels = {.count = 1, .width = 3, .kind = {CHANNEL_RGB}}};
  const struct image_attribute said[] = {{"pscn:options", "a\nb"}, {"Software", "pscn"}};
  struct piece from, to;
  assert_int_equal(piece_create(&options, 1, 1, said, 2, &from), STATUS_OK);
  assert_int_equal(piece_create(&options, 1, 1, NULL, 0, &to), STATUS_OK);
  assert_string_equal(from.image.metadata, "pscn:options=a b\n");
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
  const struct image_attribute texts[] = {{"pscn:size", "70x45"}, {"pscn:crop", "0,0,70,45"}, {"pscn:channels", "rgb"}};
  assert_int_equal(piece_encode(&from, texts, 3, &bytes, &size, message), STATUS_OK);
  piece_destroy(&from);
  write_file(bytes, size);
  assert_int_equal(piece_read(path, true, &from, message), STATUS_OK);
  assert_int_equal(remove(path), 0);
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
  assert_int_equal(piece_create(&options, 1, 1, NULL, 0, &piece), STATUS_OK);
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

/* The sum covers all pixels of the picture, one channel after the other, although those outside the tiles are not asked
 * for. */
TEST(the_sum_is_of_all_pixels)
{
  static const unsigned done[] = {63, 45,          6,     32,
                                  0,  45 | 7 << 9, 2 << 8}; /* bit k: tile k; k + 8 to k + 10: rows of it */
  const uint64_t start = UINT64_C(0xcbf29ce484222325);
  const struct render_options options = {.width = 100,
                                         .height = 80,
                                         .crop = {17, 20, WIDTH, HEIGHT},
                                         .channels = {.count = 1, .width = 3, .kind = {CHANNEL_RGB}}};
  const struct image_attribute channels = {"pscn:channels", "rgb"};
  char message[IMAGE_MESSAGE_SIZE], expected[32];
  float plane[WIDTH * HEIGHT];
  for (size_t n = 0; n < sizeof done / sizeof *done; n++) {
    struct piece piece;
    struct image whole;
    unsigned char *bytes;
    size_t size, length;
    assert_int_equal(piece_create(&options, 1, 1, NULL, 0, &piece), STATUS_OK);
    for (size_t k = 0; k < WIDTH * HEIGHT * 3; k++) piece.image.value[k] = (float)(k + 1);
    for (size_t k = 0; k < piece.tiles.count; k++) {
      const unsigned rows = done[n] >> k & 1 ? TILE_ROWS : done[n] >> (k + 8) & (TILE_ROWS - 1);
      atomic_store(&piece.tiles.rows[k], (unsigned char)rows);
    }
    assert_int_equal(piece_encode(&piece, &channels, 1, &bytes, &size, message), STATUS_OK);
    write_file(bytes, size);
    piece_destroy(&piece);
    assert_int_equal(image_read(path, &whole, message), STATUS_OK);
    const char *text = image_metadata(&whole, "pscn:done", &length);
    if (text == NULL) text = "", length = 0; /* an empty text is not in the file */
    uint64_t sum = fold(hash(start, "1/1", 3, 1)) + 2 * fold(hash(start, text, length, 1));
    for (size_t c = 0; c < 3; c++) {
      for (size_t k = 0; k < WIDTH * HEIGHT; k++) plane[k] = whole.value[3 * k + c];
      sum += fold(hash(fold(hash(start, whole.channel[c].name, 1, 1)), plane, WIDTH * HEIGHT, sizeof *plane));
    }
    (void)snprintf(expected, sizeof expected, "%016" PRIx64 "\n", sum);
    assert_memory_equal(image_metadata(&whole, "pscn:sum", &length), expected, 17);
    image_destroy(&whole);
  }
  assert_int_equal(remove(path), 0);
}

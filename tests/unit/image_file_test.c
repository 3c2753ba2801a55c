/* Pictures to and from files. */
#define _GNU_SOURCE /* pthread_setattr_default_np */
#include "image/image_file.h"

#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cmocka_test.h"
#include "files.h"
#include "base/srgb.h"
#include "random.h"

enum { WIDTH = 5, HEIGHT = 3 };

/* OpenImageIO converts codes to floats with a rounded factor and a rounded product: two units in the last place of
 * 1. */
static const double FLOAT_SLACK = 0x1p-23;

static const char path[] = "picture";

static struct image picture(size_t channels, const char *const names[])
{
  struct image image;
  assert_int_equal(image_create(WIDTH, HEIGHT, channels, &image), STATUS_OK);
  for (size_t c = 0; c < channels; c++) snprintf(image.channel[c].name, IMAGE_NAME_SIZE, "%s", names[c]);
  for (size_t k = 0; k < WIDTH * HEIGHT * channels; k++)
    image.value[k] = (float)((double)k / (WIDTH * HEIGHT * (double)channels - 1));
  return image;
}

/* Encodes a picture, writes it and reads it back. */
static struct image there_and_back(const struct image *image, const struct image_encoding *encoding)
{
  unsigned char *bytes;
  size_t size;
  char message[IMAGE_MESSAGE_SIZE];
  const enum status encoded = image_encode(image, encoding, &bytes, &size, message);
  if (encoded != STATUS_OK) print_error("%s\n", message);
  assert_int_equal(encoded, STATUS_OK);
  put_bytes(path, bytes, size);
  free(bytes);
  struct image back;
  const enum status status = image_read(path, &back, message);
  if (status != STATUS_OK) print_error("%s\n", message);
  assert_int_equal(status, STATUS_OK);
  assert_int_equal(back.width, image->width);
  assert_int_equal(back.height, image->height);
  assert_int_equal(back.channel_count, image->channel_count);
  return back;
}

static void *no_work(void *unused) { return unused; }

/* Must be the first test. OpenEXR's threads exist once OpenImageIO is ready, so a picture can be made when no thread
 * can be started any more. None can: each would need a stack larger than any machine's memory. */
IN_FOLDER(exr_is_made_without_new_threads)
{
  char message[IMAGE_MESSAGE_SIZE];
  assert_int_equal(image_file_ready(message), STATUS_OK);
  pthread_attr_t before, huge;
  pthread_t thread;
  assert_int_equal(pthread_getattr_default_np(&before), 0);
  assert_int_equal(pthread_attr_init(&huge), 0);
  assert_int_equal(pthread_attr_setstacksize(&huge, (size_t)1 << 60), 0);
  assert_int_equal(pthread_setattr_default_np(&huge), 0);
  assert_int_not_equal(pthread_create(&thread, NULL, no_work, NULL), 0);
  const char *const names[] = {"R", "G", "B"};
  struct image image = picture(3, names);
  struct image back = there_and_back(&image, &(struct image_encoding){.format = IMAGE_EXR, .bits = 32});
  assert_int_equal(pthread_setattr_default_np(&before), 0);
  image_destroy(&image);
  image_destroy(&back);
  pthread_attr_destroy(&before);
  pthread_attr_destroy(&huge);
}

IN_FOLDER(png_holds_the_nearest_codes)
{
  const char *const names[] = {"R", "G", "B"};
  struct image image = picture(3, names);
  image.value[0] = 7; /* clipped */
  for (int bits = 8; bits <= 16; bits += 8) {
    const struct image_encoding encoding = {.format = IMAGE_PNG, .bits = bits};
    struct image back = there_and_back(&image, &encoding);
    const double codes = bits == 8 ? 255 : 65535;
    for (size_t k = 0; k < WIDTH * HEIGHT * 3; k++) {
      const double code = floor(srgb_encode(fmin((double)image.value[k], 1)) * codes + 0.5);
      assert_true(fabs((double)back.value[k] * codes - code) < FLOAT_SLACK * codes);
    }
    image_destroy(&back);
  }
  image_destroy(&image);
}

/* Colours are kept as half, data as float, and found by name in whatever order the file has them. */
IN_FOLDER(exr_keeps_values_and_names)
{
  const char *const names[] = {"R", "G", "B", "depth", "normal.x"};
  struct image image = picture(5, names);
  image.channel[3].data = image.channel[4].data = true;
  image.value[0] = 7.0f + 1.0f / 4096; /* rounds to 7 in half */
  image.value[3] = INFINITY;
  image.value[4] = -1.0f - 1.0f / (1 << 20);
  for (int bits = 16; bits <= 32; bits += 16) {
    const struct image_encoding encoding = {.format = IMAGE_EXR, .bits = bits};
    struct image back = there_and_back(&image, &encoding);
    for (size_t c = 0; c < 5; c++) {
      const size_t found = image_find_channel(&back, names[c]);
      assert_true(found < 5);
      const double relative = bits == 16 && c < 3 ? 0x1p-11 : 0; /* half an ulp of half */
      for (size_t k = 0; k < WIDTH * HEIGHT; k++) {
        const float written = image.value[5 * k + c], read = back.value[5 * k + found];
        assert_true(read == written || fabs((double)read - (double)written) <= relative * (double)written);
      }
    }
    assert_true(back.value[image_find_channel(&back, "R")] == (bits == 16 ? 7.0f : image.value[0]));
    image_destroy(&back);
  }
  image_destroy(&image);
}

static bool note_progress(void *context, double part)
{
  double *last = context;
  assert_true(part > *last && part <= 1);
  *last = part;
  return true;
}

static bool end_soon(void *context, double part)
{
  (void)context;
  return part < 0.5;
}

/* Progress reaches the end of the file; rows that are written separately make the whole picture. */
IN_FOLDER(encoding_is_told)
{
  enum { TALL = 1000 };
  struct image image;
  double last = 0;
  assert_int_equal(image_create(3, TALL, 3, &image), STATUS_OK);
  for (size_t c = 0; c < 3; c++) snprintf(image.channel[c].name, IMAGE_NAME_SIZE, "%c", "RGB"[c]);
  for (size_t k = 0; k < 9 * TALL; k++) image.value[k] = (float)k;
  const struct image_encoding encoding = {.format = IMAGE_EXR, .bits = 32, .progress = note_progress, .context = &last};
  struct image back = there_and_back(&image, &encoding);
  assert_true(last == 1);
  assert_memory_equal(back.value, image.value, 9 * TALL * sizeof *image.value);
  image_destroy(&back);
  for (int format = 0; format < 2; format++) {
    const struct image_encoding ended = {
      .format = format == 0 ? IMAGE_PNG : IMAGE_EXR, .bits = 16, .progress = end_soon};
    unsigned char *bytes;
    size_t size;
    char message[IMAGE_MESSAGE_SIZE];
    assert_int_equal(image_encode(&image, &ended, &bytes, &size, message), STATUS_INTERRUPTED);
    assert_null(bytes);
  }
  image_destroy(&image);
}

/* Neither writing nor reading divides or multiplies by a channel that could be opacity. */
IN_FOLDER(no_channel_is_opacity)
{
  static const char *const names[] = {"R", "G", "B", "A"};
  for (size_t channels = 2; channels <= 4; channels += 2) {
    struct image image = picture(channels, names);
    for (size_t k = channels - 1; k < WIDTH * HEIGHT * channels; k += channels)
      image.value[k] = (float)(k / channels % 3) / 2; /* 0, 1/2, 1 */
    for (int format = 0; format < 2; format++) {
      const struct image_encoding encoding = {
        .format = format == 0 ? IMAGE_PNG : IMAGE_EXR, .bits = 16, .encoded = true};
      struct image back = there_and_back(&image, &encoding);
      assert_int_equal(back.channel_count, channels);
      for (size_t k = 0; k < WIDTH * HEIGHT * channels; k++)
        assert_true(fabsf(back.value[k] - image.value[k]) <= (format == 0 ? 0x1p-16F : 0x1p-11F));
      image_destroy(&back);
    }
    image_destroy(&image);
  }
}

/* A crop keeps its place, packed either way. Its own texts come back, others do not; a text that is missing is empty. */
IN_FOLDER(exr_keeps_its_window_and_texts)
{
  const char *const names[] = {"R", "G", "B"};
  struct image image = picture(3, names);
  assert_true(image_add_text(&image, "pscn:scene", "a=b\n.pscn") && image_add_text(&image, "pscn:size", "%dx50", 70) &&
              image_add_text(&image, "Software", "us"));
  assert_string_equal(image_text(&image, "Software"), "us");
  image.x = 5;
  image.y = 7;
  image.full_width = 70;
  image.full_height = 50;
  for (int tile = 0; tile <= 2; tile += 2) {
    const struct image_encoding encoding = {.format = IMAGE_EXR, .bits = 32, .tile = tile};
    struct image back = there_and_back(&image, &encoding);
    assert_true(back.x == 5 && back.y == 7 && back.full_width == 70 && back.full_height == 50);
    assert_memory_equal(back.value, image.value, WIDTH * HEIGHT * 3 * sizeof *image.value);
    assert_string_equal(image_text(&back, "pscn:scene"), "a=b .pscn");
    assert_string_equal(image_text(&back, "pscn:size"), "70x50");
    assert_string_equal(image_text(&back, "Software"), "");
    assert_string_equal(image_text(&back, "pscn:siz"), "");
    image_destroy(&back);
  }
  image_destroy(&image);
}

/* How many areas are wanted, and how often this was asked. */
struct question {
  size_t count, asked;
  enum status answer;
};

static enum status answer(void *context, const struct image *image, const struct rectangle **out_area,
                          size_t *out_count, char *message)
{
  static const struct rectangle areas[] = {{6, 7, 1, 2}, {9, 9, 1, 1}, {5, 7, WIDTH, HEIGHT}};
  struct question *question = context;
  assert_true(image->width == WIDTH && image->x == 5 && image->full_width == 70);
  question->asked++;
  *out_area = areas;
  *out_count = question->count;
  (void)snprintf(message, IMAGE_MESSAGE_SIZE, "so it is");
  return question->answer;
}

/* The areas' pixels are read. Of a file in tiles no others are; of one in rows, or if all tiles are needed, all are. */
IN_FOLDER(areas_of_a_picture_are_read)
{
  const char *const names[] = {"R", "G", "B"};
  static const int first[HEIGHT][WIDTH] = {/* the area that a pixel is in, from 1 */
                                           {0, 1, 0, 0, 0},
                                           {0, 1, 0, 0, 0},
                                           {0, 0, 0, 0, 2}};
  struct question question = {.answer = STATUS_OK};
  const struct image_wanted wanted = {answer, &question};
  char message[IMAGE_MESSAGE_SIZE];
  struct image image = picture(3, names), back;
  image.x = 5, image.y = 7, image.full_width = 70, image.full_height = 50;
  for (size_t k = 0; k < WIDTH * HEIGHT * 3; k++) image.value[k] += 1;
  for (int tile = 0; tile <= 2; tile += 2) {
    back = there_and_back(&image, &(struct image_encoding){.format = IMAGE_EXR, .bits = 32, .tile = tile});
    for (question.count = 0; question.count <= 3; question.count++) {
      image_destroy(&back);
      question.asked = 0;
      assert_int_equal(image_read_areas(path, &wanted, &back, message), STATUS_OK);
      assert_int_equal(question.asked, 1);
      assert_true((back.value == NULL) == (question.count == 0));
      const bool all = tile == 0 || question.count == 3;
      for (size_t k = 0; k < WIDTH * HEIGHT; k++) {
        const int area = first[k / WIDTH][k % WIDTH];
        const bool in = all || (area != 0 && area <= (int)question.count);
        for (size_t c = 0; c < 3 && question.count != 0; c++)
          assert_true(back.value[3 * k + c] == (in ? image.value[3 * k + c] : 0));
      }
    }
    image_destroy(&back);
  }
  question.answer = STATUS_INPUT; /* fails if the one who is asked does */
  assert_int_equal(image_read_areas(path, &wanted, &back, message), STATUS_INPUT);
  assert_string_equal(message, "so it is");
  assert_true(back.value == NULL && back.width == 0);
  image_destroy(&image);
}

/* If pixels lie outside the picture that they claim to be part of, on any side, they are read as a whole picture. */
IN_FOLDER(exr_outside_its_picture_is_a_whole)
{
  const char *const names[] = {"R", "G", "B"};
  static const int places[][2] = {{-1, 0}, {0, -1}, {6, 0}, {0, 8}, {5, 7} /* the last that is inside */};
  struct image image = picture(3, names);
  image.full_width = WIDTH + 5;
  image.full_height = HEIGHT + 7;
  for (int k = 0; k < 5; k++) {
    image.x = (size_t)places[k][0];
    image.y = (size_t)places[k][1];
    struct image back = there_and_back(&image, &(struct image_encoding){.format = IMAGE_EXR, .bits = 32});
    assert_true(k == 4 ? back.x == 5 && back.y == 7 : back.x == 0 && back.y == 0);
    assert_int_equal(back.full_width, k == 4 ? WIDTH + 5 : 0);
    assert_memory_equal(back.value, image.value, WIDTH * HEIGHT * 3 * sizeof *image.value);
    image_destroy(&back);
  }
  image_destroy(&image);
}

TEST(png_refuses_five_channels_and_none)
{
  const char *const names[] = {"a", "b", "c", "d", "e"};
  struct image image = picture(5, names);
  unsigned char *bytes;
  size_t size;
  char message[IMAGE_MESSAGE_SIZE];
  const struct image_encoding encoding = {.format = IMAGE_PNG, .bits = 8};
  assert_int_equal(image_encode(&image, &encoding, &bytes, &size, message), STATUS_FILE);
  assert_null(bytes);
  assert_true(message[0] != '\0');
  image.channel_count = 0;
  assert_int_equal(image_encode(&image, &encoding, &bytes, &size, message), STATUS_FILE);
  assert_string_equal(message, "the format cannot hold these channels");
  image_destroy(&image);
}

/* A TIFF of two rows in one strip: the values of its tags, which TIFF 6.0 explains. */
struct tiff {
  bool big; /* numbers begin with their largest byte */
  unsigned columns, compression, photometric, samples, bytes;
};

/* Writes the file without its last `lacking` bytes; all pixels are 51. The last two bytes of an entry are where the
 * value begins. */
static void write_tiff(const struct tiff *tiff, size_t lacking)
{
  enum { ENTRIES = 9, VALUE = 8 + 2 + 12 * ENTRIES + 4, MOST = 12 };
  const bool big = tiff->big;
  const unsigned entries[ENTRIES][2] = {
    {256, tiff->columns}, {257, 2}, {258, 8},          {259, tiff->compression}, {262, tiff->photometric}, {273, VALUE},
    {277, tiff->samples}, {278, 2}, {279, tiff->bytes}};
  unsigned char bytes[VALUE + MOST] = {big ? 'M' : 'I', big ? 'M' : 'I'};
  bytes[big ? 3 : 2] = 42, bytes[big ? 7 : 4] = 8, bytes[big ? 9 : 8] = ENTRIES;
  for (size_t k = 0; k < ENTRIES; k++) { /* tag, type 3 (of 16 bits), count 1, value */
    unsigned char *entry = bytes + 10 + 12 * k;
    const unsigned tag = entries[k][0], value = entries[k][1];
    entry[big ? 0 : 1] = (unsigned char)(tag >> 8), entry[big ? 1 : 0] = (unsigned char)tag;
    entry[big ? 3 : 2] = 3, entry[big ? 7 : 4] = 1, entry[big ? 9 : 8] = (unsigned char)value;
  }
  memset(bytes + VALUE, 51, MOST);
  put_bytes(path, bytes, VALUE + tiff->bytes - lacking);
}

/* Two grey pixels. A file that is cut off is refused, although OpenImageIO would invent the missing pixels. */
IN_FOLDER(tiff_is_read_in_both_orders_of_bytes)
{
  for (int big = 0; big < 2; big++) {
    for (size_t lacking = 0; lacking < 2; lacking++) {
      write_tiff(&(struct tiff){big, .columns = 1, .compression = 1, .photometric = 1, .samples = 1, .bytes = 2},
                 lacking);
      char message[IMAGE_MESSAGE_SIZE] = "";
      struct image image;
      const enum status status = image_read(path, &image, message);
      if (lacking == 0 && status != STATUS_OK) print_error("%s\n", message);
      assert_int_equal(status, lacking == 0 ? STATUS_OK : STATUS_FILE);
      if (lacking == 0)
        assert_true(image.width == 1 && image.height == 2 && fabs((double)image.value[0] - 0.2) < FLOAT_SLACK);
      else assert_true(message[0] != '\0' && strchr(message, '\n') == NULL);
      image_destroy(&image);
    }
  }
}

/* For such files OpenImageIO would return whatever else is in memory. One has eight pixels that share their colours by
 * fours, the format's default, in 12 bytes where pixels have 24. The other is no zip; of that OpenImageIO says nothing
 * when it reads more than a row. */
IN_FOLDER(tiff_without_the_bytes_of_its_pixels_is_refused)
{
  static const struct tiff shared = {.columns = 4, .compression = 1, .photometric = 6, .samples = 3, .bytes = 12},
                           no_zip = {.columns = 4, .compression = 8, .photometric = 1, .samples = 1, .bytes = 8};
  char message[IMAGE_MESSAGE_SIZE] = "";
  struct image image;
  write_tiff(&shared, 0);
  assert_int_equal(image_read(path, &image, message), STATUS_FILE);
  assert_non_null(strstr(message, "YCbCr"));
  write_tiff(&no_zip, 0);
  message[0] = '\0';
  assert_int_equal(image_read(path, &image, message), STATUS_FILE);
  assert_true(message[0] != '\0');
}

/* Whether this byte belongs to a size of the picture. A damaged size may take long, and is tested above. */
static bool is_size(const unsigned char *bytes, size_t size, size_t at)
{
  if (bytes[0] == 137) return at >= 16 && at < 24;
  static const char *const windows[] = {"dataWindow", "displayWindow"};
  for (size_t k = 0; k < 2; k++) {
    const size_t length = strlen(windows[k]) + strlen("box2i") + 2 + 4; /* with NULs, and the length of the value */
    for (size_t n = 0; n + length + 16 <= size; n++)
      if (memcmp(bytes + n, windows[k], strlen(windows[k])) == 0 && at >= n + length && at < n + length + 16)
        return true;
  }
  return false;
}

IN_FOLDER(damaged_pictures_are_read_or_refused)
{
  enum { SEED = 20261122, ROUNDS = 150, MOST = 3 };
  struct random random = {SEED};
  const char *const names[] = {"R", "G", "B"};
  int read = 0, refused = 0;
  for (int format = IMAGE_PNG; format <= IMAGE_EXR; format++) {
    struct image image = picture(3, names), back;
    const struct image_encoding encoding = {.format = (enum image_format)format, .bits = 16};
    assert_true(image_add_text(&image, "pscn:text", "what it is of"));
    unsigned char *bytes, *damaged;
    size_t size;
    char message[IMAGE_MESSAGE_SIZE];
    assert_int_equal(image_encode(&image, &encoding, &bytes, &size, message), STATUS_OK);
    damaged = malloc(size);
    assert_non_null(damaged);
    for (int round = 0; round < ROUNDS; round++) {
      memcpy(damaged, bytes, size);
      for (int k = 0; k <= round % MOST; k++) {
        const size_t at = (size_t)(random_bits(&random) % size);
        if (!is_size(bytes, size, at)) damaged[at] ^= (unsigned char)(1u << random_bits(&random) % 8);
      }
      put_bytes(path, damaged, round % 10 == 0 ? (size_t)(random_bits(&random) % size) : size);
      const enum status status = image_read(path, &back, message);
      assert_true(status == STATUS_OK || (message[0] != '\0' && strchr(message, '\n') == NULL && back.value == NULL));
      if (status == STATUS_OK) assert_true(back.width == WIDTH && back.height == HEIGHT && ++read);
      else refused++;
      image_destroy(&back);
    }
    free(damaged);
    free(bytes);
    image_destroy(&image);
  }
  assert_true(read > ROUNDS / 10 && refused > ROUNDS / 2);
}

TEST(absurd_sizes_are_refused)
{
  struct image image;
  assert_int_equal(image_create(SIZE_MAX / 2, 3, 3, &image), STATUS_LIMIT);
  assert_int_equal(image_create(SIZE_MAX / 8, 1, 3, &image), STATUS_LIMIT);
  assert_int_equal(image_create(1, (size_t)IMAGE_MAX_PIXELS + 1, 0, &image), STATUS_LIMIT);
  assert_null(image.value);
}

/* Parts of a picture. See piece.h. */
#include "command/piece.h"

#include <assert.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "command/values.h"

/* The metadata that two parts of a picture share, and their names in messages. */
static const struct {
  const char *name, *what;
} COMMON[] = {
  {"pscn:size", "size"},         {"pscn:crop", "crop"},
  {"pscn:samples", "samples"},   {"pscn:channels", "channels"},
  {"pscn:text", "scene's text"}, {"pscn:options", "options"},
  {"pscn:version", "version"},   {"pscn:arithmetic", "arithmetic"},
};

/* Those that only a part has. */
static const char TILE[] = "pscn:tile", DONE[] = "pscn:done", SUM[] = "pscn:sum";

enum { SUM_SIZE = 17 }; /* a checksum as text: 16 digits and a NUL */

static void name_channels(const struct channel_list *channels, struct image *image)
{
  struct image_channel *channel = image->channel;
  for (size_t k = 0; k < channels->count; k++) {
    const struct channel_traits *traits = channel_traits(channels->kind[k]);
    for (size_t c = 0; c < traits->width; c++, channel++) {
      channel->data = traits->data;
      snprintf(channel->name, IMAGE_NAME_SIZE, "%s", traits->value_names[c]);
    }
  }
}

enum status piece_create(const struct render_options *options, size_t number, size_t count, struct piece *out)
{
  const struct rectangle *crop = &options->crop;
  struct image *image = &out->image;
  *out = (struct piece){.number = number, .count = count, .channels = options->channels};
  enum status status = image_create(crop->width, crop->height, options->channels.width, image);
  if (status == STATUS_OK) status = tile_list_create(crop, number, count, &out->tiles);
  if (status != STATUS_OK) return status;
  image->x = crop->x;
  image->y = crop->y;
  image->full_width = options->width;
  image->full_height = options->height;
  name_channels(&options->channels, image);
  return STATUS_OK;
}

enum status piece_create_like(const struct piece *piece, size_t number, size_t count, struct piece *out)
{
  const struct image *image = &piece->image;
  const struct render_options options = {.width = image->full_width,
                                         .height = image->full_height,
                                         .crop = {image->x, image->y, image->width, image->height},
                                         .channels = piece->channels};
  return piece_create(&options, number, count, out);
}

void piece_destroy(struct piece *piece)
{
  image_destroy(&piece->image);
  tile_list_destroy(&piece->tiles);
  *piece = (struct piece){0};
}

static_assert(TILE_ROWS < 10, "a digit tells how many rows of a tile are done");

/* The text of DONE: a digit for each tile of the list. The caller frees it; NULL if memory is short. */
static char *done_text(const struct tile_list *tiles)
{
  char *text = malloc(tiles->count + 1);
  if (text == NULL) return NULL;
  for (size_t k = 0; k < tiles->count; k++) text[k] = (char)('0' + atomic_load(&tiles->rows[k]));
  text[tiles->count] = '\0';
  return text;
}

/* Its inverse. Returns false if it is no such text. */
static bool read_done(const char *text, const struct tile_list *tiles)
{
  if (strlen(text) != tiles->count) return false;
  for (size_t k = 0; k < tiles->count; k++) {
    if (text[k] < '0' || text[k] > '0' + TILE_ROWS) return false;
    atomic_store(&tiles->rows[k], (unsigned char)(text[k] - '0'));
  }
  return true;
}

/* Whether the picture's place is as its metadata say: the checksum does not cover the windows in the file. */
static bool stands_in_place(const struct image *image)
{
  char size[48], crop[96];
  snprintf(size, sizeof size, "%zux%zu", image->full_width, image->full_height);
  snprintf(crop, sizeof crop, "%zu,%zu,%zu,%zu", image->x, image->y, image->width, image->height);
  return strcmp(image_text(image, "pscn:size"), size) == 0 && strcmp(image_text(image, "pscn:crop"), crop) == 0;
}

/* FNV-1a (Fowler, Noll, Vo; RFC 9923), also applied to words: no two words give one hash. */
static uint64_t hash_add(uint64_t hash, uint32_t word) { return (hash ^ word) * UINT64_C(0x100000001b3); }

/* The upper bits are mixed better. */
static uint64_t hash_fold(uint64_t hash) { return hash ^ hash >> 32; }

static uint64_t hash_text(const char *text)
{
  uint64_t hash = UINT64_C(0xcbf29ce484222325);
  for (; *text != '\0'; text++) hash = hash_add(hash, (unsigned char)*text);
  return hash_fold(hash);
}

/* Hashes one channel: its name, and its values in what is done of the tiles. */
static uint64_t hash_channel(const struct image *image, size_t channel, const struct tile_list *tiles)
{
  uint64_t hash = hash_text(image->channel[channel].name);
  for (size_t k = 0; k < tiles->count; k++) {
    const struct rectangle part = tile_top(tiles, k, atomic_load(&tiles->rows[k]));
    for (size_t y = part.y - image->y; y < part.y - image->y + part.height; y++) {
      const float *value = image_pixel(image, part.x - image->x, y) + channel;
      for (size_t x = 0; x < part.width; x++, value += image->channel_count) {
        uint32_t bits;
        memcpy(&bits, value, sizeof bits);
        hash = hash_add(hash, bits);
      }
    }
  }
  return hash_fold(hash);
}

/* A checksum, as text, of a part's pixels, tiles and number, which shows that a byte has changed. It is independent of
 * the order of the channels, which a file does not keep. */
static void make_sum(const struct image *image, const struct tile_list *tiles, char out[SUM_SIZE])
{
  uint64_t sum = hash_text(image_text(image, TILE)) + 2 * hash_text(image_text(image, DONE));
  for (size_t c = 0; c < image->channel_count; c++) sum += hash_channel(image, c, tiles);
  snprintf(out, SUM_SIZE, "%016" PRIx64, sum);
}

/* The reading of a part: all of its metadata, and with `pixels` those of its tiles. */
struct reading {
  struct piece *piece;
  bool pixels;
};

/* Reads a piece's place, tiles and channels from its metadata: STATUS_INPUT if they are missing or impossible. */
static enum status wanted_areas(void *context, const struct image *image, const struct rectangle **out_area,
                                size_t *out_count, char *message)
{
  const struct reading *reading = context;
  struct piece *piece = reading->piece;
  const struct rectangle crop = {image->x, image->y, image->width, image->height};
  size_t bad_length;
  const char *bad;
  enum status status = STATUS_INPUT;
  if (stands_in_place(image) && value_range(image_text(image, TILE), '/', PIECE_MOST, &piece->number, &piece->count) &&
      channel_list_parse(image_text(image, "pscn:channels"), &piece->channels, &bad, &bad_length))
    status = tile_list_create(&crop, piece->number, piece->count, &piece->tiles);
  if (status == STATUS_OK && !read_done(image_text(image, DONE), &piece->tiles)) status = STATUS_INPUT;
  if (status != STATUS_OK)
    snprintf(message, IMAGE_MESSAGE_SIZE, status == STATUS_INPUT ? "it is not a piece of a picture" : "out of memory");
  *out_area = piece->tiles.tile;
  *out_count = reading->pixels ? piece->tiles.count : 0;
  return status;
}

enum status piece_read(const char *path, bool pixels, struct piece *out, char *message)
{
  char sum[SUM_SIZE];
  *out = (struct piece){0};
  struct reading reading = {out, pixels};
  const struct image_wanted wanted = {wanted_areas, &reading};
  enum status status = image_read_areas(path, &wanted, &out->image, message);
  if (status == STATUS_OK && pixels) make_sum(&out->image, &out->tiles, sum);
  if (status == STATUS_OK && pixels && strcmp(image_text(&out->image, SUM), sum) != 0) {
    snprintf(message, IMAGE_MESSAGE_SIZE, "it is damaged: its checksum is wrong");
    status = STATUS_INPUT;
  }
  if (status != STATUS_OK) piece_destroy(out);
  return status;
}

bool piece_belongs(const struct image *part, const struct image *picture, char *out, size_t size)
{
  for (size_t k = 0; k < sizeof COMMON / sizeof *COMMON; k++) {
    const char *here = image_text(part, COMMON[k].name), *there = image_text(picture, COMMON[k].name);
    if (strcmp(here, there) == 0) continue;
    snprintf(out, size, "its %s: '%s', not '%s'", COMMON[k].what, here, there);
    return false;
  }
  return true;
}

/* Copies the values of a tile's part. channel[c] is the channel of `from` for channel c of `to`. */
static void copy_tile(const struct image *from, const struct rectangle *tile, const size_t *channel, struct image *to)
{
  for (size_t y = tile->y - to->y; y < tile->y - to->y + tile->height; y++) {
    const float *value = image_pixel(from, tile->x - to->x, y);
    float *out = image_pixel(to, tile->x - to->x, y);
    for (size_t x = 0; x < tile->width; x++, value += from->channel_count)
      for (size_t c = 0; c < to->channel_count; c++) *out++ = value[channel[c]];
  }
}

bool piece_copy(const struct piece *from, struct image *to)
{
  size_t channel[IMAGE_MAX_CHANNELS];
  for (size_t c = 0; c < to->channel_count; c++) {
    channel[c] = image_find_channel(&from->image, to->channel[c].name);
    if (channel[c] == from->image.channel_count) return false;
  }
  for (size_t k = 0; k < from->tiles.count; k++) {
    const struct rectangle part = tile_top(&from->tiles, k, atomic_load(&from->tiles.rows[k]));
    copy_tile(&from->image, &part, channel, to);
  }
  return true;
}

const char *piece_next_text(const struct image *part, const char *name)
{
  do name = image_next_text(part, name);
  while (name != NULL && (strcmp(name, TILE) == 0 || strcmp(name, DONE) == 0 || strcmp(name, SUM) == 0));
  return name;
}

/* Copies what is done, and nothing else, because the rest is still being written, and describes it. */
static enum status copy_done(const struct piece *piece, struct piece *out)
{
  char sum[SUM_SIZE];
  const enum status status = piece_create_like(piece, piece->number, piece->count, out);
  if (status != STATUS_OK) return status;
  for (size_t k = 0; k < out->tiles.count; k++) atomic_store(&out->tiles.rows[k], atomic_load(&piece->tiles.rows[k]));
  const struct piece done = {.image = piece->image, .tiles = out->tiles};
  (void)piece_copy(&done, &out->image); /* it has the channels */
  char *text = done_text(&out->tiles);
  bool enough = text != NULL;
  for (const char *name = NULL; enough && (name = image_next_text(&piece->image, name)) != NULL;)
    enough = image_add_text(&out->image, name, "%s", name + strlen(name) + 1);
  enough = enough && image_add_text(&out->image, TILE, "%zu/%zu", piece->number, piece->count) &&
           image_add_text(&out->image, DONE, "%s", text);
  make_sum(&out->image, &out->tiles, sum);
  enough = enough && image_add_text(&out->image, SUM, "%s", sum);
  free(text);
  return enough ? STATUS_OK : STATUS_LIMIT;
}

enum status piece_encode(const struct piece *piece, unsigned char **out_bytes, size_t *out_size, char *message)
{
  const struct image_encoding encoding = {.format = IMAGE_EXR, .bits = 32, .tile = TILE_SIZE};
  struct piece copy;
  *out_bytes = NULL;
  *out_size = 0;
  enum status status = copy_done(piece, &copy);
  snprintf(message, IMAGE_MESSAGE_SIZE, "out of memory");
  if (status == STATUS_OK) status = image_encode(&copy.image, &encoding, out_bytes, out_size, message);
  piece_destroy(&copy);
  return status;
}

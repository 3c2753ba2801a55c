/* Parts of a picture. See piece.h. */
#include "command/piece.h"

#include <assert.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/text_buffer.h"
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

enum {
  MOST_PIECES = 1000000,
  SUM_SIZE = 17 /* a checksum as text: 16 digits and a NUL */
};

bool piece_number(const char *text, size_t length, size_t *out_number, size_t *out_count)
{
  const char *end = text + length;
  size_t number, count;
  if (!value_digits(&text, end, MOST_PIECES, &number) || !value_sign(&text, end, '/') ||
      !value_digits(&text, end, MOST_PIECES, &count) || text != end || number < 1 || number > count)
    return false;
  *out_number = number;
  *out_count = count;
  return true;
}

/* The lines of struct image's metadata, as they will be read back; NULL if memory is short. */
static char *metadata_lines(const struct image_attribute *attributes, size_t count)
{
  size_t size = 1, used = 0;
  for (size_t k = 0; k < count; k++) size += strlen(attributes[k].name) + strlen(attributes[k].text) + 2;
  char *lines = malloc(size);
  if (lines == NULL) return NULL;
  lines[0] = '\0';
  for (size_t k = 0; k < count; k++)
    if (strncmp(attributes[k].name, "pscn:", 5) == 0) {
      char *line = lines + used;
      used += (size_t)snprintf(line, size - used, "%s=%s\n", attributes[k].name, attributes[k].text);
      for (char *c = line; c < lines + used - 1; c++)
        if (*c == '\n') *c = ' ';
    }
  return lines;
}

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

enum status piece_create(const struct render_options *options, size_t number, size_t count,
                         const struct image_attribute *attributes, size_t attribute_count, struct piece *out)
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
  image->metadata = metadata_lines(attributes, attribute_count);
  return image->metadata == NULL ? STATUS_LIMIT : STATUS_OK;
}

enum status piece_create_like(const struct piece *piece, size_t number, size_t count, struct piece *out)
{
  const struct image *image = &piece->image;
  const struct render_options options = {.width = image->full_width,
                                         .height = image->full_height,
                                         .crop = {image->x, image->y, image->width, image->height},
                                         .channels = piece->channels};
  return piece_create(&options, number, count, NULL, 0, out);
}

void piece_destroy(struct piece *piece)
{
  image_destroy(&piece->image);
  tile_list_destroy(&piece->tiles);
  *piece = (struct piece){0};
}

/* Reads "0-17,19,18:3", the inverse of done_text, in which the numbers ascend, and again those of tiles that are begun.
 * Returns false if it is no such list. */
static bool read_done(const char *text, size_t length, const struct tile_list *tiles)
{
  const char *end = text + length;
  bool begun = false;
  for (size_t next = 0; text < end;) {
    size_t first, last, rows = TILE_ROWS;
    if (!value_digits(&text, end, tiles->count, &first)) return false;
    last = first;
    if (value_sign(&text, end, ':')) {
      if (!value_digits(&text, end, TILE_ROWS - 1, &rows)) return false;
      if (!begun) begun = true, next = 0;
    } else if (begun || (value_sign(&text, end, '-') && !value_digits(&text, end, tiles->count, &last))) {
      return false;
    }
    const bool more = value_sign(&text, end, ',');
    if (first < next || last < first || last >= tiles->count || more != (text < end)) return false;
    for (size_t k = first; k <= last; k++) {
      if (atomic_load(&tiles->rows[k]) != 0) return false;
      atomic_store(&tiles->rows[k], (unsigned char)rows);
    }
    next = last + 1;
  }
  return true;
}

/* Returns the status, and writes its reason into the message. */
static enum status told(enum status status, const char *input, char *message)
{
  if (status != STATUS_OK)
    snprintf(message, IMAGE_MESSAGE_SIZE, "%s", status == STATUS_INPUT ? input : "out of memory");
  return status;
}

/* Whether the picture's place is as its metadata say: the checksum does not cover the windows in the file. */
static bool stands_in_place(const struct image *image)
{
  char size[48], crop[96];
  size_t size_length = 0, crop_length = 0;
  const char *said_size = image_metadata(image, "pscn:size", &size_length);
  const char *said_crop = image_metadata(image, "pscn:crop", &crop_length);
  snprintf(size, sizeof size, "%zux%zu", image->full_width, image->full_height);
  snprintf(crop, sizeof crop, "%zu,%zu,%zu,%zu", image->x, image->y, image->width, image->height);
  return size_length == strlen(size) && memcmp(said_size, size, size_length) == 0 && crop_length == strlen(crop) &&
         memcmp(said_crop, crop, crop_length) == 0;
}

/* Reads a picture's place and tiles from its metadata. Returns STATUS_INPUT if they are missing or impossible. */
static enum status read_tiles(struct piece *piece)
{
  const struct image *image = &piece->image;
  const struct rectangle crop = {image->x, image->y, image->width, image->height};
  size_t length;
  const char *tile = image_metadata(image, "pscn:tile", &length);
  if (tile == NULL || !stands_in_place(image) || !piece_number(tile, length, &piece->number, &piece->count))
    return STATUS_INPUT;
  const enum status status = tile_list_create(&crop, piece->number, piece->count, &piece->tiles);
  if (status != STATUS_OK) return status;
  const char *done = image_metadata(image, "pscn:done", &length); /* empty texts are not stored: none is done */
  return done == NULL || read_done(done, length, &piece->tiles) ? STATUS_OK : STATUS_INPUT;
}

/* The same for its channels. */
static enum status read_channels(struct piece *piece)
{
  size_t length, bad_length;
  const char *channels = image_metadata(&piece->image, "pscn:channels", &length), *bad;
  if (channels == NULL) return STATUS_INPUT;
  char *list = strndup(channels, length);
  if (list == NULL) return STATUS_LIMIT;
  const bool known = channel_list_parse(list, &piece->channels, &bad, &bad_length);
  free(list);
  return known ? STATUS_OK : STATUS_INPUT;
}

/* FNV-1a (Fowler, Noll, Vo; RFC 9923), also applied to words: no two words give one hash. */
static const uint64_t HASH_PRIME = UINT64_C(0x100000001b3);

static uint64_t hash_add(uint64_t hash, uint32_t word) { return (hash ^ word) * HASH_PRIME; }

/* Adds `count` words 0. */
static uint64_t hash_add_zeros(uint64_t hash, size_t count)
{
  for (uint64_t factor = HASH_PRIME; count != 0; count /= 2, factor *= factor)
    if (count % 2 != 0) hash *= factor;
  return hash;
}

/* The upper bits are mixed better. */
static uint64_t hash_fold(uint64_t hash) { return hash ^ hash >> 32; }

static uint64_t hash_text(const char *text, size_t length)
{
  uint64_t hash = UINT64_C(0xcbf29ce484222325);
  for (size_t k = 0; k < length; k++) hash = hash_add(hash, (unsigned char)text[k]);
  return hash_fold(hash);
}

static int by_row(const void *a, const void *b)
{
  const struct rectangle *p = a, *q = b;
  return p->y != q->y ? (p->y > q->y) - (p->y < q->y) : (p->x > q->x) - (p->x < q->x);
}

/* What is done of the tiles, by rows. The caller frees it; NULL if memory is short. */
static struct rectangle *tiles_by_row(const struct tile_list *tiles, size_t *out_count)
{
  struct rectangle *sorted = malloc((tiles->count + 1) * sizeof *sorted);
  *out_count = 0;
  if (sorted == NULL) return NULL;
  for (size_t k = 0; k < tiles->count; k++) {
    sorted[*out_count] = tile_top(tiles, k, atomic_load(&tiles->rows[k]));
    *out_count += sorted[*out_count].height > 0;
  }
  qsort(sorted, *out_count, sizeof *sorted, by_row);
  return sorted;
}

/* Adds `count` pixels of one channel, from `first` on. */
static uint64_t hash_add_pixels(uint64_t hash, const struct image *image, size_t channel, size_t first, size_t count)
{
  const float *value = image->value + first * image->channel_count + channel;
  for (size_t k = 0; k < count; k++, value += image->channel_count) {
    uint32_t bits;
    memcpy(&bits, value, sizeof bits);
    hash = hash_add(hash, bits);
  }
  return hash;
}

/* Hashes one channel of the whole picture, by rows, taken as 0 outside the tiles, where it may not have been read. */
static uint64_t hash_channel(const struct image *image, size_t channel, const struct rectangle *tile, size_t count)
{
  uint64_t hash = hash_text(image->channel[channel].name, strlen(image->channel[channel].name));
  size_t next = 0; /* pixel */
  for (size_t begin = 0, end = 0; begin < count; begin = end) {
    while (end < count && tile[end].y == tile[begin].y) end++;
    for (size_t y = 0; y < TILE_SIZE; y++) {
      for (size_t k = begin; k < end; k++) {
        if (y >= tile[k].height) continue;
        const size_t first = (tile[k].y - image->y + y) * image->width + tile[k].x - image->x;
        hash = hash_add_pixels(hash_add_zeros(hash, first - next), image, channel, first, tile[k].width);
        next = first + tile[k].width;
      }
    }
  }
  return hash_fold(hash_add_zeros(hash, image->width * image->height - next));
}

/* A checksum, as text, of a part's pixels, tiles and number, which shows that a byte has changed. It is independent of
 * the order of the channels, which a file does not keep. */
static enum status make_sum(const struct image *image, const struct tile_list *tiles, const char *tile,
                            size_t tile_length, const char *done, size_t done_length, char out[SUM_SIZE])
{
  size_t count;
  struct rectangle *sorted = tiles_by_row(tiles, &count);
  if (sorted == NULL) return STATUS_LIMIT;
  uint64_t sum = hash_text(tile, tile_length) + 2 * hash_text(done, done_length);
  for (size_t c = 0; c < image->channel_count; c++) sum += hash_channel(image, c, sorted, count);
  snprintf(out, SUM_SIZE, "%016" PRIx64, sum);
  free(sorted);
  return STATUS_OK;
}

/* Whether the pixels are those that were written. */
static enum status check_sum(const struct piece *piece, char *message)
{
  const struct image *image = &piece->image;
  size_t tile_length = 0, done_length = 0, length = 0;
  const char *tile = image_metadata(image, "pscn:tile", &tile_length);
  const char *done = image_metadata(image, "pscn:done", &done_length); /* empty texts are not stored */
  const char *said = image_metadata(image, "pscn:sum", &length);
  char sum[SUM_SIZE];
  enum status status = make_sum(image, &piece->tiles, tile, tile_length, done == NULL ? "" : done, done_length, sum);
  if (status == STATUS_OK && !(length == SUM_SIZE - 1 && memcmp(said, sum, length) == 0)) status = STATUS_INPUT;
  return told(status, "it is damaged: its checksum is wrong", message);
}

/* The reading of a part: all of its metadata, and with `pixels` those of its tiles. */
struct reading {
  struct piece *piece;
  bool pixels;
};

static enum status wanted_areas(void *context, const struct image *image, const struct rectangle **out_area,
                                size_t *out_count, char *message)
{
  const struct reading *reading = context;
  struct piece *piece = reading->piece;
  (void)image; /* the piece's own */
  enum status status = read_tiles(piece);
  if (status == STATUS_OK) status = read_channels(piece);
  *out_area = piece->tiles.tile;
  *out_count = reading->pixels ? piece->tiles.count : 0;
  return told(status, "it is not a piece of a picture", message);
}

enum status piece_read(const char *path, bool pixels, struct piece *out, char *message)
{
  *out = (struct piece){0};
  struct reading reading = {out, pixels};
  const struct image_wanted wanted = {wanted_areas, &reading};
  enum status status = image_read_areas(path, &wanted, &out->image, message);
  if (status == STATUS_OK && pixels) status = check_sum(out, message);
  if (status != STATUS_OK) piece_destroy(out);
  return status;
}

int piece_compare(const struct image *part, const struct image *picture, char *out, size_t size)
{
  for (size_t k = 0; k < sizeof COMMON / sizeof *COMMON; k++) {
    size_t here = 0, there = 0;
    const char *a = image_metadata(part, COMMON[k].name, &here), *b = image_metadata(picture, COMMON[k].name, &there);
    if (a == NULL) a = "", here = 0; /* empty texts are not stored */
    if (b == NULL) b = "", there = 0;
    const int order = here == there ? memcmp(a, b, here) : here < there ? -1 : 1;
    if (order == 0) continue;
    snprintf(out, size, "its %s: '%.*s', not '%.*s'", COMMON[k].what, (int)here, a, (int)there, b);
    return order;
  }
  return 0;
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

static bool is_done(const void *tiles, size_t number) { return tile_is_done(tiles, number); }

/* The tiles that a part has, as indices in its list, and then those of which it has the first rows: "0-17,19,18:3". The
 * caller frees it; NULL if memory is short. */
static char *done_text(const struct tile_list *tiles)
{
  struct text_buffer text = {0};
  text_buffer_add_runs(&text, 0, tiles->count, is_done, tiles);
  for (size_t k = 0; k < tiles->count; k++) {
    const unsigned rows = atomic_load(&tiles->rows[k]);
    if (rows > 0 && rows < TILE_ROWS) text_buffer_format(&text, "%s%zu:%u", text.length > 0 ? "," : "", k, rows);
  }
  return text_buffer_take(&text);
}

/* Copies what is done, and nothing else, because the rest is still being written. */
static enum status copy_done(const struct piece *piece, struct piece *out)
{
  const enum status status = piece_create_like(piece, piece->number, piece->count, out);
  if (status != STATUS_OK) return status;
  for (size_t k = 0; k < out->tiles.count; k++) atomic_store(&out->tiles.rows[k], atomic_load(&piece->tiles.rows[k]));
  const struct piece done = {.image = piece->image, .tiles = out->tiles};
  (void)piece_copy(&done, &out->image); /* it has the channels */
  return STATUS_OK;
}

enum status piece_encode(const struct piece *piece, const struct image_attribute *attributes, size_t attribute_count,
                         unsigned char **out_bytes, size_t *out_size, char *message)
{
  enum { MOST = 32 };
  struct image_attribute all[MOST];
  struct piece copy;
  char tile[48], sum[SUM_SIZE], *done = NULL;
  assert(attribute_count + 3 <= MOST);
  *out_bytes = NULL;
  *out_size = 0;
  enum status status = copy_done(piece, &copy);
  if (status == STATUS_OK) done = done_text(&copy.tiles);
  snprintf(message, IMAGE_MESSAGE_SIZE, "out of memory");
  snprintf(tile, sizeof tile, "%zu/%zu", piece->number, piece->count);
  if (done == NULL) status = STATUS_LIMIT;
  else status = make_sum(&copy.image, &copy.tiles, tile, strlen(tile), done, strlen(done), sum);
  for (size_t k = 0; k < attribute_count; k++) all[k] = attributes[k];
  all[attribute_count] = (struct image_attribute){"pscn:tile", tile};
  all[attribute_count + 1] = (struct image_attribute){"pscn:done", done};
  all[attribute_count + 2] = (struct image_attribute){"pscn:sum", sum};
  const struct image_encoding encoding = {
    .format = IMAGE_EXR, .bits = 32, .tile = TILE_SIZE, .attributes = all, .attribute_count = attribute_count + 3};
  if (status == STATUS_OK) status = image_encode(&copy.image, &encoding, out_bytes, out_size, message);
  free(done);
  piece_destroy(&copy);
  return status;
}

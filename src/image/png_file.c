/* PNG, by libpng. */
#include "image/image_module.h"

#include <png.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/srgb.h"

/* A file that is being made. libpng leaves its functions by longjmp where they fail, so all that must outlive them
 * stands here. */
struct png_file {
  const struct image *image;
  const struct image_encoding *encoding;
  unsigned char *bytes, *row; /* owned: the file so far, and a row of pixels as it has them */
  size_t size, room;          /* of bytes */
  struct srgb_table table;
  enum status status; /* the reason of a failure */
  char *message;
};

/* ---- what libpng calls ---- */

static void fail(png_structp png, png_const_charp text)
{
  const struct png_file *file = png_get_error_ptr(png);
  if (file->status == STATUS_FILE) snprintf(file->message, IMAGE_MESSAGE_SIZE, "libpng: %s", text);
  png_longjmp(png, 1);
}

static void ignore(png_structp png, png_const_charp text) { (void)png, (void)text; }

/* realloc that keeps the reason of a failure. */
static void *resize(struct png_file *file, void *block, size_t size)
{
  void *larger = realloc(block, size);
  if (larger != NULL) return larger;
  file->status = STATUS_LIMIT;
  snprintf(file->message, IMAGE_MESSAGE_SIZE, "out of memory");
  return NULL;
}

static png_voidp allocate(png_structp png, png_alloc_size_t size) { return resize(png_get_mem_ptr(png), NULL, size); }

static void release(png_structp png, png_voidp block)
{
  (void)png;
  free(block);
}

static void append(png_structp png, png_bytep bytes, size_t size)
{
  struct png_file *file = png_get_io_ptr(png);
  if (size > file->room - file->size) {
    const size_t room = 2 * file->room + size;
    unsigned char *larger = resize(file, file->bytes, room);
    if (larger == NULL) png_error(png, "");
    file->bytes = larger;
    file->room = room;
  }
  memcpy(file->bytes + file->size, bytes, size);
  file->size += size;
}

static void flush_nothing(png_structp png) { (void)png; }

/* ---- the file ---- */

static void set_date(png_structp png, png_infop info, const char *value)
{
  png_time date;
  if (sscanf(value, "%hu:%hhu:%hhu %hhu:%hhu:%hhu", &date.year, &date.month, &date.day, &date.hour, &date.minute,
             &date.second) == 6)
    png_set_tIME(png, info, &date);
}

/* A line of metadata, as png_set_text would make of it; but libpng 1.6.39 loses memory if that fails. */
static void put_text(png_structp png, const char *name, const char *value)
{
  const size_t key = strlen(name) + 1, length = strlen(value);
  png_write_chunk_start(png, (png_const_bytep) "tEXt", (png_uint_32)(key + length));
  png_write_chunk_data(png, (png_const_bytep)name, key);
  png_write_chunk_data(png, (png_const_bytep)value, length);
  png_write_chunk_end(png);
}

/* All before the pixels: the chunks that OpenImageIO 2.4 writes, so that its readers find the same. */
static void put_head(png_structp png, png_infop info, const struct png_file *file)
{
  static const int types[] = {PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA, PNG_COLOR_TYPE_RGB, PNG_COLOR_TYPE_RGBA};
  const struct image_encoding *encoding = file->encoding;
  png_set_user_limits(png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
  png_set_IHDR(png, info, (png_uint_32)file->image->width, (png_uint_32)file->image->height, encoding->bits,
               types[file->image->channel_count - 1], PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_NO_FILTERS);
  png_set_sRGB_gAMA_and_cHRM(png, info, PNG_sRGB_INTENT_ABSOLUTE);
  png_set_oFFs(png, info, 0, 0, PNG_OFFSET_PIXEL);
  for (const char *name = NULL; (name = image_next_text(file->image, name)) != NULL;)
    if (strcmp(name, "DateTime") == 0) set_date(png, info, name + strlen(name) + 1);
  png_write_info(png, info);
  put_text(png, "oiio:ColorSpace", "sRGB");
  for (const char *name = NULL; (name = image_next_text(file->image, name)) != NULL;)
    if (strcmp(name, "DateTime") != 0) put_text(png, name, name + strlen(name) + 1);
}

/* Converts a row to the file's codes; those of 16 bits begin with the larger byte. */
static void fill_row(struct png_file *file, size_t y)
{
  const size_t count = file->image->width * file->image->channel_count;
  const float *value = file->image->value + y * count;
  const bool encoded = file->encoding->encoded;
  unsigned char *at = file->row;
  for (size_t k = 0; k < count; k++) {
    if (file->encoding->bits == 8) {
      *at++ = encoded ? srgb_code8(value[k]) : srgb_encode8(&file->table, value[k]);
    } else {
      const unsigned code = encoded ? srgb_code16(value[k]) : srgb_encode16(value[k]);
      *at++ = (unsigned char)(code >> 8);
      *at++ = (unsigned char)code;
    }
  }
}

static enum status put_rows(png_structp png, struct png_file *file)
{
  const struct image_encoding *encoding = file->encoding;
  const size_t height = file->image->height;
  if (encoding->bits == 8) srgb_table_fill(&file->table);
  for (size_t y = 0; y < height; y++) {
    fill_row(file, y);
    png_write_row(png, file->row);
    if (encoding->progress != NULL && !encoding->progress(encoding->context, (double)(y + 1) / (double)height))
      return STATUS_INTERRUPTED;
  }
  return STATUS_OK;
}

static enum status put_file(png_structp png, png_infop info, struct png_file *file)
{
  if (setjmp(png_jmpbuf(png)) != 0) return file->status;
  put_head(png, info, file);
  const enum status status = put_rows(png, file);
  if (status == STATUS_OK) png_write_end(png, info);
  else snprintf(file->message, IMAGE_MESSAGE_SIZE, "interrupted");
  return status;
}

enum status png_file_encode(const struct image *image, const struct image_encoding *encoding, unsigned char **out_bytes,
                            size_t *out_size, char *message)
{
  struct png_file file = {.image = image, .encoding = encoding, .status = STATUS_FILE, .message = message};
  enum status status = STATUS_FILE;
  snprintf(message, IMAGE_MESSAGE_SIZE, "libpng cannot be used");
  png_structp png = png_create_write_struct_2(PNG_LIBPNG_VER_STRING, &file, fail, ignore, &file, allocate, release);
  png_infop info = png == NULL ? NULL : png_create_info_struct(png);
  if (info != NULL) file.row = resize(&file, NULL, image->width * image->channel_count * (size_t)encoding->bits / 8);
  if (file.row != NULL) {
    png_set_write_fn(png, &file, append, flush_nothing);
    status = put_file(png, info, &file);
  } else status = file.status;
  png_destroy_write_struct(&png, &info);
  free(file.row);
  if (status != STATUS_OK) {
    free(file.bytes);
    return status;
  }
  *out_bytes = file.bytes;
  *out_size = file.size;
  return STATUS_OK;
}

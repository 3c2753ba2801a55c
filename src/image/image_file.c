/* Pictures to and from files: what the formats can hold, and the loading of the module that does the work. */
#include "image/image_file.h"

#include <dlfcn.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "base/input.h"
#include "image/image_module.h"

struct format_traits {
  const char *suffix;
  int bits[2]; /* the first is the default */
  size_t max_channels;
};

static const struct format_traits FORMATS[] = {
  [IMAGE_PNG] = { ".png", { 8, 16 }, 4 },
  [IMAGE_EXR] = { ".exr", { 16, 32 }, IMAGE_MAX_CHANNELS },
};

enum { FORMAT_COUNT = sizeof FORMATS / sizeof FORMATS[0] };

/* Of ASCII letters only, in any locale. */
static char lower(char c)
{
  return c >= 'A' && c <= 'Z' ? (char)(c - 'A' + 'a') : c;
}

static bool has_suffix(const char *path, const char *suffix)
{
  const size_t length = strlen(path), size = strlen(suffix);
  if (length <= size || path[length - size - 1] == '/')
    return false;
  size_t k = 0;
  while (k < size && lower(path[length - size + k]) == suffix[k])
    k++;
  return k == size;
}

bool image_format_of(const char *path, enum image_format *out)
{
  for (int format = 0; format < FORMAT_COUNT; format++) {
    if (has_suffix(path, FORMATS[format].suffix)) {
      *out = (enum image_format)format;
      return true;
    }
  }
  return false;
}

bool image_format_has_bits(enum image_format format, int bits)
{
  return bits == FORMATS[format].bits[0] || bits == FORMATS[format].bits[1];
}

int image_format_default_bits(enum image_format format)
{
  return FORMATS[format].bits[0];
}

/* The module stays loaded; asking again is cheap, so nothing needs to be remembered. NULL after writing the message. */
static const struct image_module *load_module(char *message)
{
  void *handle = dlopen(IMAGE_MODULE_FILE, RTLD_LAZY | RTLD_LOCAL | RTLD_NODELETE);
  const struct image_module *module = handle == NULL ? NULL : dlsym(handle, IMAGE_MODULE_SYMBOL);
  if (module == NULL)
    snprintf(message, IMAGE_MESSAGE_SIZE, "%s", dlerror());
  if (handle != NULL)
    dlclose(handle);
  return module;
}

enum status image_file_ready(char *message)
{
  message[0] = '\0';
  return load_module(message) == NULL ? STATUS_FILE : STATUS_OK;
}

enum status image_encode(const struct image *image, const struct image_encoding *encoding, unsigned char **out_bytes,
                         size_t *out_size, char *message)
{
  *out_bytes = NULL;
  *out_size = 0;
  message[0] = '\0';
  if (image->channel_count == 0 || image->channel_count > FORMATS[encoding->format].max_channels) {
    snprintf(message, IMAGE_MESSAGE_SIZE, "the format can not hold these channels");
    return STATUS_FILE;
  }
  const struct image_module *module = load_module(message);
  return module == NULL ? STATUS_FILE : module->encode(image, encoding, out_bytes, out_size, message);
}

enum status image_read(const char *path, struct image *out, char *message)
{
  *out = (struct image){ 0 };
  message[0] = '\0';
  const char *reason;
  const int file = input_open(path, INPUT_FILE, &reason);
  if (file < 0) {
    snprintf(message, IMAGE_MESSAGE_SIZE, "%s", reason);
    return STATUS_FILE;
  }
  (void)close(file); /* OpenImageIO opens files itself, each format anew, and says nothing of why it cannot */
  const struct image_module *module = load_module(message);
  return module == NULL ? STATUS_FILE : module->read(path, out, message);
}

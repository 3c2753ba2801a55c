/* Pictures to and from files: what the formats can hold, and the loading of the module that does the work. */
#define _DEFAULT_SOURCE /* MAP_ANONYMOUS, MAP_NORESERVE */
#include "image/image_file.h"

#include <dlfcn.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "base/input.h"
#include "image/image_module.h"

struct format_traits {
  const char *suffix;
  int bits[2]; /* the first is the default */
  size_t max_channels;
};

static const struct format_traits FORMATS[] = {
  [IMAGE_PNG] = {".png", {8, 16}, 4},
  [IMAGE_EXR] = {".exr", {16, 32}, IMAGE_MAX_CHANNELS},
};

enum { FORMAT_COUNT = sizeof FORMATS / sizeof FORMATS[0] };

/* Of ASCII letters only, in any locale. */
static char lower(char c) { return c >= 'A' && c <= 'Z' ? (char)(c - 'A' + 'a') : c; }

static bool has_suffix(const char *path, const char *suffix)
{
  const size_t length = strlen(path), size = strlen(suffix);
  if (length <= size || path[length - size - 1] == '/') return false;
  size_t k = 0;
  while (k < size && lower(path[length - size + k]) == suffix[k]) k++;
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

int image_format_default_bits(enum image_format format) { return FORMATS[format].bits[0]; }

/* Where address space runs out while they start, OpenImageIO and the libraries it brings along end the process instead of
 * saying so. So room is asked for first, that what they need is there: the libraries, and a stack and a heap for each of
 * OpenImageIO's threads, of which there are as many as processors. */
static bool room_for_module(void)
{
  const size_t libraries = (size_t)384 << 20, thread = (size_t)80 << 20;
  const long processors = sysconf(_SC_NPROCESSORS_ONLN);
  const size_t size = libraries + (processors > 0 ? (size_t)processors : 1) * thread;
  void *room = mmap(NULL, size, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (room != MAP_FAILED) (void)munmap(room, size);
  return room != MAP_FAILED;
}

/* Most of OpenImageIO's loading is looking for names of symbols in all libraries, one after the other. A library that is
 * opened before it looks in those that it needs itself only: these bring the most names along, and half of the time is
 * gone. The build knows what they are called (CMakeLists.txt); one that is not there costs nothing. */
static void load_first(int flags)
{
  static const char *const first[] = {IMAGE_MODULE_FIRST NULL};
  for (size_t k = 0; first[k] != NULL; k++) (void)dlopen(first[k], flags);
}

/* The module stays loaded; asking again is cheap, so nothing needs to be remembered. Writes the message on failure. */
static enum status load_module(const struct image_module **out, char *message)
{
  const int flags = RTLD_LAZY | RTLD_LOCAL | RTLD_NODELETE;
  message[0] = '\0';
  void *handle = dlopen(IMAGE_MODULE_FILE, flags | RTLD_NOLOAD);
  if (handle == NULL && !room_for_module()) {
    snprintf(message, IMAGE_MESSAGE_SIZE, "there is too little memory to load OpenImageIO");
    return STATUS_LIMIT;
  }
  if (handle == NULL) {
    load_first(flags);
    handle = dlopen(IMAGE_MODULE_FILE, flags);
  }
  *out = handle == NULL ? NULL : dlsym(handle, IMAGE_MODULE_SYMBOL);
  if (*out == NULL) snprintf(message, IMAGE_MESSAGE_SIZE, "%s", dlerror());
  if (handle != NULL) dlclose(handle);
  return *out == NULL ? STATUS_FILE : STATUS_OK;
}

enum status image_file_ready(char *message)
{
  const struct image_module *module;
  return load_module(&module, message);
}

enum status image_encode(const struct image *image, const struct image_encoding *encoding, unsigned char **out_bytes,
                         size_t *out_size, char *message)
{
  *out_bytes = NULL;
  *out_size = 0;
  if (image->channel_count == 0 || image->channel_count > FORMATS[encoding->format].max_channels) {
    snprintf(message, IMAGE_MESSAGE_SIZE, "the format can not hold these channels");
    return STATUS_FILE;
  }
  const struct image_module *module;
  const enum status status = load_module(&module, message);
  return status == STATUS_OK ? module->encode(image, encoding, out_bytes, out_size, message) : status;
}

static enum status read_file(const char *path, bool pixels, struct image *out, char *message)
{
  *out = (struct image){0};
  const char *reason;
  const int file = input_open(path, INPUT_FILE, &reason);
  if (file < 0) {
    snprintf(message, IMAGE_MESSAGE_SIZE, "%s", reason);
    return STATUS_FILE;
  }
  (void)close(file); /* OpenImageIO opens files itself, each format anew, and says nothing of why it cannot */
  const struct image_module *module;
  const enum status status = load_module(&module, message);
  return status == STATUS_OK ? module->read(path, pixels, out, message) : status;
}

enum status image_read(const char *path, struct image *out, char *message)
{
  return read_file(path, true, out, message);
}

enum status image_read_header(const char *path, struct image *out, char *message)
{
  return read_file(path, false, out, message);
}

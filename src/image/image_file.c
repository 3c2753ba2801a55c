/* Reads and writes picture files: the limits of the formats, and the loading of the module that does the work for all but PNG
 * that is written. */
#define _DEFAULT_SOURCE /* MAP_ANONYMOUS, MAP_NORESERVE */
#include "image/image_file.h"

#include <dlfcn.h>
#include <errno.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/mman.h>
#include <unistd.h>

#include "base/input.h"
#include "base/module.h"
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

bool image_format_of(const char *path, enum image_format *out)
{
  const char *suffix = strrchr(path, '.');
  for (int format = 0; format < FORMAT_COUNT && suffix != NULL && suffix > path && suffix[-1] != '/'; format++) {
    if (strcasecmp(suffix, FORMATS[format].suffix) != 0) continue;
    *out = (enum image_format)format;
    return true;
  }
  return false;
}

bool image_format_has_bits(enum image_format format, int bits)
{
  return bits == FORMATS[format].bits[0] || bits == FORMATS[format].bits[1];
}

int image_format_default_bits(enum image_format format) { return FORMATS[format].bits[0]; }

static void *wait_at(void *gate)
{
  pthread_mutex_lock(gate);
  pthread_mutex_unlock(gate);
  return NULL;
}

/* Whether `count` threads can exist at once. */
static bool room_for_threads(size_t count)
{
  pthread_mutex_t gate = PTHREAD_MUTEX_INITIALIZER;
  pthread_t *threads = malloc(count * sizeof *threads);
  size_t started = 0;
  if (threads == NULL) return false;
  pthread_mutex_lock(&gate);
  while (started < count && pthread_create(&threads[started], NULL, wait_at, &gate) == 0) started++;
  pthread_mutex_unlock(&gate);
  for (size_t k = 0; k < started; k++) pthread_join(threads[k], NULL);
  free(threads);
  return started == count;
}

static bool room_for_bytes(size_t size, int protection)
{
  void *room = mmap(NULL, size, protection, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (room != MAP_FAILED) (void)munmap(room, size);
  return room != MAP_FAILED;
}

/* If address space, memory or threads run out while they start, OpenImageIO and its libraries end the process without a
 * message. So we first test for the room they need: for the libraries, their data, four threads of a library's and one
 * of OpenImageIO's for each processor, besides as many of ours, each with a stack and a heap. */
static bool room_for_module(void)
{
  const size_t libraries = (size_t)384 << 20, data = (size_t)160 << 20, heap = (size_t)80 << 20;
  const long here = sysconf(_SC_NPROCESSORS_ONLN);
  const size_t processors = here > 0 ? (size_t)here : 1;
  return room_for_bytes(libraries + processors * heap, PROT_NONE) && room_for_bytes(data, PROT_READ | PROT_WRITE) &&
         room_for_threads(4 + 2 * processors);
}

/* Most of OpenImageIO's loading time goes into looking up symbols in all libraries, one after another. A library that
 * is opened before it looks only in those that it needs itself. The ones opened here have the most symbols, and this
 * halves the time. The build knows their names (CMakeLists.txt); a missing one costs nothing. */
static void load_first(int flags)
{
  static const char *const first[] = {IMAGE_MODULE_FIRST NULL};
  for (size_t k = 0; first[k] != NULL; k++) (void)dlopen(first[k], flags);
}

/* The module stays loaded, and asking again is cheap, so nothing is remembered. Writes the message on failure. */
static enum status load_module(const struct image_module **out, char *message)
{
  const int flags = RTLD_LAZY | RTLD_LOCAL | RTLD_NODELETE;
  message[0] = '\0';
  void *handle = module_open(IMAGE_MODULE_FILE, flags | RTLD_NOLOAD);
  if (handle == NULL && !room_for_module()) {
    snprintf(message, IMAGE_MESSAGE_SIZE, "there is too little memory, or too few threads, to load OpenImageIO");
    return STATUS_LIMIT;
  }
  if (handle == NULL) {
    load_first(flags);
    handle = module_open(IMAGE_MODULE_FILE, flags);
  }
  const struct image_module *module = handle == NULL ? NULL : dlsym(handle, IMAGE_MODULE_SYMBOL);
  *out = NULL;
  if (module == NULL) snprintf(message, IMAGE_MESSAGE_SIZE, "%s", dlerror());
  else if (module->image_size != sizeof(struct image) || module->encoding_size != sizeof(struct image_encoding))
    snprintf(message, IMAGE_MESSAGE_SIZE, IMAGE_MODULE_FILE " is of another build");
  else *out = module;
  if (handle != NULL) dlclose(handle);
  return *out == NULL ? STATUS_FILE : STATUS_OK;
}

enum status image_file_ready(char *message)
{
  const struct image_module *module;
  const enum status status = load_module(&module, message);
  return status == STATUS_OK ? module->begin(message) : status;
}

enum status image_encode(const struct image *image, const struct image_encoding *encoding, unsigned char **out_bytes,
                         size_t *out_size, char *message)
{
  *out_bytes = NULL;
  *out_size = 0;
  if (image->channel_count == 0 || image->channel_count > FORMATS[encoding->format].max_channels) {
    snprintf(message, IMAGE_MESSAGE_SIZE, "the format cannot hold these channels");
    return STATUS_FILE;
  }
  if (encoding->format == IMAGE_PNG) return png_file_encode(image, encoding, out_bytes, out_size, message);
  const struct image_module *module;
  const enum status status = load_module(&module, message);
  return status == STATUS_OK ? module->encode(image, encoding, out_bytes, out_size, message) : status;
}

/* The first bytes of the formats that are read. OpenImageIO would try all its readers on a file, and some of them trust
 * any content. */
static const struct {
  const char *begin;
  size_t length;
  const char *format; /* OpenImageIO's name */
} READ[] = {{"\x89PNG\r\n\x1a\n", 8, "png"},
            {"\x76\x2f\x31\x01", 4, "openexr"},
            {"II*\0", 4, "tiff"},
            {"MM\0*", 4, "tiff"},
            {"\xff\xd8\xff", 3, "jpeg"}};

/* OpenImageIO's name of the file's format, or NULL if it is none of these. Closes the file. */
static const char *format_of_content(int file)
{
  char begin[8] = {0};
  ssize_t got;
  do got = read(file, begin, sizeof begin);
  while (got < 0 && errno == EINTR);
  (void)close(file); /* OpenImageIO opens the file itself */
  for (size_t k = 0; got == (ssize_t)sizeof begin && k < sizeof READ / sizeof READ[0]; k++)
    if (memcmp(begin, READ[k].begin, READ[k].length) == 0) return READ[k].format;
  return NULL;
}

enum status image_read_areas(const char *path, const struct image_wanted *wanted, struct image *out, char *message)
{
  *out = (struct image){0};
  const char *reason;
  const int file = input_open(path, INPUT_FILE, &reason);
  const char *format = file < 0 ? NULL : format_of_content(file);
  if (format == NULL) {
    snprintf(message, IMAGE_MESSAGE_SIZE, "%s", file < 0 ? reason : "it is not a PNG, EXR, TIFF or JPEG");
    return STATUS_FILE;
  }
  const struct image_module *module;
  const enum status status = load_module(&module, message);
  return status == STATUS_OK ? module->read(path, format, wanted, out, message) : status;
}

enum status image_read(const char *path, struct image *out, char *message)
{
  return image_read_areas(path, NULL, out, message);
}

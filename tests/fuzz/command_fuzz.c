/* Commands, run as main runs them, in a folder of their own, with FUZZ_COMMAND one of
 *   FUZZ_RAYS         `pscn trace`: two bytes say which scene, solver and form, the rest is standard input
 *   FUZZ_POLYNOMIALS  `pscn roots`: two bytes say which solver and format, the rest is standard input
 *   FUZZ_OPTIONS      any command: the first byte says which, the rest are its arguments, parted by line ends
 *   FUZZ_PICTURES     `pscn compare`: five bytes say what pictures are like, the rest is their values
 */
#define _XOPEN_SOURCE 700 /* nftw */
#include <fcntl.h>
#include <ftw.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "command/command.h"
#include "image/image_file.h"
#include "target.h"

enum { FUZZ_RAYS = 1, FUZZ_POLYNOMIALS, FUZZ_OPTIONS, FUZZ_PICTURES };

static const uint8_t nothing[1];

#define TURN(list, byte) list[(byte) % (sizeof list / sizeof *list)]
#define ARGUMENTS(...) ((const char *[]){__VA_ARGS__, NULL})

static void put(const char *path, const void *bytes, size_t size)
{
  FILE *file = fopen(path, "wb");
  assert(file && fwrite(bytes, 1, size, file) == size && fclose(file) == 0);
}

/* Runs a command with these bytes as standard input. Returns its exit code. */
static int run(const char *argv[], const uint8_t *data, size_t size)
{
  const struct command *command = command_find(argv[0]);
  int argc = 0;
  while (argv[argc]) argc++;
  put("standard-input", data, size);
  const int input = open("standard-input", O_RDONLY);
  assert(command && input >= 0 && dup2(input, STDIN_FILENO) == STDIN_FILENO && close(input) == 0);
  const int code = (int)command_run(command, argc, argv);
  assert(code >= STATUS_OK && code <= STATUS_LIMIT);
  assert(fflush(stdout) == 0);
  return code;
}

/* ---- the folder ---- */

static const char *const keep[] = {".", "./s.pscn", "./i.inc", "./a.png", "./b.exr"};

static int remove_made(const char *path, const struct stat *state, int type, struct FTW *walk)
{
  (void)state, (void)type, (void)walk;
  for (size_t k = 0; k < sizeof keep / sizeof *keep; k++)
    if (strcmp(path, keep[k]) == 0) return 0;
  return remove(path);
}

static void clean(void) { (void)nftw(".", remove_made, 8, FTW_DEPTH | FTW_PHYS); }

static char folder[] = "pscn-fuzz-XXXXXX";

static void leave(void)
{
  clean();
  for (size_t k = 1; k < sizeof keep / sizeof *keep; k++) (void)remove(keep[k]);
  if (chdir("..") == 0) (void)rmdir(folder);
}

/* Makes a scene, its include file, and two pictures of it, which the arguments of FUZZ_OPTIONS may name. */
static void enter(void)
{
  static const char scene[] =
    "#include \"i.inc\"\n#ifndef (Low) #declare Low = 0; #end\ncamera { location <0, 1, -3> look_at 0 }\n"
    "light_source { <1, 5, -5>, rgb 1 }\nbicubic_patch { type 1 <-1,Low,-1><-.3,0,-1><.3,0,-1><1,0,-1>\n"
    "<-1,0,-.3><-.3,1,-.3><.3,1,-.3><1,0,-.3> <-1,0,.3><-.3,1,.3><.3,1,.3><1,0,.3>\n"
    "<-1,0,1><-.3,0,1><.3,0,1><1,0,1> texture { Red } }\n";
  static const char include[] = "#declare Red = texture { pigment { rgb <1, 0, 0> } finish { phong 1 } }\n";
  if (!mkdtemp(folder) || chdir(folder) != 0) abort();
  (void)atexit(leave);
  put("s.pscn", scene, sizeof scene - 1);
  put("i.inc", include, sizeof include - 1);
  assert(run(ARGUMENTS("render", "s.pscn", "--size=8x6", "-q", "-o", "a.png"), nothing, 0) == STATUS_OK);
  assert(run(ARGUMENTS("render", "s.pscn", "--size=8x6", "-q", "-o", "b.exr", "--channels=rgb,depth"), nothing, 0) ==
         0);
}

/* ---- the commands ---- */

static void trace(const uint8_t *data, size_t size)
{
  static const char *const scenes[] = {"scenes/inside", "scenes/bent", "scenes/degrees", "scenes/paper",
                                       "tests/fuzz/seeds/render/pole"};
  static const char *const solvers[] = {"bernstein",
                                        "aberth",
                                        "newton",
                                        "laguerre",
                                        "durand_kerner",
                                        "aberth { polish off split 1 }",
                                        "laguerre { form paper }",
                                        "bernstein { split 1 }",
                                        "newton { basis power split 2 start previous }"};
  char path[1000];
  (void)snprintf(path, sizeof path, PSCN_SOURCE_DIR "/%s.pscn", TURN(scenes, data[0]));
  const char *argv[10] = {"trace", path, "-q", "--solver", TURN(solvers, data[1] & 15)};
  int argc = 5;
  if (data[1] & 16) argv[argc++] = "--binary";
  if (data[1] & 32) argv[argc++] = "--certainty";
  if (data[1] & 64) argv[argc++] = "--all";
  if (data[1] & 128) argv[argc++] = "--explain";
  run(argv, data + 2, size - 2);
}

static void roots(const uint8_t *data, size_t size)
{
  static const char *const solvers[] = {"bernstein",
                                        "aberth",
                                        "newton",
                                        "laguerre",
                                        "durand_kerner",
                                        "bernstein { basis power }",
                                        "aberth { basis bernstein }",
                                        "newton { basis bernstein }",
                                        "laguerre { basis bernstein }",
                                        "durand_kerner { basis bernstein }",
                                        "aberth { form paper }",
                                        "newton { form paper }",
                                        "laguerre { form paper }",
                                        "aberth { start previous radii circle stop step horner plain update jacobi }",
                                        "newton { deflation composite refine on start previous max_iterations 3 }",
                                        "laguerre { tolerance 1e-300 }"};
  static const char *const formats[] = {"plain", "table", "json"};
  run(ARGUMENTS("roots", "-q", "--solver", TURN(solvers, data[0]), "--format", TURN(formats, data[1]),
                data[1] >= 192   ? "--iterates"
                : data[1] >= 128 ? "--tolerance=1e-9"
                                 : "--stats=s.json"),
      data + 2, size - 2);
}

/* File names may have no folder, so that all files stay in this one. Options that bound the run time are appended, and
 * so take effect. */
static void options(const uint8_t *data, size_t size)
{
  enum { MOST = 20, TYPED = 1 };
  static const char *const commands[] = {"render", "trace", "roots", "dump", "compare", "check", "chart", "help"};
  static const char *const limits[][5] = {
    {"--size=16x12", "--samples=1", "--threads=2"},
    {NULL},
    {NULL},
    {NULL},
    {NULL},
    {"--size=8x6", "--steps=0", "--timeout=5", "--povray=/bin/false"},
    {"--size=4x3", "--rays=1", "--rounds=1", "--quick", "--no-peers"},
    {NULL},
  };
  char text[2000];
  const char *argv[TYPED + MOST + 5 + 1];
  int argc = 0;
  if (size >= sizeof text || memchr(data, '/', size) || memchr(data, '\0', size)) return;
  const size_t which = data[0] % (sizeof commands / sizeof *commands);
  memcpy(text, data + 1, size - 1);
  text[size - 1] = '\0';
  argv[argc++] = commands[which];
  for (char *word = strtok(text, "\n"); word && argc < MOST; word = strtok(NULL, "\n")) argv[argc++] = word;
  for (int k = 0; k < 5 && limits[which][k]; k++) argv[argc++] = limits[which][k];
  argv[argc] = NULL;
  static const char polynomials[] = "1 0 -1\n";
  run(argv, (const uint8_t *)polynomials, sizeof polynomials - 1);
}

struct picture_form {
  enum image_format format;
  int bits;
  bool encoded;
};

/* Writes a picture with these values and reads it back: EXR with 32 bits keeps them. */
static void write_picture(const char *path, const struct image *image, const struct picture_form *form)
{
  const struct image_encoding encoding = {.format = form->format, .bits = form->bits, .encoded = form->encoded};
  unsigned char *bytes;
  size_t size;
  char message[IMAGE_MESSAGE_SIZE];
  struct image again;
  assert(image_encode(image, &encoding, &bytes, &size, message) == STATUS_OK);
  put(path, bytes, size);
  free(bytes);
  assert(image_read(path, &again, message) == STATUS_OK);
  assert(again.width == image->width && again.height == image->height);
  assert(again.channel_count == image->channel_count);
  const size_t values = image->width * image->height * image->channel_count;
  if (form->format == IMAGE_EXR && form->bits == 32)
    assert(memcmp(again.value, image->value, values * sizeof *image->value) == 0);
  image_destroy(&again);
}

/* A picture with any values is equal to itself. It is also compared with another one, with any result. */
static void pictures(const uint8_t *data, size_t size)
{
  enum { HEAD = 5 };
  static const char *const names[] = {"R", "G", "B", "A", "depth", "u"}; /* in EXR's order */
  static const char *const lists[] = {"R", "B,R", "depth", "R,G,B,A,depth", "", "R,,G"};
  if (size < HEAD) return;
  const bool exr = data[0] & 1;
  const struct picture_form form = {.format = exr ? IMAGE_EXR : IMAGE_PNG,
                                    .bits = data[0] & 2 ? (exr ? 32 : 16) : (exr ? 16 : 8),
                                    .encoded = data[0] & 4};
  const size_t width = 1 + data[1] % 8U, height = 1 + data[2] % 8U, channels = 1 + data[3] % (exr ? 6U : 4U);
  struct image image;
  assert(image_create(width, height, channels, &image) == STATUS_OK);
  for (size_t c = 0; c < image.channel_count; c++)
    (void)snprintf(image.channel[c].name, IMAGE_NAME_SIZE, "%s", names[c]);
  const size_t room = image.width * image.height * image.channel_count * sizeof *image.value;
  memcpy(image.value, data + HEAD, size - HEAD < room ? size - HEAD : room);
  const char *first = exr ? "1.exr" : "1.png", *second = exr ? "2.exr" : "2.png";
  write_picture(first, &image, &form);
  put(second, "", 0);
  assert(run(ARGUMENTS("compare", first, first, "-q", "--fail=0"), nothing, 0) == STATUS_OK);
  if (size > HEAD + room)
    memcpy(image.value, data + HEAD + room, size - HEAD - room < room ? size - HEAD - room : room);
  write_picture(second, &image, &form);
  const char *list = TURN(lists, data[4] & 63);
  if (data[4] & 64) /* this waits for the disk */
    run(
      ARGUMENTS("compare", first, second, "--channels", list, "--scale=1e30", "-o", data[4] & 128 ? "d.png" : "d.exr"),
      nothing, 0);
  else if (data[4] & 128) run(ARGUMENTS("compare", "a.png", second, "--channels", list), nothing, 0);
  else run(ARGUMENTS("compare", first, second, "--hardfail=1", "--warn=0.5"), nothing, 0);
  image_destroy(&image);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  static bool entered;
  if (!entered) enter();
  entered = true;
  if (size < 2) return 0;
  if (FUZZ_COMMAND == FUZZ_RAYS) trace(data, size);
  else if (FUZZ_COMMAND == FUZZ_POLYNOMIALS) roots(data, size);
  else if (FUZZ_COMMAND == FUZZ_OPTIONS) options(data, size);
  else pictures(data, size);
  clean();
  return 0;
}

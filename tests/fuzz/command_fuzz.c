/* Commands, run as main runs them, with FUZZ_COMMAND one of
 *   FUZZ_RAYS         `pscn trace`: the first byte says which scene and which form, the rest is standard input
 *   FUZZ_POLYNOMIALS  `pscn roots`: the first byte says which solver and format, the rest is standard input
 *   FUZZ_OPTIONS      any command: the bytes are its arguments, parted by line ends
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "command/command.h"
#include "target.h"

enum { FUZZ_RAYS = 1, FUZZ_POLYNOMIALS, FUZZ_OPTIONS };

/* The bytes become what is read from standard input. */
static void feed(const uint8_t *data, size_t size)
{
  static FILE *file;
  if (!file) {
    file = tmpfile();
    assert(file && dup2(fileno(file), STDIN_FILENO) == STDIN_FILENO);
  }
  assert(ftruncate(STDIN_FILENO, 0) == 0 && lseek(STDIN_FILENO, 0, SEEK_SET) == 0);
  for (ssize_t put; size > 0; data += put, size -= (size_t)put) {
    put = write(STDIN_FILENO, data, size);
    assert(put > 0);
  }
  assert(lseek(STDIN_FILENO, 0, SEEK_SET) == 0);
}

static void run(int argc, const char **argv)
{
  const struct command *command = command_find(argv[0]);
  if (!command) return;
  const int code = command->run(command, argc, argv);
  assert(code >= STATUS_OK && code <= STATUS_LIMIT);
  assert(fflush(stdout) == 0);
}

#define TURN(list, byte) list[(byte) % (sizeof list / sizeof *list)]

static void trace(const uint8_t *data, size_t size)
{
  static const char *const scenes[] = {"inside", "bent", "degrees", "paper", "paper_magnified"};
  static const char *const solvers[] = {"bernstein", "aberth", "newton", "laguerre", "aberth { polish off split 1 }"};
  char path[1000];
  (void)snprintf(path, sizeof path, PSCN_SOURCE_DIR "/scenes/%s.pscn", TURN(scenes, data[0]));
  const char *argv[] = {"trace", path, "-q", "--solver", TURN(solvers, data[0] / 5), "--binary", NULL};
  feed(data + 1, size - 1);
  run(data[0] >= 200 ? 6 : 5, argv);
}

static void roots(const uint8_t *data, size_t size)
{
  static const char *const solvers[] = {"bernstein",
                                        "aberth",
                                        "newton",
                                        "laguerre",
                                        "bernstein { basis power }",
                                        "aberth { basis bernstein }",
                                        "newton { basis bernstein }",
                                        "aberth { form paper }"};
  const char *argv[] = {"roots", "-q", "--solver", TURN(solvers, data[0]), NULL};
  feed(data + 1, size - 1);
  run(4, argv);
}

/* No names of files with a folder: what is written stays in the current one. Pictures and charts take too long: what
 * would be made of a scene ends where it is not there, and none is read from standard input. */
static void options(const uint8_t *data, size_t size)
{
  enum { MOST = 20 };
  static const char *const commands[] = {"render", "trace", "roots", "dump", "compare", "check", "chart", "help"};
  static char text[2000];
  const char *argv[MOST + 3];
  int argc = 1;
  if (size >= sizeof text || memchr(data, '/', size) || memchr(data, '\0', size)) return;
  memcpy(text, data + 1, size - 1);
  text[size - 1] = '\0';
  argv[0] = TURN(commands, data[0]);
  for (char *word = strtok(text, "\n"); word && argc < MOST; word = strtok(NULL, "\n")) {
    if (strcmp(word, "-") == 0) return;
    argv[argc++] = word;
  }
  if (data[0] >= 128) argv[argc++] = "there-is-none.pscn";
  argv[argc] = NULL;
  feed(NULL, 0);
  run(argc, argv);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  if (size == 0) return 0;
  if (FUZZ_COMMAND == FUZZ_RAYS) trace(data, size);
  else if (FUZZ_COMMAND == FUZZ_POLYNOMIALS) roots(data, size);
  else options(data, size);
  return 0;
}

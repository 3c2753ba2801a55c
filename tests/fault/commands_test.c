/* The commands when memory or threads run out: each is run as often as it allocates, and each time another
 * allocation fails. It ends with exit code 5 and a word on stderr, or as ever where what failed could be done
 * without; a file that it writes is whole or not there; nothing leaks (the sanitizers look).
 *
 * The linker hands every call of malloc, calloc, realloc, strdup and pthread_create in commands and library to the
 * functions below. What jansson and OpenImageIO allocate is theirs.
 */
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cmocka_test.h"
#include "command/command.h"

enum { LEAST = 8, MOST_ARGUMENTS = 16 };

/* Calls that succeed before one fails; negative: all do. */
static long left = -1, threads_left = -1;

static bool fails(void) { return left >= 0 && left-- == 0; }

void *__real_malloc(size_t size);
void *__real_calloc(size_t count, size_t size);
void *__real_realloc(void *block, size_t size);
char *__real_strdup(const char *text);
int __real_pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*run)(void *), void *argument);
void *__wrap_malloc(size_t size);
void *__wrap_calloc(size_t count, size_t size);
void *__wrap_realloc(void *block, size_t size);
char *__wrap_strdup(const char *text);
int __wrap_pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*run)(void *), void *argument);

void *__wrap_malloc(size_t size) { return fails() ? NULL : __real_malloc(size); }
void *__wrap_calloc(size_t count, size_t size) { return fails() ? NULL : __real_calloc(count, size); }
void *__wrap_realloc(void *block, size_t size) { return fails() ? NULL : __real_realloc(block, size); }
char *__wrap_strdup(const char *text) { return fails() ? NULL : __real_strdup(text); }

int __wrap_pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*run)(void *), void *argument)
{
  if (threads_left >= 0 && threads_left-- == 0) return EAGAIN;
  return __real_pthread_create(thread, attributes, run, argument);
}

static char folder[] = "/tmp/pscn-fault-XXXXXX";
static char input[64], output[64], errors[64], answers[64], stats[64];

static size_t size_of(const char *path)
{
  struct stat s;
  return stat(path, &s) == 0 ? (size_t)s.st_size : 0;
}

/* Runs a command with its streams in files; answers its exit code. */
static int run(const char *const arguments[])
{
  const char *argv[MOST_ARGUMENTS] = {NULL};
  int argc = 0, saved[3];
  while (arguments[argc]) argv[argc] = arguments[argc], argc++;
  const char *const paths[3] = {input, answers, errors};
  const struct command *command = command_find(argv[0]);
  assert_non_null(command);
  fflush(NULL);
  for (int k = 0; k < 3; k++) {
    const int file = open(paths[k], k == 0 ? O_RDONLY : O_WRONLY | O_CREAT | O_TRUNC, 0600);
    saved[k] = dup(k);
    assert_true(file >= 0 && saved[k] >= 0 && dup2(file, k) == k);
    close(file);
  }
  const int code = command->run(command, argc, argv);
  fflush(NULL);
  for (int k = 0; k < 3; k++) dup2(saved[k], k), close(saved[k]);
  return code;
}

/* Lets the calls that `counter` counts fail one after the other. Answers how many there are. */
static long fail_each(const char *const arguments[], long *counter, bool writes)
{
  remove(output);
  assert_int_equal(run(arguments), STATUS_OK);
  const size_t whole = size_of(output), answered = size_of(answers);
  assert_true(!writes || whole > 0);
  for (long n = 0;; n++) {
    remove(output);
    *counter = n;
    const int code = run(arguments);
    const bool failed = *counter < 0;
    *counter = -1;
    if (code == STATUS_OK) assert_true(size_of(output) == whole && size_of(answers) == answered);
    if (code != STATUS_OK && code != STATUS_LIMIT)
      fail_msg("%s: exit code %d where call %ld fails", arguments[0], code, n);
    if (code == STATUS_LIMIT) assert_true(size_of(errors) > 0);
    /* Statistics are written after the picture. */
    assert_true(size_of(output) == whole || access(output, F_OK) != 0);
    if (!failed) {
      assert_int_equal(code, STATUS_OK);
      return n;
    }
  }
}

static void feed(const char *text)
{
  FILE *file = fopen(input, "w");
  assert_non_null(file);
  assert_true(fputs(text, file) >= 0 && fclose(file) == 0);
}

static void test_render(void **state)
{
  (void)state;
  const char *const plain[] = {"render", PSCN_SOURCE_DIR "/scenes/dome.pscn", "--size", "9x7", "--quiet", "-o", output,
                               NULL};
  const char *const more[] =
      {"render",   PSCN_SOURCE_DIR "/scenes/nested.pscn", "--size",  "9x7", "--threads", "2",    "--quiet",
       "--solver", "aberth { start previous }",           "--stats", stats, "-o",        output, NULL};
  assert_true(fail_each(plain, &left, true) > LEAST);
  assert_true(fail_each(more, &left, true) > LEAST);
}

static void test_render_threads(void **state)
{
  (void)state;
  const char *const arguments[] = {"render", PSCN_SOURCE_DIR "/scenes/dome.pscn", "--size", "200x150", "--threads", "3",
                                   "--quiet", "-o", output, NULL};
  assert_true(fail_each(arguments, &threads_left, true) > 0);
}

static void test_others(void **state)
{
  (void)state;
  const char *const dump[] = {"dump", PSCN_SOURCE_DIR "/scenes/nested.pscn", NULL};
  const char *const trace[] = {"trace", PSCN_SOURCE_DIR "/scenes/dome.pscn", "--quiet", NULL};
  const char *const roots[] = {"roots", "--quiet", NULL};
  assert_true(fail_each(dump, &left, false) > LEAST);
  feed("0 3 -9 0 -0.25 1\n0 3 -9 1 0 0\n");
  assert_true(fail_each(trace, &left, false) > LEAST);
  feed("1 0 -1\n1 -6 11 -6\n");
  assert_true(fail_each(roots, &left, false) > 0);
  feed("");
}

static void test_compare(void **state)
{
  (void)state;
  char picture[64];
  snprintf(picture, sizeof picture, "%s/picture.png", folder);
  const char *const render[] = {"render",  PSCN_SOURCE_DIR "/scenes/dome.pscn",
                                "--size",  "9x7",
                                "--quiet", "-o",
                                picture,   NULL};
  const char *const compare[] = {"compare", picture, picture, "-o", output, NULL};
  assert_int_equal(run(render), STATUS_OK);
  assert_true(fail_each(compare, &left, true) > LEAST);
  remove(picture);
}

int main(void)
{
  if (!mkdtemp(folder)) return EXIT_FAILURE;
  snprintf(input, sizeof input, "%s/input", folder);
  snprintf(output, sizeof output, "%s/output.png", folder);
  snprintf(errors, sizeof errors, "%s/errors", folder);
  snprintf(answers, sizeof answers, "%s/answers", folder);
  snprintf(stats, sizeof stats, "%s/stats", folder);
  feed("");
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_render),
      cmocka_unit_test(test_render_threads),
      cmocka_unit_test(test_others),
      cmocka_unit_test(test_compare),
  };
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  remove(input), remove(output), remove(errors), remove(answers), remove(stats), rmdir(folder);
  return failed;
}

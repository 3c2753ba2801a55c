/* The commands when memory, threads, files or processes fail: each is run as often as it makes a call, and each time
 * another one fails. It ends with exit code 5 (memory, threads) or 4 and a word on stderr, or as ever where what failed
 * could be done without; a file that it writes is whole or what it was; no other is left; nothing leaks (the sanitizers
 * look).
 *
 * The linker hands every such call in commands and library to the functions below. What jansson and OpenImageIO allocate
 * is theirs.
 */
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cmocka_test.h"
#include "command/command.h"

enum { LEAST = 8, MOST_ARGUMENTS = 16 };

enum call { ALLOCATE, THREAD, OPEN, WRITE, FSYNC, FCHMOD, LINK, RENAME, CLOSE, FORK, PIPE, CALLS };

/* Of one kind of call: how many succeed before one fails; negative: all do. `armed` only while a command runs. */
static enum call failing;
static long left = -1;
static bool armed;

static bool fails(enum call call) { return armed && call == failing && left >= 0 && left-- == 0; }

static int failure(int reason)
{
  errno = reason;
  return -1;
}

void *__real_malloc(size_t size);
void *__real_calloc(size_t count, size_t size);
void *__real_realloc(void *block, size_t size);
char *__real_strdup(const char *text);
int __real_pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*run)(void *), void *argument);
int __real_open(const char *path, int flags, ...);
ssize_t __real_write(int file, const void *bytes, size_t size);
int __real_fsync(int file);
int __real_fchmod(int file, mode_t mode);
int __real_linkat(int from_folder, const char *from, int to_folder, const char *to, int flags);
int __real_rename(const char *from, const char *to);
int __real_close(int file);
pid_t __real_fork(void);
int __real_pipe(int files[2]);
void *__wrap_malloc(size_t size);
void *__wrap_calloc(size_t count, size_t size);
void *__wrap_realloc(void *block, size_t size);
char *__wrap_strdup(const char *text);
int __wrap_pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*run)(void *), void *argument);
int __wrap_open(const char *path, int flags, ...);
ssize_t __wrap_write(int file, const void *bytes, size_t size);
int __wrap_fsync(int file);
int __wrap_fchmod(int file, mode_t mode);
int __wrap_linkat(int from_folder, const char *from, int to_folder, const char *to, int flags);
int __wrap_rename(const char *from, const char *to);
int __wrap_close(int file);
pid_t __wrap_fork(void);
int __wrap_pipe(int files[2]);

void *__wrap_malloc(size_t size) { return fails(ALLOCATE) ? NULL : __real_malloc(size); }
void *__wrap_calloc(size_t count, size_t size) { return fails(ALLOCATE) ? NULL : __real_calloc(count, size); }
void *__wrap_realloc(void *block, size_t size) { return fails(ALLOCATE) ? NULL : __real_realloc(block, size); }
char *__wrap_strdup(const char *text) { return fails(ALLOCATE) ? NULL : __real_strdup(text); }

int __wrap_pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*run)(void *), void *argument)
{
  return fails(THREAD) ? EAGAIN : __real_pthread_create(thread, attributes, run, argument);
}

int __wrap_open(const char *path, int flags, ...)
{
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = va_arg(arguments, mode_t); /* whatever it is where there is none */
  va_end(arguments);
  return fails(OPEN) ? failure(EMFILE) : __real_open(path, flags, mode);
}

ssize_t __wrap_write(int file, const void *bytes, size_t size)
{
  return fails(WRITE) ? failure(ENOSPC) : __real_write(file, bytes, size);
}

int __wrap_fsync(int file) { return fails(FSYNC) ? failure(EIO) : __real_fsync(file); }
int __wrap_fchmod(int file, mode_t mode) { return fails(FCHMOD) ? failure(EPERM) : __real_fchmod(file, mode); }
int __wrap_rename(const char *from, const char *to) { return fails(RENAME) ? failure(EIO) : __real_rename(from, to); }

int __wrap_linkat(int from_folder, const char *from, int to_folder, const char *to, int flags)
{
  return fails(LINK) ? failure(ENOSPC) : __real_linkat(from_folder, from, to_folder, to, flags);
}

int __wrap_close(int file)
{
  const bool told = fails(CLOSE);
  const int result = __real_close(file); /* a file is closed even where that fails */
  return told ? failure(EIO) : result;
}

pid_t __wrap_fork(void) { return fails(FORK) ? failure(EAGAIN) : __real_fork(); }
int __wrap_pipe(int files[2]) { return fails(PIPE) ? failure(EMFILE) : __real_pipe(files); }

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
  armed = true;
  const int code = command->run(command, argc, argv);
  armed = false;
  fflush(NULL);
  for (int k = 0; k < 3; k++) dup2(saved[k], k), close(saved[k]);
  return code;
}

static void put(const char *path, const char *text)
{
  FILE *file = fopen(path, "w");
  assert_non_null(file);
  assert_true(fputs(text, file) >= 0 && fclose(file) == 0);
}

static void expect_no_litter(void)
{
  DIR *here = opendir(folder);
  assert_non_null(here);
  for (const struct dirent *entry; (entry = readdir(here)) != NULL;)
    if (strncmp(entry->d_name, ".pscn", 5) == 0) fail_msg("'%s' is left behind", entry->d_name);
  closedir(here);
}

/* Lets the calls of that kind fail one after the other. Answers how many there are. `old`: what the file to be written
 * held before, or NULL. */
static long fail_each(const char *const arguments[], enum call call, bool writes, const char *old)
{
  const int expected = call == ALLOCATE || call == THREAD ? STATUS_LIMIT : STATUS_FILE;
  remove(output);
  assert_int_equal(run(arguments), STATUS_OK);
  const size_t whole = size_of(output), answered = size_of(answers);
  assert_true(!writes || whole > 0);
  failing = call;
  for (long n = 0;; n++) {
    remove(output), remove(stats);
    if (old) put(output, old);
    left = n;
    const int code = run(arguments);
    const bool failed = left < 0;
    left = -1;
    if (code == STATUS_OK) assert_true(!writes || size_of(output) == whole);
    if (code == STATUS_OK) assert_int_equal(size_of(answers), answered);
    const bool include = call == OPEN && code == STATUS_INPUT; /* an error of the scene that includes */
    if (code != STATUS_OK && code != expected && !include)
      fail_msg("%s: exit code %d where call %ld of kind %d fails", arguments[0], code, n, call);
    if (code != STATUS_OK) assert_true(size_of(errors) > 0);
    /* Picture and statistics appear together. */
    if (code != STATUS_OK || !writes) assert_true(old ? size_of(output) == strlen(old) : access(output, F_OK) != 0);
    if (code != STATUS_OK) assert_true(access(stats, F_OK) != 0);
    expect_no_litter();
    if (!failed) {
      assert_int_equal(code, STATUS_OK);
      remove(output);
      return n;
    }
  }
}

/* Lets every kind of call on files fail. */
static void fail_files(const char *const arguments[], bool writes)
{
  static const enum call calls[] = {OPEN, WRITE, FSYNC, FCHMOD, LINK, RENAME, CLOSE};
  for (size_t k = 0; k < sizeof calls / sizeof calls[0]; k++) {
    const long made = fail_each(arguments, calls[k], writes, NULL);
    const long replaced = writes ? fail_each(arguments, calls[k], writes, "old") : 1;
    assert_true(replaced > 0 && (made > 0 || !writes || calls[k] == FCHMOD || calls[k] == RENAME));
  }
}

static void feed(const char *text) { put(input, text); }

static void test_render(void **state)
{
  (void)state;
  const char *const plain[] = {"render", PSCN_SOURCE_DIR "/scenes/dome.pscn", "--size", "9x7", "--quiet", "-o", output,
                               NULL};
  const char *const more[] = {
    "render",   PSCN_SOURCE_DIR "/scenes/nested.pscn", "--size",  "9x7", "--threads", "2",    "--quiet",
    "--solver", "aberth { start previous }",           "--stats", stats, "-o",        output, NULL};
  assert_true(fail_each(plain, ALLOCATE, true, NULL) > LEAST);
  assert_true(fail_each(more, ALLOCATE, true, NULL) > LEAST);
  fail_files(more, true);
}

static void test_render_threads(void **state)
{
  (void)state;
  const char *const arguments[] = {
    "render", PSCN_SOURCE_DIR "/scenes/dome.pscn", "--size", "200x150", "--threads", "3", "--quiet", "-o", output,
    NULL};
  assert_true(fail_each(arguments, THREAD, true, NULL) > 0);
}

static void test_others(void **state)
{
  (void)state;
  const char *const dump[] = {"dump", PSCN_SOURCE_DIR "/scenes/nested.pscn", NULL};
  const char *const trace[] = {"trace", PSCN_SOURCE_DIR "/scenes/dome.pscn", "--quiet", "--stats", stats, NULL};
  const char *const all[] = {"trace", "--all", PSCN_SOURCE_DIR "/scenes/dome.pscn", "--quiet", NULL};
  const char *const roots[] = {"roots", "--quiet", "--stats", stats, NULL};
  assert_true(fail_each(dump, ALLOCATE, false, NULL) > LEAST);
  feed("0 3 -9 0 -0.25 1\n0 3 -9 1 0 0\n");
  assert_true(fail_each(trace, ALLOCATE, false, NULL) > LEAST);
  feed("0 3 -9 0 -0.25 1\n0 3 -9 1 0 0\n0 1 0 0 1 0\n"); /* the last one meets the pole: the last resort's lists too */
  assert_true(fail_each(all, ALLOCATE, false, NULL) > LEAST);
  fail_files(trace, false);
  fail_files(dump, false);
  feed("1 0 -1\n1 -6 11 -6\n");
  assert_true(fail_each(roots, ALLOCATE, false, NULL) > 0);
  fail_files(roots, false);
  feed("");
}

static void test_compare(void **state)
{
  (void)state;
  char picture[64];
  snprintf(picture, sizeof picture, "%s/picture.png", folder);
  const char *const render[] = {
    "render", PSCN_SOURCE_DIR "/scenes/dome.pscn", "--size", "9x7", "--quiet", "-o", picture, NULL};
  const char *const compare[] = {"compare", picture, picture, "-o", output, NULL};
  assert_int_equal(run(render), STATUS_OK);
  assert_true(fail_each(compare, ALLOCATE, true, NULL) > LEAST);
  fail_files(compare, true);
  remove(picture);
}

/* POV-Ray cannot be started: nothing is written. */
static void test_check_processes(void **state)
{
  (void)state;
  char results[64];
  snprintf(results, sizeof results, "%s/check", folder);
  const char *const arguments[] = {
    "check", PSCN_SOURCE_DIR "/scenes/dome.pscn", "--quiet", "--povray", "/bin/true", "--size", "8x6", "-o", results,
    NULL};
  for (enum call call = FORK; call <= PIPE; call++) {
    failing = call, left = 0;
    assert_int_equal(run(arguments), STATUS_FILE);
    assert_true(left < 0 && size_of(errors) > 0 && access(results, F_OK) != 0);
    left = -1;
  }
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
    cmocka_unit_test(test_render),  cmocka_unit_test(test_render_threads),  cmocka_unit_test(test_others),
    cmocka_unit_test(test_compare), cmocka_unit_test(test_check_processes),
  };
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  remove(input), remove(output), remove(errors), remove(answers), remove(stats), rmdir(folder);
  return failed;
}

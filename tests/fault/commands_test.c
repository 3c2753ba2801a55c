/* The commands when memory, threads, files or processes fail: each is run as often as it makes a call, and each time
 * another one fails. It ends with exit code 5 (memory, threads) or 4 and a word on stderr, or as ever where what failed
 * could be done without; a file that it writes is whole or what it was; no other is left; nothing leaks (the sanitizers
 * look).
 */
#define _DEFAULT_SOURCE /* MAP_ANONYMOUS */
#include <dirent.h>
#include <fcntl.h>
#include <jansson.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cmocka_test.h"
#include "command/command.h"
#include "effort.h"
#include "fault/calls.h"
#include "files.h"

enum { LEAST = 8, MOST_ARGUMENTS = 24 };

static char folder[] = "/tmp/pscn-fault-XXXXXX";
static char input[64], output[64], errors[64], answers[64], stats[64], results[64], page[80], povray[64], picture[64];
static char kept[80]; /* what was rendered of `output` and could not be written there */

/* jansson's allocations, if they are to count as ours. */
static void *json_block(size_t size) { return malloc(size); }

static size_t size_of(const char *path)
{
  struct stat s;
  return stat(path, &s) == 0 ? (size_t)s.st_size : 0;
}

/* Runs a command with its streams in files. Returns its exit code. */
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
  const int code = (int)command_run(command, argc, argv);
  armed = false;
  fflush(NULL);
  for (int k = 0; k < 3; k++) dup2(saved[k], k), close(saved[k]);
  return code;
}

static void expect_no_litter(void)
{
  DIR *here = opendir(folder);
  assert_non_null(here);
  for (const struct dirent *entry; (entry = readdir(here)) != NULL;)
    if (strncmp(entry->d_name, ".pscn", 5) == 0 || strncmp(entry->d_name, "pscn-", 5) == 0)
      fail_msg("'%s' is left behind", entry->d_name);
  closedir(here);
}

/* What a command leaves: only its answers, a file (`output`, with `stats`), a folder of files (`results`). */
enum leaves { NOTHING, FILES, FOLDER };

static size_t count_results(void)
{
  size_t count = 0;
  DIR *here = opendir(results);
  if (!here) return 0;
  for (const struct dirent *entry; (entry = readdir(here)) != NULL;) count += entry->d_name[0] != '.';
  closedir(here);
  return count;
}

/* Restores the initial state: nothing, or an old file of that name. */
static void prepare(enum leaves leaves, const char *old)
{
  remove(output), remove(kept), remove(stats), remove_all(results);
  if (!old) return;
  if (leaves == FOLDER) assert_int_equal(mkdir(results, 0700), 0);
  put_text(leaves == FOLDER ? page : output, old);
}

/* Asserts that after a command that failed everything is as before. */
static void expect_as_before(enum leaves leaves, const char *old)
{
  const char *path = leaves == FOLDER ? page : output;
  assert_true(old ? size_of(path) == strlen(old) : access(path, F_OK) != 0);
  assert_true(access(stats, F_OK) != 0);
  if (leaves == FOLDER) assert_true(old ? count_results() == 1 : access(results, F_OK) != 0);
}

/* Whether an error is reported more than once. */
static bool repeats(const char *text)
{
  for (const char *line = text, *next; (next = strchr(line, '\n')) != NULL; line = next) {
    const size_t length = (size_t)(++next - line);
    for (const char *other = next; (other = strstr(other, ": error: ")) != NULL; other++) {
      const char *begin = other;
      while (begin > next && begin[-1] != '\n') begin--;
      if (strncmp(begin, line, length) == 0) return true;
    }
  }
  return false;
}

/* Fails the test, with the messages, if the exit code is wrong, or a word is missing or superfluous. */
static void expect_told(bool right, const char *command, enum call call, long n, int code)
{
  char text[1000];
  FILE *file = fopen(errors, "r");
  const size_t length = file ? fread(text, 1, sizeof text - 1, file) : 0;
  text[length] = '\0';
  if (file) fclose(file);
  if (!right || strstr(text, ": \n") || repeats(text))
    fail_msg("%s: exit code %d where call %ld of kind %d fails: %s", command, code, n, call, text);
}

static bool fits(int code, enum call call)
{
  if (call == ALLOCATE || call == ALLOCATE_AT || call == THREAD || call == MMAP) return code == STATUS_LIMIT;
  return code == STATUS_FILE || (call == OPEN && code == STATUS_INPUT); /* an error in the scene that includes it */
}

/* Lets each call of this kind fail in turn; or, for a command that takes memory thousands of times and starts programs,
 * the first one of each place that takes memory. Commands that make folders take long: if the effort is small, only
 * every fifth call of theirs fails (PSCN_SEED: which), except calls that start processes. Returns the number of calls.
 * `old`: the former content of the file to be written, or of the folder's page, or NULL. */
static long fail_each(const char *const arguments[], enum call call, enum leaves leaves, const char *old)
{
  prepare(leaves, NULL);
  failing = call;
  place_count = 0;
  assert_int_equal(run(arguments), STATUS_OK);
  const size_t whole = size_of(output), answered = size_of(answers), files = count_results();
  assert_true(leaves == NOTHING || (leaves == FILES ? whole : files) > 0);
  const bool long_run = leaves == FOLDER && call != FORK && call != PIPE;
  const long step = long_run && effort_fraction() < EFFORT_DEFAULT ? 5 : 1;
  for (long n = (long)(effort_seed(0) % (uint64_t)step);; n += step) {
    prepare(leaves, old);
    atomic_store(left, n);
    const int code = run(arguments);
    const bool failed = atomic_load(left) < 0;
    atomic_store(left, -1);
    expect_told(code == STATUS_OK || fits(code, call), arguments[0], call, n, code);
    if (code != STATUS_OK) {
      assert_true(size_of(errors) > 0);
      expect_as_before(leaves, old);
    } else if (leaves == FOLDER) { /* the figure may be missing, with a message */
      assert_true(count_results() == files || (count_results() == files - 1 && size_of(errors) > 0));
    } else {
      assert_int_equal(size_of(answers), answered);
      assert_int_equal(size_of(output), leaves == FILES ? whole : 0);
    }
    expect_no_litter();
    if (!failed && (call != ALLOCATE_AT || n >= place_count)) {
      assert_int_equal(code, STATUS_OK);
      prepare(leaves, NULL);
      return n;
    }
  }
}

/* Lets every kind of call on files fail. */
static void fail_files(const char *const arguments[], enum leaves leaves)
{
  static const enum call calls[] = {OPEN, WRITE, FSYNC, FCHMOD, LINK, RENAME, CLOSE, FOPEN, FCLOSE, MKDIR, MKDTEMP};
  for (size_t k = 0; k < sizeof calls / sizeof calls[0]; k++) {
    const bool always = calls[k] != FCHMOD && calls[k] != RENAME && calls[k] < FOPEN;
    const long made = fail_each(arguments, calls[k], leaves, NULL);
    assert_true(leaves == NOTHING || !always || made > 0);
    const bool naming = calls[k] == FCHMOD || calls[k] == LINK || calls[k] == RENAME; /* of an existing file */
    if (leaves == FILES || (leaves == FOLDER && naming))
      assert_true(fail_each(arguments, calls[k], leaves, "old") > 0 || calls[k] >= FOPEN);
  }
}

static void feed(const char *text) { put_text(input, text); }

/* A picture that `compare` reads, and with which the program below answers. */
static void make_picture(void)
{
  const char *const render[] = {
    "render", PSCN_SOURCE_DIR "/scenes/dome.pscn", "--size", "8x6", "--quiet", "-o", picture, NULL};
  if (access(picture, F_OK) != 0) assert_int_equal(run(render), STATUS_OK);
}

/* The first test. Room for OpenImageIO is reserved before it is loaded, which happens once: PNG is written without it. */
TEST(test_first_picture)
{
  const char *const compare[] = {"compare", picture, picture, NULL};
  make_picture();
  failing = MMAP;
  atomic_store(left, 0);
  assert_int_equal(run(compare), STATUS_LIMIT);
  assert_true(atomic_load(left) < 0 && size_of(errors) > 0);
  expect_as_before(FILES, NULL);
}

TEST(test_render)
{
  const char *const plain[] = {"render", PSCN_SOURCE_DIR "/scenes/dome.pscn", "--size", "9x7", "--quiet", "-o", output,
                               NULL};
  const char *const more[] = {
    "render",   PSCN_SOURCE_DIR "/scenes/nested.pscn", "--size",  "9x7", "--threads", "2",    "--quiet",
    "--solver", "aberth { start previous }",           "--stats", stats, "-o",        output, NULL};
  assert_true(fail_each(plain, ALLOCATE, FILES, NULL) > LEAST);
  assert_true(fail_each(more, ALLOCATE_AT, FILES, NULL) > LEAST);
  fail_files(more, FILES);
}

TEST(test_render_threads)
{
  const char *const arguments[] = {
    "render", PSCN_SOURCE_DIR "/scenes/dome.pscn", "--size", "200x150", "--threads", "3", "--quiet", "-o", output,
    NULL};
  assert_true(fail_each(arguments, THREAD, FILES, NULL) > 0);
}

TEST(test_others)
{
  const char *const dump[] = {"dump", PSCN_SOURCE_DIR "/scenes/nested.pscn", NULL};
  const char *const trace[] = {"trace", PSCN_SOURCE_DIR "/scenes/dome.pscn", "--quiet", "--stats", stats, NULL};
  const char *const all[] = {"trace", "--all", PSCN_SOURCE_DIR "/scenes/dome.pscn", "--quiet", NULL};
  const char *const twice[] = {"trace", "--all", PSCN_SOURCE_DIR "/tests/fault/twice.pscn", "--quiet", NULL};
  const char *const roots[] = {"roots", "--quiet", "--stats", stats, NULL};
  const char *const json[] = {"roots", "--quiet", "--format", "json", NULL};
  assert_true(fail_each(dump, ALLOCATE, NOTHING, NULL) > LEAST);
  feed("0 3 -9 0 -0.25 1\n0 3 -9 1 0 0\n");
  assert_true(fail_each(trace, ALLOCATE, NOTHING, NULL) > LEAST);
  feed("0 3 -9 0 -0.25 1\n0 3 -9 1 0 0\n0 1 0 0 1 0\n"); /* the last one meets the pole, for the last resort's lists */
  assert_true(fail_each(all, ALLOCATE, NOTHING, NULL) > LEAST);
  assert_true(fail_each(twice, ALLOCATE, NOTHING, NULL) > LEAST);
  fail_files(trace, NOTHING);
  fail_files(dump, NOTHING);
  feed("1 0 -1\n1 -6 11 -6\n");
  json_malloc_t get;
  json_free_t release;
  json_get_alloc_funcs(&get, &release);
  json_set_alloc_funcs(json_block, free);
  assert_true(fail_each(roots, ALLOCATE, NOTHING, NULL) > LEAST);
  assert_true(fail_each(json, ALLOCATE, NOTHING, NULL) > LEAST);
  json_set_alloc_funcs(get, release);
  fail_files(roots, NOTHING);
  feed("");
}

/* The pieces of a picture: none is changed, and the picture is complete or absent. */
TEST(test_merge)
{
  char piece[2][80];
  for (int k = 0; k < 2; k++) {
    const char *const numbers[] = {"1/2", "2/2"};
    snprintf(piece[k], sizeof piece[k], "%s/piece%d.exr", folder, k);
    const char *const render[] = {
      "render", PSCN_SOURCE_DIR "/scenes/dome.pscn", "--size", "70x40", "--quiet", "--tile", numbers[k], "-o", piece[k],
      NULL};
    assert_int_equal(run(render), STATUS_OK);
  }
  const char *const merge[] = {"merge", piece[1], piece[0], "--quiet", "-o", output, NULL};
  assert_true(fail_each(merge, ALLOCATE, FILES, NULL) > LEAST);
  assert_true(fail_each(merge, WRITE, FILES, "old") > 0);
  assert_true(fail_each(merge, FSYNC, FILES, "old") > 0);
  for (int k = 0; k < 2; k++) remove(piece[k]);
}

TEST(test_compare)
{
  const char *const compare[] = {"compare", picture, picture, "-o", output, NULL};
  make_picture();
  assert_true(fail_each(compare, ALLOCATE, FILES, NULL) > LEAST);
  fail_files(compare, FILES);
}

TEST(test_standard_input)
{
  const char *const dump[] = {"dump", "-", NULL};
  feed("camera { location -z }\n");
  assert_int_equal(fail_each(dump, DUP, NOTHING, NULL), 1);
  feed("");
}

/* A program that answers as POV-Ray does: the picture, a hit for every ray, a time. */
static const char POVRAY[] = "#!/bin/sh\n"
                             "[ \"$1\" = --version ] && { echo 'POV-Ray 3.7.0'; exit; }\n"
                             "sed -n 's/^Ask(.*/1/p' scene.pov >answers.txt\n"
                             "cat %s >picture.png\n"
                             "echo 'Trace Time: 0 hours 0 minutes 0 seconds (0.1 seconds)'\n"
                             "echo '  using 1 thread(s) with 0.100 CPU-seconds total'\n";

static void make_povray(void)
{
  char text[sizeof POVRAY + sizeof picture];
  snprintf(text, sizeof text, POVRAY, picture);
  put_text(povray, text);
  assert_int_equal(chmod(povray, 0700), 0);
}

/* The command line of a check of SCENE. */
#define CHECK_OF(scene)                                                                                            \
  {                                                                                                                \
    "check", PSCN_SOURCE_DIR scene, "--quiet", "--povray", povray, "--size", "8x6", "--steps", "0", "--grid", "2", \
      "--failpercent", "100", "--failpsnr", "0", "--failmask", "100", "-o", results, NULL                          \
  }

TEST(test_check)
{
  const char *const arguments[] = CHECK_OF("/tests/cli/scenes/bent.pscn");
  make_picture();
  snprintf(page, sizeof page, "%s/check.html", results);
  assert_true(fail_each(arguments, FORK, FOLDER, NULL) > 1); /* POV-Ray */
  assert_true(fail_each(arguments, PIPE, FOLDER, "old") > 1);
  fail_files(arguments, FOLDER);
}

/* The scene's file is copied with everything that it includes. */
TEST(test_check_includes)
{
  const char *const arguments[] = CHECK_OF("/scenes/nested.pscn");
  make_picture();
  snprintf(page, sizeof page, "%s/check.html", results);
  assert_true(fail_each(arguments, OPEN, FOLDER, NULL) > 2);
  assert_true(fail_each(arguments, FOPEN, FOLDER, "old") > 2);
  assert_true(fail_each(arguments, FCLOSE, FOLDER, NULL) > 2);
  assert_true(fail_each(arguments, ALLOCATE_AT, FOLDER, NULL) > LEAST);
}

TEST(test_chart)
{
  const char *const arguments[] = {"chart",      PSCN_SOURCE_DIR "/scenes/bent.pscn",
                                   "--solver",   "bernstein",
                                   "--quiet",    "--quick",
                                   "--size",     "1x1",
                                   "--rays",     "1",
                                   "--rounds",   "1",
                                   "--no-peers", "-o",
                                   results,      NULL};
  snprintf(page, sizeof page, "%s/chart.html", results);
  assert_true(fail_each(arguments, FORK, FOLDER, NULL) == 1); /* gnuplot */
  assert_true(fail_each(arguments, PIPE, FOLDER, "old") == 1);
  fail_files(arguments, FOLDER);
  assert_true(fail_each(arguments, ALLOCATE_AT, FOLDER, NULL) > LEAST);
}

int main(int argc, char **argv)
{
  if (argc > 1) cmocka_set_test_filter(argv[1]); /* a single test by its name, by hand */
  left = mmap(NULL, sizeof *left, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (left == MAP_FAILED || !mkdtemp(folder)) return EXIT_FAILURE;
  atomic_init(left, -1);
  setenv("TMPDIR", folder, 1);
  snprintf(input, sizeof input, "%s/input", folder);
  snprintf(output, sizeof output, "%s/output.png", folder);
  snprintf(kept, sizeof kept, "%s.part.exr", output);
  snprintf(errors, sizeof errors, "%s/errors", folder);
  snprintf(answers, sizeof answers, "%s/answers", folder);
  snprintf(stats, sizeof stats, "%s/stats", folder);
  snprintf(results, sizeof results, "%s/results", folder);
  snprintf(povray, sizeof povray, "%s/povray", folder);
  snprintf(picture, sizeof picture, "%s/picture.png", folder);
  feed("");
  make_povray();
  const int failed = test_run();
  remove_all(folder);
  return failed;
}

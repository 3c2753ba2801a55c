/* Reading when memory runs out: the nth allocation fails, for every n that a text needs. Each time the answer is
 * STATUS_LIMIT with something told, or, where what failed could be done without, the same scene; nothing leaks (the
 * sanitizers look).
 *
 * The linker hands every call of malloc, calloc, realloc and strdup in the library to the functions below.
 */
#include <math.h>
#include <stdlib.h>
#include <unistd.h>

#include "cmocka_test.h"
#include "language/language.h"

enum { LEAST = 6 }; /* allocations that reading surely takes */

static long left = -1; /* allocations that succeed before one fails; negative: all do */

static bool fails(void) { return left >= 0 && left-- == 0; }

void *__real_malloc(size_t size);
void *__real_calloc(size_t count, size_t size);
void *__real_realloc(void *block, size_t size);
char *__real_strdup(const char *text);
void *__wrap_malloc(size_t size);
void *__wrap_calloc(size_t count, size_t size);
void *__wrap_realloc(void *block, size_t size);
char *__wrap_strdup(const char *text);

void *__wrap_malloc(size_t size) { return fails() ? NULL : __real_malloc(size); }
void *__wrap_calloc(size_t count, size_t size) { return fails() ? NULL : __real_calloc(count, size); }
void *__wrap_realloc(void *block, size_t size) { return fails() ? NULL : __real_realloc(block, size); }
char *__wrap_strdup(const char *text) { return fails() ? NULL : __real_strdup(text); }

static void count(void *context, const char *text, size_t length)
{
  (void)text, (void)length;
  ++*(size_t *)context;
}

/* How many allocations reading the file takes; each of them has failed once then. */
static long run(const char *path, enum status expected)
{
  const struct language_settings settings = {
    .image_width = 800, .image_height = 600, .solver_text = "aberth { polish off }", .tolerance = 1e-9};
  long n = 0;
  for (;; n++) {
    size_t told = 0;
    struct diagnostics diagnostics = {.tell = count, .context = &told};
    struct scene *scene = NULL;
    left = n;
    const enum status status = language_load(path, &settings, &diagnostics, &scene);
    const bool failed = left < 0;
    left = -1;
    assert_int_equal(status == STATUS_OK, scene != NULL);
    assert_true(status == expected || status == STATUS_LIMIT);
    /* Without memory for the text of an error it is counted all the same. */
    assert_int_equal(status != STATUS_OK, diagnostics.error_count > 0);
    scene_destroy(scene);
    if (!failed) {
      assert_int_equal(status, expected);
      return n;
    }
  }
}

static void test_scenes(void **state)
{
  (void)state;
  static const char *const files[] = {"ok/includes.pscn", "ok/nesting.pscn",    "ok/textures.pscn",
                                      "ok/solvers.pscn",  "ok/conditions.pscn", "ok/povray_files.pscn"};
  for (size_t k = 0; k < sizeof files / sizeof *files; k++) assert_true(run(files[k], STATUS_OK) > LEAST);
}

static void test_errors(void **state)
{
  (void)state;
  static const char *const files[] = {"bad/include_missing.pscn", "bad/misspelt_keyword.pscn", "bad/types.pscn",
                                      "bad/missing_brace.pscn"};
  for (size_t k = 0; k < sizeof files / sizeof *files; k++) assert_true(run(files[k], STATUS_INPUT) > LEAST);
}

int main(void)
{
  if (chdir(PSCN_SOURCE_DIR "/tests/language") != 0) return 1;
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_scenes), cmocka_unit_test(test_errors)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}

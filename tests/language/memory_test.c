/* Proves that reading survives a lack of memory: the nth allocation fails, for every n that a text needs. Each time the
 * status is STATUS_LIMIT with a message, or the scene is the same, if reading could do without the allocation. Nothing
 * leaks (the sanitizers check).
 *
 * The linker passes every call of malloc, calloc, realloc and strdup in the library to the functions below, and every
 * call of arena_alloc, which asks for memory only once in many calls. */
#define _DEFAULT_SOURCE /* scandir */
#include <dirent.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/arena.h"
#include "cmocka_test.h"
#include "language/language.h"

enum { LEAST = 6 }; /* allocations that reading takes at least */

static long left = -1; /* allocations that succeed before one fails; negative: all do */

static bool fails(void) { return left >= 0 && left-- == 0; }

void *__real_malloc(size_t size);
void *__real_calloc(size_t count, size_t size);
void *__real_realloc(void *block, size_t size);
char *__real_strdup(const char *text);
void *__real_arena_alloc(struct arena *arena, size_t count, size_t size);
void *__wrap_malloc(size_t size);
void *__wrap_calloc(size_t count, size_t size);
void *__wrap_realloc(void *block, size_t size);
char *__wrap_strdup(const char *text);
void *__wrap_arena_alloc(struct arena *arena, size_t count, size_t size);

void *__wrap_malloc(size_t size) { return fails() ? NULL : __real_malloc(size); }
void *__wrap_calloc(size_t count, size_t size) { return fails() ? NULL : __real_calloc(count, size); }
void *__wrap_realloc(void *block, size_t size) { return fails() ? NULL : __real_realloc(block, size); }
char *__wrap_strdup(const char *text) { return fails() ? NULL : __real_strdup(text); }

void *__wrap_arena_alloc(struct arena *arena, size_t count, size_t size)
{
  return fails() ? NULL : __real_arena_alloc(arena, count, size);
}

static void count(void *context, const char *text, size_t length)
{
  (void)text, (void)length;
  ++*(size_t *)context;
}

static enum status load(const char *path, size_t *out_errors)
{
  const struct language_settings settings = {.image_width = 800,
                                             .image_height = 600,
                                             .solver_text = "aberth { polish off }",
                                             .tolerance = 1e-9,
                                             .max_work = 2000};
  size_t told = 0;
  struct diagnostics diagnostics = {.tell = count, .context = &told};
  struct scene *scene = NULL;
  const enum status status = language_load(path, &settings, &diagnostics, &scene);
  assert_int_equal(status == STATUS_OK, scene != NULL);
  scene_destroy(scene);
  *out_errors = diagnostics.error_count;
  return status;
}

/* The number of allocations that reading the file takes. Each of them has failed once. */
static long run(const char *path)
{
  size_t errors;
  const enum status expected = load(path, &errors);
  for (long n = 0;; n++) {
    left = n;
    const enum status status = load(path, &errors);
    const bool failed = left < 0;
    left = -1;
    assert_true(status == expected || status == STATUS_LIMIT);
    /* An error counts even without memory for its text. */
    assert_int_equal(status != STATUS_OK, errors > 0);
    if (!failed) {
      assert_int_equal(status, expected);
      return n;
    }
  }
}

static int is_scene(const struct dirent *entry)
{
  const char *suffix = strrchr(entry->d_name, '.');
  return suffix && strcmp(suffix, ".pscn") == 0;
}

static void run_folder(const char *folder)
{
  struct dirent **files;
  assert_int_equal(chdir(folder), 0);
  const int found = scandir(".", &files, is_scene, alphasort);
  assert_true(found > LEAST);
  for (int k = 0; k < found; k++) {
    if (run(files[k]->d_name) <= LEAST) fail_msg("%s takes no memory", files[k]->d_name);
    free(files[k]);
  }
  free(files);
}

TEST(test_scenes) { run_folder(PSCN_SOURCE_DIR "/tests/language/ok"); }

TEST(test_errors) { run_folder(PSCN_SOURCE_DIR "/tests/language/bad"); }

/* The language by example.
 *
 * bad/NAME.pscn is wrong: bad/NAME.errors holds what is told, to the letter, and then the status as "exit N" unless it is
 * 3, STATUS_INPUT.
 * ok/NAME.pscn is right: ok/NAME.dump holds its canonical text, which read again gives itself, without the first lines
 * that are those of ok/empty.dump.
 *
 * With PSCN_UPDATE set in the environment the expected files are written instead; look at what changed.
 */
#include <dirent.h>
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cmocka_test.h"
#include "files.h"
#include "language/language.h"
#include "scene/dump.h"

static const struct language_settings SETTINGS = {
  .image_width = 800, .image_height = 600, .tolerance = NAN, .max_work = 200000};

static void tell(void *context, const char *text, size_t length)
{
  assert_int_equal(fwrite(text, 1, length, context), length);
}

static const char USUAL[] = "exit 3\n"; /* may stand at the end of a file, too */

/* Whether the file holds this text. On request the text is written to it. */
static bool is_expected(const char *path, const char *text, size_t length)
{
  if (getenv("PSCN_UPDATE")) {
    put_bytes(path, text, length);
    return true;
  }
  FILE *file = fopen(path, "rb");
  if (!file) {
    print_error("%s is missing\n", path);
    return false;
  }
  char *expected = malloc(length + sizeof USUAL);
  assert_non_null(expected);
  size_t got = fread(expected, 1, length + sizeof USUAL, file);
  if (got >= sizeof USUAL && memcmp(expected + got - (sizeof USUAL - 1), USUAL, sizeof USUAL - 1) == 0)
    got -= sizeof USUAL - 1;
  (void)fclose(file);
  const bool same = got == length && memcmp(expected, text, length) == 0;
  if (!same) print_error("%s is not what was told:\n%.*s\n", path, (int)length, text);
  free(expected);
  return same;
}

static bool bad_case(const char *path, const char *expected_path)
{
  char *text = NULL;
  size_t length = 0;
  FILE *memory = open_memstream(&text, &length);
  assert_non_null(memory);
  struct diagnostics diagnostics = {.tell = tell, .context = memory};
  struct scene *scene = NULL;
  const enum status status = language_load(path, &SETTINGS, &diagnostics, &scene);
  assert_int_not_equal(status, STATUS_OK);
  assert_null(scene);
  assert_true(diagnostics.error_count > 0);
  if (status != STATUS_INPUT) (void)fprintf(memory, "exit %d\n", (int)status);
  assert_int_equal(fclose(memory), 0);
  const bool same = is_expected(expected_path, text, length);
  free(text);
  return same;
}

/* The dump of a scene, freed by the caller. */
static char *dump(const struct scene *scene, size_t *length)
{
  char *text = NULL;
  FILE *memory = open_memstream(&text, length);
  assert_non_null(memory);
  assert_int_equal(scene_dump(scene, memory), STATUS_OK);
  assert_int_equal(fclose(memory), 0);
  return text;
}

/* How many bytes of whole lines two texts have in common. */
static size_t common_lines(const char *a, const char *b)
{
  size_t lines = 0;
  for (size_t k = 0; a[k] != '\0' && a[k] == b[k]; k++)
    if (a[k] == '\n') lines = k + 1;
  return lines;
}

static char *of_nothing; /* the dump of an empty scene; NULL until it is known */

static bool ok_case(const char *path, const char *expected_path)
{
  struct diagnostics diagnostics = {.tell = tell, .context = stderr};
  struct scene *scene = NULL, *again = NULL;
  assert_int_equal(language_load(path, &SETTINGS, &diagnostics, &scene), STATUS_OK);
  assert_int_equal(diagnostics.error_count, 0);
  size_t length, length_again;
  char *text = dump(scene, &length);
  assert_int_equal(language_load_text("<dump>", text, length, &SETTINGS, &diagnostics, &again), STATUS_OK);
  char *text_again = dump(again, &length_again);
  assert_int_equal(length, length_again);
  assert_memory_equal(text, text_again, length);
  const size_t known = of_nothing == NULL ? 0 : common_lines(text, of_nothing);
  const bool same = is_expected(expected_path, text + known, length - known);
  if (of_nothing == NULL) of_nothing = text;
  else free(text);
  free(text_again);
  scene_destroy(scene);
  scene_destroy(again);
  return same;
}

static int is_scene(const struct dirent *entry)
{
  const size_t length = strlen(entry->d_name);
  return length > 5 && strcmp(entry->d_name + length - 5, ".pscn") == 0 && strcmp(entry->d_name, "empty.pscn") != 0;
}

static void run_folder(const char *folder, const char *ending, bool (*run)(const char *, const char *))
{
  struct dirent **entries;
  const int count = scandir(folder, &entries, is_scene, alphasort);
  assert_true(count > 0);
  int failed = 0;
  for (int k = 0; k < count; k++) {
    char path[600], expected[600];
    const int stem = (int)strlen(entries[k]->d_name) - 5;
    (void)snprintf(path, sizeof path, "%s/%s", folder, entries[k]->d_name);
    (void)snprintf(expected, sizeof expected, "%s/%.*s.%s", folder, stem, entries[k]->d_name, ending);
    failed += !run(path, expected);
    free(entries[k]);
  }
  free(entries);
  assert_int_equal(failed, 0);
}

TEST(test_bad) { run_folder("bad", "errors", bad_case); }

TEST(test_ok)
{
  assert_true(ok_case("ok/empty.pscn", "ok/empty.dump"));
  run_folder("ok", "dump", ok_case);
  free(of_nothing);
  of_nothing = NULL;
}

/* Pieces of a picture may be rendered on different machines, so the hash must be the same on all of them. A Python
 * program has computed this one. */
TEST(test_hash)
{
  static const char text[] = "background { rgb <1, 0.5, 0.25> } // \xc3\xa4\xc3\xb6\xc3\xbc\n";
  struct diagnostics diagnostics = {.tell = tell, .context = stderr};
  struct scene *scene = NULL;
  assert_int_equal(language_load_text("<text>", text, sizeof text - 1, &SETTINGS, &diagnostics, &scene), STATUS_OK);
  assert_string_equal(scene->text_hash, "1384bce67a8bde7f78487bf0bba79e90");
  scene_destroy(scene);
}

/* A missing file is no file; nor is a text. */
TEST(test_missing)
{
  static const char text[] = "#include \"none.inc\"";
  char *said = NULL;
  size_t length;
  FILE *memory = open_memstream(&said, &length);
  assert_non_null(memory);
  struct diagnostics diagnostics = {.tell = tell, .context = memory};
  struct scene *scene = NULL;
  assert_int_equal(language_load_text("<text>", text, sizeof text - 1, &SETTINGS, &diagnostics, &scene), STATUS_INPUT);
  assert_int_equal(fclose(memory), 0);
  assert_non_null(strstr(said, "cannot include 'none.inc': "));
  assert_int_equal(diagnostics.error_count, 1);
  free(said);
}

/* Whether the patches of a copy are its object's, moved, within the rounding of three products, their sum and its
 * terms. */
static bool is_moved(const struct scene *scene, const struct scene_copy *copy)
{
  const struct scene_object *object = &scene->objects[copy->object];
  bool same = true;
  for (size_t n = 0; n < object->patch_count * 48; n++) {
    const size_t patch = n / 48, i = n / 12 % 4, j = n / 3 % 4, k = n % 3;
    const double *p = object->P[patch][i][j];
    double sum = copy->b[k], size = fabs(copy->b[k]);
    for (size_t m = 0; m < 3; m++) {
      sum += p[m] * copy->A[m][k];
      size += fabs(p[m] * copy->A[m][k]);
    }
    same &= fabs(scene->patches[copy->first_patch + patch].P[i][j][k] - sum) <= 8 * DBL_EPSILON * size;
  }
  return same;
}

/* Objects that stand in a scene several times are reported, only the outermost ones, and how they are moved. */
TEST(test_copies)
{
  static const char text[] =
    "#declare A = bicubic_patch { type 0 <0,0,0> <1,0,0> <2,0,0> <3,0,0> <0,1,0> <1,1,1> <2,1,0> <3,1,0>"
    " <0,2,0> <1,2,0> <2,2,2> <3,2,0> <0,3,0> <1,3,0> <2,3,0> <3,3,4> }"
    "#declare B = union { object { A } union { object { A scale 2 translate x } rotate 90*z scale <1, 2, 4> } }"
    "#declare C = union { object { A } }"
    "object { B } object { C } object { B rotate <10, 20, 30> translate y } object { A }";
  static const size_t first[] = {0, 2, 3, 5}, object[] = {0, 1, 0, 1}, patches[] = {2, 1};
  struct diagnostics diagnostics = {.tell = tell, .context = stderr};
  struct scene *scene = NULL;
  assert_int_equal(language_load_text("<text>", text, sizeof text - 1, &SETTINGS, &diagnostics, &scene), STATUS_OK);
  assert_int_equal(scene->object_count, 2);
  assert_int_equal(scene->copy_count, 4);
  for (size_t n = 0; n < 4; n++) {
    assert_int_equal(scene->copies[n].first_patch, first[n]);
    assert_int_equal(scene->copies[n].object, object[n]);
    assert_int_equal(scene->objects[object[n]].patch_count, patches[object[n]]);
    assert_true(is_moved(scene, &scene->copies[n]));
  }
  scene_destroy(scene);
}

int main(void)
{
  /* Names in messages are relative to this folder. */
  if (chdir(PSCN_SOURCE_DIR "/tests/language") != 0) return 1;
  return test_run();
}

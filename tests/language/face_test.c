/* The face of the language: settings, solver texts, texts too long to stand in a file, and what stands in a scene several
 * times. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/table.h"
#include "cmocka_test.h"
#include "language/language.h"

static char told[4000];

static void tell(void *context, const char *text, size_t length)
{
  (void)context;
  const size_t used = strlen(told);
  if (used + length >= sizeof told) return;
  memcpy(told + used, text, length);
  told[used + length] = '\0';
}

static struct diagnostics listener(void)
{
  told[0] = '\0';
  return (struct diagnostics){.tell = tell};
}

static const struct language_settings PLAIN = {.image_width = 320, .image_height = 200, .tolerance = NAN};

static enum status load(const char *text, size_t length, const struct language_settings *settings, struct scene **out)
{
  struct diagnostics diagnostics = listener();
  return language_load_text("<text>", text, length, settings, &diagnostics, out);
}

TEST(test_unreadable_file)
{
  if (geteuid() == 0) skip(); /* root may read everything */
  char path[] = "/tmp/pscn-XXXXXX";
  const int file = mkstemp(path);
  assert_true(file >= 0 && fchmod(file, 0) == 0);
  struct scene *scene = NULL;
  struct diagnostics diagnostics = listener();
  assert_int_equal(language_load(path, &PLAIN, &diagnostics, &scene), STATUS_FILE);
  assert_non_null(strstr(told, "permission denied"));
  close(file);
  unlink(path);
}

TEST(test_wrong_solver_texts)
{
  static const struct {
    const char *text, *told;
  } cases[] = {
    {"", "<--solver>:1:1: error: the text ends here, expected a name\n  \n  ^\n"},
    {"aberth { polish", "<--solver>:1:8: error: this brace is not closed\n  aberth { polish\n         ^\n"},
    {"aberth } x", "<--solver>:1:8: error: unexpected '}', expected '{'\n  aberth } x\n         ^\n"},
    {"aberth {} camera", "<--solver>:1:11: error: unexpected 'camera', expected the end of the text\n  aberth {} "
                         "camera\n            ^~~~~~\n"},
    {"aberth #ifdef (pscn)", "<--solver>:1:8: error: directives are not allowed in the text of a solver\n"},
    {"aberth { #declare A = 1; }", "<--solver>:1:10: error: directives are not allowed in the text of a solver\n"},
  };
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    struct method options = {.split = 99};
    struct diagnostics diagnostics = listener();
    assert_int_equal(language_parse_solver(cases[k].text, &diagnostics, &options), STATUS_USAGE);
    assert_int_equal(options.split, 99);
    if (strncmp(told, cases[k].told, strlen(cases[k].told)) != 0) print_error("%s\n", told);
    assert_memory_equal(told, cases[k].told, strlen(cases[k].told));
  }
}

/* Many different ones, each asked for twice: all are kept, once each. */
TEST(test_textures_and_solvers)
{
  enum { COUNT = 100 };
  static char text[2 * COUNT * 120];
  size_t length = 0;
  for (int k = 0; k < 2 * COUNT; k++)
    length += (size_t)snprintf(text + length, sizeof text - length,
                               "bicubic_patch { type 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 pigment { rgb %d } "
                               "solver newton { max_iterations %d } }\n",
                               k % COUNT, 1 + k % COUNT);
  assert_true(length < sizeof text - 1);
  struct scene *scene = NULL;
  assert_int_equal(load(text, length, &PLAIN, &scene), STATUS_OK);
  assert_int_equal(scene->patch_count, 2 * COUNT);
  assert_int_equal(scene->texture_count, COUNT);
  assert_int_equal(scene->solver_count, 1 + COUNT); /* the scene's own */
  for (int k = 0; k < 2 * COUNT; k++) {
    const struct scene_patch *patch = &scene->patches[k];
    assert_true(scene->textures[patch->texture].pigment[0] == k % COUNT);
    assert_int_equal(scene->solvers[patch->solver].roots.max_iterations, 1 + k % COUNT);
  }
  scene_destroy(scene);
}

/* --solver replaces every solver statement, --tolerance then that one item of every one. */
TEST(test_override)
{
  static const char text[] =
    "#declare P = bicubic_patch { type 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 solver newton { tolerance 1e-3 } }"
    "object { P } global_settings { solver aberth { tolerance 1e-4 } }";
  struct language_settings settings = {.image_width = 1, .image_height = 1, .tolerance = 1e-8};
  struct scene *scene = NULL;
  assert_int_equal(load(text, sizeof text - 1, &settings, &scene), STATUS_OK);
  assert_int_equal(scene->solver_count, 2);
  assert_string_equal(scene->solvers[0].roots.solver->name, "aberth");
  assert_string_equal(scene->solvers[scene->patches[0].solver].roots.solver->name, "newton");
  for (size_t k = 0; k < 2; k++) assert_true(scene->solvers[k].roots.tolerance == 1e-8);
  scene_destroy(scene);

  settings.solver_text = "laguerre { tolerance 1e-5 }";
  assert_int_equal(load(text, sizeof text - 1, &settings, &scene), STATUS_OK);
  const struct method *used = &scene->solvers[scene->patches[0].solver];
  assert_string_equal(used->roots.solver->name, "laguerre");
  assert_true(used->roots.tolerance == 1e-8);
  scene_destroy(scene);

  settings.tolerance = NAN;
  assert_int_equal(load(text, sizeof text - 1, &settings, &scene), STATUS_OK);
  assert_true(scene->solvers[scene->patches[0].solver].roots.tolerance == 1e-5);
  scene_destroy(scene);

  settings = (struct language_settings){
    .image_width = 1, .image_height = 1, .solver_text = "nothing", .tolerance = NAN};
  assert_int_equal(load(text, sizeof text - 1, &settings, &scene), STATUS_USAGE);
  assert_null(scene);
}

/* `count` times `piece`, then `end`; freed by the caller. */
static char *repeated(const char *piece, size_t count, const char *end, size_t *out_length)
{
  const size_t length = strlen(piece), end_length = strlen(end);
  char *text = malloc(count * length + end_length + 1);
  assert_non_null(text);
  for (size_t k = 0; k < count; k++) memcpy(text + k * length, piece, length);
  memcpy(text + count * length, end, end_length + 1);
  *out_length = count * length + end_length;
  return text;
}

/* Long texts of one kind: the time of reading is proportional to the length, and the status is right. */
TEST(test_long_texts)
{
  enum { MANY = 200000 };
  static const struct {
    const char *piece, *end;
    enum status status;
  } cases[] = {
    {"(", "", STATUS_INPUT},
    {"{", "", STATUS_LIMIT},
    {"union {", "", STATUS_LIMIT},
    {"#ifdef (pscn) ", "", STATUS_LIMIT},
    {"#ifdef (no) ", "", STATUS_INPUT},
    {"/*", "", STATUS_INPUT},
    {"/ ", "", STATUS_INPUT},
    {"<1,2,", "", STATUS_INPUT},
    {"\"", "", STATUS_INPUT},
    {"a", ";", STATUS_INPUT},
    {"9", "", STATUS_INPUT},
    {" ", "", STATUS_OK},
    {"//", "", STATUS_OK},
    {"/**/", "", STATUS_OK},
    {"\n", "", STATUS_OK},
    {"background{rgb 1}", "", STATUS_OK},
    {"union{}", "", STATUS_OK},
    {"#declare A=1;", "", STATUS_OK},
    {"#declare U = union { object { U } object { U } }\n", "", STATUS_LIMIT},
  };
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    size_t length;
    char *text = repeated(cases[k].piece, MANY, cases[k].end, &length);
    struct scene *scene = NULL;
    assert_int_equal(load(text, length, &PLAIN, &scene), cases[k].status);
    scene_destroy(scene);
    free(text);
  }
}

/* Nobody can predict where a name lies in a table, or a text could be made that takes quadratic time to read. */
TEST(test_no_two_tables_are_alike)
{
  struct arena *arena = arena_create();
  struct table one = {0}, other = {0};
  struct table_entry a, b;
  assert_true(table_add(&one, arena, &a, "Name", 4) && table_add(&other, arena, &b, "Name", 4));
  assert_true(a.hash != b.hash);
  arena_destroy(arena);
}

/* A quarter of a million names, many more that are unknown, and ten thousand files that forget theirs. It would take
 * minutes if any step took time in proportion to all names. */
TEST(test_many_names)
{
  enum { NAMES = 250000 };
  char *text = NULL;
  size_t length = 0;
  FILE *memory = open_memstream(&text, &length);
  assert_non_null(memory);
  for (int k = 0; k < NAMES; k++) assert_true(fprintf(memory, "#declare Name%d = %d;\n", k, k) > 0);
  for (int k = 0; k < 9000; k++) assert_true(fprintf(memory, "#include \"ok/included/local.inc\"\n") > 0);
  assert_true(fprintf(memory, "background { rgb Name%d }\n", NAMES - 1) > 0);
  assert_int_equal(fflush(memory), 0);
  struct scene *scene = NULL;
  assert_int_equal(load(text, length, &PLAIN, &scene), STATUS_OK);
  assert_true(scene->background[0] == NAMES - 1);
  scene_destroy(scene);
  for (int k = 0; k < NAMES; k++) assert_true(fprintf(memory, "#declare Other%d = Nmae%d;\n", k, k) > 0);
  assert_int_equal(fclose(memory), 0);
  assert_int_equal(load(text, length, &PLAIN, &scene), STATUS_INPUT);
  free(text);
}

#define NET                                                                                  \
  "<0,0,0> <1,0,0> <2,0,0> <3,0,0> <0,1,0> <1,1,1> <2,1,0> <3,1,0> <0,2,0> <1,2,0> <2,2,1> " \
  "<3,2,0> <0,3,0> <1,3,0> <2,3,0> <3,3,0>"

/* An object named once is only its patches. */
TEST(test_one_is_no_copy)
{
  static const char text[] = "#declare P = bicubic_patch { type 1 " NET " }\n"
                             "object { P rotate 10 * x }\n";
  struct scene *scene = NULL;
  assert_int_equal(load(text, sizeof text - 1, &PLAIN, &scene), STATUS_OK);
  assert_int_equal(scene->patch_count, 1);
  assert_int_equal(scene->copy_count, 0);
  assert_int_equal(scene->object_count, 0);
  scene_destroy(scene);
}

/* A declared object that is named several times is reported as one, wherever it is and however it is moved. Its copies'
 * maps carry its patches to theirs. */
TEST(test_copies)
{
  static const char text[] =
    "#declare P = bicubic_patch { type 1 " NET " translate <0.1, 0, 0> }\n"
    "#declare Two = union { object { P rotate <10, 20, 30> } object { P scale <1, -2, 0.3> } translate z }\n"
    "object { P }\n"
    "union { object { Two } object { Two rotate 33 * y translate <5, 0, 0.7> } rotate 7 * x }\n"
    "object { Two matrix <1, 0.5, 0, 0, 1, 0.25, 0.125, 0, 1, 3, 4, 5> scale 2 }\n";
  struct scene *scene = NULL;
  assert_int_equal(load(text, sizeof text - 1, &PLAIN, &scene), STATUS_OK);
  assert_int_equal(scene->patch_count, 7);
  assert_int_equal(scene->copy_count, 4);
  assert_int_equal(scene->object_count, 2); /* P itself, which is also named in Two, and Two */
  static const size_t first[4] = {0, 1, 3, 5};
  double moved = 0;
  for (size_t c = 0; c < 4; c++) {
    const struct scene_copy *copy = &scene->copies[c];
    const struct scene_object *object = &scene->objects[copy->object];
    assert_int_equal(copy->first_patch, first[c]);
    assert_int_equal(object->patch_count, c == 0 ? 1 : 2);
    for (size_t p = 0; p < object->patch_count; p++) {
      for (int n = 0; n < 48; n++) {
        const double *from = object->P[p][n / 12][n / 3 % 4],
                     *to = scene->patches[copy->first_patch + p].P[n / 12][n / 3 % 4];
        double x = copy->b[n % 3], size = fabs(x);
        for (int i = 0; i < 3; i++) x += from[i] * copy->A[i][n % 3], size += fabs(from[i] * copy->A[i][n % 3]);
        assert_true(fabs(x - to[n % 3]) <= 16 * 0x1p-53 * size);
        moved += fabs(from[n % 3] - to[n % 3]);
      }
    }
  }
  assert_true(moved > 1);
  scene_destroy(scene);
}

int main(void)
{
  if (chdir(PSCN_SOURCE_DIR "/tests/language") != 0) return 1;
  return test_run();
}

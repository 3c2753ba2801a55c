/* pscn.h: scenes are made of files, texts and points; what is wrong is kept, with its place; memory comes from the
 * caller's hooks and goes back there, also when there is not enough. */
#include <locale.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/arena.h"
#include "library/ball.h"
#include "library/pscn.h"

#include "cmocka_test.h"

static const char PATCH[] = "bicubic_patch { type 1 flatness 0 u_steps 3 v_steps 3\n"
                            "<0,0,0> <1,0,0> <2,0,0> <3,0,0> <0,1,0> <1,1,1> <2,1,1> <3,1,0>\n"
                            "<0,2,0> <1,2,1> <2,2,1> <3,2,0> <0,3,0> <1,3,0> <2,3,0> <3,3,0.5> }\n";

static enum pscn_status from_text(const char *text, const struct pscn_options *options, struct pscn_scene **out)
{
  return pscn_scene_from_text("given.pscn", text, strlen(text), options, out);
}

TEST(test_version)
{
  char text[32];
  snprintf(text, sizeof text, "%d.%d.%d", PSCN_VERSION_MAJOR, PSCN_VERSION_MINOR, PSCN_VERSION_PATCH);
  assert_string_equal(text, PSCN_VERSION);
  assert_string_equal(pscn_version_text(), PSCN_VERSION);
  assert_int_equal(pscn_version(), PSCN_VERSION_NUMBER);
  for (int status = -1; status < 7; status++) assert_true(strlen(pscn_status_text((enum pscn_status)status)) > 3);
}

/* A file, its text, and its points make the same scene. */
TEST(test_origins)
{
  static const char path[] = PSCN_SOURCE_DIR "/scenes/bent.pscn";
  struct pscn_scene *file, *points, *none;
  double P[4][4][3], Q[4][4][3];
  assert_int_equal(pscn_scene_from_file(path, NULL, &file), PSCN_OK);
  assert_int_equal(pscn_scene_status(file), PSCN_OK);
  assert_string_equal(pscn_scene_messages(file), "");
  assert_int_equal(pscn_patch_count(file), 1);
  assert_int_equal(pscn_patch(file, 0, P), PSCN_OK);
  /* 64 bytes a point, with the coordinates in the middle. */
  double apart[16][8];
  for (int n = 0; n < 16; n++) memcpy(&apart[n][3], P[n / 4][n % 4], sizeof P[0][0]);
  assert_int_equal(pscn_scene_from_points(&apart[0][3], 1, 0, sizeof apart[0], NULL, &points), PSCN_OK);
  assert_int_equal(pscn_patch(points, 0, Q), PSCN_OK);
  assert_memory_equal(P, Q, sizeof P);
  assert_int_equal(pscn_patch(points, 1, Q), PSCN_USAGE);
  assert_true(Q[0][0][0] == 0 && Q[3][3][2] == 0);
  struct pscn_camera camera;
  pscn_scene_camera(points, &camera); /* POV-Ray's default */
  assert_true(camera.location[2] == 0 && camera.direction[2] == 1 && camera.up[1] == 1);
  assert_int_equal(pscn_scene_from_points(NULL, 0, 0, 0, NULL, &none), PSCN_OK);
  assert_int_equal(pscn_patch_count(none), 0);
  pscn_scene_free(file);
  pscn_scene_free(points);
  pscn_scene_free(none);
}

TEST(test_messages)
{
  struct pscn_scene *scene;
  struct pscn_message message;
  assert_int_equal(
    from_text("global_settings { assumed_gamma 1 assumed_gamma 1 }\ncamera {\n  loaction <0,0,1>\n}\nspher { }\n", NULL,
              &scene),
    PSCN_INPUT);
  assert_int_equal(pscn_scene_status(scene), PSCN_INPUT);
  assert_int_equal(pscn_message_count(scene), 3);
  assert_int_equal(pscn_message(scene, 0, &message), PSCN_OK);
  assert_int_equal(message.warning, 1);
  assert_int_equal(message.line, 1);
  assert_int_equal(pscn_message(scene, 1, &message), PSCN_OK);
  assert_int_equal(message.warning, 0);
  assert_string_equal(message.file, "given.pscn");
  assert_int_equal(message.line, 3);
  assert_int_equal(message.column, 3);
  assert_string_equal(message.text, "unknown word 'loaction'; did you mean 'location'?");
  assert_int_equal(pscn_message(scene, 2, &message), PSCN_OK);
  assert_int_equal(message.line, 5);
  assert_int_equal(pscn_message(scene, 3, &message), PSCN_USAGE);
  assert_string_equal(message.text, "");
  const char *all = pscn_scene_messages(scene); /* asking again does not remove them */
  assert_non_null(strstr(all, "given.pscn:3:3: error: unknown word 'loaction'"));
  assert_non_null(strstr(all, "\n  ^~~~~") ? all : strstr(all, "    ^~~~~~~~\n"));
  assert_string_equal(all, pscn_scene_messages(scene));
  pscn_scene_free(scene);

  assert_int_equal(pscn_scene_from_file("/nowhere/at all.pscn", NULL, &scene), PSCN_FILE);
  assert_int_equal(pscn_message(scene, 0, &message), PSCN_OK);
  assert_string_equal(message.text, "/nowhere/at all.pscn: there is no such file");
  assert_int_equal(message.line, 0);
  assert_string_equal(message.file, "");
  pscn_scene_free(scene);
}

/* Each wrong argument is PSCN_USAGE, or PSCN_INPUT for data, with a message that names it. */
TEST(test_arguments)
{
  struct pscn_number named_so = {"x", 1}, infinite = {"Width", INFINITY};
  union {
    struct pscn_options options;
    char bytes[sizeof(struct pscn_options) + 16];
  } newer = {PSCN_OPTIONS};
  newer.options.size += 16;
  newer.bytes[sizeof(struct pscn_options) + 3] = 1;
  const struct {
    struct pscn_options options;
    const char *says;
  } wrong[] = {
    {{.size = 0}, "not of this version"},
    {{.size = 3}, "not of this version"},
    {{.size = sizeof(size_t) + 3, .solver = "aberth"}, "not of this version"},
    {{.size = sizeof(struct pscn_options), .solver = "abert"}, "did you mean 'aberth'?"},
    {{.size = sizeof(struct pscn_options), .tolerance = 7}, "the tolerance must be a number from"},
    {{.size = sizeof(struct pscn_options), .tolerance = NAN}, "the tolerance is not a number"},
    {{.size = sizeof(struct pscn_options), .clock = INFINITY}, "the clock is not a number"},
    {{.size = sizeof(struct pscn_options), .untrusted = 2}, "not of this version"},
    {{.size = sizeof(struct pscn_options), .lenient = -1}, "not of this version"},
    {{.size = sizeof(struct pscn_options), .image_width = -1}, "negative"},
    {{.size = sizeof(struct pscn_options), .image_height = -1}, "negative"},
    {{.size = sizeof(struct pscn_options), .number_count = 1}, "numbers is NULL"},
    {{.size = sizeof(struct pscn_options), .numbers = &named_so, .number_count = 1}, "cannot be declared"},
    {{.size = sizeof(struct pscn_options), .numbers = &infinite, .number_count = 1}, "not a number up to 1e100"},
  };
  struct pscn_scene *scene;
  for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
    assert_int_equal(from_text(PATCH, &wrong[k].options, &scene), PSCN_USAGE);
    if (!strstr(pscn_scene_messages(scene), wrong[k].says)) fail_msg("%zu: %s", k, pscn_scene_messages(scene));
    pscn_scene_free(scene);
  }
  assert_int_equal(from_text(PATCH, &newer.options, &scene), PSCN_USAGE);
  pscn_scene_free(scene);
  newer.bytes[sizeof(struct pscn_options) + 3] = 0;
  assert_int_equal(from_text(PATCH, &newer.options, &scene), PSCN_OK);
  pscn_scene_free(scene);
  double points[BALL_PATCHES][4][4][3];
  ball_points(points);
  points[5][1][2][0] = NAN;
  assert_int_equal(pscn_scene_from_points(**points[0], BALL_PATCHES, sizeof *points, sizeof ***points, NULL, &scene),
                   PSCN_INPUT);
  assert_string_equal(pscn_scene_messages(scene), "error: patch 5: control point [1][2] is not a number up to 1e100\n");
  assert_int_equal(pscn_patch_count(scene), 0);
  struct pscn_camera camera, none = {{0}, {0}, {0}, {0}};
  memset(&camera, 0xff, sizeof camera);
  pscn_scene_camera(scene, &camera);
  assert_memory_equal(&camera, &none, sizeof none);
  pscn_scene_free(scene);
  assert_int_equal(pscn_scene_from_text("x", NULL, 1, NULL, &scene), PSCN_USAGE);
  pscn_scene_free(scene);
  assert_int_equal(pscn_scene_from_file(NULL, NULL, &scene), PSCN_USAGE);
  pscn_scene_free(scene);
  assert_int_equal(pscn_scene_from_points(NULL, 1, 0, 0, NULL, &scene), PSCN_USAGE);
  pscn_scene_free(scene);
  assert_int_equal(pscn_scene_from_file("x", NULL, NULL), PSCN_USAGE);
  assert_int_equal(from_text(PATCH, NULL, &scene), PSCN_OK);
  assert_int_equal(pscn_patch(scene, 0, NULL), PSCN_USAGE);
  assert_int_equal(pscn_message(scene, 0, NULL), PSCN_USAGE);
  pscn_scene_camera(scene, NULL);
  pscn_scene_free(scene);
}

/* A missing instruction set is reported. */
TEST(test_kernel)
{
  struct pscn_scene *scene;
  assert_int_equal(setenv("PSCN_KERNEL", "sparc", 1), 0);
  const enum pscn_status status = from_text(PATCH, NULL, &scene);
  assert_int_equal(unsetenv("PSCN_KERNEL"), 0);
  assert_int_equal(status, PSCN_USAGE);
  assert_non_null(strstr(pscn_scene_messages(scene), "PSCN_KERNEL"));
  pscn_scene_free(scene);
}

/* The options take effect. */
TEST(test_options)
{
  static const char text[] = "#ifndef (Far) #error #end\n"
                             "camera { location <Far, image_width, image_height> look_at 0 }\n"
                             "#include \"part.inc\"\n";
  const char *const folders[] = {PSCN_SOURCE_DIR "/tests/library", NULL};
  const struct pscn_number far = {"Far", 1.5};
  struct pscn_options options = PSCN_OPTIONS;
  options.numbers = &far;
  options.number_count = 1;
  options.folders = folders;
  options.image_height = 30;
  struct pscn_scene *scene;
  struct pscn_camera camera;
  if (from_text(text, &options, &scene) != PSCN_OK) fail_msg("%s", pscn_scene_messages(scene));
  pscn_scene_camera(scene, &camera);
  assert_true(camera.location[0] == 1.5 && camera.location[1] == 800 && camera.location[2] == 30);
  assert_int_equal(pscn_patch_count(scene), 1);
  pscn_scene_free(scene);

  options = (struct pscn_options)PSCN_OPTIONS;
  options.clock = 0.25, options.lenient = 1, options.max_work = 100;
  static const char loops[] = "camera { location <clock, 0, 0> look_at z } sphere { 0, 1 } #while (1) #end";
  assert_int_equal(from_text(loops, &options, &scene), PSCN_LIMIT);
  assert_non_null(strstr(pscn_scene_messages(scene), "loop"));
  pscn_scene_free(scene);
  assert_int_equal(pscn_scene_from_text("", loops, strcspn(loops, "#"), &options, &scene), PSCN_OK);
  pscn_scene_camera(scene, &camera);
  assert_true(camera.location[0] == 0.25);
  assert_non_null(strstr(pscn_scene_messages(scene), "warning"));
  pscn_scene_free(scene);

  options = (struct pscn_options)PSCN_OPTIONS;
  options.max_memory = 1000;
  assert_int_equal(from_text(PATCH, &options, &scene), PSCN_LIMIT);
  assert_int_equal(pscn_message_count(scene), 1);
  pscn_scene_free(scene);
  double points[BALL_PATCHES][4][4][3];
  ball_points(points);
  options.max_memory = 3000; /* enough for reading nothing */
  assert_int_equal(
    pscn_scene_from_points(**points[0], BALL_PATCHES, sizeof *points, sizeof ***points, &options, &scene), PSCN_LIMIT);
  assert_non_null(strstr(pscn_scene_messages(scene), "memory"));
  pscn_scene_free(scene);
}

/* The outermost objects of a text that have patches, by the patches' numbers. */
TEST(test_objects)
{
  static const char text[] = "#declare Lid = bicubic_patch { type 0 <0,0,0> <1,0,0> <2,0,0> <3,0,0> <0,1,0> <1,1,1>\n"
                             "<2,1,1> <3,1,0> <0,2,0> <1,2,1> <2,2,1> <3,2,0> <0,3,0> <1,3,0> <2,3,0> <3,3,0> }\n"
                             "#declare Pot = union { object { Lid } object { Lid translate x } }\n"
                             "union { } object { Pot } union { object { Lid } } object { Lid } object { Pot scale 2 }";
  static const struct pscn_object expected[] = {{"Pot", 0, 0, 2}, {"", 1, 2, 1}, {"Lid", 2, 3, 1}, {"Pot", 3, 4, 2}};
  static const size_t part_of[] = {0, 0, 1, 2, 3, 3};
  struct pscn_scene *scene;
  struct pscn_object object;
  if (from_text(text, NULL, &scene) != PSCN_OK) fail_msg("%s", pscn_scene_messages(scene));
  for (size_t n = 0; n < 6; n++) {
    const struct pscn_object *meant = &expected[part_of[n]];
    assert_int_equal(pscn_object(scene, n, &object), PSCN_OK);
    assert_string_equal(object.name, meant->name);
    assert_true(object.number == meant->number && object.first_patch == meant->first_patch &&
                object.patch_count == meant->patch_count);
  }
  assert_int_equal(pscn_object(scene, 6, &object), PSCN_USAGE);
  assert_true(object.name[0] == 0 && object.patch_count == 0);
  assert_int_equal(pscn_object(scene, 0, NULL), PSCN_USAGE);
  pscn_scene_free(scene);
}

/* ---- memory ---- */

struct pool {
  long blocks, asked, fails; /* held; asked for so far; the one that fails, or -1 */
};

/* Our blocks are preceded by their number: no other block is returned here. */
static void *pool_resize(void *context, void *block, size_t size)
{
  enum { HEAD = 32, MARK = 0x5ca1ab1e };
  struct pool *pool = context;
  int *head = block ? (int *)((char *)block - HEAD) : NULL;
  if (head) assert_int_equal(*head, MARK);
  if (size > 0 && pool->asked++ == pool->fails) return NULL;
  pool->blocks += (size > 0) - (block != NULL);
  if (size > 0) {
    head = realloc(head, size + HEAD);
    assert_non_null(head);
    if (!block) memset((char *)head + HEAD, 0xA5, size);
    *head = MARK;
    return (char *)head + HEAD;
  }
  *head = 0;
  free(head);
  return NULL;
}

/* An arena asks its hooks once for many calls. Each of these fails as well, counted together with the hooks' blocks. */
static struct pool *asked_too;
void *__real_arena_alloc(struct arena *arena, size_t count, size_t size);
void *__wrap_arena_alloc(struct arena *arena, size_t count, size_t size);
void *__wrap_arena_alloc(struct arena *arena, size_t count, size_t size)
{
  return asked_too && asked_too->asked++ == asked_too->fails ? NULL : __real_arena_alloc(arena, count, size);
}

/* Copies of objects in unions, moved and turned; textures and solvers of their own, a light, a camera; and a
 * warning. */
static const char MANY[] = "global_settings { assumed_gamma 1 assumed_gamma 1 }\n"
                           "#declare Gold = texture { pigment { rgb <1, Low, 0> } finish { phong 1 } }\n"
                           "#declare A = bicubic_patch { type 1 flatness 0 u_steps 3 v_steps 3\n"
                           "<0,0,0> <1,0,0> <2,0,0> <3,0,0> <0,1,0> <1,1,1> <2,1,1> <3,1,0>\n"
                           "<0,2,0> <1,2,1> <2,2,1> <3,2,0> <0,3,0> <1,3,0> <2,3,0> <3,3,0.5> }\n"
                           "#declare C = bicubic_patch { type 1 flatness 0 u_steps 3 v_steps 3\n"
                           "<3,0,0> <4,0,0> <5,0,0> <6,0,0> <3,1,0> <4,1,1> <5,1,1> <6,1,0>\n"
                           "<3,2,0> <4,2,1> <5,2,1> <6,2,0> <3,3,0> <4,3,0> <5,3,0> <6,3,0.5> solver newton }\n"
                           "#declare B = union { object { A } object { C translate z } texture { Gold } }\n"
                           "object { B } object { B rotate <10, 20, 30> } union { object { B scale 2 } object { A } }\n"
                           "light_source { <0, 9, -9>, 1 } camera { location -9*z look_at 0 }\n";

TEST(test_memory)
{
  struct pool pool = {0, 0, -1};
  struct pscn_options options = PSCN_OPTIONS;
  const struct pscn_number low = {"Low", 0.5};
  options.memory = (struct pscn_memory){pool_resize, &pool};
  options.numbers = &low;
  options.number_count = 1;
  options.solver = "aberth { polish off }";
  asked_too = &pool;
  const struct pscn_ray ray = {{1.5, 1.5, -5}, {0, 0, 1}, 0, INFINITY};
  const struct {
    const char *text;
    enum pscn_status status;
  } scenes[] = {{PATCH, PSCN_OK},
                {MANY, PSCN_OK},
                {"camera { location -9*z }", PSCN_OK},
                {"global_settings { assumed_gamma 1 assumed_gamma 1 }\ncamera { loaction 0 }", PSCN_INPUT},
                {"#declare A = union { object {", PSCN_INPUT}};
  for (size_t k = 0; k < sizeof scenes / sizeof *scenes; k++) {
    struct pscn_scene *scene;
    struct pscn_hit hit;
    pool = (struct pool){0, 0, -1};
    assert_int_equal(from_text(scenes[k].text, &options, &scene), scenes[k].status);
    assert_true(pool.blocks > 0);
    (void)pscn_nearest(scene, 1, &ray, 0, &hit, 0);
    pscn_scene_free(scene);
    assert_int_equal(pool.blocks, 0);
    const long all = pool.asked;
    for (long fails = 0; fails < all; fails++) {
      pool = (struct pool){0, 0, fails};
      const enum pscn_status status = from_text(scenes[k].text, &options, &scene);
      /* Only a message may be missing without harm. */
      assert_true(status == PSCN_LIMIT || (status == scenes[k].status && (status == PSCN_INPUT || scene)));
      assert_true(status == PSCN_OK || strstr(pscn_scene_messages(scene), "error: "));
      pscn_scene_free(scene);
      assert_int_equal(pool.blocks, 0);
    }
  }
  asked_too = NULL;
}

/* Patches of points: memory that fails or is limited, and a coordinate that is not a number. */
TEST(test_points)
{
  struct pool pool = {0, 0, -1};
  struct pscn_options options = PSCN_OPTIONS;
  struct pscn_scene *scene;
  double points[2][4][4][3] = {0};
  for (int n = 0; n < 32; n++) points[n / 16][n / 4 % 4][n % 4][0] = n, points[n / 16][n / 4 % 4][n % 4][1] = n / 4 % 4;
  options.memory = (struct pscn_memory){pool_resize, &pool};
  asked_too = &pool;
  enum pscn_status status = PSCN_LIMIT;
  long fails = -1;
  for (; status == PSCN_LIMIT; fails++) {
    pool = (struct pool){0, 0, fails + 1};
    status = pscn_scene_from_points(**points[0], 2, sizeof *points, sizeof ***points, &options, &scene);
    pscn_scene_free(scene);
    assert_int_equal(pool.blocks, 0);
  }
  assert_int_equal(status, PSCN_OK);
  assert_true(fails > 3);
  asked_too = NULL;
  pool.fails = -1;
  options.max_memory = 500;
  assert_int_equal(pscn_scene_from_points(**points[0], 2, sizeof *points, sizeof ***points, &options, &scene),
                   PSCN_LIMIT);
  pscn_scene_free(scene);
  options.max_memory = 0;
  for (int c = 0; c < 3; c++) {
    points[1][2][3][c] = c == 1 ? INFINITY : NAN;
    assert_int_equal(pscn_scene_from_points(**points[0], 2, sizeof *points, sizeof ***points, &options, &scene),
                     PSCN_INPUT);
    pscn_scene_free(scene);
    points[1][2][3][c] = 1;
  }
}

/* Without a scene, or where no answer is wanted. */
TEST(test_nothing)
{
  struct pscn_message message = {.text = NULL, .file = NULL};
  struct pscn_scene *scene;
  assert_string_equal(pscn_scene_messages(NULL), "error: memory is short\n");
  assert_int_equal(pscn_message_count(NULL), 0);
  assert_int_equal(pscn_message(NULL, 0, &message), PSCN_USAGE);
  assert_true(strcmp(message.text, "") == 0 && strcmp(message.file, "") == 0);
  assert_int_equal(from_text("camera { }", NULL, &scene), PSCN_OK);
  assert_int_equal(pscn_message(scene, 0, NULL), PSCN_USAGE);
  pscn_scene_free(scene);
  pscn_scene_free(NULL);
}

int main(void)
{
  (void)setlocale(LC_ALL, "");
  return test_run();
}

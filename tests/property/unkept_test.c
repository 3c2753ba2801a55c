/* Scenes with so many patches that neither patches nor leaves are kept: answers are those with kept ones, to the
 * last bit, and memory stays within the promised bounds. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/diagnostics.h"
#include "cmocka_test.h"
#include "intersect/intersect.h"
#include "language/language.h"
#include "method_of.h"
#include "property/world.h"

enum { SEED = 20261122, RAYS = 400, MANY = 70000 };

/* The memory of the process that a patch may take from its text to rays, in bytes, at the worst moment: while it is
 * read, in all if it is one leaf; and if it is four leaves, the maximum, of 140 bytes each with their part of the
 * hierarchy. */
enum { PATCH_BYTES = 1024, PATCH_BYTES_OF_FOUR = 1152 };

/* Of this process alone: getrusage includes its parent's. */
static long peak_bytes(void)
{
  char line[256];
  long kilobytes = 0;
  FILE *file = fopen("/proc/self/status", "r");
  assert_non_null(file);
  while (kilobytes == 0 && fgets(line, sizeof line, file)) (void)sscanf(line, "VmHWM: %ld", &kilobytes);
  assert_int_equal(fclose(file), 0);
  assert_true(kilobytes > 0);
  return kilobytes * 1024;
}

/* Patches that are off a plane by `bend` of their size. */
static void write_scene(const char *path, double bend, const char *line)
{
  struct random random = {SEED};
  FILE *file = fopen(path, "w");
  assert_non_null(file);
  for (int p = 0; p < MANY; p++) {
    if (p == 3000) fputs(line, file);
    fputs("bicubic_patch { type 1 flatness 0 u_steps 3 v_steps 3", file);
    for (int n = 0; n < 16; n++)
      fprintf(file, ", <%.9f, %.9f, %.9f>", p % 250 + n / 4 / 3.0, p / 250 + n % 4 / 3.0, bend * random_unit(&random));
    fputs(" }\n", file);
  }
  assert_int_equal(fclose(file), 0);
}

struct peak {
  long before, read, all;
};

static void take_peak(const char *path, struct peak *out)
{
  const struct language_settings settings = {.image_width = 1, .image_height = 1, .tolerance = NAN};
  struct diagnostics diagnostics = {0};
  struct world side;
  struct scene *scene;
  out->before = peak_bytes();
  assert_int_equal(language_load(path, &settings, &diagnostics, &scene), STATUS_OK);
  out->read = peak_bytes();
  assert_int_equal(intersector_create(scene, &side.intersector), STATUS_OK);
  assert_int_equal(tracer_create(side.intersector, &side.tracer), STATUS_OK);
  const struct ray ray = {.origin = {7.5, 7.5, 9}, .direction = {0.1, 0.1, -1}, .t_max = INFINITY};
  struct hit hit;
  tracer_closest(side.tracer, 1, &ray, &hit);
  assert_int_not_equal(hit.patch, HIT_NONE);
  out->all = peak_bytes();
  tracer_destroy(side.tracer);
  intersector_destroy(side.intersector);
  scene_destroy(scene);
}

/* Runs in a process of its own, which has used no memory before. */
static void check_memory(double bend, long most)
{
  static const char path[] = "unkept_test.pscn";
  struct peak peak;
  int ends[2], status;
  write_scene(path, bend, "");
  assert_int_equal(pipe(ends), 0);
  const pid_t child = fork();
  assert_true(child >= 0);
  if (child == 0) {
    take_peak(path, &peak);
    _exit(write(ends[1], &peak, sizeof peak) == (ssize_t)sizeof peak ? EXIT_SUCCESS : EXIT_FAILURE);
  }
  assert_int_equal(close(ends[1]), 0);
  const ssize_t got = read(ends[0], &peak, sizeof peak);
  assert_int_equal(close(ends[0]), 0);
  assert_int_equal(waitpid(child, &status, 0), child);
  assert_int_equal(status, 0);
  assert_int_equal(got, sizeof peak);
  assert_int_equal(remove(path), 0);
  const long read_bytes = peak.read - peak.before, all_bytes = peak.all - peak.before;
  print_message("%ld bytes a patch, %ld of them to read it\n", all_bytes / MANY, read_bytes / MANY);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  assert_true(read_bytes <= (long)PATCH_BYTES * MANY);
  assert_true(all_bytes <= most * MANY);
#else
  (void)most;
#endif
}

/* The first test, because a peak stays. */
TEST(memory_is_bounded)
{
  check_memory(0.01, PATCH_BYTES);
  check_memory(1, PATCH_BYTES_OF_FOUR);
}

static void keep_text(void *context, const char *text, size_t length)
{
  assert_true(length < 1000);
  memcpy(context, text, length); /* if it is zero-terminated */
}

/* The line of the text is already released when an error is reported there at the end. */
TEST(errors_show_their_lines)
{
  static const char path[] = "unkept_error_test.pscn";
  const struct language_settings settings = {.image_width = 1, .image_height = 1, .tolerance = NAN};
  char told[1000] = "";
  struct diagnostics diagnostics = {.tell = keep_text, .context = told};
  struct scene *scene;
  write_scene(path, 1, "  #ifdef (pscn) // never closed\n");
  assert_int_equal(language_load(path, &settings, &diagnostics, &scene), STATUS_INPUT);
  assert_int_equal(remove(path), 0);
  assert_string_equal(told, "unkept_error_test.pscn:3001:3: error: #ifdef without #end\n"
                            "    #ifdef (pscn) // never closed\n    ^~~~~~\n");
}

/* The nets alone, or with small patches far away added: one leaf each in both cases. With a floor added too, so wide
 * that the small ones are in a tree of their own. */
#define FLOOR 0x1p33

static void side_open(struct world *side, struct method *solver, world_net nets[], size_t count, size_t far,
                      bool floored)
{
  struct random random = {SEED};
  *side = (struct world){.scene = {.solvers = solver, .solver_count = 1, .patch_count = count + far + floored}};
  side->scene.patches = calloc(count + far + floored, sizeof *side->scene.patches);
  assert_non_null(side->scene.patches);
  struct scene_patch *patch = side->scene.patches;
  for (int n = 0; n < 16 && floored; n++) {
    double *at = patch->P[n / 4][n % 4];
    at[0] = FLOOR * (n / 4 - 1.25), at[1] = -20, at[2] = FLOOR * (n % 4 - 1.25);
  }
  if (floored) patch++;
  for (size_t p = 0; p < count; p++, patch++) memcpy(patch->P, nets[p], sizeof nets[p]);
  for (size_t p = 0; p < far; p++, patch++)
    for (int n = 0; n < 48; n++) patch->P[n / 12][n / 3 % 4][n % 3] = 1000 + random_between(&random, 0, 1);
  world_prepare(side);
  assert_true((side->tracer->model->leaves != NULL) == (far == 0));
  const size_t inner = side->tracer->model->inner_count;
  if (far > 0) assert_true(floored ? inner > 0 : inner == 0);
}

static int compare(int kind, struct tracer *const tracers[2], struct random *random, world_net nets[], size_t count)
{
  int hits = 0;
  struct asked asked;
  for (int n = 0; n < RAYS; n += ASKED_RAYS) {
    world_ask_both(tracers, random, nets, count, n, &asked);
    for (int l = 0; l < ASKED_RAYS; l++) {
      const struct hit_list *kept = &asked.list[0][l], *unkept = &asked.list[1][l];
      hits += asked.hit[0][l].patch != HIT_NONE;
      assert_same_hit("kept or not", kind, &asked.rays[l], &asked.hit[0][l], &asked.hit[1][l]);
      assert_int_equal(asked.occluded[0][l], asked.occluded[1][l]);
      assert_int_equal(kept->certainty, unkept->certainty);
      /* what a list holds that is not certain also depends on the work that the boxes of others took */
      if (kept->certainty != CERTAINTY_CERTAIN) continue;
      assert_int_equal(kept->count, unkept->count);
      for (size_t h = 0; h < kept->count; h++)
        assert_same_hit("kept or not, of all", kind, &asked.rays[l], &kept->hits[h], &unkept->hits[h]);
    }
  }
  return hits;
}

TEST(answers_are_the_same)
{
  static world_net nets[WORLD_MAX];
  struct random random = {SEED};
  static const struct {
    enum world_kind kind;
    const char *solver;
  } ways[] = {{WORLD_GRID, "bernstein { split 2 }"}, {WORLD_WILD, "aberth { split 1 }"}};
  for (size_t n = 0; n < sizeof ways / sizeof ways[0]; n++) {
    const int kind = (int)ways[n].kind;
    struct method solver = method_of(ways[n].solver);
    struct world sides[2];
    const size_t count = world_fill(ways[n].kind, &random, nets);
    for (int k = 0; k < 2; k++) side_open(&sides[k], &solver, nets, count, k == 0 ? 0 : MANY, kind % 2);
    struct tracer anew; /* remembers no leaves, unlike the other one, and makes each anew */
    tracer_begin(sides[1].intersector, &anew);
    const int hits = compare(kind, (struct tracer *[]){sides[0].tracer, sides[1].tracer}, &random, nets, count) +
                     compare(kind, (struct tracer *[]){sides[0].tracer, &anew}, &random, nets, count);
    tracer_end(&anew);
    assert_true(hits > RAYS / 16);
    for (int k = 0; k < 2; k++) world_close(&sides[k]);
  }
}

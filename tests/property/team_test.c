/* A model prepared by several threads is that of one thread, to the last bit, however the work is divided; if
 * threads run short, there is no model. */
#define _GNU_SOURCE /* pthread_getattr_np */
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "cmocka_test.h"
#include "copied.h"
#include "intersect/model.h"
#include "property/world.h"
#include "render/threads.h"

enum { SEED = 20261123 };

/* The input of a model: a height field of patches that share their borders, or copies of pieces of it. */
struct trial {
  struct scene scene;
  struct method solvers[2];
  struct scene_object object;
};

static void trial_open(struct trial *trial, size_t side, size_t copies, int split)
{
  struct random random = {SEED};
  *trial = (struct trial){.scene = {.solver_count = 2}};
  struct scene *scene = &trial->scene;
  const size_t count = side * side, points = 3 * side + 1;
  method_default(solver_at(0), &trial->solvers[0]);
  trial->solvers[1] = trial->solvers[0], trial->solvers[1].split = split;
  scene->solvers = trial->solvers;
  scene->patch_count = count;
  scene->patches = calloc(scene->patch_count, sizeof *scene->patches);
  double *height = calloc(points * points, sizeof *height);
  assert_non_null(scene->patches);
  assert_non_null(height);
  for (size_t k = 0; k < points * points; k++) height[k] = random_between(&random, -0.3, 0.3);
  for (size_t p = 0; p < count; p++) {
    double(*P)[4][3] = scene->patches[p].P;
    const double bend = random_bits(&random) % 4 == 0 ? 0 : 1; /* some are flat: of degree (1,1) */
    for (size_t n = 0; n < 16; n++) {
      const size_t i = p / side * 3 + n / 4, j = p % side * 3 + n % 4;
      P[n / 4][n % 4][0] = (double)i / 3, P[n / 4][n % 4][1] = (double)j / 3;
      P[n / 4][n % 4][2] = bend * height[i * points + j];
    }
    scene->patches[p].solver = p % 5 == 0;
  }
  free(height);
  if (copies == 0) return;
  trial->object = (struct scene_object){calloc(count, sizeof *trial->object.P), count};
  assert_non_null(trial->object.P);
  for (size_t p = 0; p < count; p++) memcpy(trial->object.P[p], scene->patches[p].P, sizeof trial->object.P[p]);
  free(scene->patches);
  copied_open(scene, &trial->object, copies);
  for (size_t c = 0; c < copies; c++) scene->copies[c].b[2] = (double)c;
  copied_place(scene);
  for (size_t p = 0; p < scene->patch_count; p++) scene->patches[p].solver = p % count % 5 == 0;
}

static void trial_close(struct trial *trial)
{
  copied_close(&trial->scene);
  free(trial->object.P);
}

#define SAME(a, b, member) assert_memory_equal(&(a)->member, &(b)->member, sizeof(a)->member)

static void assert_same_leaf(const struct leaf *a, const struct leaf *b)
{
  SAME(a, b, slab);
  SAME(a, b, x);
  SAME(a, b, second);
  SAME(a, b, first);
  assert_true(a->patch == b->patch && a->column_u == b->column_u && a->column_v == b->column_v);
  SAME(a, b, parts.base);
  SAME(a, b, parts.rest);
  assert_true(a->parts.error == b->parts.error && a->parts.final == b->parts.final);
}

static void assert_same(const struct model *a, const struct model *b)
{
  const size_t count = a->scene ? a->scene->patch_count : 0;
  assert_int_equal(a->leaf_count, b->leaf_count);
  assert_int_equal(a->copy_count, b->copy_count);
  assert_true(!a->leaves == !b->leaves && !a->patches == !b->patches && !a->places == !b->places);
  SAME(a, b, tree.origin);
  assert_true(a->tree.frame == b->tree.frame && a->size == b->size && a->unproven == b->unproven);
  assert_int_equal(a->tree.bvh.node_count, b->tree.bvh.node_count);
  assert_memory_equal(a->tree.bvh.nodes, b->tree.bvh.nodes, a->tree.bvh.node_count * sizeof *a->tree.bvh.nodes);
  for (size_t p = 0; p < count; p++) {
    SAME(&a->cuts[p], &b->cuts[p], split);
    if (a->patches) SAME(&a->patches[p], &b->patches[p], x);
    if (a->patches) assert_memory_equal(a->patches[p].rest, b->patches[p].rest, sizeof(double[3][4][4]));
  }
  assert_true(!a->oriented == !b->oriented);
  for (size_t l = 0; a->oriented && l < a->leaf_count; l++) SAME(a, b, oriented[l].g), SAME(a, b, oriented[l].half);
  for (size_t k = 0; k < 4 * count; k++) {
    const struct edge_neighbour *m = &a->neighbours[k], *n = &b->neighbours[k];
    assert_true(m->patch == n->patch && m->border == n->border && m->reversed == n->reversed);
  }
  for (size_t l = 0; l < a->leaf_count; l++)
    if (a->places) SAME(a, b, places[l]);
    else assert_same_leaf(&a->leaves[l], &b->leaves[l]);
  for (size_t k = 0; k < a->object_count; k++) assert_same(a->objects[k].model, b->objects[k].model);
}

/* Teams without threads: the last worker finds all the work; a worker's failure is the team's; no worker comes. */
static enum status last_first(size_t count, team_work *work, void *context)
{
  enum status status = STATUS_OK;
  for (size_t k = count; k-- > 0;)
    if (status == STATUS_OK) status = work(context, k);
  return status;
}

static int calls_left;

static enum status then_nobody(size_t count, team_work *work, void *context)
{
  return calls_left-- > 0 ? last_first(count, work, context) : STATUS_LIMIT;
}

static void try_teams(size_t side, size_t copies, int split, bool kept)
{
  struct trial trial;
  struct model *alone, *together;
  const struct team teams[] = {threads_team(5), threads_team(2), {last_first, 3}};
  trial_open(&trial, side, copies, split);
  assert_int_equal(model_create(&trial.scene, NULL, &alone), STATUS_OK);
  assert_true(!alone->leaves == !kept);
  const size_t count = side > 40 ? 1 : sizeof teams / sizeof *teams; /* preparing many patches takes long */
  for (size_t k = 0; k < count; k++) {
    assert_int_equal(model_create(&trial.scene, &teams[k], &together), STATUS_OK);
    assert_same(alone, together);
    model_destroy(together);
  }
  model_destroy(alone);
  trial_close(&trial);
}

TEST(kept) { try_teams(40, 0, 3, true); }

TEST(not_kept_for_a_split) { try_teams(70, 0, 24, false); }

TEST(not_kept_for_their_number) { try_teams(257, 0, 2, false); }

TEST(copied) { try_teams(10, 300, 0, true); }

/* Whichever of its calls for a team fails. */
TEST(short_of_threads)
{
  struct trial trial;
  struct model *model;
  trial_open(&trial, 40, 0, 3);
  const struct team failing = {then_nobody, 2};
  int failures = 0;
  for (enum status status = STATUS_LIMIT; status != STATUS_OK; failures++) {
    calls_left = failures;
    status = model_create(&trial.scene, &failing, &model);
    assert_true(status == STATUS_OK || (status == STATUS_LIMIT && model == NULL));
    if (status == STATUS_OK) model_destroy(model);
  }
  assert_true(failures > 3);
  trial_close(&trial);
}

/* The work for a few patches is done before another thread has begun. */
TEST(few)
{
  struct trial trial;
  struct model *model;
  const struct team nobody = {then_nobody, 2};
  calls_left = 0;
  trial_open(&trial, 2, 0, 1);
  assert_int_equal(model_create(&trial.scene, &nobody, &model), STATUS_OK);
  model_destroy(model);
  trial_close(&trial);
}

static enum status measure_stack(void *context, size_t worker)
{
  pthread_attr_t attributes;
  size_t *stack = context;
  if (worker == 0) return STATUS_OK; /* the calling thread */
  assert_int_equal(pthread_getattr_np(pthread_self(), &attributes), 0);
  assert_int_equal(pthread_attr_getstacksize(&attributes, stack), 0);
  assert_int_equal(pthread_attr_destroy(&attributes), 0);
  return STATUS_OK;
}

/* If little stack is the default (`ulimit -s`), a thread still has what hard rays take. */
TEST(little_stack)
{
  pthread_attr_t attributes, before;
  size_t stack = 0;
  assert_int_equal(pthread_getattr_default_np(&before), 0);
  assert_int_equal(pthread_attr_init(&attributes), 0);
  assert_int_equal(pthread_attr_setstacksize(&attributes, 256 << 10), 0);
  assert_int_equal(pthread_setattr_default_np(&attributes), 0);
  const struct team team = threads_team(2);
  assert_int_equal(team.run(2, measure_stack, &stack), STATUS_OK);
  assert_true(stack >= 2 << 20);
  assert_int_equal(pthread_setattr_default_np(&before), 0);
  assert_int_equal(pthread_attr_destroy(&attributes), 0);
}

/* The chart's own arithmetic: the front, the judge, the choice of rays, the sweep. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "chart/judge.h"
#include "chart/point.h"
#include "chart/rays.h"
#include "cmocka_test.h"
#include "intersect/tracer.h"

static struct chart_point point(double ns, double error)
{
  struct chart_point p = {.camera.p99_of_all = error};
  p.time[RAYS_CAMERA].lower = p.time[RAYS_CAMERA].median = p.time[RAYS_CAMERA].upper = ns;
  return p;
}

TEST(test_front)
{
  struct chart_point points[] = {
    point(100, 1e-15), /* front: the most exact */
    point(100, 1e-12), /* as fast as the first, less exact */
    point(120, 1e-15), /* as exact, slower */
    point(50, 1e-5),   /* front */
    point(60, 1e-4),   /* beaten in both */
    point(10, 1),      /* front: the fastest */
    point(NAN, 1e-18), /* no time */
    point(1, NAN),     /* no error */
    point(50, 1e-5),   /* equal to another of the front, which comes first */
  };
  const bool expected[] = {true, false, false, true, false, true, false, false, false};
  const size_t count = sizeof points / sizeof points[0];
  point_front(points, count);
  for (size_t k = 0; k < count; k++) assert_int_equal(points[k].front, expected[k]);
}

/* Times are in units of the yardstick: those measured while the machine was half as fast are halved. */
TEST(test_level)
{
  struct chart_point points[] = {point(300, 1e-15), point(NAN, 1e-15), point(200, 1e-15)};
  points[0].time[RAYS_CAMERA].ratio = 1.5;                                     /* the yardstick took 200 */
  points[1].time[RAYS_CAMERA].ratio = points[2].time[RAYS_CAMERA].ratio = NAN; /* measured without the yardstick */
  points[0].time[RAYS_SHADOW] = points[1].time[RAYS_CAMERA];
  const double yard[RAY_KINDS] = {100, 50};
  point_level(points, 3, yard);
  assert_true(points[0].time[RAYS_CAMERA].median == 150 && points[0].time[RAYS_CAMERA].upper == 150);
  assert_true(points[2].time[RAYS_CAMERA].median == 200);
  assert_true(isnan(points[0].time[RAYS_SHADOW].median) && isnan(points[1].time[RAYS_CAMERA].median));
}

static void count_up(void *context, enum ray_kind kind, struct answer *answers)
{
  assert_null(answers);
  size_t *calls = context;
  calls[kind]++;
}

TEST(test_measure)
{
  size_t calls[2][RAY_KINDS] = {{0}};
  const struct runner runners[2] = {{count_up, calls[0]}, {count_up, calls[1]}};
  const size_t counts[RAY_KINDS] = {10, 0};
  struct timing time[2][RAY_KINDS];
  assert_int_equal(measure_rounds(runners, 2, counts, 5, NULL, time), STATUS_OK);
  for (int k = 0; k < 2; k++) {
    const struct timing *t = &time[k][RAYS_CAMERA];
    assert_true(t->least > 0 && t->least <= t->lower && t->lower <= t->median && t->median <= t->upper &&
                t->upper <= t->most);
    assert_true(isnan(time[k][RAYS_SHADOW].median)); /* there are no shadow rays */
    assert_true(calls[k][RAYS_CAMERA] >= 6 && calls[k][RAYS_SHADOW] == 0);
  }
  assert_true(time[0][RAYS_CAMERA].ratio == 1);
  assert_int_equal(measure_rounds(runners, 2, counts, 1, NULL, time), STATUS_OK);
  const double median[2] = {time[0][RAYS_CAMERA].median, time[1][RAYS_CAMERA].median};
  assert_true(fabs(time[1][RAYS_CAMERA].ratio * median[0] / median[1] - 1) < 1e-12); /* relative to the first one */
  atomic_int stop = 1;
  assert_int_equal(measure_rounds(runners, 2, counts, 5, &stop, time), STATUS_INTERRUPTED);
}

/* The truth, a third of the way, is known beyond double precision. */
TEST(test_truths)
{
  struct scene_patch patch = {0};
  for (int n = 0; n < 16; n++)
    patch.P[n / 4][n % 4][0] = n % 4 - 1, patch.P[n / 4][n % 4][1] = n / 4 - 1, patch.P[n / 4][n % 4][2] = 1;
  const struct scene scene = {.patches = &patch, .patch_count = 1};
  struct ray rays[] = {{.direction = {0, 0, 3}, .t_max = INFINITY}, {.direction = {0, 0, -3}, .t_max = INFINITY}};
  const struct ray_list list = {.rays = rays, .count = 2};
  struct truth truths[2];
  if (!judge_available()) skip();
  assert_int_equal(judge_truths(&scene, &list, NULL, truths), STATUS_OK);
  assert_true(truths[0].kind == TRUTH_HIT && truths[0].patch == 0 && !truths[0].shared);
  assert_true(truths[0].t == 1.0 / 3 && fabs(truths[0].t_rest - 0x1p-54 / 3) < 1e-30);
  assert_true(truths[1].kind == TRUTH_MISS && isinf(truths[1].t));
}

TEST(test_judge)
{
  const struct truth truths[] = {
    {TRUTH_HIT, 2, 0, 4, false},
    {TRUTH_HIT, 2, 0x1p-52, 4, false},
    {TRUTH_HIT, 2, 0, 4, false},
    {TRUTH_HIT, 2, 0, 4, true},
    {TRUTH_HIT, 2, 0, 4, false},
    {TRUTH_MISS, INFINITY, 0, HIT_NONE, false},
    {TRUTH_MISS, INFINITY, 0, HIT_NONE, false},
    {TRUTH_UNDECIDED, INFINITY, 0, HIT_NONE, false},
    {TRUTH_HIT, 2, 0, 4, false},
  };
  const struct answer answers[] = {
    {2, 4},               /* exact */
    {2 + 0x1p-51, 4},     /* off by 2^-52 of 2 */
    {2.001, 5},           /* the right place, another patch */
    {2.002, 5},           /* on a shared edge: either patch will do */
    {3, 4},               /* wrong */
    {INFINITY, HIT_NONE}, /* right */
    {1, 0},               /* invented */
    {1, 0},               /* undecided */
    {INFINITY, HIT_NONE}, /* lost */
  };
  enum { COUNT = sizeof truths / sizeof truths[0] };
  double errors[2 * COUNT];
  struct judgement j;
  judge_answers(COUNT, truths, answers, errors, &j);
  assert_int_equal(j.rays, COUNT);
  assert_int_equal(j.undecided, 1);
  assert_int_equal(j.hits, 6);
  assert_int_equal(j.lost, 1);
  assert_int_equal(j.invented, 1);
  assert_int_equal(j.wrong, 1);
  assert_int_equal(j.other_patch, 1);
  assert_true(j.median == 0x1p-53);
  assert_true(fabs(j.max - 0.001) < 1e-12 && j.p99 == j.max); /* the wrong one has no place */
  assert_true(j.p99_of_all == 1);
  /* Where nothing can be hit, an invented hit leaves no error, and no place on the front. */
  judge_answers(2, truths + 5, answers + 5, errors, &j);
  assert_true(j.hits == 0 && j.invented == 1 && isnan(j.p99_of_all));
}

/* A hit that is lost, invented or wrong counts as an error of 1, no more. A peer that knows no patches never has
 * another patch. */
TEST(test_judge_errors)
{
  const struct truth truths[] = {{TRUTH_HIT, 2, 0, 4, false}, {TRUTH_MISS, INFINITY, 0, HIT_NONE, false}};
  const struct answer right[] = {{2, ANSWER_PATCH_UNKNOWN}, {INFINITY, HIT_NONE}}, invented[] = {{2, 4}, {1, 0}},
                      wrong = {8, 5}, lost = {INFINITY, HIT_NONE};
  double errors[4];
  struct judgement j;
  judge_answers(2, truths, right, errors, &j);
  assert_true(j.other_patch == 0 && j.wrong == 0 && j.p99_of_all == 0);
  judge_answers(2, truths, invented, errors, &j);
  assert_true(j.invented == 1 && j.p99 == 0 && j.p99_of_all == 1);
  judge_answers(1, truths, &wrong, errors, &j);
  assert_true(j.wrong == 1 && isnan(j.max) && j.p99_of_all == 1 && j.other_patch == 0);
  memset(errors, 0, sizeof errors);
  judge_answers(1, truths, &lost, errors, &j);
  assert_true(j.lost == 1 && isnan(j.median) && isnan(j.p99) && isnan(j.max) && j.p99_of_all == 1);
}

TEST(test_judge_occluded)
{
  const struct ray rays[4] = {{.t_max = 1}, {.t_max = 1}, {.t_max = 1}, {.t_max = 1}};
  const struct truth truths[4] = {{TRUTH_HIT, 0.5, 0, 0, false},
                                  {TRUTH_HIT, 1.5, 0, 0, false},
                                  {TRUTH_MISS, INFINITY, 0, HIT_NONE, false},
                                  {TRUTH_UNDECIDED, 0, 0, 0, false}};
  const struct answer miss = {INFINITY, HIT_NONE}, hit = {0, 0};
  const struct answer none[4] = {miss, miss, miss, miss}, all[4] = {hit, hit, hit, hit};
  struct judgement j;
  judge_occluded(4, rays, truths, none, &j);
  assert_true(j.hits == 1 && j.lost == 1 && j.invented == 0 && j.undecided == 1);
  judge_occluded(4, rays, truths, all, &j);
  assert_true(j.lost == 0 && j.invented == 2);
}

/* All rays are the pixels' own, each once, if all are wanted. Fewer are whole strips, spread over the picture. */
TEST(test_rays)
{
  const struct scene scene = {.camera = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}}};
  enum { WIDTH = 70, HEIGHT = 45 }; /* multiples neither of a tile's side nor of a packet's */
  struct arena *arena = arena_create();
  struct ray_list list;
  assert_int_equal(rays_of_camera(&scene, WIDTH, HEIGHT, WIDTH * HEIGHT, arena, &list), STATUS_OK);
  assert_int_equal(list.count, WIDTH * HEIGHT);
  static int seen[HEIGHT][WIDTH];
  for (size_t k = 0; k < list.count; k++) {
    const int x = (int)floor((list.rays[k].direction[0] + 0.5) * WIDTH),
              y = (int)floor((0.5 - list.rays[k].direction[1]) * HEIGHT);
    seen[y][x]++;
  }
  for (int k = 0; k < WIDTH * HEIGHT; k++) assert_int_equal(seen[k / WIDTH][k % WIDTH], 1);
  size_t packed = 0;
  for (size_t k = 0; k < list.packet_count; k++) {
    assert_true(list.packets[k].first == packed && list.packets[k].count > 0);
    packed += list.packets[k].count;
  }
  assert_int_equal(packed, list.count);
  assert_int_equal(rays_of_camera(&scene, 640, 640, 640, arena, &list), STATUS_OK);
  assert_int_equal(list.count, 640);
  double lowest = 1, highest = -1;
  for (size_t k = 0; k < list.count; k++) {
    lowest = fmin(lowest, list.rays[k].direction[1]);
    highest = fmax(highest, list.rays[k].direction[1]);
  }
  assert_true(lowest < -0.35 && highest > 0.35);
  arena_destroy(arena);
}

/* Shadow rays go packet by packet, one light after the other, none to a shadowless one. A run of them begins with the
 * first packet of camera rays that sends some. */
TEST(test_shadow_rays)
{
  enum { LIGHTS = 3, PACKETS = 5, HITS = 3 };
  struct scene_light lights[] = {{.position = {0, 0, 5}},
                                 {.position = {0, 0, 9}, .shadowless = true},
                                 {.position = {0, 0, 6}},
                                 {.position = {0, 0, 7}}};
  const struct scene scene = {.lights = lights, .light_count = LIGHTS + 1};
  struct ray rays[PACKETS];
  struct ray_packet packets[PACKETS] = {{0, 1, true}, {1, 1, false}, {2, 1, false}, {3, 1, true}, {4, 1, false}};
  const struct ray_list camera = {.rays = rays, .packets = packets, .count = PACKETS, .packet_count = PACKETS};
  const struct hit hit = {.patch = 0, .certainty = CERTAINTY_GRAZING, .u = 0.5, .v = 0.5, .normal = {0, 0, 1}},
                   miss = {.patch = HIT_NONE};
  const struct hit hits[PACKETS] = {miss, hit, hit, miss, hit};
  const bool begins[HITS] = {true, false, true};
  for (int k = 0; k < PACKETS; k++) rays[k] = (struct ray){.direction = {0, 0, -1}, .t_max = 1};
  struct arena *arena = arena_create();
  struct ray_list shadows;
  const struct kernel *kernels[KERNELS_MAX];
  (void)kernels_here(kernels);
  struct tracer tracer = {.kernel = kernels[0]}; /* for hits that are not certain nothing is traced */
  assert_int_equal(rays_of_shadows(&scene, &tracer, &camera, hits, arena, &shadows), STATUS_OK);
  assert_int_equal(shadows.count, LIGHTS * HITS);
  assert_int_equal(shadows.packet_count, LIGHTS * HITS);
  for (size_t k = 0; k < LIGHTS * HITS; k++) {
    assert_true(shadows.packets[k].first == k && shadows.packets[k].count == 1);
    assert_int_equal(shadows.packets[k].new_run, k % LIGHTS == 0 && begins[k / LIGHTS]);
    assert_true(fabs(shadows.rays[k].direction[2] - (5 + (double)(k % LIGHTS))) < 1e-6);
  }
  arena_destroy(arena);
}

/* The first is the default, and all are different. Each power of the tolerance comes with polish and without; for the
 * three solvers of all roots, with both bases, both starts and the paper's forms; and with whole patches, from each
 * start. */
TEST(test_sweep)
{
  for (int quick = 0; quick < 2; quick++) {
    static struct sweep_point sweep[SWEEP_MOST];
    const size_t count = point_sweep(quick, sweep), powers = quick ? 3 : 15;
    assert_int_equal(count, 1 + (2 * powers + 1) + 3 * ((8 + 2) * powers + 2));
    assert_ptr_equal(sweep[0].options.roots.solver, solver_at(0));
    size_t whole = 0;
    for (size_t a = 1; a < count; a++) {
      whole += sweep[a].options.split == 1;
      for (size_t b = a + 1; b < count; b++) {
        bool same = sweep[a].options.roots.solver == sweep[b].options.roots.solver;
        for (size_t k = 0; same && k < method_item_count(); k++)
          same = method_item_at(k)->get(&sweep[a].options) == method_item_at(k)->get(&sweep[b].options);
        assert_false(same);
      }
    }
    assert_int_equal(whole, 1 + 3 * (2 + 2 * powers)); /* with the paper's form */
  }
}

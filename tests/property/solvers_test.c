/* All methods give the default's answers, as far as each says what it needs. (That a ray's answer does not depend on the
 * rays beside it: packets_test.c.) */
#include <string.h>

#include "cmocka_test.h"
#include "method_of.h"
#include "property/world.h"

enum { SEED = 20240521, SCENES = 2, RAYS = 96 };

/* The nearest hits by a method. */
static void answer(const struct method *method, world_net *nets, size_t count, const struct ray rays[RAYS],
                   struct hit hits[RAYS])
{
  struct world world;
  world_open(&world, nets, count, method);
  for (size_t n = 0; n < RAYS; n += PACKET_SIZE) tracer_closest(world.tracer, PACKET_SIZE, rays + n, hits + n);
  world_close(&world);
}

static int certain_hits(const struct hit hits[RAYS])
{
  int count = 0;
  for (int n = 0; n < RAYS; n++) count += hits[n].patch != HIT_NONE && hits[n].certainty == CERTAINTY_CERTAIN;
  return count;
}

/* On lanes, on whole patches and leaves, from cold and from previous starts, and by other algebra. */
static const char *const ways[] = {
  "bernstein",
  "aberth { split 1 }",
  "aberth { split 1 start previous }",
  "aberth",
  "aberth { split 2 start previous }",
  "aberth { resultant sylvester }",
  "newton { split 1 }",
  "newton { split 1 start previous }",
  "newton",
  "newton { back_substitution euclid }",
  "laguerre { split 1 }",
  "laguerre { start previous }",
  "laguerre { resultant sylvester }",
  "durand_kerner { split 1 }",
  "durand_kerner { split 2 start previous }",
  "durand_kerner",
  "durand_kerner { back_substitution euclid }",
  "bernstein { resultant sylvester }",
  "bernstein { back_substitution euclid }",
  "bernstein { split 3 }",
  "bernstein { split 10 }",
  "bernstein { split 49 }",
};
enum { WAYS = sizeof ways / sizeof ways[0] };

TEST(answers_are_the_defaults)
{
  struct random random = {SEED};
  int wrong = 0, certain[WAYS] = {0};
  for (int scene = 0; scene < SCENES * WORLD_KINDS; scene++) {
    static world_net nets[WORLD_MAX];
    static struct ray rays[RAYS];
    static struct hit want[RAYS], got[RAYS];
    const int kind = scene % WORLD_KINDS;
    const size_t count = world_fill((enum world_kind)kind, &random, nets);
    for (int n = 0; n < RAYS; n++) rays[n] = world_ray(&random, nets, count, n % RAY_KINDS);
    for (int way = 0; way < WAYS; way++) {
      const struct method method = method_of(ways[way]);
      answer(&method, nets, count, rays, way > 0 ? got : want);
      certain[way] += certain_hits(way > 0 ? got : want);
      for (int n = 0; way > 0 && n < RAYS; n++)
        if (!hits_agree(&rays[n], &got[n], &want[n]) && wrong++ < 5)
          world_print_case(ways[way], kind, &rays[n], &want[n], &got[n]);
    }
  }
  assert_int_equal(wrong, 0);
  /* Most rays hit for certain, and what is certain does not become doubtful. */
  assert_true(certain[0] > SCENES * WORLD_KINDS * RAYS / 4);
  for (int way = 1; way < WAYS; way++) {
    if (certain[way] < certain[0] - certain[0] / 250)
      print_message("%s: %d of %d\n", ways[way], certain[way], certain[0]);
    assert_true(certain[way] >= certain[0] - certain[0] / 250);
  }
}

/* Without polish the solver's roots are the answer, whatever bounds on the coefficients say that are known beforehand.
 * On rays near the axis of a height field these exceed all coefficients of r; yet every hit is found. */
TEST(bare_roots_are_the_solvers_own)
{
  static const double slants[2] = {0.12, 0.012}; /* 7 degrees, 0.7 degrees */
  enum { FIELDS = 8, SPLITS = 3 };
  static const int splits[SPLITS] = {0, 1, 3};
  struct random random = {SEED + 3};
  static struct ray rays[RAYS];
  static struct hit want[RAYS], got[RAYS];
  int hits = 0, lost = 0;
  for (int field = 0; field < FIELDS; field++) {
    static world_net net[1];
    for (int n = 0; n < 16; n++) {
      const double at[3] = {n / 4, n % 4, random_between(&random, -1, 1)};
      memcpy(net[0][n / 4][n % 4], at, sizeof at);
    }
    for (int n = 0; n < RAYS; n++) {
      const double slant = slants[n % 2];
      rays[n] = (struct ray){
        .origin = {random_between(&random, 0, 3), random_between(&random, 0, 3), -8},
        .direction = {random_between(&random, -slant, slant), random_between(&random, -slant, slant), 1},
        .t_max = INFINITY};
      for (int k = 0; k < 2; k++) rays[n].origin[k] -= 8 * rays[n].direction[k];
    }
    answer(NULL, net, 1, rays, want);
    for (size_t way = 0; way < SPLITS * solver_count(); way++) {
      struct method options = method_of(solver_at(way / SPLITS)->name);
      options.polish = false, options.split = splits[way % SPLITS];
      answer(&options, net, 1, rays, got);
      for (int n = 0; n < RAYS; n++) {
        if (want[n].patch == HIT_NONE) continue;
        hits++;
        if ((got[n].patch == HIT_NONE || fabs(got[n].t - want[n].t) > 1e-6) && lost++ < 5)
          world_print_case(solver_at(way / SPLITS)->name, splits[way % SPLITS], &rays[n], &want[n], &got[n]);
      }
    }
  }
  assert_true(hits > FIELDS * RAYS);
  assert_in_range(lost, 0, hits / 1000);
}

/* If eps asks for less than a rounding, the methods that move all roots at once end beside the real axis; their
 * values are accepted as real. The paper's form then loses no more hits than at an eps that they reach, and has no
 * more phantoms. */
TEST(rounding_makes_no_root_complex)
{
  static const double eps[2] = {1e-8, 1e-15};
  static const char *const methods[] = {"aberth { form paper }", "durand_kerner { form paper }"};
  enum { SLACK = 4 };
  struct random random = {SEED + 2};
  int wrong[2] = {0}, phantoms[2] = {0}, hits = 0;
  for (int scene = 0; scene < 8; scene++) {
    static world_net nets[WORLD_MAX];
    static struct ray rays[RAYS];
    static struct hit want[RAYS], got[RAYS];
    const size_t count = world_fill(WORLD_WILD, &random, nets);
    for (int n = 0; n < RAYS; n++) rays[n] = world_ray(&random, nets, count, 0);
    answer(NULL, nets, count, rays, want);
    hits += certain_hits(want);
    for (int e = 0; e < 2; e++) {
      struct method options = method_of(methods[scene % 2]);
      options.roots.tolerance = eps[e];
      answer(&options, nets, count, rays, got);
      for (int n = 0; n < RAYS; n++) {
        if (want[n].certainty != CERTAINTY_CERTAIN) continue;
        const bool hit = want[n].patch != HIT_NONE, found = got[n].patch != HIT_NONE;
        wrong[e] += hit && !(found && fabs(got[n].t - want[n].t) <= 0.01 * want[n].t);
        phantoms[e] += !hit && found;
      }
    }
  }
  assert_true(hits > RAYS);
  assert_in_range(wrong[1], 0, wrong[0] + SLACK);
  assert_in_range(phantoms[1], 0, phantoms[0] + SLACK);
}

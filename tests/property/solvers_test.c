/* The methods on lanes (all_roots.c), on whole patches and leaves, give the default's answers, and a ray's answer
 * does not depend on the rays beside it. */
#include <string.h>

#include "cmocka_test.h"
#include "property/world.h"

enum { SEED = 20240521, SCENES = 4, RAYS = 160 };

static struct method method_of(const char *name, enum start start, int split)
{
  struct method options;
  method_default(solver_find(name, strlen(name)), &options);
  options.roots.start = start, options.split = split;
  return options;
}

static void answer(struct world *world, const struct ray rays[RAYS], struct hit hits[RAYS])
{
  for (size_t n = 0; n < RAYS; n += PACKET_SIZE) tracer_closest(world->tracer, PACKET_SIZE, rays + n, hits + n);
}

static int certain_hits(const struct hit hits[RAYS])
{
  int count = 0;
  for (int n = 0; n < RAYS; n++) count += hits[n].patch != HIT_NONE && hits[n].certainty == CERTAINTY_CERTAIN;
  return count;
}

TEST(answers_are_the_defaults)
{
  static const struct {
    const char *name, *solver;
    enum start start;
    int split;
  } ways[] = {{"aberth", "aberth", START_COLD, 1},
              {"warm", "aberth", START_PREVIOUS, 1},
              {"leaves", "aberth", START_COLD, 0},
              {"few, warm", "aberth", START_PREVIOUS, 2},
              {"newton", "newton", START_COLD, 1},
              {"warm", "newton", START_PREVIOUS, 1},
              {"leaves", "newton", START_COLD, 0},
              {"laguerre", "laguerre", START_COLD, 1},
              {"leaves, warm", "laguerre", START_PREVIOUS, 0},
              {"durand_kerner", "durand_kerner", START_COLD, 1},
              {"few, warm", "durand_kerner", START_PREVIOUS, 2},
              {"leaves", "durand_kerner", START_COLD, 0}};
  enum { WAYS = sizeof ways / sizeof ways[0] };
  struct random random = {SEED};
  int wrong = 0, certain[1 + WAYS] = {0};
  uint64_t escalated[1 + WAYS] = {0};
  for (int scene = 0; scene < SCENES * WORLD_KINDS; scene++) {
    static world_net nets[WORLD_MAX];
    static struct ray rays[RAYS];
    static struct hit want[RAYS], got[RAYS];
    const int kind = scene % WORLD_KINDS;
    const size_t count = world_fill((enum world_kind)kind, &random, nets);
    for (int n = 0; n < RAYS; n++) rays[n] = world_ray(&random, nets, count, n % RAY_KINDS);
    for (int way = 0; way <= WAYS; way++) {
      struct world world;
      const int w = way > 0 ? way - 1 : 0;
      const struct method options = method_of(ways[w].solver, ways[w].start, ways[w].split);
      world_open(&world, nets, count, way > 0 ? &options : NULL);
      answer(&world, rays, way > 0 ? got : want);
      certain[way] += certain_hits(way > 0 ? got : want);
      escalated[way] += tracer_counts(world.tracer)->escalated;
      world_close(&world);
      for (int n = 0; way > 0 && n < RAYS; n++)
        if (!hits_agree(&rays[n], &got[n], &want[n]) && wrong++ < 5)
          world_print_case(ways[way - 1].name, kind, &rays[n], &want[n], &got[n]);
    }
  }
  print_message("certain hits, undecided by lanes: default %d, %d", certain[0], (int)escalated[0]);
  for (int way = 1; way <= WAYS; way++)
    print_message("; %s %d, %d", ways[way - 1].name, certain[way], (int)escalated[way]);
  print_message("\n");
  assert_int_equal(wrong, 0);
  /* Most rays hit for certain, and what is certain does not become doubtful. */
  assert_true(certain[0] > SCENES * WORLD_KINDS * RAYS / 4);
  for (int way = 1; way <= WAYS; way++) assert_true(certain[way] >= certain[0] - certain[0] / 500);
}

TEST(answers_do_not_depend_on_companions)
{
  struct random random = {SEED + 1};
  int wrong = 0;
  for (int scene = 0; scene < SCENES * WORLD_KINDS; scene++) {
    static world_net nets[WORLD_MAX];
    static struct ray rays[RAYS];
    static struct hit hits[RAYS];
    static const char *const solvers[] = {"aberth", "newton", "laguerre", "durand_kerner"};
    const struct method options = method_of(solvers[scene % 4], START_COLD, 1 + scene / 4 % 2);
    const int kind = scene % WORLD_KINDS;
    const size_t count = world_fill((enum world_kind)kind, &random, nets);
    struct world world;
    world_open(&world, nets, count, &options);
    for (int n = 0; n < RAYS; n++) rays[n] = world_ray(&random, nets, count, n % RAY_KINDS);
    answer(&world, rays, hits);
    for (int n = 0; n < RAYS; n++) {
      const struct hit alone = world_closest(&world, &rays[n]);
      if (!same_hit(&alone, &hits[n]) && wrong++ < 5) world_print_case("companions", kind, &rays[n], &alone, &hits[n]);
    }
    world_close(&world);
  }
  assert_int_equal(wrong, 0);
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
    struct world world;
    world_open(&world, net, 1, NULL);
    answer(&world, rays, want);
    world_close(&world);
    for (size_t way = 0; way < SPLITS * solver_count(); way++) {
      struct method options = method_of(solver_at(way / SPLITS)->name, START_COLD, splits[way % SPLITS]);
      options.polish = false;
      world_open(&world, net, 1, &options);
      answer(&world, rays, got);
      world_close(&world);
      for (int n = 0; n < RAYS; n++) {
        if (want[n].patch == HIT_NONE) continue;
        hits++;
        if ((got[n].patch == HIT_NONE || fabs(got[n].t - want[n].t) > 1e-6) && lost++ < 5)
          world_print_case(solver_at(way / SPLITS)->name, splits[way % SPLITS], &rays[n], &want[n], &got[n]);
      }
    }
  }
  print_message("of %d hits on height fields %d lost\n", hits, lost);
  assert_true(hits > FIELDS * RAYS);
  assert_in_range(lost, 0, hits / 1000);
}

/* If eps asks for less than a rounding, the methods that move all roots at once end beside the real axis; their
 * values are accepted as real. The paper's form then loses no more hits than at an eps that they reach, and has no
 * more phantoms. */
TEST(rounding_makes_no_root_complex)
{
  static const double eps[2] = {1e-8, 1e-15};
  static const char *const methods[] = {"aberth", "durand_kerner"};
  enum { SLACK = 4 };
  struct random random = {SEED + 2};
  int wrong[2] = {0}, phantoms[2] = {0}, hits = 0;
  for (int scene = 0; scene < 2 * SCENES; scene++) {
    static world_net nets[WORLD_MAX];
    static struct ray rays[RAYS];
    static struct hit want[RAYS], got[RAYS];
    const size_t count = world_fill(WORLD_WILD, &random, nets);
    for (int n = 0; n < RAYS; n++) rays[n] = world_ray(&random, nets, count, 0);
    struct world world;
    world_open(&world, nets, count, NULL);
    answer(&world, rays, want);
    world_close(&world);
    hits += certain_hits(want);
    for (int e = 0; e < 2; e++) {
      struct method options = method_of(methods[scene % 2], START_COLD, 1);
      const struct method_item *form = method_item_find("form");
      form->set(&options, 0);
      options.roots.tolerance = eps[e];
      world_open(&world, nets, count, &options);
      answer(&world, rays, got);
      for (int n = 0; n < RAYS; n++) {
        if (want[n].certainty != CERTAINTY_CERTAIN) continue;
        const bool hit = want[n].patch != HIT_NONE, found = got[n].patch != HIT_NONE;
        wrong[e] += hit && !(found && fabs(got[n].t - want[n].t) <= 0.01 * want[n].t);
        phantoms[e] += !hit && found;
      }
      world_close(&world);
    }
  }
  print_message("of %d hits %d, %d not found, %d, %d phantoms\n", hits, wrong[0], wrong[1], phantoms[0], phantoms[1]);
  assert_true(hits > RAYS);
  assert_in_range(wrong[1], 0, wrong[0] + SLACK);
  assert_in_range(phantoms[1], 0, phantoms[0] + SLACK);
}

int main(void)
{
  print_message("seed %d\n", SEED);
  return test_run();
}

/* Hits next to their rays' starts: t is right to its last places, however small it is beside the patch, and in any
 * packet. */
#include <math.h>

#include "cmocka_test.h"
#include "property/world.h"
#include "reference/reference.h"
#include "worse.h"

enum { SEED = 20261123, SCENES = 6, PACKETS = 40, RAYS = PACKET_SIZE };

/* How near to the surface rays start, in powers of two of a scene of size 1. Nearer than NEAR, a patch's own digits
 * no longer determine t, and t is rounded only once. */
enum { FARTHEST = -8, NEAREST = -42, NEAR = -19 };

/* Makes a ray to a hit of another ray, from next to it. The point is rounded, so the reference says what t is. */
static bool next_to_surface(struct random *random, const struct world *world, world_net *nets, size_t count, int n,
                            struct ray *out)
{
  const struct ray ray = world_ray(random, nets, count, n % RAY_KINDS);
  const struct hit hit = world_closest(world, &ray);
  if (hit.patch == HIT_NONE) return false;
  const double way = exp2(random_between(random, NEAREST, FARTHEST));
  *out = (struct ray){.t_max = INFINITY};
  for (int c = 0; c < 3; c++) out->direction[c] = random_between(random, -1, 1);
  for (int c = 0; c < 3; c++) out->origin[c] = hit.point[c] - way * out->direction[c];
  return true;
}

static double worst[2]; /* the last entry: of near starts */
static int told[2];

static void check(const struct reference *reference, const struct ray *ray, const struct hit *hit)
{
  struct reference_answer exact;
  reference_closest(reference, ray->origin, ray->direction, &exact);
  if (exact.verdict != REFERENCE_HIT || hit->certainty != CERTAINTY_CERTAIN) return;
  assert_int_not_equal(hit->patch, HIT_NONE);
  const double t = (double)exact.t, place = nextafter(t, INFINITY) - t;
  if (exact.shared || exact.t_radius > 0.01 * place) return; /* the neighbour's hit, or edge-on */
  const double *d = ray->direction;
  const bool near = t * sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) < exp2(NEAR);
  told[near]++;
  worst[near] = worse(worst[near], (double)quad_abs(hit->t - exact.t) / place);
}

TEST(hits_next_to_the_start_have_their_last_places)
{
  struct random random = {SEED};
  world_net nets[WORLD_MAX];
  for (int scene = 0; scene < SCENES; scene++) {
    const enum world_kind kind = scene % 3 == 0 ? WORLD_GRID : scene % 3 == 1 ? WORLD_WILD : WORLD_LOW;
    const size_t count = world_fill(kind, &random, nets);
    struct world world;
    world_open(&world, nets, count, NULL);
    struct reference *reference = reference_create((const double(*)[4][4][3])nets, count);
    assert_non_null(reference);
    for (int n = 0; n < PACKETS; n++) {
      struct ray rays[RAYS];
      struct hit hits[RAYS];
      for (size_t k = 0; k < RAYS; k++)
        while (!next_to_surface(&random, &world, nets, count, n, &rays[k])) continue;
      tracer_closest(world.tracer, RAYS, rays, hits);
      for (size_t k = 0; k < RAYS; k++) {
        const struct hit alone = world_closest(&world, &rays[k]);
        assert_same_hit("next to the start", (int)kind, &rays[k], &alone, &hits[k]);
        check(reference, &rays[k], &hits[k]);
      }
    }
    reference_destroy(reference);
    world_close(&world);
  }
  print_message("t of %d hits off by %.3f last places at most, of %d that are near by %.3f\n", told[0], worst[0],
                told[1], worst[1]);
  assert_true(told[0] > SCENES * PACKETS * RAYS / 8 && told[1] > SCENES * PACKETS * RAYS / 4);
  assert_true(worst[0] <= 2);
  assert_true(worst[1] <= 0.51);
}

/* Rays, patches and lengths over the whole range of numbers that are read, in all combinations: a ray through the middle of a
 * patch meets it, whatever their sizes and wherever the ray starts. */
#include <string.h>
#include <math.h>

#include "base/wide.h"
#include "cmocka_test.h"
#include "property/world.h"

enum { SEED = 20261122, SCENES = 1500, RAYS = PACKET_SIZE };

static const double sizes[] = {1e-100, 1e-90, 1e-60, 1e-30, 1e-10, 1e-5, 0.25, 0.5,  1,
                               1,      1,     1e5,   1e10,  1e30,  1e60, 1e90, 1e100};

static double any_size(struct random *random)
{
  return sizes[random_bits(random) % (sizeof sizes / sizeof *sizes)] * (1 - 0.3 * random_unit(random));
}

/* A root nearer to the ray's start than this part of the patch cannot be told from it by 113 bits. */
#define NEAR_START 1e-29

/* A ray that meets the patch next to its middle, at a t known to a part of `bend`. */
struct shot {
  struct ray ray;
  double start; /* the distance of its start, in sizes */
  wide t;
  bool hits; /* within the ray's range */
};

/* Across axis k, or along a diagonal through the middle of the frame. */
static struct shot make_shot(struct random *random, int k, double size)
{
  const double away = any_size(random), length = any_size(random);
  const bool diagonal = random_bits(random) % 2;
  struct shot shot = {.ray = {.t_max = INFINITY}, .start = away / size, .t = (wide)away / length, .hits = true};
  for (int c = 0; c < 3; c++) {
    const double side = random_bits(random) % 2 ? 1 : -1;
    const bool along = diagonal || c == k;
    shot.ray.origin[c] = along ? -side * away : size * random_between(random, -0.5, 0.5);
    shot.ray.direction[c] = along ? side * length : 0;
  }
  const double twice = (double)(2 * shot.t), half = (double)(shot.t / 2);
  const bool plain = shot.start > 1e3; /* then the bend does not matter */
  switch (random_bits(random) % 4) {
  case 0:
    if (plain) shot.ray.t_max = twice;
    break;
  case 1:
    if (plain) shot.ray.t_min = half;
    break;
  case 2:
    if (plain) shot.ray.t_max = half, shot.hits = false;
    break;
  default: break;
  }
  return shot;
}

static const char *wrong_hit(const struct shot *shot, const struct hit *hit, bool flat)
{
  const bool certain = hit->certainty == CERTAINTY_CERTAIN;
  if (hit->patch == HIT_NONE) return !shot->hits ? NULL : certain ? "a certain miss" : "a miss";
  if (!shot->hits) return certain ? "a hit beyond the end" : NULL;
  if (!(hit->t > shot->ray.t_min && hit->t < shot->ray.t_max)) return "t out of range";
  const wide off = hit->t > shot->t ? hit->t - shot->t : shot->t - hit->t;
  if (certain && flat && off > 1e-15 * shot->t) return "a certain hit elsewhere";
  return NULL;
}

static int check(struct world *world, const struct shot shots[RAYS], bool flat)
{
  struct ray rays[RAYS];
  struct hit hits[RAYS];
  bool occluded[RAYS];
  int wrong = 0;
  for (int n = 0; n < RAYS; n++) rays[n] = shots[n].ray;
  tracer_closest(world->tracer, RAYS, rays, hits);
  tracer_occluded(world->tracer, RAYS, rays, occluded);
  for (int n = 0; n < RAYS; n++) {
    const struct shot *shot = &shots[n];
    if (shot->start < NEAR_START || (!flat && shot->start < 4)) continue;
    const struct hit alone = world_closest(world, &rays[n]);
    const struct hit_list list = world_all(world, &rays[n]);
    const char *what = wrong_hit(shot, &hits[n], flat);
    if (!what) what = wrong_hit(shot, &alone, flat);
    if (!what && occluded[n] != shot->hits) what = "occluded";
    if (!what && (list.count > 0) != shot->hits) what = "all hits";
    if (!what && list.count > 0) what = wrong_hit(shot, &list.hits[0], flat);
    if (!what) continue;
    if (wrong++ < 3) world_print_case(what, 0, &rays[n], &hits[n], &alone);
  }
  return wrong;
}

TEST(rays_and_patches_of_all_sizes)
{
  struct random random = {SEED};
  int wrong = 0;
  for (int scene = 0; scene < SCENES; scene++) {
    const int k = scene % 3;
    const double size = any_size(&random);
    const double bend = scene % 2 ? 0 : size * random_between(&random, 0, 0.3);
    world_net net[1];
    for (int i = 0; i < 4; i++) {
      for (int j = 0; j < 4; j++) {
        double *p = net[0][i][j];
        p[(k + 1) % 3] = (i - 1.5) * size, p[(k + 2) % 3] = (j - 1.5) * size;
        p[k] = bend * (i % 3 ? 1 : -1) * (j % 3 ? 1 : -1);
      }
    }
    struct world world;
    struct shot shots[RAYS];
    struct method method;
    method_default(solver_at((size_t)scene % solver_count()), &method);
    if (scene % 5 == 0) method.split = 1;
    world_open(&world, net, 1, &method);
    for (int n = 0; n < RAYS; n++) shots[n] = make_shot(&random, k, size);
    wrong += check(&world, shots, bend == 0);
    world_close(&world);
  }
  assert_int_equal(wrong, 0);
}

/* A floor over a square with a corner in the origin of the plane, at that height there. */
static void floor_at(double height, double size, double bend, world_net net)
{
  for (int n = 0; n < 16; n++) {
    net[n / 4][n % 4][0] = size * (n / 4 / 3.0), net[n / 4][n % 4][1] = size * (n % 4 / 3.0);
    net[n / 4][n % 4][2] = height + bend * (n / 4) * (n % 4);
  }
}

/* The ray meets a pole exactly, next to its start; the pole is known to lie on one side of t_min. */
TEST(poles_next_to_the_start_are_told)
{
  struct random random = {SEED + 3};
  world_net net[1];
  struct world world;
  floor_at(0, 1, 0.25, net[0]);
  memset(net[0][0], 0, sizeof net[0][0]);
  world_open(&world, net, 1, NULL);
  for (int n = 0; n < 4000; n++) {
    const double way = ldexp(rint(ldexp(random_between(&random, 1, 2), n % 53)), -330 + n % 7 * 9);
    struct ray ray = {{0, 0, -way}, {0, 0, random_between(&random, 1, 2)}, 0, INFINITY};
    const double t = way / ray.direction[2], off = (double)(n % 3 - 1);
    if (n % 5) ray.t_min = off == 0 ? t : nextafter(t, off > 0 ? 1 : 0);
    const struct hit hit = world_closest(&world, &ray);
    assert_int_equal(hit.certainty, CERTAINTY_CERTAIN);
    assert_int_equal(hit.patch != HIT_NONE, (wide)ray.t_min * ray.direction[2] < way);
  }
  world_close(&world);
}

/* Hits on patches far smaller than 2^-100 of their scene, the smallest size of a frame, have all their parts. */
TEST(patches_lost_in_their_scene_have_normals)
{
  for (int k = 100; k < 640; k += 20) {
    world_net nets[2];
    struct world world;
    const double size = ldexp(1, -k / 2);
    floor_at(0, ldexp(1, k - k / 2), 0, nets[0]);
    floor_at(0, 1, 0, nets[1]);
    for (int n = 0; n < 16; n++) { /* z = -(x + y), through the origin */
      double *p = nets[1][n / 4][n % 4];
      p[0] = (n / 4 - 1) * size, p[1] = (n % 4 - 1) * size, p[2] = -(p[0] + p[1]);
      nets[0][n / 4][n % 4][2] = -2 * ldexp(1, k - k / 2);
    }
    world_open(&world, nets, 2, NULL);
    const struct ray ray = {{0, 0, 5 * size}, {0, 0, -1}, 0, INFINITY};
    const struct hit hit = world_closest(&world, &ray);
    assert_int_equal(hit.patch, 1);
    assert_int_equal(hit.certainty, CERTAINTY_CERTAIN);
    for (int c = 0; c < 3; c++) assert_true(fabs(hit.normal[c] - sqrt(1.0 / 3)) < 1e-15);
    world_close(&world);
  }
}

/* A ray that starts exactly in a corner meets beyond it, in the same leaf or on borders too, what a ray meets that
 * starts before the corner and whose range begins there. A whole patch is one leaf; every third patch has a pole in that
 * corner. */
TEST(rays_from_a_corner_meet_what_is_beyond)
{
  enum { CORNER_SCENES = 600 };
  struct random random = {SEED + 4};
  int hits = 0, certain = 0;
  for (int n = 0; n < CORNER_SCENES; n++) {
    struct method method;
    struct world world;
    world_net net[1];
    method_default(solver_at(0), &method);
    if (n % 2) method.split = 1;
    for (int k = 0; k < 16; k++) { /* small whole numbers, so that starts and ends are exact */
      double *point = net[0][k / 4][k % 4];
      point[0] = k / 4, point[1] = k % 4, point[2] = rint(random_between(&random, -4, 4));
    }
    net[0][0][0][2] = 0;
    if (n % 3 == 0) memset(net[0][0], 0, sizeof net[0][0]);
    world_open(&world, net, 1, &method);
    const double *to = net[0][random_bits(&random) % 2 ? 3 : 0][3];
    struct ray ray = {.t_max = INFINITY}, before = {.t_min = 1, .t_max = INFINITY};
    for (int c = 0; c < 3; c++) {
      ray.direction[c] = n % 5 < 2 ? rint(random_between(&random, -3, 4)) : to[c];
      before.direction[c] = ray.direction[c], before.origin[c] = -ray.direction[c];
    }
    if (ray.direction[0] != 0 || ray.direction[1] != 0 || ray.direction[2] != 0) {
      const struct hit hit = world_closest(&world, &ray), other = world_closest(&world, &before);
      const bool same = hit.patch == HIT_NONE ? other.patch == HIT_NONE : fabs(hit.t + 1 - other.t) <= 1e-15 * other.t;
      const bool sure = hit.certainty == CERTAINTY_CERTAIN; /* the other ray meets the corner, where its range begins */
      if (sure && !same) {
        world_print_case("from a corner", 0, &ray, &hit, &other);
        fail();
      }
      hits += sure && hit.patch != HIT_NONE, certain += sure;
    }
    world_close(&world);
  }
  assert_in_range(hits, CORNER_SCENES / 8, CORNER_SCENES);
}

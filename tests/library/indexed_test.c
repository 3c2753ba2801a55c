/* Scenes of indexed patches and their instances; short answers; points and bounds of patches. */
#include <math.h>
#include <string.h>

#include "cmocka_test.h"
#include "library/pscn.h"
#include "random.h"

enum { PATCHES = 2, VERTICES = 28, INSTANCES = 3, RAYS = 400 };

/* Two wavy patches side by side: rows of seven vertices, the middle one in both. */
static void make_mesh(double vertices[VERTICES][3], uint32_t patches[PATCHES][16])
{
  for (int n = 0; n < VERTICES; n++) {
    const double at[3] = {n % 7, n / 7, sin(2.0 * n)};
    memcpy(vertices[n], at, sizeof at);
  }
  for (int k = 0; k < 16; k++)
    for (int p = 0; p < PATCHES; p++) patches[p][k] = (uint32_t)(7 * (k / 4) + 3 * p + k % 4);
}

static struct pscn_ray ray_down(struct random *random)
{
  struct pscn_ray ray = PSCN_RAY;
  const double from[3] = {random_between(random, -1, 7), random_between(random, -1, 4), 9};
  memcpy(ray.origin, from, sizeof from);
  ray.direction[0] = random_between(random, -0.1, 0.1), ray.direction[2] = -1;
  return ray;
}

/* The same answers as from the control points themselves, in full and in short; and a patch's point where it is hit. */
TEST(test_indexed)
{
  double vertices[VERTICES][3], nets[INSTANCES * PATCHES][16][3];
  static const double placed[INSTANCES][4][3] = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}},
                                                 {{0, 2, 0}, {1, 0, 0}, {0, 0, 0.5}, {0, 0, -8}},
                                                 {{-1, 0, 0.25}, {0, 1, 0}, {0, 0, 1}, {6, 0, 4}}};
  uint32_t patches[PATCHES][16];
  struct pscn_scene *scene, *same;
  struct random random = {7};
  size_t hits = 0;
  make_mesh(vertices, patches);
  for (int n = 0; n < INSTANCES * PATCHES * 48; n++) {
    const double(*M)[3] = placed[n / (PATCHES * 48)], *p = vertices[patches[n / 48 % PATCHES][n / 3 % 16]];
    nets[n / 48][n / 3 % 16][n % 3] = p[0] * M[0][n % 3] + p[1] * M[1][n % 3] + p[2] * M[2][n % 3] + M[3][n % 3];
  }
  assert_int_equal(
    pscn_scene_from_indexed(vertices[0], VERTICES, patches[0], PATCHES, placed[0][0], INSTANCES, NULL, &scene),
    PSCN_OK);
  assert_int_equal(
    pscn_scene_from_points(nets[0][0], INSTANCES * PATCHES, sizeof nets[0], sizeof nets[0][0], NULL, &same), PSCN_OK);
  assert_int_equal(pscn_patch_count(scene), INSTANCES * PATCHES);
  for (int n = 0; n < RAYS; n++) {
    const struct pscn_ray ray = ray_down(&random);
    struct pscn_hit hit, other;
    struct pscn_answer answer;
    assert_int_equal(pscn_nearest(scene, 1, &ray, 0, &hit, 0), PSCN_OK);
    assert_int_equal(pscn_nearest(same, 1, &ray, 0, &other, 0), PSCN_OK);
    assert_int_equal(pscn_nearest_answer(scene, 1, &ray, 0, &answer, 0), PSCN_OK);
    assert_memory_equal(&hit, &other, sizeof hit);
    assert_true(answer.t == hit.t && answer.u == hit.u && answer.v == hit.v && answer.patch == hit.patch);
    assert_true(answer.verdict == hit.verdict && answer.certain == hit.certain && answer.reserved == 0);
    if (hit.verdict != PSCN_HIT) continue;
    const struct pscn_place place = {hit.u, hit.v, hit.patch, 0};
    struct pscn_surface surface;
    double box[2][3], along = 0;
    hits++;
    assert_int_equal(pscn_surface(scene, 1, &place, 0, &surface, 0), PSCN_OK);
    assert_int_equal(pscn_bounds(scene, hit.patch, box), PSCN_OK);
    for (int c = 0; c < 3; c++) {
      assert_true(fabs(surface.point[c] - hit.point[c]) <= 1e-14 && surface.du[c] == hit.du[c]);
      assert_true(surface.point[c] >= box[0][c] && surface.point[c] <= box[1][c] && surface.dv[c] == hit.dv[c]);
      along += surface.normal[c] * hit.normal[c];
    }
    assert_true(fabs(fabs(along) - 1) <= 1e-14);
  }
  assert_true(hits > RAYS / 2);
  pscn_scene_free(same);
  pscn_scene_free(scene);
}

/* Floats make the patches that doubles of the same values make. */
TEST(test_floats)
{
  double vertices[VERTICES][3], nets[2][16][3], P[2][4][4][3];
  float floats[VERTICES][3], apart[PATCHES * 16][4];
  uint32_t patches[PATCHES][16];
  struct pscn_scene *scene[2];
  make_mesh(vertices, patches);
  for (int n = 0; n < VERTICES * 3; n++) floats[n / 3][n % 3] = (float)vertices[n / 3][n % 3];
  for (int n = 0; n < PATCHES * 16; n++) memcpy(apart[n], floats[patches[n / 16][n % 16]], sizeof floats[0]);
  for (int n = 0; n < PATCHES * 48; n++) nets[n / 48][n / 3 % 16][n % 3] = (double)apart[n / 3][n % 3];
  assert_int_equal(pscn_scene_from_float_indexed(floats[0], VERTICES, patches[0], PATCHES, NULL, 0, NULL, &scene[0]),
                   PSCN_OK);
  assert_int_equal(
    pscn_scene_from_float_points(apart[0], PATCHES, 16 * sizeof apart[0], sizeof apart[0], NULL, &scene[1]), PSCN_OK);
  for (int k = 0; k < 2; k++) {
    struct pscn_object object;
    for (size_t n = 0; n < PATCHES; n++) assert_int_equal(pscn_patch(scene[k], n, P[n]), PSCN_OK);
    assert_memory_equal(P, nets, sizeof nets);
    assert_int_equal(pscn_object(scene[k], 0, &object), PSCN_USAGE); /* not from a text */
    pscn_scene_free(scene[k]);
  }
  assert_int_equal(pscn_scene_from_float_points(NULL, 1, 0, 0, NULL, &scene[0]), PSCN_USAGE);
  pscn_scene_free(scene[0]);
}

TEST(test_wrong_arguments)
{
  double vertices[VERTICES][3], box[2][3];
  uint32_t patches[PATCHES][16];
  struct pscn_scene *scene;
  make_mesh(vertices, patches);
  assert_int_equal(pscn_scene_from_indexed(vertices[0], VERTICES, NULL, PATCHES, NULL, 0, NULL, &scene), PSCN_USAGE);
  pscn_scene_free(scene);
  assert_int_equal(pscn_scene_from_indexed(vertices[0], VERTICES, patches[0], PATCHES, NULL, 2, NULL, &scene),
                   PSCN_USAGE);
  pscn_scene_free(scene);
  assert_int_equal(pscn_scene_from_indexed(vertices[0], VERTICES - 1, patches[0], PATCHES, NULL, 0, NULL, &scene),
                   PSCN_INPUT);
  assert_string_equal(pscn_scene_messages(scene),
                      "error: patch 1: control point [3][3] is not a vertex, or not a number up to 1e100\n");
  assert_int_equal(pscn_bounds(scene, 0, box), PSCN_USAGE);
  pscn_scene_free(scene);
  assert_int_equal(pscn_scene_from_indexed(vertices[0], VERTICES, patches[0], PATCHES, NULL, 0, NULL, &scene), PSCN_OK);
  assert_int_equal(pscn_bounds(scene, PSCN_ALL_PATCHES, box), PSCN_OK);
  assert_true(box[0][0] == 0 && box[1][0] == 6 && box[1][1] == 3 && box[0][2] < -0.99);
  assert_int_equal(pscn_bounds(scene, PATCHES, box), PSCN_USAGE);
  const struct pscn_place places[2] = {{0, 1, PATCHES, 0}, {1.5, 0, 0, 0}};
  struct pscn_surface out[2];
  assert_int_equal(pscn_surface(scene, 2, places, sizeof *places, out, sizeof *out), PSCN_INPUT);
  assert_true(isnan(out[0].point[0]) && isnan(out[1].normal[2]));
  pscn_scene_free(scene);
}

/* Shared borders of patches. */
#include "geometry/edges.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cmocka_test.h"
#include "random.h"

enum { SEED = 20240502 };

typedef double net[4][4][3];

static void random_net(struct random *random, net P)
{
  for (int n = 0; n < 48; n++) P[n / 12][n / 3 % 4][n % 3] = random_between(random, -1, 1);
}

static double *border_point(net P, int border, int k)
{
  return border == 0 ? P[0][k] : border == 1 ? P[3][k] : border == 2 ? P[k][0] : P[k][3];
}

/* Makes border `to` of Q run along border `from` of P, backwards if asked. This changes corners of Q's other
 * borders. */
static void glue(net P, int from, net Q, int to, bool reversed)
{
  for (int k = 0; k < 4; k++)
    memcpy(border_point(Q, to, k), border_point(P, from, reversed ? 3 - k : k), 3 * sizeof(double));
}

/* Runs one worker after the other, until one fails. */
static enum status in_turn(size_t count, team_work *work, void *context)
{
  enum status status = STATUS_OK;
  for (size_t k = 0; k < count && status == STATUS_OK; k++) status = work(context, k);
  return status;
}

/* Also uses teams, and one so large that a worker's share does not fit in its part of the table. */
static void match(net *nets, size_t count, struct edge_neighbour *out)
{
  static const struct team teams[] = {{in_turn, 2}, {in_turn, 64}};
  struct edge_neighbour *other = calloc(4 * count, sizeof *other);
  assert_non_null(other);
  memset(out, 0x5a, 4 * count * sizeof *out);
  assert_int_equal(edges_match(nets, sizeof *nets, count, NULL, NULL, out), STATUS_OK);
  for (int t = 0; t < 2; t++) {
    memset(other, 0xa5, 4 * count * sizeof *other);
    assert_int_equal(edges_match(nets, sizeof *nets, count, NULL, &teams[t], other), STATUS_OK);
    for (size_t k = 0; k < 4 * count; k++)
      assert_true(out[k].patch == other[k].patch && out[k].border == other[k].border &&
                  out[k].reversed == other[k].reversed);
  }
  free(other);
}

static void assert_pair(const struct edge_neighbour *n, uint32_t p, int b, uint32_t q, int c, bool reversed)
{
  assert_int_equal(n[4 * p + (unsigned)b].patch, q);
  assert_int_equal(n[4 * p + (unsigned)b].border, c);
  assert_int_equal(n[4 * p + (unsigned)b].reversed, reversed);
  assert_int_equal(n[4 * q + (unsigned)c].patch, p);
  assert_int_equal(n[4 * q + (unsigned)c].border, b);
  assert_int_equal(n[4 * q + (unsigned)c].reversed, reversed);
}

static size_t alone(const struct edge_neighbour *n, size_t count)
{
  size_t sum = 0;
  for (size_t k = 0; k < 4 * count; k++) sum += n[k].patch == EDGE_NONE;
  return sum;
}

TEST(every_pair_of_borders_both_ways)
{
  struct random random = {SEED};
  for (int from = 0; from < 4; from++) {
    for (int to = 0; to < 4; to++) {
      for (int reversed = 0; reversed < 2; reversed++) {
        net P[3];
        struct edge_neighbour n[12];
        for (int k = 0; k < 3; k++) random_net(&random, P[k]);
        glue(P[0], from, P[2], to, reversed);
        match(P, 3, n);
        assert_pair(n, 0, from, 2, to, reversed);
        assert_int_equal(alone(n, 3), 10);
      }
    }
  }
}

TEST(a_patch_may_meet_itself)
{
  struct random random = {SEED + 1};
  for (int reversed = 0; reversed < 2; reversed++) {
    net P[1];
    struct edge_neighbour n[4];
    random_net(&random, P[0]);
    glue(P[0], 0, P[0], 1, reversed);
    match(P, 1, n);
    assert_pair(n, 0, 0, 0, 1, reversed);
    assert_int_equal(alone(n, 1), 2);
  }
  net P[1]; /* u = 0 is v = 0: they also share a corner */
  struct edge_neighbour n[4];
  random_net(&random, P[0]);
  glue(P[0], 0, P[0], 2, false);
  match(P, 1, n);
  assert_pair(n, 0, 0, 0, 2, false);
}

TEST(more_than_two_at_one_border_are_none)
{
  struct random random = {SEED + 2};
  for (size_t count = 3; count <= 5; count++) {
    net P[5];
    struct edge_neighbour n[20];
    for (size_t k = 0; k < count; k++) random_net(&random, P[k]);
    for (size_t k = 1; k < count; k++) glue(P[0], 1, P[k], (int)k % 4, k % 2 == 0);
    match(P, count, n);
    assert_int_equal(alone(n, count), 4 * count);
  }
}

/* Patches that lie on earlier ones have no neighbours, and do not hide those of others. */
TEST(those_there_again_are_alone)
{
  struct random random = {SEED + 6};
  static const uint32_t surface[3] = {1, 1 | SURFACE_AGAIN, 0};
  net P[3];
  struct edge_neighbour n[12];
  random_net(&random, P[0]);
  memcpy(P[1], P[0], sizeof P[1]);
  random_net(&random, P[2]);
  glue(P[0], 1, P[2], 3, true);
  assert_int_equal(edges_match(P, sizeof *P, 3, surface, NULL, n), STATUS_OK);
  assert_pair(n, 0, 1, 2, 3, true);
  assert_int_equal(alone(n, 3), 10);
}

TEST(collapsed_borders_are_none)
{
  struct random random = {SEED + 3};
  net P[2];
  struct edge_neighbour n[8];
  for (int k = 0; k < 2; k++) {
    random_net(&random, P[k]);
    for (int j = 0; j < 4; j++)
      for (int c = 0; c < 3; c++) P[k][0][j][c] = 0.25 * c;
  }
  match(P, 2, n);
  assert_int_equal(alone(n, 2), 8);
}

/* A difference in one last bit is a difference. */
TEST(nearly_equal_is_not_equal)
{
  struct random random = {SEED + 4};
  for (int k = 0; k < 4; k++) {
    for (int c = 0; c < 3; c++) {
      net P[2];
      struct edge_neighbour n[8];
      random_net(&random, P[0]);
      random_net(&random, P[1]);
      glue(P[0], 1, P[1], 0, false);
      P[1][0][k][c] = nextafter(P[1][0][k][c], 2);
      match(P, 2, n);
      assert_int_equal(alone(n, 2), 8);
    }
  }
}

/* -0 and 0 are the same place: a mirrored patch has -0 where its twin has 0. */
TEST(zeros_of_either_sign_are_equal)
{
  struct random random = {SEED + 5};
  enum { PAIRS = 40 };
  static net P[2 * PAIRS];
  static struct edge_neighbour n[8 * PAIRS];
  bool reversed[PAIRS];
  for (int p = 0; p < PAIRS; p++) {
    random_net(&random, P[p]);
    random_net(&random, P[PAIRS + p]);
    reversed[p] = random_bits(&random) % 2;
    for (int k = 0; k < 4; k++) {
      double *point = border_point(P[p], p % 4, k);
      point[0] = 0, point[1] = k % 2 ? 0 : p;
      if (random_bits(&random) % 2) point[2] = 0;
    }
    glue(P[p], p % 4, P[PAIRS + p], p / 4 % 4, reversed[p]);
    for (int k = 0; k < 4; k++) {
      for (int c = 0; c < 3; c++) {
        double *x = &border_point(P[PAIRS + p], p / 4 % 4, k)[c];
        if (*x == 0 && random_bits(&random) % 2) *x = -*x;
      }
    }
    for (int k = 0; k < 4; k++) border_point(P[p], p % 4, k)[2] += 0.0;
  }
  match(P, 2 * PAIRS, n);
  for (uint32_t p = 0; p < PAIRS; p++) {
    const struct edge_neighbour *here = &n[4 * p + p % 4], *there = &n[4 * (PAIRS + p) + p / 4 % 4];
    assert_int_equal(here->patch, PAIRS + p);
    assert_int_equal(here->border, p / 4 % 4);
    assert_int_equal(there->patch, p);
    /* For a border that reads the same in both directions either answer is right. */
    bool palindrome = true;
    for (int c = 0; c < 3; c++)
      for (int k = 0; k < 2; k++)
        palindrome &= border_point(P[p], (int)p % 4, k)[c] == border_point(P[p], (int)p % 4, 3 - k)[c];
    if (!palindrome) assert_int_equal(here->reversed, reversed[p]);
    assert_int_equal(here->reversed, there->reversed);
  }
  assert_int_equal(alone(n, 2 * PAIRS), 6 * PAIRS);
}

/* A grid of patches, with nets inside larger records and in a shuffled order. Every inner border is found, and no outer
 * one. */
TEST(a_grid_with_a_stride)
{
  enum { SIDE = 6, COUNT = SIDE * SIDE };
  struct record {
    net P;
    char more[24];
  };
  static struct record records[COUNT];
  struct random random = {SEED + 6};
  double height[3 * SIDE + 1][3 * SIDE + 1];
  for (int i = 0; i <= 3 * SIDE; i++)
    for (int j = 0; j <= 3 * SIDE; j++) height[i][j] = random_unit(&random);
  size_t place[COUNT];
  for (size_t k = 0; k < COUNT; k++) place[k] = k;
  random_shuffle(&random, COUNT, place);
  for (int a = 0; a < SIDE; a++) {
    for (int b = 0; b < SIDE; b++) {
      double(*P)[4][3] = records[place[a * SIDE + b]].P;
      for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++)
          P[i][j][0] = 3 * a + i, P[i][j][1] = 3 * b + j, P[i][j][2] = height[3 * a + i][3 * b + j];
    }
  }
  static struct edge_neighbour n[4 * COUNT];
  assert_int_equal(edges_match(records, sizeof *records, COUNT, NULL, NULL, n), STATUS_OK);
  for (int a = 0; a < SIDE; a++) {
    for (int b = 0; b < SIDE; b++) {
      const struct edge_neighbour *here = &n[4 * place[a * SIDE + b]];
      const size_t want[4] = {
        a > 0 ? place[(a - 1) * SIDE + b] : EDGE_NONE, a + 1 < SIDE ? place[(a + 1) * SIDE + b] : EDGE_NONE,
        b > 0 ? place[a * SIDE + b - 1] : EDGE_NONE, b + 1 < SIDE ? place[a * SIDE + b + 1] : EDGE_NONE};
      for (int k = 0; k < 4; k++) {
        assert_int_equal(here[k].patch, want[k]);
        if (want[k] != EDGE_NONE) assert_true(here[k].border == (k ^ 1) && !here[k].reversed);
      }
    }
  }
}

TEST(points_run_with_the_parameter_and_none_is_fine)
{
  struct random random = {SEED + 7};
  net P;
  random_net(&random, P);
  for (int border = 0; border < 4; border++) {
    double out[4][3];
    edge_points(P, border, out);
    for (int k = 0; k < 4; k++) assert_memory_equal(out[k], border_point(P, border, k), sizeof out[k]);
  }
  assert_int_equal(edges_match(NULL, sizeof P, 0, NULL, NULL, NULL), STATUS_OK);
}

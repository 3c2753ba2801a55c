/* Leaves are the parts of their patches that they should be; their bounds, polynomials and boxes hold. */
#include "intersect/prepare/leaf.h"

#include <math.h>
#include <string.h>

#include "cmocka_test.h"
#include "geometry/patch.h"
#include "random.h"
#include "reference/quad.h"
#include "worse.h"

enum { SEED = 20261123 };

static const uint16_t splits[][2] = {{1, 1}, {2, 2}, {3, 3}, {4, 4}, {5, 5}, {16, 16}, {32, 32}, {1, 64}, {64, 1}};
enum { SPLITS = sizeof splits / sizeof *splits, KINDS = 8 };

/* Kinds: 0 any shape; 1 flat: second derivatives are 0; 2 so thin that squares underflow; 3 a border is a point; 4 all
 * one point; 5 few bits: cutting into a power of two is exact; 6 on one line; 7 so small that squares underflow. */
static void make_patch(struct random *random, int kind, struct model_patch *patch, double rest[3][4][4])
{
  *patch = (struct model_patch){.scale = 1, .rest = (const double(*)[4][4])rest, .pole[2] = kind == 3};
  for (int k = 0; k < 3; k++) {
    for (int n = 0; n < 16; n++) {
      double x = random_between(random, -1, 1);
      if (kind == 1) x = k == 0 ? n / 4 / 4.0 : k == 1 ? n % 4 / 4.0 : 0;
      if (kind == 2) x *= k == 0 ? 1 : 0x1p-500;
      if (kind == 3 && n % 4 == 0) x = k / 4.0;
      if (kind == 4) x = 0.25;
      if (kind == 6 && k > 0) x = 0;
      if (kind == 7) x *= 0x1p-530;
      if (kind == 5) x = rint(x * 0x1p12) * 0x1p-12;
      patch->x[k][n / 4][n % 4] = x;
      rest[k][n / 4][n % 4] = kind == 0 ? random_between(random, -1, 1) * fabs(x) * 0x1p-54 : 0;
    }
  }
}

/* Calls the test with patches of every kind, split in each way. */
typedef void patch_test(struct random *random, int kind, const struct model_patch *patch);

static void for_patches(unsigned long seed, patch_test *test)
{
  struct random random = {SEED + seed};
  for (int kind = 0; kind < KINDS; kind++) {
    for (int n = 0; n < SPLITS; n++) {
      struct model_patch patch;
      double rest[3][4][4];
      make_patch(&random, kind, &patch, rest);
      patch.cut.split[0] = splits[n][0], patch.cut.split[1] = splits[n][1];
      test(&random, kind, &patch);
    }
  }
}

/* Coordinates of few bits leave no rest, so both ways of cutting agree exactly. */
static void leaves_as_cut_one_by_one(struct random *random, int kind, const struct model_patch *patch)
{
  (void)random;
  if (kind != 5) return;
  for (int n = 0; n < patch->cut.split[0] * patch->cut.split[1]; n++) {
    struct leaf leaf;
    leaf_make(patch, 7, (uint32_t)n, &leaf);
    const int column[2] = {leaf.column_u, leaf.column_v};
    assert_int_equal(column[0] * patch->cut.split[1] + column[1], n);
    assert_int_equal(leaf.patch, 7);
    double range[4];
    for (int k = 0; k < 4; k++) range[k] = (column[k / 2] + k % 2) / (double)patch->cut.split[k / 2];
    for (int k = 0; k < 3; k++) {
      double net[4][4], cut[4][4];
      memcpy(net, patch->x[k], sizeof net);
      patch_subnet(net, range[0], range[1], range[2], range[3], cut);
      assert_memory_equal(cut, leaf.x[k], sizeof cut);
    }
  }
}

TEST(leaves_are_subnets) { for_patches(1, leaves_as_cut_one_by_one); }

/* ---- what is known of a leaf ---- */

/* The exact patch, with its rest. */
static void exact_nets(const struct model_patch *patch, struct quad_net out[3])
{
  for (int k = 0; k < 3; k++)
    for (int n = 0; n < 16; n++)
      out[k].c[n / 4][n % 4] = (quad)patch->x[k][n / 4][n % 4] + patch->rest[k][n / 4][n % 4];
}

static quad parts_value(const struct leaf_parts *parts, int k, quad s, quad t)
{
  quad sum = parts->base[0][k] + s * parts->base[1][k] + t * parts->base[2][k] + s * t * parts->base[3][k], power = 1;
  for (int i = 0; i < 4; i++, power *= s)
    sum += power * (parts->rest[4 * i][k] +
                    t * (parts->rest[4 * i + 1][k] + t * (parts->rest[4 * i + 2][k] + t * parts->rest[4 * i + 3][k])));
  return sum;
}

static double worst_value, worst_slab, worst_slope;

static void leaf_is_its_part(struct random *random, int kind, const struct model_patch *patch)
{
  (void)kind;
  struct quad_net exact[3];
  exact_nets(patch, exact);
  for (int n = 0; n < 30; n++) {
    const uint32_t number = (uint32_t)(random_bits(random) % (uint64_t)(patch->cut.split[0] * patch->cut.split[1]));
    struct leaf leaf;
    leaf_make(patch, 0, number, &leaf);
    const double u = random_between(random, -LEAF_MARGIN, 1 + LEAF_MARGIN);
    const double v = random_between(random, -LEAF_MARGIN, 1 + LEAF_MARGIN);
    const quad at[2] = {(leaf.column_u + (quad)u) / patch->cut.split[0],
                        (leaf.column_v + (quad)v) / patch->cut.split[1]};
    double x[3], slope[2] = {0, 0};
    for (int k = 0; k < 3; k++) {
      const struct quad_jet jet = quad_net_jet(&exact[k], at[0], at[1]);
      x[k] = (double)jet.value;
      const double off = (double)quad_abs(parts_value(&leaf.parts, k, (quad)u - 0.5, (quad)v - 0.5) - jet.value);
      worst_value = worse(worst_value, off / UNIT_ROUNDOFF);
      const double su = (double)jet.du / patch->cut.split[0], sv = (double)jet.dv / patch->cut.split[1];
      slope[0] += su * su, slope[1] += sv * sv;
    }
    for (int side = 0; side < 2 && leaf.first[side] > 0x1p-400; side++)
      worst_slope = worse(worst_slope, sqrt(slope[side]) / leaf.first[side]);
    const bool within = u >= 0 && u <= 1 && v >= 0 && v <= 1;
    for (int q = 0; q < 3 && within; q++) {
      const double *g = leaf.slab[q].g;
      const double off = fabs(g[0] * x[0] + g[1] * x[1] + g[2] * x[2] - leaf.slab[q].offset);
      worst_slab = worse(worst_slab, off / leaf.slab[q].half);
    }
  }
}

TEST(leaves_are_their_parts_of_the_patch)
{
  for_patches(2, leaf_is_its_part);
  print_message(
    "Taylor's polynomial off by %.3g roundings; of its box a point reaches %.17g, of its bounds a derivative %.17g\n",
    worst_value, worst_slab, worst_slope);
  assert_true(worst_value <= 4 && worst_value > 0.5);
  assert_true(worst_slab <= 1 && worst_slab > 0.9);
  assert_true(worst_slope <= 1 + 0x1p-40 && worst_slope > 0.5);
}

/* Second differences in quadruple precision. */
static quad second(const struct quad_net *net, quad u, quad v, int kind)
{
  const quad h = 0x1p-30;
  const struct quad_jet low = quad_net_jet(net, kind == 2 ? u : u - h, kind == 2 ? v - h : v);
  const struct quad_jet high = quad_net_jet(net, kind == 2 ? u : u + h, kind == 2 ? v + h : v);
  return (kind == 0 ? high.du - low.du : high.dv - low.dv) / (2 * h);
}

TEST(second_derivative_bounds_hold_and_are_near)
{
  struct random random = {SEED + 6};
  double worst = 0, best = INFINITY;
  for (int n = 0; n < 40; n++) {
    struct model_patch patch;
    struct leaf leaf;
    double rest[3][4][4];
    make_patch(&random, 0, &patch, rest);
    if (n % 4 == 1)
      for (int i = 0; i < 16; i++)
        patch.x[0][i / 4][i % 4] = i / 4, patch.x[1][i / 4][i % 4] = i % 4; /* a height field */
    patch.cut.split[0] = patch.cut.split[1] = 1;
    leaf_make(&patch, 0, 0, &leaf);
    const double *bound = leaf.second;
    struct quad_net net[3];
    exact_nets(&patch, net);
    for (int kind = 0; kind < 3; kind++) {
      double most = 0;
      for (int a = 0; a <= 10; a++) {
        for (int b = 0; b <= 10; b++) {
          double sum = 0;
          for (int k = 0; k < 3; k++) {
            const double s = (double)second(&net[k], a / (quad)10, b / (quad)10, kind);
            sum += s * s;
          }
          most = fmax(most, sqrt(sum));
        }
      }
      worst = worse(worst, most / bound[kind]), best = fmin(best, most / bound[kind]);
    }
  }
  print_message("largest second derivative / bound: %.6g at most, %.3g at least\n", worst, best);
  assert_true(worst <= 1 + 1e-12); /* the error of differences of derivatives */
  assert_true(best > 0.1);         /* bounds are of the leaf widened */
}

/* What the last resort makes of the roots and doubts of one ray: which root is the nearest, what is proven, what is left.
 * Some roots are made by hand, so that each bound decides alone. The others are those of patches through which the ray
 * goes at known places. */
#include "intersect/exact/judge.h"

#include <math.h>
#include <stdlib.h>

#include "cmocka_test.h"

/* The ray meets FIRST and TWIN at t = 1, AT_TOUCH at 2, THIRD at 3. It touches TOUCHED at t = 2, u = 1/3. BENT has a
 * bent border u = 0, of which the ray meets v = SMALL, and, if it is moved there, v = 1/2 at t = 4. */
enum { FIRST, TOUCHED, THIRD, TWIN, AT_TOUCH, BENT, PATCHES };
static const double t_of[PATCHES] = {1, 2, 3, 1, 2, 4};
#define SMALL 0x1p-17

static struct scene_patch patches[PATCHES];
static const struct scene scene = {.patches = patches, .patch_count = PATCHES};
static struct model model = {.scene = &scene};
static struct ray ray;
static struct exact_region regions[PATCHES];
static struct exact_root known;
static uint64_t work;
static struct exact_case asked;
static struct judge judge;
static double tilt; /* of all but TOUCHED */

static void set_patches(void)
{
  static const double c = 3 * SMALL, touching[4] = {1, -1, 0, 4};                        /* (3 u - 1)^2 */
  const double square[4] = {c * c, c * c - 2 * c, c * c - 4 * c + 3, (3 - c) * (3 - c)}; /* (3 v - c)^2 */
  for (int n = 0; n < 16 * PATCHES; n++) {
    const int p = n / 16, i = n / 4 % 4, j = n % 4;
    double *P = patches[p].P[i][j];
    P[0] = p == TOUCHED ? 1 + i : p == BENT ? 4 + (j - 1.5) / 64 : t_of[p] + (j - 1.25) / (p == TWIN ? 32 : 64);
    P[1] = p == BENT ? 1.25 + j - c - tilt * i : j;
    P[2] = p == BENT ? 0.7 * i + square[j] : p == TOUCHED ? touching[i] : i - 1.5 + tilt * (j - 1.5);
  }
}

/* A case of the regions in the set `which`, all from t = 0. */
static void ask(unsigned which)
{
  set_patches();
  ray = (struct ray){.origin = {0, 1.25, 0}, .direction = {1, 0, 0}, .t_max = INFINITY};
  work = 0, model.unproven = false;
  asked = (struct exact_case){
    .model = &model, .ray = &ray, .regions = regions, .cut_from = INFINITY, .work = &work, .limit = 1 << 16};
  for (uint32_t p = 0; p < PATCHES; p++)
    if (which >> p & 1) regions[asked.region_count++] = (struct exact_region){.patch = p};
}

static void begin(enum judge_asks asks, struct exact_list *list)
{
  ask(0);
  ray.t_min = 1, ray.t_max = 3;
  judge_run(&judge, &asked, asks, list);
}

static struct exact_root root_at(uint32_t patch, wide t, double radius, double t_error)
{
  return (struct exact_root){
    .patch = patch, .u = 0.5, .v = 0.5, .t = t, .radius_u = radius, .radius_v = radius, .t_error = t_error};
}

/* ---- roots beside each other ---- */

#define SHARP 0x1p-107

TEST(roots_are_one_if_one_holds_the_other_or_both_are_sharp)
{
  static const struct {
    double apart, radius[2];
    bool same;
  } cases[] = {{0.05, {0.1, 0.01}, true},          {0.095, {0.1, 0.01}, false},
               {0.5, {0.1, 0.01}, false},          {1.5 * SHARP, {SHARP, SHARP}, true},
               {3 * SHARP, {SHARP, SHARP}, false}, {0x1p-100, {0x1p-100, SHARP}, false}};
  begin(JUDGE_NEAREST, NULL);
  for (int n = 0; n < 8 * (int)(sizeof cases / sizeof *cases); n++) {
    const struct exact_root a = root_at(0, 1, cases[n / 8].radius[n & 1], 0);
    struct exact_root b = root_at(0, 2, cases[n / 8].radius[~n & 1], 0);
    *(n & 2 ? &b.u : &b.v) += (n & 4 ? 1 : -1) * (wide)cases[n / 8].apart;
    assert_int_equal(judge_same(&judge, &a, &b), cases[n / 8].same);
    b.patch = 1;
    assert_false(judge_same(&judge, &a, &b));
  }
  assert_true(judge.undecided == INFINITY);
  struct exact_root a = root_at(0, 2, SHARP, 0), b = root_at(0, 1 - (wide)0x1p-80, SHARP, 0);
  a.u += 1.5 * (wide)SHARP, a.borders = 4;
  assert_true(judge_same(&judge, &a, &b)); /* one may be on the border, the other not */
  assert_true(judge.undecided <= b.t && judge.undecided > 0.5);
}

TEST(roots_are_at_one_t_if_their_errors_say_so)
{
  const struct exact_root a = root_at(0, 2, SHARP, 0.125), b = root_at(1, 2.25, SHARP, 0.25);
  const struct exact_root c = root_at(1, 2.5, SHARP, 0.25), d = root_at(1, 2.25, 0x1p-90, 0.25);
  begin(JUDGE_NEAREST, NULL);
  assert_true(judge_compare(&judge, &a, &b) == 0 && judge_compare(&judge, &b, &a) == 0);
  assert_true(judge_compare(&judge, &a, &c) == -1 && judge_compare(&judge, &c, &a) == 1);
  assert_true(judge.undecided == INFINITY);
  for (int n = 0; n < 2; n++) { /* d is not known as well as can be */
    begin(JUDGE_NEAREST, NULL);
    assert_true(judge_compare(&judge, n ? &a : &d, n ? &d : &a) == 0 && judge.undecided == 2 - 0.125);
  }
}

TEST(roots_at_one_t_are_in_the_order_of_patches_and_parameters)
{
  struct exact_root a = root_at(0, 1, SHARP, 0), b = root_at(1, 1, SHARP, 0);
  a.u = a.v = 1;
  assert_true(judge_stands_before(&a, &b) && !judge_stands_before(&b, &a));
  b.patch = 0;
  assert_true(judge_stands_before(&b, &a) && !judge_stands_before(&a, &b));
  a.v = 0;
  assert_true(judge_stands_before(&b, &a) && !judge_stands_before(&a, &b));
  a.u = b.u + 1.5 * (wide)SHARP; /* it may be the smaller one */
  assert_true(judge_stands_before(&a, &b) && !judge_stands_before(&b, &a));
}

/* ---- what is found ---- */

static void found(uint32_t patch, wide t, uint32_t nearest, bool tied)
{
  struct exact_root root = root_at(patch, t, SHARP, 0);
  judge_root(&judge, &root);
  assert_true(judge.hit && judge.nearest.patch == nearest && judge.tied == tied);
  assert_true(judge.limit >= judge.nearest.t);
}

TEST(the_nearest_root_is_kept)
{
  begin(JUDGE_NEAREST, NULL);
  found(4, 2.5, 4, false), found(5, 2.75, 4, false), found(4, 2.5, 4, false);
  found(3, 2 + (wide)0x1p-80, 3, false), found(2, 2 + (wide)0x1p-80, 2, true), found(6, 2 + (wide)0x1p-80, 2, true);
  found(1, 2.5, 2, true), found(7, 1.5, 7, false);
}

TEST(a_doubt_counts_as_far_as_it_may_be_in_the_range)
{
  static const struct {
    double t;
    bool counts, hit;
  } cases[] = {{0.5, false, false}, {0.875, true, false}, {1.125, true, false}, {1.5, true, true},
               {2.875, true, true}, {3, true, false},     {3.125, true, false}, {3.5, false, false}};
  for (size_t n = 0; n < sizeof cases / sizeof *cases; n++) {
    const double t = cases[n].t;
    begin(JUDGE_NEAREST, NULL);
    judge_maybe(&judge, 0.5, 0.5, t, 0.25, t - 0.25);
    assert_true(judge.undecided == (cases[n].counts ? t - 0.25 : INFINITY));
    assert_true(judge.doubtful == cases[n].hit && (!judge.doubtful || judge.maybe.t == t));
  }
}

static void doubt(uint32_t patch, double t, uint32_t nearest)
{
  judge.patch = patch;
  judge_maybe(&judge, 0.5, 0.5, t, 0x1p-9, t);
  assert_true(judge.maybe.patch == nearest && judge.limit >= judge.maybe.t + 0x1p-9);
}

TEST(the_nearest_doubt_is_kept_or_all_are_listed)
{
  struct exact_list list = {0};
  begin(JUDGE_NEAREST, NULL);
  doubt(1, 2, 1), doubt(0, 2.5, 1), doubt(2, 2, 1), doubt(0, 2, 0), doubt(3, 1.5, 3);
  begin(JUDGE_ALL, &list);
  judge_maybe(&judge, 0.5, 0.5, 2.5, 0, 2.5), judge_maybe(&judge, 0.5, 0.5, 2, 0, 2);
  assert_true(list.count == 2 && list.at[1].kind == EXACT_OPEN && judge.undecided == 2 && !judge.doubtful);
  free(list.at);
}

TEST(a_rest_counts_unless_it_is_behind_all_that_matters)
{
  begin(JUDGE_ANY, NULL);
  judge_left(&judge, 3.5, 4);
  assert_true(judge.undecided == INFINITY && !judge.cut_short);
  judge_left(&judge, 0.25, 0.5);
  assert_true(judge.undecided == 0.25 && !judge.cut_short); /* all of it is before the ray's start */
  judge_left(&judge, 0.25, 2);
  assert_true(judge.cut_short);
}

/* ---- where a root lies ---- */

TEST(a_depth_is_within_the_range_or_not_known_to_be)
{
  enum { OUT = PLACE_OUT, IN = PLACE_IN, UNKNOWN = PLACE_UNKNOWN };
  static const struct {
    double along;
    wide w;
    double error;
    int exact, within;
  } cases[] = {{2, 2, 0, true, OUT},         {2, 2, 0, false, IN},         {2, 4, 0, true, IN},
               {2, 6, 0, true, OUT},         {2, 6, 0, false, OUT},        {-2, -2, 0, true, OUT},
               {-2, -2, 0, false, OUT},      {-2, -6, 0, false, IN},       {2, 1.5, 0.25, 0, OUT},
               {2, 2, 0.25, 1, UNKNOWN},     {2, 2.5, 0.25, 0, IN},        {2, 5.5, 0.25, 0, IN},
               {2, 2.125, 0.25, 0, UNKNOWN}, {2, 5.875, 0.25, 0, UNKNOWN}, {2, 6.5, 0.25, 0, OUT}};
  begin(JUDGE_NEAREST, NULL);
  for (size_t n = 0; n < sizeof cases / sizeof *cases; n++) {
    const struct depth depth = {cases[n].w, cases[n].error, cases[n].exact};
    judge.sight.along = cases[n].along;
    assert_int_equal(place_in_range(&judge, &depth), cases[n].within);
  }
}

TEST(a_root_is_found_sharply_or_left_undecided)
{
  static const struct piece_root root = {.at = {0.5, 1.3 / 3}, .radius = 0x1p-5};
  static const double depth[4] = {0.3125, -1.1875, 0.3125, 4.8125}; /* (3 v - 1.25) + (3 v - 1.25)^2 */
  const double t = 0x1p-50;                                         /* it changes fast there */
  const struct exact_root *found = &judge.nearest;
  begin(JUDGE_NEAREST, NULL);
  for (int n = 0; n < 16; n++) patches[FIRST].P[n / 4][n % 4][0] = 1 + depth[n % 4] * 0x1p20;
  ray.t_min = 0, ray.origin[0] = 1 - t, judge_turn(&judge, FIRST);
  const struct waiting it = {.piece = judge.sight.off, .near = 0x1p-60, .border = -1};
  place_root(&judge, &it, &root);
  assert_true(judge.hit && judge_sharp(found) && fabs((double)(3 * found->v - 1.25)) <= 3 * found->radius_v);
  assert_true(found->t_error < 0x1p-80 && wide_abs(found->t - t) <= found->t_error && judge.undecided == INFINITY);
  judge.hit = false, ray.t_min = t; /* it may be before the start */
  place_root(&judge, &it, &root);
  assert_true(!judge.hit && judge.undecided < t && judge.undecided > t / 2);
  judge.pool.room = judge.pool.used, ray.t_min = 0;
  place_root(&judge, &it, &root);
  assert_true(!judge.hit && judge.undecided == it.near);
}

TEST(a_root_on_a_border_is_exact_in_corners_of_pieces_and_at_simple_places)
{
  static const struct piece_root corner = {.radius = 0}, near = {.at = {0x1p-12, 0.5 - 0x1p-12}, .radius = 0x1p-11},
                                 beside = {.at = {0, 0.5 + 0x1p-18}, .radius = 0x1p-24},
                                 inside = {.at = {0.5 + 0x1p-12, 0.5 - 0x1p-12}, .radius = 0x1p-11};
  const double c = 3 * SMALL;
  struct waiting it = {.border = -1};
  begin(JUDGE_NEAREST, NULL);
  ray.t_max = 5, judge_turn(&judge, BENT);
  assert_true(piece_part(&judge.sight.off, 1, 1, 2, 17, &judge.pool, &it.piece));
  assert_true(piece_corner_root(&it.piece, 0, 0, &judge.pool));
  place_root(&judge, &it, &corner);
  assert_true(judge.hit && judge.nearest.borders == 1 && judge.nearest.u == 0 && judge.nearest.v == SMALL);
  for (int n = 0; n < 256; n++) { /* some of the roots found are off by a rounding */
    tilt = n / 128.0;
    begin(JUDGE_NEAREST, NULL);
    ray.t_max = 5, ray.origin[1] = 2.75 - c, ray.origin[2] = (1.5 - c) * (1.5 - c), judge_turn(&judge, BENT);
    it.piece = judge.sight.off;
    place_root(&judge, &it, &beside);
    assert_false(judge.hit);
    place_root(&judge, &it, &near);
    assert_true(judge.hit && judge.nearest.borders == 1 && judge.nearest.u == 0 && judge.nearest.v == 0.5);
    judge.hit = false, ray.t_min = 4;
    place_root(&judge, &it, &near);
    assert_true(!judge.hit && judge.undecided == INFINITY);
    ray.origin[1] = 1.5, ray.origin[2] = 0, ray.t_min = 1 + 0.25 / 64, judge_turn(&judge, FIRST); /* in its middle */
    it.piece = judge.sight.off;
    place_root(&judge, &it, &inside);
    assert_true(!judge.hit && judge.undecided == INFINITY);
  }
  tilt = 0;
}

TEST(a_root_next_to_the_start_or_nearly_singular_is_a_root)
{
  struct exact_list list = {0};
  begin(JUDGE_ALL, &list), ray.t_min = 0;
  for (int p = FIRST; p <= THIRD; p += THIRD, list.count = 0) {
    const double middle = p == FIRST ? 1.25 : 1.5;
    for (int n = 0; n < 16; n++) { /* of THIRD, the derivatives of the planes are 1, 1 + e and 1 - e, 1 */
      double *P = patches[p].P[n / 4][n % 4], u = n / 4 - 1.5, v = n % 4 - middle;
      P[0] = v;
      if (p == THIRD) P[1] = u + (1 + 0x1p-50) * v, P[2] = (1 - 0x1p-50) * u + v;
    }
    ray.origin[0] = p == FIRST ? -0x1p-140 : -2, ray.origin[1] = p == FIRST ? 1.25 : 0, judge_turn(&judge, (uint32_t)p);
    place_root(&judge, &(struct waiting){.piece = judge.sight.off, .border = -1},
               &(struct piece_root){.at = {0.5, middle / 3}, .radius = 0x1p-5});
    assert_true(list.count == 1 && list.at[0].kind == EXACT_INSIDE);
  }
  free(list.at);
}

/* ---- decisions ---- */

enum { SURE = 1, KNOWN = 2, ONLY = -1 };
#define BIT(patch) (1u << (patch))

/* Asserts the decision on the case: that patch, or ONLY a miss. A root on the border u = 0 is exactly there. */
static void decide(int flags, int patch)
{
  struct exact_decision out;
  exact_closest(&asked, &out);
  assert_int_equal(out.sure + 2 * out.known, flags);
  assert_int_equal(out.hit ? (int)out.root.patch : ONLY, patch);
  if (out.hit && !out.known) assert_true(fabs((double)out.root.t - t_of[patch]) < 0x1p-50);
  if (out.hit && ray.origin[2] != 0) assert_true(out.root.borders == 1 && out.root.u == 0 && out.root.radius_u == 0);
}

/* The lanes know the root of that patch. */
static void ask_known(unsigned which, uint32_t patch, double t_error)
{
  ask(which);
  known = root_at(patch, t_of[patch], 0x1p-30, t_error), known.v = 1.25 / 3, asked.known = &known;
}

TEST(the_nearest_hit_is_decided)
{
  ask(0), decide(SURE, ONLY);
  asked.cut_from = 1, decide(0, ONLY);
  ask(BIT(THIRD)), decide(SURE, THIRD);
  asked.cut_from = 2.5, decide(0, THIRD);
  asked.cut_from = 3, decide(0, THIRD);
  asked.cut_from = 3.5, decide(SURE, THIRD);
  ask(BIT(TOUCHED)), decide(0, TOUCHED);
  ask(BIT(TOUCHED) | BIT(THIRD)), decide(0, TOUCHED);
  regions[0].near = 1, decide(0, TOUCHED); /* the farther one is searched first */
  ask(BIT(FIRST) | BIT(TOUCHED) | BIT(THIRD)), decide(SURE, FIRST);
  regions[0].near = 0.5, decide(SURE, FIRST);
  ask(BIT(TOUCHED) | BIT(AT_TOUCH)), decide(0, AT_TOUCH);
  ask(BIT(FIRST) | BIT(TWIN)), regions[0].near = 0.5, decide(SURE, FIRST);
  ray.t_max = 0.5, decide(SURE, ONLY);
  ask(BIT(FIRST)), ray.origin[2] = -1.5, decide(SURE, FIRST); /* on a straight border */
  ask(BIT(FIRST)), decide(SURE, FIRST);
  const uint64_t alone = work;
  ask(BIT(FIRST) | BIT(THIRD)), regions[0].near = 0.5, regions[1].near = 2.5, decide(SURE, FIRST);
  assert_true(work == alone); /* nothing behind the hit is searched */
}

/* Of the patch, one polynomial is zero at a border's first two control points and positive elsewhere, so in that piece the
 * corner's root is the only one; but not if both are zero in another corner, which the ray meets before or behind. */
TEST(a_root_in_a_corner_is_alone_unless_there_is_one_in_another_corner)
{
  static const int others[4] = {0, 3, 12, 15}, z[16] = {0, 1, -1, 2, -2, 1, 3, -1, 1, -3, 2, 1, 3, 2, -1, 1};
  for (int n = 0; n < 16; n++) {
    struct exact_decision out;
    const int other = others[n % 4];
    ask(BIT(FIRST));
    for (int k = 0; k < 16; k++) {
      double *P = n % 8 < 4 ? patches[FIRST].P[k / 4][k % 4] : patches[FIRST].P[k % 4][k / 4];
      const bool met = k == 0 || k == other || (other == 0 && k == 4);
      P[0] = (k == other) == (n < 8) || other == 0 ? 1 : 2;
      P[1] = 1.25 + (met || k == 1 ? 0 : 1), P[2] = met ? 0 : z[k];
    }
    exact_closest(&asked, &out);
    assert_true(out.sure && out.hit && out.root.t == 1);
  }
}

TEST(a_border_may_be_on_the_ray)
{
  struct exact_decision out;
  for (int k = 0; k < 4; k++) { /* from t = 4 to 1, from 1 to 4, a pole, a pole of two rows */
    const int by = (const int[]){-1, 1, 0, 0}[k];
    ask(BIT(FIRST) | BIT(THIRD));
    for (int n = 0; n < 16; n++) {
      const int off = n / (k == 3 ? 8 : 4);
      double *P = patches[FIRST].P[n / 4][n % 4];
      P[0] = (by < 0 ? 4 : 1) + by * (n % 4) + off, P[1] = off ? n % 4 : 1.25, P[2] = off;
    }
    decide(by ? 0 : SURE, FIRST);
    ray.t_min = by ? 2 : 1, decide(by ? 0 : SURE, THIRD);
    ray.t_min = 4.5, decide(SURE, ONLY);
    ray.t_min = 0, ray.direction[0] = 3, exact_closest(&asked, &out); /* a pole is at t = 1/3 */
    assert_true(by || (out.sure && out.root.u == 0 && out.root.v == 0.5 && out.root.t_error > 0));
  }
}

TEST(a_root_is_found_however_small_or_long_the_polynomials_are)
{
  static const double b[4] = {0, 1, -1, -3}, z[4] = {-1, 0x1p-9, 0.5, 1};
  struct exact_decision out;
  ask(BIT(FIRST)); /* b is zero twice along the border, which is met at v = 5/12 */
  for (int k = 0; k < 16; k++) patches[FIRST].P[k / 4][k % 4][2] = k / 8 * (k / 4);
  decide(SURE, FIRST);
  for (int k = 0; k < 48; k++) {
    double *P = patches[FIRST].P[k / 4 % 4][k % 4];
    const bool last = k % 16 >= 12, on = k % 16 < 4; /* the border on which a is so small that its doubles are 0 */
    if (k % 16 == 0) ask(BIT(FIRST)), ray.origin[1] = 0;
    if (k < 32) P[0] = 2 - P[0], P[1 + k / 16] = on ? k % 4 * 0x1p-70 : k % 4 - 1.25, P[2 - k / 16] = b[k / 4 % 4];
    else P[0] = last ? 1.9 : -0.9, P[1] = last ? 1.9 : -1.9, P[2] = z[k % 4]; /* these take all bits of their limbs */
    if (k == 15 || k == 31) decide(SURE, FIRST);
  }
  ray = (struct ray){{-1.9, 0, 0}, {1.9, -1.9, 0x1p-11}, 0, INFINITY}, exact_closest(&asked, &out);
  assert_true(out.sure && out.hit);
}

TEST(a_place_that_is_never_decided_is_as_small_as_can_be)
{
  ask(BIT(FIRST)), asked.limit = 256; /* all of it on the ray */
  for (int n = 0; n < 48; n++) patches[FIRST].P[n / 12][n / 3 % 4][n % 3] = (const double[3]){1, 1.25, 0}[n % 3];
  decide(0, FIRST);
  ask(BIT(TOUCHED)), ray.origin[0] = -0x1p-30; /* its middle is before the ray's start, the place is not */
  for (int n = 0; n < 16; n++) patches[TOUCHED].P[n / 4][n % 4][0] = (1 - n / 4) * 0x1p40;
  decide(0, ONLY);
  ask(BIT(TOUCHED)), ray.t_min = 2; /* all of it is at t = 2 */
  for (int n = 0; n < 16; n++) patches[TOUCHED].P[n / 4][n % 4][0] = 2;
  decide(SURE, ONLY);
}

TEST(a_known_root_is_the_answer_if_nothing_else_is_near)
{
  const double off = 0x1p-20;
  ask_known(0, THIRD, off), decide(SURE | KNOWN, THIRD);
  asked.cut_from = 2.5, decide(KNOWN, THIRD);
  asked.cut_from = 3 + off / 2, decide(SURE | KNOWN, THIRD); /* its own place is found to be nearer */
  asked.cut_from = 3.5, decide(SURE | KNOWN, THIRD);
  ask_known(0, FIRST, off), asked.limit = 0, asked.cut_from = 0.5, decide(KNOWN, FIRST);
  ask_known(BIT(FIRST), THIRD, off), decide(SURE, FIRST);
  ask_known(BIT(TOUCHED), THIRD, off), decide(0, TOUCHED);
  ask_known(BIT(THIRD), FIRST, off), decide(SURE | KNOWN, FIRST);
  ask_known(BIT(TOUCHED), FIRST, off), decide(SURE | KNOWN, FIRST);
  ask_known(BIT(FIRST), FIRST, off), decide(SURE | KNOWN, FIRST);
  ask_known(BIT(FIRST), THIRD, 2.5), decide(SURE, FIRST); /* either may be the nearer one, as far as the lanes know */
  ask_known(BIT(THIRD), FIRST, 2.5), decide(SURE | KNOWN, FIRST);
  ask_known(BIT(TWIN), FIRST, off), decide(SURE, FIRST); /* at one t */
  ask_known(BIT(FIRST), TWIN, off), decide(SURE, FIRST);
  ask_known(BIT(FIRST), THIRD, 2.5), asked.limit = 8, decide(0, FIRST); /* there is no work left for THIRD */
}

TEST(a_root_of_polish_off_is_not_sought)
{
  ask_known(0, THIRD, 0), known.t = 3.5, known.u = 0.75, asked.cut_from = 2, model.unproven = true;
  decide(KNOWN, THIRD);
  ask_known(BIT(FIRST), THIRD, 0), model.unproven = true, decide(SURE, FIRST);
}

TEST(nothing_is_said_to_be_visible_that_may_be_hidden)
{
  bool proven;
  ask(0), assert_false(exact_occluded(&asked, &proven)), assert_true(proven);
  ask(BIT(FIRST)), assert_true(exact_occluded(&asked, &proven)), assert_true(proven);
  ask(BIT(TOUCHED)), assert_true(exact_occluded(&asked, &proven)), assert_false(proven);
  ray.t_max = 1, assert_false(exact_occluded(&asked, &proven)), assert_true(proven);
  asked.limit = 0, assert_true(exact_occluded(&asked, &proven)), assert_false(proven);
}

TEST(of_what_may_be_one_hit_one_is_left)
{
  static const struct {
    double at[3][2];             /* t and its error of an open place, and of places of one root */
    int count, open, in, doubts; /* open: the number of that place; in, doubts: of what is left */
  } cases[] = {{{{2, 0.5}, {2.75, 0.5}}, 2, -1, 1, 0},
               {{{2, 0.125}, {2.125, 0}}, 2, 1, 1, 0},
               {{{2, 0}, {2.125, 0.125}}, 2, 0, 1, 0},
               {{{2, 0}, {2.125, 0}, {4, 1}}, 3, 1, 2, 1},
               {{{2, 0.125}, {2.1875, 0.125}, {2.25, 0}}, 3, 2, 1, 1}, /* one left out takes none with it */
               {{{2, 0.125}, {2.1875, 0.125}, {2.15625, 0}}, 3, 2, 1, 1}};
  struct exact_list list = {0};
  for (size_t n = 0; n < sizeof cases / sizeof *cases; n++, list.count = 0) {
    int left[2] = {0};
    ask(BIT(AT_TOUCH)), asked.limit = 0; /* nothing is searched */
    for (int k = 0; k < cases[n].count; k++) {
      const bool open = k == cases[n].open;
      const struct exact_root root = root_at(open, cases[n].at[k][0], SHARP, cases[n].at[k][1]);
      assert_true(exact_list_add(&list, &(struct exact_found){root, open ? EXACT_OPEN : EXACT_INSIDE, .taken = -open}));
    }
    exact_all(&asked, &list);
    for (size_t k = 0; k < list.count; k++) left[list.at[k].kind == EXACT_OPEN]++;
    assert_true(left[0] == cases[n].in && left[1] == cases[n].doubts);
  }
  ask(0), model.unproven = true, assert_false(exact_all(&asked, &list)), free(list.at);
}

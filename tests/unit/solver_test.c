/* The table of solvers, its items, and every solver on polynomials whose roots are known. */
#include "algebra/solver.h"

#include <math.h>
#include <string.h>

#include "algebra/root_problem.h"
#include "cmocka_test.h"

static struct root_set solve(const char *name, int degree, enum basis basis, const double c[], const double error[])
{
  struct solver_options options;
  solver_options_default(solver_find(name, strlen(name)), &options);
  const struct polynomial p = {degree, basis, c, error};
  struct root_set out;
  solver_solve(&p, &options, NULL, &out);
  return out;
}

/* Whether the disc of some value contains the real number. */
static bool found(const struct root_set *roots, double at)
{
  for (int i = 0; i < roots->count; i++)
    if (hypot(roots->root[i].re - at, roots->root[i].im) <= roots->root[i].radius) return true;
  return false;
}

/* Whether every solver finds it. */
static bool found_all(int degree, enum basis basis, const double c[], const double error[], double at)
{
  bool all = true;
  for (size_t i = 0; i < solver_count(); i++) {
    const struct root_set roots = solve(solver_at(i)->name, degree, basis, c, error);
    all = all && found(&roots, at);
  }
  return all;
}

TEST(table)
{
  assert_string_equal(solver_at(0)->name, "bernstein");
  assert_null(solver_at(solver_count()));
  for (size_t i = 0; i < solver_count(); i++) {
    const struct solver *solver = solver_at(i);
    assert_ptr_equal(solver_find(solver->name, strlen(solver->name)), solver);
    assert_null(solver_find(solver->name, strlen(solver->name) - 1));
  }
  assert_non_null(solver_find("newton", 6));
  assert_non_null(solver_find("laguerre", 8));
  assert_non_null(solver_find("aberth", 6));
  assert_non_null(solver_find("durand_kerner", 13));
}

TEST(hopeless_input)
{
  const double nan_c[] = {1.0, NAN, 1.0}, infinite[] = {1.0, 1.0, INFINITY}, zero[] = {0.0, 0.0, 0.0};
  const double small[] = {1e-12, -1e-12, 1e-12}, large_error[] = {1e-11, 1e-11, 1e-11}, constant[] = {2.0, 0.0, 0.0};
  const double good[] = {1.0, 2.0, 3.0}, bad_error[] = {0.0, NAN, 0.0};
  for (size_t i = 0; i < solver_count(); i++) {
    const char *name = solver_at(i)->name;
    for (int basis = 0; basis < 2; basis++) {
      const struct root_set a = solve(name, 2, (enum basis)basis, nan_c, NULL);
      assert_true(a.not_finite && a.count == 0);
      const struct root_set b = solve(name, 2, (enum basis)basis, infinite, NULL);
      assert_true(b.not_finite && b.count == 0);
      const struct root_set c = solve(name, 2, (enum basis)basis, zero, NULL);
      assert_true(c.identically_zero && c.count == 0);
      const struct root_set d = solve(name, 2, (enum basis)basis, small, large_error);
      assert_true(d.identically_zero && d.count == 0);
      const struct root_set e = solve(name, 2, (enum basis)basis, good, bad_error);
      assert_true(e.not_finite && e.count == 0);
    }
    const struct root_set f = solve(name, 2, BASIS_POWER, constant, NULL);
    assert_true(!f.identically_zero && !f.not_finite && f.count == 0);
  }
}

/* u^2 (1-u)^3 (u - 1/4) exactly: zero coefficients at both ends are roots of radius 0. */
TEST(exact_ends)
{
  const double c[] = {0.0, 0.0, -1.0, 3.0, 0.0, 0.0, 0.0}; /* u^2 (1-u)^3 (3 u - (1-u)) */
  for (size_t i = 0; i < solver_count(); i++) {
    const struct root_set roots = solve(solver_at(i)->name, 6, BASIS_BERNSTEIN, c, NULL);
    int at_zero = 0, at_one = 0;
    for (int k = 0; k < roots.count; k++) {
      at_zero += roots.root[k].re == 0.0 && roots.root[k].im == 0.0 && roots.root[k].radius == 0.0;
      at_one += roots.root[k].re == 1.0 && roots.root[k].im == 0.0 && roots.root[k].radius == 0.0;
    }
    assert_int_equal(roots.count, 6);
    assert_int_equal(at_zero, 2);
    assert_int_equal(at_one, 3);
    assert_true(found(&roots, 0.25));
  }
}

/* The same polynomial, written with a higher degree in Bernstein form, has roots at infinity. They are not listed. */
TEST(raised_degree)
{
  const double power[] = {0.1875, -1.0, 1.0, 0.0, 0.0, 0.0, 0.0}; /* (u - 1/4) (u - 3/4) */
  const struct polynomial p = {6, BASIS_POWER, power, NULL};
  double c[7], error[7];
  polynomial_to_bernstein(&p, c, error);
  for (size_t i = 0; i < solver_count(); i++) {
    const struct root_set roots = solve(solver_at(i)->name, 6, BASIS_BERNSTEIN, c, error);
    assert_true(found(&roots, 0.25));
    assert_true(found(&roots, 0.75));
    for (int k = 0; k < roots.count; k++)
      assert_true(roots.root[k].status != ROOT_CONVERGED || fabs(roots.root[k].re - 0.5) < 0.5);
  }
}

/* A root at u = 1, where u/(1-u) becomes infinite, is known as well as any other, although the change of basis leaves
 * the last coefficient uncertain. */
TEST(roots_at_one)
{
  const double power[][4] = {{-1.0, 1.0},         {2.0, -3.0, 1.0}, {1.0, -2.0, 1.0},
                             {-0.25, 1.25, -1.0}, {0.3, -0.4, 0.1}, {-1.0, 1.0, -1.0, 1.0}};
  const int degrees[] = {1, 2, 2, 2, 2, 3};
  for (size_t k = 0; k < sizeof degrees / sizeof degrees[0]; k++) {
    const struct polynomial p = {degrees[k], BASIS_POWER, power[k], NULL};
    double c[4], error[4];
    polynomial_to_bernstein(&p, c, error);
    for (size_t i = 0; i < solver_count(); i++) {
      const struct root_set roots = solve(solver_at(i)->name, p.degree, BASIS_BERNSTEIN, c, error);
      assert_true(found(&roots, 1.0) || solver_at(i)->real_only);
      assert_int_equal(roots.missing, 0);
      for (int j = 0; j < roots.count; j++) assert_true(roots.root[j].radius < 1e-6);
    }
  }
}

/* Coefficients far smaller than their neighbours mean roots near 0 and near infinity. A solver of [0,1] returns those
 * that lie there, and no others. */
TEST(extremes_beside_the_interval)
{
  const double outside[][3] = {{0.0, 0x1p-500, 0x1p532},       /* u (u + 2^-1032) */
                               {0x1p-70, 0x1p-500, 0x1p-1074}, /* roots next to -2^430 and -2^574 */
                               {1.0, 0x1p-600, 0x1p-1000},     /* a pair of 2^500 */
                               {1.0, -0x1p-1000, 0.0}};
  const double inside[] = {0x1p-1000, -1.0, 0x1p-1000}; /* roots next to 2^-1000 and 2^1000 */
  for (size_t i = 0; i < solver_count(); i++) {
    if (!solver_at(i)->real_only) continue;
    for (size_t k = 0; k < sizeof outside / sizeof outside[0]; k++) {
      const struct root_set roots = solve(solver_at(i)->name, 2, BASIS_POWER, outside[k], NULL);
      assert_int_equal(roots.count, k == 0);
    }
    const struct root_set roots = solve(solver_at(i)->name, 2, BASIS_POWER, inside, NULL);
    assert_int_equal(roots.count, 1);
    assert_true(found(&roots, 0x1p-1000));
    const double pair[] = {0x1p-1000, 0x1p-460, 1.0}; /* next to -2^-540 and -2^-460 */
    const struct root_set near = solve(solver_at(i)->name, 2, BASIS_BERNSTEIN, pair, NULL);
    assert_int_equal(near.count, 0);
  }
}

/* A root of [0,1] next to the end of an interval where a coefficient's sign is unknown. */
TEST(roots_next_to_open_ends)
{
  /* c[0] may also be -5e-12 */
  const double end[] = {1e-12, 1.0, 1.0}, end_error[] = {1e-11, 0.0, 0.0};
  assert_true(found_all(2, BASIS_BERNSTEIN, end, end_error, 5e-12));
  /* c[1] may be -2.53e-11, with the others as small as possible: then the pair at 0 is as far apart as it can be */
  const double pair[] = {0.0, 0.0, 1.0}, pair_error[] = {0x1p-35, 0x1p-35, 0x1p-35};
  assert_true(found_all(2, BASIS_BERNSTEIN, pair, pair_error, 5.3948092348877005e-06));
  /* product of (u - 1/2 - 16^-k), k = 1 ... 11, rounded: the largest root lies behind an undecided stretch */
  const double tower[] = {-0.0005538962869768103, 0.012053466000110459, -0.11921418234380377, 0.707374498982631,
                          -2.7979046910829592,    7.745809270436902,    -15.31524554494498,   21.62735319655019,
                          -21.376176534431394,    14.083594771241811,   -5.566666666666663,   1.0};
  assert_true(found_all(11, BASIS_POWER, tower, NULL, 0.56255857303151413));
}

/* `start previous` along a family whose two real roots meet, become a complex pair, and return. */
TEST(warm_start)
{
  for (size_t s = 0; s < solver_count(); s++) {
    struct solver_options options;
    solver_options_default(solver_at(s), &options);
    options.start = START_PREVIOUS;
    struct solver_warm warm = {0};
    for (int step = -20; step <= 20; step++) {
      const double height = step * 1e-2; /* (u - 1/2)^2 + height, times (u + 1) */
      const double c[] = {0.25 + height, -1.0 + 0.25 + height, 0.0, 1.0};
      const struct polynomial p = {3, BASIS_POWER, c, NULL};
      struct root_set roots;
      solver_solve(&p, &options, &warm, &roots);
      assert_int_equal(roots.not_finite || roots.identically_zero, 0);
      if (!solver_at(s)->real_only) {
        assert_int_equal(roots.count, 3);
        assert_true(found(&roots, -1.0));
        for (int k = 0; k < 3; k++) assert_true(roots.root[k].status != ROOT_LIMIT);
      }
      if (step < 0) {
        assert_true(found(&roots, 0.5 - sqrt(-height)));
        assert_true(found(&roots, 0.5 + sqrt(-height)));
      }
    }
    /* All starts are equal, and not as many as the roots: they are as good as any. */
    const double cube[] = {-1.0, 0.0, 0.0, 1.0};
    const struct polynomial p = {3, BASIS_POWER, cube, NULL};
    for (int count = 2; count <= 3; count++) {
      warm = (struct solver_warm){.count = count, .re = {0.5, 0.5, 0.5}};
      struct root_set roots;
      solver_solve(&p, &options, &warm, &roots);
      assert_true(found(&roots, 1.0));
      assert_true(solver_at(s)->real_only || roots.count == 3);
    }
  }
}

/* The largest radius, over all solvers, of the root next to `at`, of this polynomial and of its Bernstein form;
 * INFINITY if one has another status, or a solver that seeks it finds none. */
static double largest_radius(int degree, const double c[], double at, enum root_status status)
{
  const struct polynomial power = {degree, BASIS_POWER, c, NULL};
  double bernstein[POLYNOMIAL_MAX_DEGREE + 1], error[POLYNOMIAL_MAX_DEGREE + 1], largest = 0.0;
  polynomial_to_bernstein(&power, bernstein, error);
  for (size_t s = 0; s < solver_count(); s++) {
    for (int form = 0; form < 2; form++) {
      const struct root_set roots = form == 0 ? solve(solver_at(s)->name, degree, BASIS_POWER, c, NULL)
                                              : solve(solver_at(s)->name, degree, BASIS_BERNSTEIN, bernstein, error);
      bool missing = !solver_at(s)->real_only || (at >= 0.0 && at <= 1.0);
      for (int k = 0; k < roots.count; k++) {
        const struct root *root = &roots.root[k];
        if (!(hypot(root->re - at, root->im) < 0.1)) continue;
        largest = fmax(largest, root->status == status ? root->radius : INFINITY);
        missing = false;
      }
      if (missing) largest = INFINITY;
    }
  }
  return largest;
}

/* A true radius is useless if it is large. */
TEST(radii_are_small)
{
  const double c[] = {-0.5, 1.75, -0.75, -2.0, 1.0}; /* -1, 1/2 twice, 2 */
  assert_true(largest_radius(4, c, -1.0, ROOT_CONVERGED) < 1e-12);
  assert_true(largest_radius(4, c, 2.0, ROOT_CONVERGED) < 1e-12);
  assert_true(largest_radius(4, c, 0.5, ROOT_CLUSTER) < 1e-3);
}

/* A polynomial that is a power has only one root. Doubles know (x - 1)^8 to 0.02 and (x - 1)^20 to 0.4; the discs of
 * their clusters are not much larger. The complex roots of a real polynomial are printed as conjugate pairs, in a
 * cluster or not. */
TEST(clusters_have_discs_and_pairs)
{
  static const struct {
    int power;
    double largest;
  } cases[] = {{3, 1e-4}, {8, 0.1}, {20, 1.0}};
  for (size_t s = 0; s < solver_count(); s++) {
    if (solver_at(s)->real_only) continue;
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
      double c[21] = {1.0};
      const int power = cases[k].power;
      for (int j = 0; j < power; j++)
        for (int i = j + 1; i >= 0; i--) c[i] = (i > 0 ? c[i - 1] : 0.0) - (i <= j ? c[i] : 0.0);
      const struct root_set roots = solve(solver_at(s)->name, power, BASIS_POWER, c, NULL);
      assert_int_equal(roots.count, power);
      for (int i = 0; i < power; i++) {
        const struct root *root = &roots.root[i];
        assert_true(root->radius <= cases[k].largest && root->radius >= hypot(root->re - 1.0, root->im));
        bool paired = root->im == 0.0;
        for (int j = 0; j < power; j++) paired |= roots.root[j].re == root->re && roots.root[j].im == -root->im;
        assert_true(paired);
      }
    }
    const double plain[] = {5.0, -2.0, 3.0, 0.0, -1.0, 0.5, 7.0, 1.0};
    const struct root_set roots = solve(solver_at(s)->name, 7, BASIS_POWER, plain, NULL);
    for (int i = 0; i < roots.count; i++) {
      bool paired = false;
      for (int j = 0; j < roots.count; j++)
        paired |= roots.root[j].re == roots.root[i].re && roots.root[j].im == -roots.root[i].im;
      assert_true(paired);
    }
  }
}

/* Measured in units of 2^size, the unknown has the same roots, in those units, with the same statuses, as long as the
 * coefficients are doubles. */
TEST(sizes)
{
  const double c[][5] = {{-1.0, 0.0, 0.0, 0.0, 1.0}, {3.0, -2.0, 0.5, 7.0, -1.0}, {0.25, 0.5, 8.0, -0.125, 1.0}};
  for (size_t i = 0; i < solver_count(); i++) {
    if (solver_at(i)->real_only) continue; /* [0,1] is no interval of theirs in other units */
    for (size_t k = 0; k < sizeof c / sizeof c[0]; k++) {
      const struct root_set plain = solve(solver_at(i)->name, 4, BASIS_POWER, c[k], NULL);
      for (int size = -255; size <= 255; size += 17) {
        double scaled[5];
        for (int j = 0; j < 5; j++) scaled[j] = ldexp(c[k][j], -j * size);
        const struct root_set roots = solve(solver_at(i)->name, 4, BASIS_POWER, scaled, NULL);
        assert_int_equal(roots.count, plain.count);
        for (int j = 0; j < roots.count; j++) {
          assert_true(roots.root[j].re == ldexp(plain.root[j].re, size));
          assert_true(roots.root[j].im == ldexp(plain.root[j].im, size));
          assert_true(roots.root[j].radius == ldexp(plain.root[j].radius, size));
          assert_int_equal(roots.root[j].status, plain.root[j].status);
        }
      }
    }
  }
}

/* A root beyond the range of doubles is missing, and does not disturb the others. */
TEST(beyond_doubles)
{
  const double c[] = {-0x1p-100, 0.0, 0x1p900, 0x1p-1070}; /* next to -2^-500, 2^-500 and -2^1970 */
  for (size_t i = 0; i < solver_count(); i++) {
    if (solver_at(i)->real_only) continue;
    const struct root_set roots = solve(solver_at(i)->name, 3, BASIS_POWER, c, NULL);
    assert_int_equal(roots.count, 2);
    assert_int_equal(roots.missing, 1);
    assert_true(found(&roots, -0x1p-500) && found(&roots, 0x1p-500));
    for (int k = 0; k < 2; k++) assert_true(roots.root[k].radius < 0x1p-540);
    const double small[] = {-0x1.8000000000001p-600, 0x1p470}; /* 2^-1122 from the next double */
    const struct root_set one = solve(solver_at(i)->name, 1, BASIS_POWER, small, NULL);
    assert_true(one.count == 1 && one.root[0].re == 0x1.8p-1070);
    assert_true(one.root[0].radius > 0.0 && one.root[0].radius < 0x1p-1070);
  }
}

/* If roots are far apart, the squares of values next to the small ones underflow; these values must not be taken for
 * zeros. */
TEST(small_beside_large)
{
  const double s = 0x1p-430, root[] = {s, 2.0 * s, 1.0, -3.0, 1.0 / s};
  /* x times the polynomial of the four small roots */
  const double q[] = {0.0, -6.0 * s * s, 9.0 * s, -3.0, 2.0, 1.0, 0.0};
  double c[6];
  for (int k = 0; k < 6; k++) c[k] = q[k] - q[k + 1] / s;
  for (size_t i = 0; i < solver_count(); i++) {
    if (solver_at(i)->real_only) continue;
    const struct root_set roots = solve(solver_at(i)->name, 5, BASIS_POWER, c, NULL);
    assert_int_equal(roots.count, 5);
    for (int j = 0; j < 5; j++) {
      double nearest = INFINITY;
      for (int k = 0; k < 5; k++)
        if (roots.root[k].radius < 1e-9 * fabs(root[j]))
          nearest = fmin(nearest, hypot(roots.root[k].re - root[j], roots.root[k].im));
      assert_true(nearest < 1e-12 * fabs(root[j]));
    }
  }
}

/* 2^-354 is the root of x^3 - 2^-1062. Just beside it underflow still rounds the cube to 2^-1062. */
TEST(underflow_is_in_the_radius)
{
  const double c[] = {-0x1p-1062, 0.0, 0.0, 1.0}, beside = 0x1p-370;
  struct evaluation p;
  evaluation_prepare(3, BASIS_POWER, c, NULL, &p);
  struct root_set roots = {.count = 1, .root = {{.re = 0x1p-354 + beside, .status = ROOT_CONVERGED}}};
  validation_judge(&p, false, 0, &roots);
  assert_true(roots.root[0].radius >= beside);
}

/* Methods that divide by differences of their values are never given equal ones. */
TEST(equal_warm_starts_are_parted)
{
  const struct root_problem problem = {.degree = 4, .basis = BASIS_POWER, .c = {1, 2, 3, 4, 5}};
  const struct solver_warm warm = {4, {0.5, 0.5, 0.5, -3}, {0, 0, 0, 1}};
  double re[4], im[4];
  start_values(&problem, RADII_POLYGON, &warm, 4, re, im);
  for (int i = 0; i < 4; i++) {
    assert_true(hypot(re[i] - warm.re[i], im[i] - warm.im[i]) < 0x1p-8);
    for (int j = 0; j < i; j++) assert_true(re[i] != re[j] || im[i] != im[j]);
  }
}

/* The number of steps of all roots; also returns the roots. */
static int steps(const struct polynomial *p, const struct solver_options *options, struct solver_warm *warm,
                 struct root_set *out)
{
  int all = 0;
  solver_solve(p, options, warm, out);
  for (int k = 0; k < out->count; k++) all += out->root[k].iterations;
  return all;
}

/* `start previous` begins at the previous roots, in whatever unit roots are sought, and stores the new ones. `start
 * cold` ignores them. */
TEST(warm_start_is_where_roots_were)
{
  const double plain[] = {-20.0, 22.0, 2.0, -5.0, 1.0}; /* 1, -2, 3 + i, 3 - i */
  for (size_t s = 0; s < solver_count(); s++) {
    if (solver_at(s)->real_only) continue; /* needs no start */
    for (int size = -40; size <= 40; size += 40) {
      double c[5];
      for (int j = 0; j < 5; j++) c[j] = ldexp(plain[j], -j * size);
      const struct polynomial p = {4, size == 0 ? BASIS_BERNSTEIN : BASIS_POWER, c, NULL};
      struct solver_options options;
      solver_options_default(solver_at(s), &options);
      struct solver_warm warm = {0};
      struct root_set roots;
      const int cold = steps(&p, &options, &warm, &roots);
      assert_int_equal(warm.count, 0);
      options.start = START_PREVIOUS;
      assert_int_equal(steps(&p, &options, &warm, &roots), cold);
      for (int k = 0; k < 4; k++) {
        double nearest = INFINITY;
        for (int j = 0; j < warm.count; j++)
          nearest = fmin(nearest, hypot(warm.re[j] - roots.root[k].re, warm.im[j] - roots.root[k].im));
        assert_true(nearest <= 2 * roots.root[k].radius); /* a root within its error of the axis is put on the axis */
      }
      assert_true(2 * steps(&p, &options, &warm, &roots) < cold);
      options.start = START_COLD;
      assert_int_equal(steps(&p, &options, &warm, &roots), cold);
    }
  }
}

/* 1, 2 and 6 have the centroid 3. About that Cauchy's equation is r^3 = 7 r + 6. */
TEST(aberths_circle)
{
  const struct root_problem problem = {.degree = 3, .basis = BASIS_POWER, .c = {-12, 20, -9, 1}};
  double re[3], im[3];
  start_values(&problem, RADII_CIRCLE, NULL, 3, re, im);
  for (int i = 0; i < 3; i++) {
    const double angle = 2 * acos(-1.0) / 3 * (i + 0.25);
    assert_true(hypot(re[i] - (3 + 3 * cos(angle)), im[i] - 3 * sin(angle)) <= 3 * 1e-2);
  }
}

/* Whatever the limit of iterations, there is an answer, and its radii hold. */
TEST(limits)
{
  const double c[] = {-0.375, 1.75, -2.375, 1.0}; /* 0.375, 1, 1 */
  for (size_t s = 0; s < solver_count(); s++) {
    struct solver_options options;
    solver_options_default(solver_at(s), &options);
    options.max_iterations = 1;
    const struct polynomial p = {3, BASIS_POWER, c, NULL};
    struct root_set roots;
    solver_solve(&p, &options, NULL, &roots);
    for (int k = 0; k < roots.count; k++) {
      const struct root *root = &roots.root[k];
      assert_true(root->iterations <= 1);
      assert_true(fmin(hypot(root->re - 0.375, root->im), hypot(root->re - 1.0, root->im)) <= root->radius);
    }
  }
}

/* Both divisions return the other factor of an exact product. */
TEST(division)
{
  for (int how = 0; how < 2; how++) {
    double linear[] = {-6.0, 11.0, -6.0, 1.0}; /* 1, 2, 3 */
    deflation_divide_linear((enum deflation)how, 3, linear, 2.0);
    assert_true(linear[0] == 3.0 && linear[1] == -4.0 && linear[2] == 1.0);
    double quadratic[] = {10.0, -9.0, -6.0, 8.0, -4.0, 1.0}; /* (x^2 - 2 x + 5) (x^3 - 2 x^2 - x + 2) */
    deflation_divide_quadratic((enum deflation)how, 5, quadratic, 2.0, 5.0);
    assert_true(quadratic[0] == 2.0 && quadratic[1] == -1.0 && quadratic[2] == -2.0 && quadratic[3] == 1.0);
  }
}

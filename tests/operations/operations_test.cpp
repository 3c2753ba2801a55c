// Table 1 of the paper for our loops: real operations of one iteration of one root, as a function of the degree n,
// counted by compiling the solvers' sources with a counting number. The paper's forms (power basis, eq 10 alone as the
// stop).
//
//                     additions      multiplications   divisions       square roots
//   paper: Newton      6n + 2          8n + 4            2 inversions
//          Laguerre    9n + 7         12n + 16           1               3, and 2 moduli
//          Aberth     11n + 4         12n + 12           n + 1
// Ours are in the table `expected` below. A coefficient costs each of P, P' and P'' one complex product (4
// multiplications, 2 additions) and a sum (1 addition for P, whose coefficients are real, else 2); a neighbour costs
// Aberth 5 additions, 4 multiplications and 1 division.
#include <cassert>
#include <cfloat>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "base/real.h" // whose functions are not what is counted
#include "operations/counted.hpp"

#undef isfinite
#undef isnan
#define double counted
#define PSCN_KERNEL baseline
#include "algebra/aberth.c"
#undef UNDERFLOW_ERROR
#define UNDERFLOW_ERROR 0x1p-1057
#include "algebra/deflation.c"
#include "algebra/start.c"
#undef double

static const struct solver newton_row = {"newton", "", false, SOLVER_LANES_NONE, 1, newton_find};
static const struct solver laguerre_row = {"laguerre", "", false, SOLVER_LANES_NONE, 1, laguerre_find};
static const struct solver aberth_row = {"aberth", "", false, SOLVER_LANES_NONE, 1, aberth_find_baseline};

// The counter at the first steps of a method: between two of them lies one iteration.
enum { STEPS = 2 };
static operations at_step[STEPS];
static int steps;

static void note_step()
{
  if (steps < STEPS) at_step[steps] = counter;
  steps++;
}

static struct complex_number noted_newton(const struct local_view *view)
{
  note_step();
  return newton_step(view);
}

static struct complex_number noted_laguerre(const struct local_view *view)
{
  note_step();
  return laguerre_step(view);
}

static operations difference(operations a, operations b)
{
  return {a.additions - b.additions, a.multiplications - b.multiplications, a.divisions - b.divisions,
          a.square_roots - b.square_roots};
}

// Operations of one iteration: of one root, or of all n by Aberth's method.
static operations count(const struct solver *solver, int degree)
{
  struct root_problem problem = {};
  struct root_set out;
  struct solver_options options = {};
  unsigned state = 7;
  problem.degree = degree;
  problem.basis = BASIS_POWER;
  // Roots well within the unit circle, so that no value needs the reversed polynomial.
  for (int k = 0; k <= degree; k++) {
    state = state * 1664525u + 1013904223u;
    problem.c[k] = ((state >> 8) * 0x1p-24 + 0.25) * exp2(4.0 * k);
  }
  options.solver = solver;
  options.tolerance = 1e-300;
  options.max_iterations = STEPS;
  options.radii = RADII_CIRCLE;
  options.stop = STOP_STEP;
  options.update = UPDATE_JACOBI;
  counter = {};
  steps = 0;
  if (solver == &aberth_row) {
    aberth_find_baseline(&problem, &options, nullptr, &out);
    const operations two = counter;
    options.max_iterations = 1;
    counter = {};
    aberth_find_baseline(&problem, &options, nullptr, &out);
    return difference(two, counter);
  }
  const bool newton = solver == &newton_row;
  const struct deflation_method noted = {newton ? noted_newton : noted_laguerre, !newton};
  deflation_find(&problem, &options, nullptr, &noted, 1, &out);
  return difference(at_step[1], at_step[0]);
}

// Slope and constant in n, per iteration of a root.
struct row {
  const struct solver *solver;
  long additions[2], multiplications[2], divisions[2], square_roots[2];
};

static const row expected[] = {
#include "operations/table.inc"
};

int main()
{
  int failed = 0;
  for (const row &row : expected) {
    for (int n = 3; n <= 24; n++) {
      const operations all = count(row.solver, n);
      const long roots = row.solver == &aberth_row ? n : 1;
      const long found[4] = {all.additions / roots, all.multiplications / roots, all.divisions / roots,
                             all.square_roots / roots};
      const long said[4] = {row.additions[0] * n + row.additions[1],
                            row.multiplications[0] * n + row.multiplications[1],
                            row.divisions[0] * n + row.divisions[1], row.square_roots[0] * n + row.square_roots[1]};
      if (memcmp(found, said, sizeof found) != 0) {
        failed++;
        fprintf(stderr, "%s, n = %d: %ld %ld %ld %ld counted, %ld %ld %ld %ld expected\n", row.solver->name, n,
                found[0], found[1], found[2], found[3], said[0], said[1], said[2], said[3]);
      }
    }
  }
  return failed == 0 ? 0 : 1;
}

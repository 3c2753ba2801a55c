/* What the paper's experiments share. */
#include "measure.h"

#include <assert.h>
#include <math.h>
#include <string.h>
#include <time.h>

/* "unit" of eq 11 for double precision: beta^-(s-1). */
#define PAPER_UNIT 0x1p-52

double measure_clock(void)
{
  struct timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

double measure_random(uint64_t *state)
{
  uint64_t z = (*state += 0x9e3779b97f4a7c15u);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

double measure_eq11(const struct root_problem *problem, double re, double im)
{
  const int n = problem->degree;
  root_problem_x_from_u(problem->basis, &re, &im);
  const double modulus = hypot(re, im);
  const int reversed = modulus > 1.0; /* by x^n, which both sides of eq 11 have in common */
  const double zr = reversed ? re / (modulus * modulus) : re, zi = reversed ? -im / (modulus * modulus) : im;
  const double size = reversed ? 1.0 / modulus : modulus;
  double pr = 0.0, pi = 0.0, largest = 0.0;
  for (int k = n; k >= 0; k--) {
    const double c = problem->c[reversed ? n - k : k];
    const double next = pr * zr - pi * zi + c;
    pi = pr * zi + pi * zr;
    pr = next;
    largest = fmax(largest, fabs(c) * pow(size, k));
  }
  const double ratio = hypot(pr, pi) / (n * PAPER_UNIT * largest);
  return isfinite(ratio) ? ratio : HUGE_VAL;
}

void measure_set(struct solver_options *options, const char *item, double value)
{
  size_t i = 0;
  while (strcmp(solver_item_at(i)->name, item) != 0) {
    i++;
    assert(i < solver_item_count());
  }
  solver_item_at(i)->set(options, value);
}

/* What every solver does on every polynomial of the corpus: CSV on standard output.
 *
 *     corpus_table
 *
 * The polynomials in the power basis, as they stand. Every true root is given the nearest value not yet given away; the
 * error is the largest distance of such a pair, relative to 1 or to the root's modulus where that is larger. A multiple
 * root counts as often as its multiplicity, but once for solvers of real roots, which answer a cluster by one or two
 * candidates.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "algebra/solver.h"
#include "corpus/corpus.h"
#include "corpus/exact_roots.h"

struct column {
  const char *method;
  bool improved;
  const char *title;
};

static const struct column columns[] = {
  {"newton", false, "newton as printed"},     {"newton", true, "newton"},
  {"laguerre", false, "laguerre as printed"}, {"laguerre", true, "laguerre"},
  {"aberth", false, "aberth as printed"},     {"aberth", true, "aberth"},
  {"durand_kerner", true, "durand_kerner"},   {"bernstein", true, "bernstein"},
};
enum { COLUMNS = sizeof columns / sizeof columns[0] };

static bool belongs(const struct solver *solver, struct exact_root root)
{
  return !solver->real_only || (root.real && root.re >= 0.0 && root.re <= 1.0);
}

/* The largest distance of true roots and values, paired as said above. Counts roots without a value. */
static double pair_up(const struct exact_roots *exact, const struct solver *solver, const struct root_set *found,
                      int *out_roots, int *out_missing)
{
  bool taken[POLYNOMIAL_MAX_DEGREE] = {false};
  double worst = 0.0;
  *out_roots = *out_missing = 0;
  for (int k = 0; k < exact_roots_count(exact); k++) {
    const struct exact_root root = exact_roots_at(exact, k);
    for (int copy = 0; belongs(solver, root) && copy < (solver->real_only ? 1 : root.multiplicity); copy++) {
      int best = -1;
      double distance = INFINITY;
      for (int r = 0; r < found->count; r++) {
        const double d = exact_roots_distance_above(exact, k, found->root[r].re, found->root[r].im);
        if (!taken[r] && d < distance) {
          best = r;
          distance = d;
        }
      }
      ++*out_roots;
      if (best < 0) {
        ++*out_missing;
      } else {
        taken[best] = true;
        worst = fmax(worst, distance / fmax(1.0, hypot(root.re, root.im)));
      }
    }
  }
  return worst;
}

static void cell(const struct corpus_entry *entry, const struct exact_roots *exact, const struct column *column)
{
  struct solver_options options;
  solver_options_default(solver_find(column->method, strlen(column->method)), &options);
  solver_options_form(&options, column->improved);
  const struct polynomial p = {entry->degree, BASIS_POWER, entry->c, NULL};
  struct root_set found;
  solver_solve(&p, &options, NULL, &found);
  int roots, missing, limit = 0, iterations = 0;
  for (int r = 0; r < found.count; r++) {
    limit += found.root[r].status == ROOT_LIMIT;
    iterations += found.root[r].iterations;
  }
  const double error = pair_up(exact, options.solver, &found, &roots, &missing);
  printf("%s,%d,%s,%d,%.1e,%d,%d,%d\n", entry->name, entry->degree, column->title, roots, error, iterations, limit,
         missing);
}

int main(void)
{
  static struct corpus_entry entries[CORPUS_MAX];
  const size_t count = corpus_read(entries);
  printf("polynomial,degree,solver,roots,error,iterations,at the limit,without value\n");
  for (size_t i = 0; i < count; i++) {
    const struct polynomial p = {entries[i].degree, BASIS_POWER, entries[i].c, NULL};
    struct exact_roots *exact = exact_roots_find(&p);
    for (int c = 0; exact != NULL && c < COLUMNS; c++) cell(&entries[i], exact, &columns[c]);
    exact_roots_destroy(exact);
  }
  return count > 0 ? 0 : 1;
}

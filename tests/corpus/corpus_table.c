/* The table of docs/corpus.md: what every solver does on every polynomial of the corpus. Markdown on standard output.
 *
 *     corpus_table
 *
 * Beside them mpsolve, where it is installed: another program that finds all roots, to as many digits as it is asked
 * for, by iterations of Aberth's kind in growing precision.
 *
 * The polynomials in the power basis, as they stand. Every true root is given the nearest value not yet given away; the
 * error is the largest distance of such a pair, relative to 1 or to the root's modulus where that is larger. A multiple
 * root counts as often as its multiplicity, but once for solvers of real roots, which answer a cluster by one or two
 * candidates.
 */
#include <flint/fmpz.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

#include "algebra/solver.h"
#include "base/clock.h"
#include "corpus/corpus.h"
#include "corpus/exact_roots.h"

struct column {
  const char *method;
  bool improved;
  const char *title;
};

static const struct column columns[] = {
  {"newton", false, "newton, form paper"},     {"newton", true, "newton"},
  {"laguerre", false, "laguerre, form paper"}, {"laguerre", true, "laguerre"},
  {"aberth", false, "aberth, form paper"},     {"aberth", true, "aberth"},
  {"durand_kerner", true, "durand_kerner"},    {"bernstein", true, "bernstein"},
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

/* Median time of a solve, microseconds. */
static double time_of(const struct polynomial *p, const struct solver_options *options)
{
  enum { TURNS = 9, REPEATS = 3 };
  double turn[TURNS];
  struct root_set found;
  for (int t = 0; t < TURNS; t++) {
    const double start = clock_seconds(CLOCK_THREAD_CPUTIME_ID);
    for (int k = 0; k < REPEATS; k++) solver_solve(p, options, NULL, &found);
    turn[t] = (clock_seconds(CLOCK_THREAD_CPUTIME_ID) - start) / REPEATS * 1e6;
    for (int k = t; k > 0 && turn[k] < turn[k - 1]; k--) {
      const double swap = turn[k];
      turn[k] = turn[k - 1], turn[k - 1] = swap;
    }
  }
  return turn[TURNS / 2];
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
  if (roots == 0) {
    printf(" %s |", found.count == 0 ? "none there" : "none there, candidates");
    return;
  }
  printf(" %.0e", error);
  if (missing > 0) printf(", %d without value", missing);
  if (limit > 0) printf(", %d at the limit", limit);
  printf(" (%d; %.0f us) |", iterations, time_of(&p, &options));
}

/* ---- mpsolve ---- */

/* The digits asked of it: more than a double has. */
#define DIGITS "20"

/* Writes c as the fraction of two whole numbers that it is. */
static void write_fraction(FILE *file, double c)
{
  int exponent;
  const double mantissa = ldexp(frexp(c, &exponent), 53);
  exponent -= 53;
  fmpz_t top, bottom;
  fmpz_init(top), fmpz_init(bottom);
  fmpz_set_d(top, mantissa), fmpz_one(bottom);
  if (exponent > 0) fmpz_mul_2exp(top, top, (ulong)exponent);
  else fmpz_mul_2exp(bottom, bottom, (ulong)-exponent);
  fmpz_fprint(file, top), fputc('/', file), fmpz_fprint(file, bottom), fputc('\n', file);
  fmpz_clear(top), fmpz_clear(bottom);
}

static double seconds_of_children(void)
{
  struct rusage usage;
  getrusage(RUSAGE_CHILDREN, &usage);
  return (double)usage.ru_utime.tv_sec + (double)usage.ru_stime.tv_sec +
         1e-6 * ((double)usage.ru_utime.tv_usec + (double)usage.ru_stime.tv_usec);
}

/* Its roots as doubles, and the CPU seconds of the whole process; false if mpsolve is missing. */
static bool mpsolve(const struct corpus_entry *entry, struct root_set *out, double *out_seconds)
{
  char path[] = "/tmp/corpus-XXXXXX", command[128], line[512];
  const int descriptor = mkstemp(path);
  FILE *file = descriptor < 0 ? NULL : fdopen(descriptor, "w");
  if (file == NULL) return false;
  int degree = entry->degree;
  while (degree > 1 && entry->c[degree] == 0) degree--;
  fprintf(file, "Monomial;\nDegree=%d;\nRational;\nReal;\n\n", degree);
  for (int k = 0; k <= degree; k++) write_fraction(file, entry->c[k]);
  fclose(file);
  snprintf(command, sizeof command, "mpsolve -as -Ga -j1 -o" DIGITS " %s 2>/dev/null", path);
  const double before = seconds_of_children();
  FILE *answers = popen(command, "r");
  out->count = 0;
  while (answers != NULL && fgets(line, sizeof line, answers) != NULL && out->count < POLYNOMIAL_MAX_DEGREE) {
    struct root *root = &out->root[out->count];
    if (sscanf(line, " ( %lf , %lf )", &root->re, &root->im) == 2) out->count++;
  }
  const bool good = answers != NULL && pclose(answers) == 0;
  *out_seconds = seconds_of_children() - before;
  remove(path);
  return good;
}

static void mpsolve_cell(const struct corpus_entry *entry, const struct exact_roots *exact)
{
  struct root_set found;
  double seconds;
  int roots, missing;
  if (!mpsolve(entry, &found, &seconds)) {
    printf(" no answer |");
    return;
  }
  const double error = pair_up(exact, solver_find("aberth", strlen("aberth")), &found, &roots, &missing);
  printf(" %.0e", error);
  if (missing > 0) printf(", %d without value", missing);
  printf(" (%.0f ms) |", seconds * 1e3);
}

int main(void)
{
  static struct corpus_entry entries[CORPUS_MAX];
  const size_t count = corpus_read(entries);
  printf("| polynomial | degree |");
  for (int c = 0; c < COLUMNS; c++) printf(" %s |", columns[c].title);
  printf(" mpsolve |\n|---|---|---|");
  for (int c = 0; c < COLUMNS; c++) printf("---|");
  printf("\n");
  for (size_t i = 0; i < count; i++) {
    const struct polynomial p = {entries[i].degree, BASIS_POWER, entries[i].c, NULL};
    struct exact_roots *exact = exact_roots_find(&p);
    printf("| %s | %d |", entries[i].name, entries[i].degree);
    for (int c = 0; exact != NULL && c < COLUMNS; c++) cell(&entries[i], exact, &columns[c]);
    if (exact != NULL) mpsolve_cell(&entries[i], exact);
    printf("\n");
    exact_roots_destroy(exact);
  }
  return count > 0 ? 0 : 1;
}

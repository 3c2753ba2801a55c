/* No root is lost in silence: ten families of hard polynomials, and those of the corpus, every solver in both forms,
 * both bases, against guaranteed roots.
 *
 * Of a solver of all roots: the true roots, each as often as it counts, can be paired with the answers so that each
 * lies within its answer's radius, or its answer is said to be unknown, or the answer says that as many more are
 * missing. Of a solver of real roots in [0,1]: every such root lies within the radius of an answer. And no disc is
 * without a root. The Bernstein form is rounded, with bounds; the truth is the power form.
 *
 * PSCN_EFFORT scales the number of polynomials; full is 1,000 a family.
 */
#include <math.h>
#include <stdlib.h>

#include "algebra/solver.h"
#include "cmocka_test.h"
#include "corpus/corpus.h"
#include "corpus/exact_roots.h"
#include "corpus/families.h"
#include "effort.h"

enum { FULL = 1000, QUICK = 12 };

struct trial {
  enum family family;
  size_t number;
  enum basis basis;
  const struct solver_options *options;
  const struct exact_roots *exact;
  const struct root_set *roots;
  bool holds[POLYNOMIAL_MAX_DEGREE][POLYNOMIAL_MAX_DEGREE]; /* [true root, with copies][answer] */
  int true_count;                                           /* counted with copies */
  struct exact_root at[POLYNOMIAL_MAX_DEGREE];
};

static size_t said_unknown, answered; /* of all */

static bool unknown(const struct root *root) { return root->status == ROOT_LIMIT || !(root->radius < INFINITY); }

static void tell(const struct trial *trial, const char *what, double re, double im)
{
  print_error("%s %zu, %s, form %s, basis %d: %s %.17g %+.17g i\n", family_name(trial->family), trial->number,
              trial->options->solver->name, solver_options_paper(trial->options) ? "paper" : "improved",
              (int)trial->basis, what, re, im);
}

/* Kuhn's augmenting path: whether true root t can be given an answer. */
static bool augment(const struct trial *trial, int t, bool seen[], int partner[])
{
  for (int r = 0; r < trial->roots->count; r++) {
    if (!trial->holds[t][r] || seen[r]) continue;
    seen[r] = true;
    if (partner[r] < 0 || augment(trial, partner[r], seen, partner)) {
      partner[r] = t;
      return true;
    }
  }
  return false;
}

static int lost_of_all(const struct trial *trial)
{
  int partner[POLYNOMIAL_MAX_DEGREE], unpaired = 0, last = 0;
  for (int r = 0; r < trial->roots->count; r++) partner[r] = -1;
  for (int t = 0; t < trial->true_count; t++) {
    bool seen[POLYNOMIAL_MAX_DEGREE] = {false};
    if (!augment(trial, t, seen, partner)) unpaired++, last = t;
  }
  if (unpaired <= trial->roots->missing) return 0;
  tell(trial, "lost in silence:", trial->at[last].re, trial->at[last].im);
  return 1;
}

static int lost_of_real(const struct trial *trial)
{
  for (int t = 0; t < trial->true_count; t++) {
    const struct exact_root root = trial->at[t];
    bool held = !root.real || root.re < 0 || root.re > 1 || trial->roots->missing > 0;
    for (int r = 0; r < trial->roots->count; r++) held |= trial->holds[t][r];
    if (held) continue;
    tell(trial, "lost in silence:", root.re, root.im);
    return 1;
  }
  return 0;
}

/* The number of false statements of one answer. */
static int judge(struct trial *trial)
{
  int wrong = 0;
  bool sound[POLYNOMIAL_MAX_DEGREE] = {false};
  trial->true_count = 0;
  for (int k = 0; k < exact_roots_count(trial->exact); k++) {
    const struct exact_root root = exact_roots_at(trial->exact, k);
    for (int copy = 0; copy < root.multiplicity; copy++) {
      const int t = trial->true_count++;
      trial->at[t] = root;
      for (int r = 0; r < trial->roots->count; r++) {
        const struct root *answer = &trial->roots->root[r];
        trial->holds[t][r] = copy > 0 ? trial->holds[t - 1][r]
                                      : unknown(answer) || exact_roots_distance_below(trial->exact, k, answer->re,
                                                                                      answer->im) <= answer->radius;
        sound[r] |= trial->holds[t][r];
      }
    }
  }
  for (int r = 0; r < trial->roots->count; r++) {
    answered++, said_unknown += unknown(&trial->roots->root[r]);
    if (sound[r]) continue;
    tell(trial, "no root within its radius:", trial->roots->root[r].re, trial->roots->root[r].im);
    wrong++;
  }
  said_unknown += (size_t)trial->roots->missing;
  wrong += trial->options->solver->real_only ? lost_of_real(trial) : lost_of_all(trial);
  return wrong;
}

static int try_polynomial(struct trial *trial, int degree, const double c[])
{
  double b[POLYNOMIAL_MAX_DEGREE + 1], error[POLYNOMIAL_MAX_DEGREE + 1];
  const struct polynomial power = {degree, BASIS_POWER, c, NULL};
  struct exact_roots *exact = exact_roots_find(&power);
  int wrong = 0;
  polynomial_to_bernstein(&power, b, error);
  trial->exact = exact;
  for (size_t s = 0; s < 2 * solver_count(); s++) {
    struct solver_options options;
    solver_options_default(solver_at(s / 2), &options);
    solver_options_form(&options, s % 2 == 0);
    for (int basis = 0; basis < 2; basis++) {
      const struct polynomial bernstein = {degree, BASIS_BERNSTEIN, b, error};
      struct root_set roots;
      solver_solve(basis == BASIS_POWER ? &power : &bernstein, &options, NULL, &roots);
      trial->basis = (enum basis)basis, trial->options = &options, trial->roots = &roots;
      wrong += judge(trial);
    }
  }
  exact_roots_destroy(exact);
  return wrong;
}

TEST(no_root_is_lost)
{
  static struct trial trial;
  const size_t count = effort_count(FULL, QUICK);
  int wrong = 0;
  for (int family = 0; family < FAMILIES; family++) {
    int polynomials = 0;
    said_unknown = answered = 0;
    for (size_t k = 0; k < count; k++) {
      struct random random = {effort_seed(7919 * (uint64_t)family + 104729 * k)};
      double c[POLYNOMIAL_MAX_DEGREE + 1];
      const int degree = family_draw((enum family)family, &random, c);
      trial.family = (enum family)family, trial.number = k;
      const int found = try_polynomial(&trial, degree, c);
      polynomials += found > 0, wrong += found;
    }
    print_message("%-10s: %d of %zu polynomials with something false; %.3f %% of the roots said to be unknown\n",
                  family_name((enum family)family), polynomials, count,
                  100.0 * (double)said_unknown / (double)(answered + 1));
  }
  static struct corpus_entry entries[CORPUS_MAX];
  trial.family = FAMILIES;
  trial.number = corpus_read(entries);
  while (trial.number-- > 0) wrong += try_polynomial(&trial, entries[trial.number].degree, entries[trial.number].c);
  assert_int_equal(wrong, 0);
}

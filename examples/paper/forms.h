/* The paper's methods in two forms, for measuring: scalar as printed, and on lanes, one polynomial a lane. The
 * iterations are the same, values and counts (forms.c says how far); only the time differs.
 *
 * src/algebra has neither: its newton and laguerre are scalar as here, its aberth moves several roots of one polynomial
 * side by side, and roots_lanes.h has iterations of its own.
 */
#ifndef PSCN_EXAMPLES_FORMS_H
#define PSCN_EXAMPLES_FORMS_H

#include <stddef.h>

#include "algebra/root_problem.h"

enum { FORMS_DEGREE = 24 };

enum paper_method { PAPER_NEWTON, PAPER_LAGUERRE, PAPER_ABERTH, PAPER_METHODS };
enum form { FORM_SCALAR, FORM_LANES, FORMS };

extern const char *const paper_method_names[PAPER_METHODS];
extern const char *const form_names[FORMS];

/* Polynomials in the power basis, one after the other, with n + 1 coefficients each. The first and the last are not
 * 0. */
struct batch {
  int degree;
  size_t count;
  const double *c;
  double tolerance;
  int max_iterations;
  bool previous;   /* each starts from the roots of the one before; on lanes each lane has its own stretch */
  bool first_only; /* newton, laguerre: only the first root */
};

/* The sums over a batch. where[] is NULL or has room for count * degree roots. */
struct batch_totals {
  double iterations, sought; /* those that took iterations */
  double operations;         /* additions, multiplications, inversions and roots, by docs/paper.md's Table 1, ours */
  double operations_paper;   /* the same by the paper's */
};

void form_run(enum form form, enum paper_method method, const struct batch *batch, struct batch_totals *out,
              double where[][2]);

/* How many polynomials FORM_LANES works on at once here. */
int form_lanes(enum paper_method method);

#endif

/* The named polynomials of polynomials.txt. */
#ifndef TESTS_CORPUS_CORPUS_H
#define TESTS_CORPUS_CORPUS_H

#include <stddef.h>

#include "algebra/polynomial.h"

enum { CORPUS_MAX = 64 };

struct corpus_entry {
  char name[48];
  char what[256];
  int degree;
  double c[POLYNOMIAL_MAX_DEGREE + 1];     /* power basis, c[k] belongs to u^k */
  double b[POLYNOMIAL_MAX_DEGREE + 1];     /* scaled Bernstein, rounded */
  double error[POLYNOMIAL_MAX_DEGREE + 1]; /* bounds on b's rounding */
};

/* Reads the corpus. Returns the number of entries, or 0 if the file cannot be read or is not well formed. */
size_t corpus_read(struct corpus_entry out[CORPUS_MAX]);

#endif

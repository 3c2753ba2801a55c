/* Guaranteed roots by arb. */
#include "corpus/exact_roots.h"

#include <math.h>
#include <stdlib.h>

/* Foreign headers, which do not compile under our warnings. */
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wsign-conversion"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wunused-parameter"
#pragma GCC diagnostic ignored "-Wstrict-prototypes"
#include <acb.h>
#include <arb_fmpz_poly.h>
#include <flint/fmpz_poly_factor.h>
#pragma GCC diagnostic pop

/* Bits of the roots: enough for the distance of two that are 1e-90 apart to have 53 good bits. */
enum { PRECISION = 400 };

struct exact_roots {
  int count;
  acb_ptr root;
  int multiplicity[POLYNOMIAL_MAX_DEGREE];
};

/* c[k] times a common power of two, as integers. */
static void set_integers(fmpz_poly_t out, int degree, const double c[])
{
  int lowest = 0;
  bool seen = false;
  for (int k = 0; k <= degree; k++) {
    int exponent;
    (void)frexp(c[k], &exponent);
    if (c[k] != 0.0 && (!seen || exponent - 53 < lowest)) {
      lowest = exponent - 53;
      seen = true;
    }
  }
  fmpz_t integer;
  fmpz_init(integer);
  for (int k = 0; k <= degree; k++) {
    int exponent;
    const double mantissa = frexp(c[k], &exponent);
    fmpz_set_d(integer, ldexp(mantissa, 53));
    if (c[k] != 0.0) fmpz_mul_2exp(integer, integer, (ulong)(exponent - 53 - lowest));
    fmpz_poly_set_coeff_fmpz(out, k, integer);
  }
  fmpz_clear(integer);
}

/* sum c[k] u^k (1-u)^(n-k), multiplied out exactly. */
static void bernstein_to_power(fmpz_poly_t poly, int degree)
{
  fmpz_poly_t sum, term, other;
  fmpz_t c;
  fmpz_poly_init(sum);
  fmpz_poly_init(term);
  fmpz_poly_init(other);
  fmpz_init(c);
  fmpz_poly_set_coeff_si(other, 0, 1);
  fmpz_poly_set_coeff_si(other, 1, -1);
  for (int k = 0; k <= degree; k++) {
    fmpz_poly_pow(term, other, (ulong)(degree - k));
    fmpz_poly_shift_left(term, term, k);
    fmpz_poly_get_coeff_fmpz(c, poly, k);
    fmpz_poly_scalar_mul_fmpz(term, term, c);
    fmpz_poly_add(sum, sum, term);
  }
  fmpz_poly_swap(sum, poly);
  fmpz_poly_clear(sum);
  fmpz_poly_clear(term);
  fmpz_poly_clear(other);
  fmpz_clear(c);
}

struct exact_roots *exact_roots_find(const struct polynomial *p)
{
  struct exact_roots *out = calloc(1, sizeof *out);
  if (out == NULL) return NULL;
  out->root = _acb_vec_init(POLYNOMIAL_MAX_DEGREE);
  fmpz_poly_t poly;
  fmpz_poly_init(poly);
  set_integers(poly, p->degree, p->c);
  if (p->basis == BASIS_BERNSTEIN) bernstein_to_power(poly, p->degree);
  fmpz_poly_factor_t factors;
  fmpz_poly_factor_init(factors);
  fmpz_poly_factor_squarefree(factors, poly);
  for (slong f = 0; f < factors->num; f++) {
    const int degree = (int)fmpz_poly_degree(factors->p + f);
    arb_fmpz_poly_complex_roots(out->root + out->count, factors->p + f, 0, PRECISION);
    for (int i = 0; i < degree; i++) out->multiplicity[out->count++] = (int)factors->exp[f];
  }
  fmpz_poly_factor_clear(factors);
  fmpz_poly_clear(poly);
  return out;
}

void exact_roots_destroy(struct exact_roots *roots)
{
  if (roots != NULL) {
    _acb_vec_clear(roots->root, POLYNOMIAL_MAX_DEGREE);
    free(roots);
    flint_cleanup();
  }
}

int exact_roots_count(const struct exact_roots *roots) { return roots->count; }

struct exact_root exact_roots_at(const struct exact_roots *roots, int index)
{
  acb_srcptr root = roots->root + index;
  return (struct exact_root){
    .re = arf_get_d(arb_midref(acb_realref(root)), ARF_RND_NEAR),
    .im = arf_get_d(arb_midref(acb_imagref(root)), ARF_RND_NEAR),
    .multiplicity = roots->multiplicity[index],
    .real = arb_is_zero(acb_imagref(root)) != 0,
  };
}

/* The distance rounded down or up. */
static double distance(const struct exact_roots *roots, int index, double re, double im, bool up)
{
  acb_t at;
  arb_t length;
  arf_t bound;
  acb_init(at);
  arb_init(length);
  arf_init(bound);
  acb_set_d_d(at, re, im);
  acb_sub(at, at, roots->root + index, PRECISION);
  acb_abs(length, at, PRECISION);
  double out;
  if (up) {
    arb_get_ubound_arf(bound, length, PRECISION);
    out = arf_get_d(bound, ARF_RND_UP);
  } else {
    arb_get_lbound_arf(bound, length, PRECISION);
    out = fmax(0.0, arf_get_d(bound, ARF_RND_DOWN));
  }
  arf_clear(bound);
  arb_clear(length);
  acb_clear(at);
  return out;
}

double exact_roots_distance_below(const struct exact_roots *roots, int index, double re, double im)
{
  return distance(roots, index, re, im, false);
}

double exact_roots_distance_above(const struct exact_roots *roots, int index, double re, double im)
{
  return distance(roots, index, re, im, true);
}

double exact_roots_nearest_below(const struct exact_roots *roots, double re, double im)
{
  double nearest = INFINITY;
  for (int i = 0; i < roots->count; i++) nearest = fmin(nearest, distance(roots, i, re, im, false));
  return nearest;
}

/* A real polynomial in one of two bases, with coefficients that may be known only within bounds. Nothing here
 * allocates, fails or keeps state. */
#ifndef PSCN_ALGEBRA_POLYNOMIAL_H
#define PSCN_ALGEBRA_POLYNOMIAL_H

enum { POLYNOMIAL_MAX_DEGREE = 64 };

enum basis {
  BASIS_BERNSTEIN, /* scaled: p(u) = sum c[k] u^k (1-u)^(n-k), c[k] = C(n,k) times the Bernstein coefficient */
  BASIS_POWER      /* p(u) = sum c[k] u^k */
};

/* A real polynomial of formal degree n = degree, 1 <= n <= POLYNOMIAL_MAX_DEGREE. Borrowed pointers. */
struct polynomial {
  int degree;
  enum basis basis;
  const double *c;     /* n + 1 coefficients, c[k] belongs to u^k */
  const double *error; /* n + 1 absolute bounds on the error of each c[k], or NULL where c is exact */
};

/* |P(z)| / delta(z) of the paper's eq 11 at a finite z = re + i im, where delta = n 2^-52 max |a_k z^k| and a_n is not
 * 0. Below 1, the paper calls z accurate. In scaled Bernstein form, P and the terms are those of the plain polynomial
 * in z/(1-z). */
double polynomial_eq11(const struct polynomial *p, double re, double im);

/* Converts p to scaled Bernstein form, or copies it if it has that form. Writes degree + 1 coefficients and bounds (the
 * old bounds carried over, plus all rounding). The arrays must not overlap p's. */
void polynomial_to_bernstein(const struct polynomial *p, double out_c[], double out_error[]);

/* The most sign changes that a sequence of n + 1 coefficients can have, if signs are known only where |c[k]| > error[k]
 * (error may be NULL). By Descartes' rule on scaled Bernstein (or Bernstein) coefficients, 0 proves that (0,1) holds no
 * root. 1 proves that it holds exactly one, where both ends have signs and these differ. */
int polynomial_sign_variations(int degree, const double c[], const double error[]);

/* Newton's polygon, the upper convex hull of the points (k, height[k]), from left to right. Adds point k to the corners
 * so far, and returns how many there are then. An edge from k to l stands for l - k roots of about one modulus. */
static inline int polynomial_add_corner(const double height[], int corner[], int corners, int k)
{
  for (; corners >= 2; corners--) {
    const int a = corner[corners - 2], b = corner[corners - 1];
    if ((height[b] - height[a]) * (k - a) > (height[k] - height[a]) * (b - a)) break;
  }
  corner[corners] = k;
  return corners + 1;
}

/* C(n,k) for n <= POLYNOMIAL_MAX_DEGREE: exact up to 2^53, correctly rounded beyond. */
double polynomial_binomial(int n, int k);

#endif

/* Sylvester's resultant of two polynomials in two parameters (paper eq 5 and 6).
 *
 * The contract is that of bezout_determinant (algebra/bezout.h), for which this is the paper's form and the test. In
 * A[4 * i + j], i = 0..m belongs to the parameter that is kept, j = 0..n to the one that is eliminated, 1 <= m, n <= 3.
 * Laplace expansion along the upper half of the 2n x 2n determinant gives sums of products of n x n minors, which are
 * polynomials of degree mn. Writes c[0..2mn], which equals Bezout's up to a sign. Pure; safe on any thread.
 */
#ifndef PSCN_ALGEBRA_SYLVESTER_H
#define PSCN_ALGEBRA_SYLVESTER_H

void sylvester_determinant(int m, int n, const double A[16], const double B[16], double c[19]);

#endif

/* Sylvester's resultant of two polynomials in two parameters (paper eq 5 and 6).
 *
 * The same contract as bezout_determinant (algebra/bezout.h), of which this is the paper's form and the test: A[4 *
 * i + j], i = 0..m the degree that is kept, j = 0..n the one that is eliminated, 1 <= m, n <= 3. The 2n x 2n
 * determinant is expanded by Laplace along its upper half: sums of products of n x n minors, which are polynomials
 * of degree mn. c[0..2mn] is written; it equals Bezout's up to a sign. Pure; safe on any thread.
 */
#ifndef PSCN_ALGEBRA_SYLVESTER_H
#define PSCN_ALGEBRA_SYLVESTER_H

void sylvester_determinant(int m, int n, const double A[16], const double B[16], double c[19]);

#endif

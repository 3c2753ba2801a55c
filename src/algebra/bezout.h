/* Bezout's resultant of two polynomials in two parameters, in scaled Bernstein form.
 *
 * a and b are nets a[4 * i + j] of plain Bernstein coefficients, 1 <= m, n <= 3; i = 0..m is for the parameter that is
 * kept (u), j = 0..n for the one that is eliminated (v). With A_ij = C(m,i) C(n,j) a_ij, products are convolutions
 * (Farouki and Rajan 1988). The minors [kl] = A_k B_l - A_l B_k of the v-coefficients have degree 2m in u, and r(u) is
 * the determinant of
 *   n = 1: [01]    n = 2: |01 02; 02 12|    n = 3: |01 02 03; 02 03+12 13; 03 13 23|
 * of degree 2 m n, r(u) = sum c_k u^k (1-u)^(2mn-k) (paper eq 4-6, in Bezout's form instead of Sylvester's). Where r(u)
 * = 0, the matrix has the null vector (s^(n-1), ..., t^(n-1)), and v = t/(s+t).
 *
 * The same source serves one double and a register of lanes: BEZOUT_REAL is the type. All functions are pure.
 */
#ifndef BEZOUT_REAL
#error "define BEZOUT_REAL and BEZOUT_NAME before including algebra/bezout.h"
#endif

enum { BEZOUT_NAME(MAX_DEGREE) = 18 };

#define BEZOUT_INLINE static inline __attribute__((always_inline, unused))

/* Without optimization, gcc warns of a loop with two conditions that it is told to unroll. */
#define BEZOUT_PRAGMA(text) _Pragma(#text)
#ifdef __OPTIMIZE__
#define BEZOUT_UNROLL(times) BEZOUT_PRAGMA(GCC unroll times)
#else
#define BEZOUT_UNROLL(times)
#endif

/* The binomials C(n,k), n = 1..3. */
BEZOUT_INLINE double BEZOUT_NAME(binomial)(int n, int k) { return k == 0 || k == n ? 1 : n; }

/* out[0..2m] = A_k B_l - A_l B_k as polynomials in u. */
BEZOUT_INLINE void BEZOUT_NAME(minor)(int m, int k, int l, const BEZOUT_REAL A[16], const BEZOUT_REAL B[16],
                                      BEZOUT_REAL out[7])
{
  BEZOUT_UNROLL(8)
  for (int e = 0; e <= 2 * m; e++) {
    BEZOUT_REAL sum = {0};
    BEZOUT_UNROLL(4)
    for (int i = e > m ? e - m : 0; i <= e && i <= m; i++)
      sum += A[4 * i + k] * B[4 * (e - i) + l] - A[4 * i + l] * B[4 * (e - i) + k];
    out[e] = sum;
  }
}

/* out[0..p+q] = sign x y, for x and y of degrees p and q; with `add`, out += sign x y. */
BEZOUT_INLINE void BEZOUT_NAME(multiply)(int p, int q, const BEZOUT_REAL x[], const BEZOUT_REAL y[], double sign,
                                         int add, BEZOUT_REAL out[])
{
  BEZOUT_UNROLL(19)
  for (int e = 0; e <= p + q; e++) {
    BEZOUT_REAL sum = {0};
    BEZOUT_UNROLL(7)
    for (int i = e > q ? e - q : 0; i <= e && i <= p; i++) sum += x[i] * y[e - i];
    out[e] = add ? out[e] + sign * sum : sign * sum;
  }
}

/* c[0..2mn] of the determinant, for coefficients whose products are convolutions. A and B in scaled Bernstein form give
 * c in that form; in power form (power of u times power of v) they give power form. */
BEZOUT_INLINE void BEZOUT_NAME(determinant)(int m, int n, const BEZOUT_REAL A[16], const BEZOUT_REAL B[16],
                                            BEZOUT_REAL c[BEZOUT_NAME(MAX_DEGREE) + 1])
{
  const int d = 2 * m;
  if (n == 1) {
    BEZOUT_NAME(minor)(m, 0, 1, A, B, c);
    return;
  }
  BEZOUT_REAL m01[7], m02[7], m12[7];
  BEZOUT_NAME(minor)(m, 0, 1, A, B, m01);
  BEZOUT_NAME(minor)(m, 0, 2, A, B, m02);
  BEZOUT_NAME(minor)(m, 1, 2, A, B, m12);
  if (n == 2) {
    BEZOUT_NAME(multiply)(d, d, m01, m12, 1, 0, c);
    BEZOUT_NAME(multiply)(d, d, m02, m02, -1, 1, c);
    return;
  }
  BEZOUT_REAL m03[7], m13[7], m23[7], middle[7], k0[13], k1[13], k2[13];
  BEZOUT_NAME(minor)(m, 0, 3, A, B, m03);
  BEZOUT_NAME(minor)(m, 1, 3, A, B, m13);
  BEZOUT_NAME(minor)(m, 2, 3, A, B, m23);
  for (int e = 0; e <= d; e++) middle[e] = m03[e] + m12[e];
  BEZOUT_NAME(multiply)(d, d, middle, m23, 1, 0, k0);
  BEZOUT_NAME(multiply)(d, d, m13, m13, -1, 1, k0);
  BEZOUT_NAME(multiply)(d, d, m13, m03, 1, 0, k1);
  BEZOUT_NAME(multiply)(d, d, m02, m23, -1, 1, k1);
  BEZOUT_NAME(multiply)(d, d, m02, m13, 1, 0, k2);
  BEZOUT_NAME(multiply)(d, d, middle, m03, -1, 1, k2);
  BEZOUT_NAME(multiply)(d, 2 * d, m01, k0, 1, 0, c);
  BEZOUT_NAME(multiply)(d, 2 * d, m02, k1, 1, 1, c);
  BEZOUT_NAME(multiply)(d, 2 * d, m03, k2, 1, 1, c);
}

/* c[0..2mn] of r, for nets a and b in plain Bernstein form. */
BEZOUT_INLINE void BEZOUT_NAME(resultant)(int m, int n, const BEZOUT_REAL a[16], const BEZOUT_REAL b[16],
                                          BEZOUT_REAL c[BEZOUT_NAME(MAX_DEGREE) + 1])
{
  BEZOUT_REAL A[16], B[16];
  for (int i = 0; i <= m; i++) {
    for (int j = 0; j <= n; j++) {
      const double s = BEZOUT_NAME(binomial)(m, i) * BEZOUT_NAME(binomial)(n, j);
      A[4 * i + j] = s * a[4 * i + j], B[4 * i + j] = s * b[4 * i + j];
    }
  }
  BEZOUT_NAME(determinant)(m, n, A, B, c);
}

/* The v of the null vector at a root u. p[0..n] and q[0..n] are the values there of the plain Bernstein v-coefficients
 * of a and b. Row 0 and row 1 are two ways to write it, each v = num[.]/den[.]; row 0 is the better one where
 * `first_better` > 0. den may be 0 (the root v is at infinity, or two hits share u). */
BEZOUT_INLINE void BEZOUT_NAME(null_vector)(int n, const BEZOUT_REAL p[4], const BEZOUT_REAL q[4], BEZOUT_REAL num[2],
                                            BEZOUT_REAL den[2], BEZOUT_REAL *first_better)
{
  if (n == 1) { /* p0 s + p1 t = 0, and q0 s + q1 t = 0 */
    num[0] = p[0], den[0] = p[0] - p[1];
    num[1] = q[0], den[1] = q[0] - q[1];
    *first_better = den[0] * den[0] - den[1] * den[1];
    return;
  }
  const BEZOUT_REAL m01 = n * (p[0] * q[1] - p[1] * q[0]);
  if (n == 2) { /* |m01 m02; m02 m12| (s, t) = 0 */
    const BEZOUT_REAL m02 = p[0] * q[2] - p[2] * q[0], m12 = 2 * (p[1] * q[2] - p[2] * q[1]);
    num[0] = m01, den[0] = m01 - m02;
    num[1] = m02, den[1] = m02 - m12;
    *first_better = den[0] * den[0] - den[1] * den[1];
    return;
  }
  const BEZOUT_REAL m02 = 3 * (p[0] * q[2] - p[2] * q[0]), m03 = p[0] * q[3] - p[3] * q[0];
  const BEZOUT_REAL m12 = 9 * (p[1] * q[2] - p[2] * q[1]), m13 = 3 * (p[1] * q[3] - p[3] * q[1]);
  const BEZOUT_REAL m23 = 3 * (p[2] * q[3] - p[3] * q[2]), middle = m03 + m12;
  /* The adjugate is (s^2, st, t^2) times its own transpose. Its first row is divided by s^2, its last one by t^2. */
  const BEZOUT_REAL a00 = middle * m23 - m13 * m13, a01 = m03 * m13 - m02 * m23;
  const BEZOUT_REAL a12 = m02 * m03 - m01 * m13, a22 = m01 * middle - m02 * m02;
  num[0] = a01, den[0] = a00 + a01;
  num[1] = a22, den[1] = a12 + a22;
  *first_better = a00 * a00 - a22 * a22;
}

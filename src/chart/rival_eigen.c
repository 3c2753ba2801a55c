/* Roots as eigenvalues, by LAPACK: of the companion matrix of r(u) (paper eq 6), and of the pencil of Bezout's matrix,
 * whose determinant r is, without forming that (D. Manocha, S. Krishnan, "Algebraic Pruning: A Fast Technique for Curve
 * and Surface Intersection", 1997). A module, so that pscn needs no LAPACK. */
#include <string.h>

#include "chart/rivals.h"

#define BEZOUT_REAL double
#define BEZOUT_NAME(name) bezout_##name
#include "algebra/bezout.h"

enum { DEGREE = 18, WORK = 16 * DEGREE };

/* A real double root is found as a pair this near to the axis. */
#define NEARLY_REAL 1e-7

/* A leading coefficient below this part of the largest is none. */
#define NO_COEFFICIENT 1e-15

void dhseqr_(const char *job, const char *compz, const int *n, const int *ilo, const int *ihi, double *h,
             const int *ldh, double *wr, double *wi, double *z, const int *ldz, double *work, const int *lwork,
             int *info);
void dggev_(const char *jobvl, const char *jobvr, const int *n, double *a, const int *lda, double *b, const int *ldb,
            double *alphar, double *alphai, double *beta, double *vl, const int *ldvl, double *vr, const int *ldvr,
            double *work, const int *lwork, int *info);

/* A part is of a lower degree where that is so within this, of its largest coefficient. (At a higher one r would
 * vanish.) */
#define DEGREE_SLACK 1e-12

/* The nets in Bernstein and in power form, of their true bidegree (m, n), [4 * i + j]. */
struct forms {
  int m, n;
  double a[16], b[16], A[16], B[16];
};

static void to_power(int n, double *b, int stride)
{
  const double b0 = b[0], b1 = b[stride], b2 = n > 1 ? b[2 * stride] : 0, b3 = n > 2 ? b[3 * stride] : 0;
  b[stride] = n * (b1 - b0);
  if (n == 2) b[2 * stride] = b2 - 2 * b1 + b0;
  if (n == 3) b[2 * stride] = 3 * (b2 - 2 * b1 + b0), b[3 * stride] = b3 - 3 * (b2 - b1) - b0;
}

static void make_forms(double a[4][4], double b[4][4], struct forms *out)
{
  double x[3][4][4] = {{{0}}}, reduced[4][4] = {{0}}, size = 0;
  memcpy(x[0], a, sizeof x[0]), memcpy(x[1], b, sizeof x[1]);
  for (int n = 0; n < 16; n++) size = fmax(size, fmax(fabs(a[n / 4][n % 4]), fabs(b[n / 4][n % 4])));
  patch_bidegree(x, DEGREE_SLACK * size, &out->m, &out->n);
  for (int plane = 0; plane < 2; plane++) {
    double *net = plane == 0 ? out->a : out->b, *power = plane == 0 ? out->A : out->B;
    patch_reduce(x[plane], out->m, out->n, reduced);
    memcpy(net, reduced, sizeof reduced), memcpy(power, reduced, sizeof reduced);
    for (int i = 0; i <= out->m; i++) to_power(out->n, power + 4 * i, 1);
    for (int j = 0; j <= out->n; j++) to_power(out->m, power + j, 4);
  }
}

/* Adds the root at u, with its v from the null vector, if it is on the part. */
static void add(const struct forms *forms, double u, int *count, struct rival_root out[RIVAL_ROOTS])
{
  double p[4] = {0}, q[4] = {0}, num[2], den[2], better, power = 1;
  if (!(fabs(u - 0.5) <= 0.5 + RIVAL_EDGE)) return;
  double w[4];
  for (int i = 0; i <= forms->m; i++) {
    w[i] = bezout_binomial(forms->m, i) * power, power *= u;
    for (int k = 0; k < forms->m - i; k++) w[i] *= 1 - u;
  }
  for (int i = 0; i <= forms->m; i++)
    for (int j = 0; j <= forms->n; j++) p[j] += w[i] * forms->a[4 * i + j], q[j] += w[i] * forms->b[4 * i + j];
  bezout_null_vector(forms->n, p, q, num, den, &better);
  const double v = better > 0 ? num[0] / den[0] : num[1] / den[1];
  if (fabs(v - 0.5) <= 0.5 + RIVAL_EDGE && *count < RIVAL_ROOTS) out[(*count)++] = (struct rival_root){u, v};
}

__attribute__((visibility("default"))) int rival_companion(double a[4][4], double b[4][4],
                                                           struct rival_root out[RIVAL_ROOTS])
{
  double c[DEGREE + 1], H[DEGREE * DEGREE] = {0}, re[DEGREE], im[DEGREE], work[WORK], largest = 0;
  struct forms forms;
  make_forms(a, b, &forms);
  bezout_determinant(forms.m, forms.n, forms.A, forms.B, c);
  int n = 2 * forms.m * forms.n, info = 0, count = 0;
  for (int k = 0; k <= n; k++) largest = fmax(largest, fabs(c[k]));
  while (n > 0 && !(fabs(c[n]) > NO_COEFFICIENT * largest)) n--;
  if (n == 0) return 0;
  for (int k = 0; k < n; k++) {
    H[n * (n - 1) + k] = -c[k] / c[n]; /* by columns: the last one */
    if (k > 0) H[n * (k - 1) + k] = 1;
  }
  const int one = 1, room = WORK;
  dhseqr_("E", "N", &n, &one, &n, H, &n, re, im, NULL, &one, work, &room, &info);
  for (int k = info > 0 ? info : 0; k < n; k++)
    if (fabs(im[k]) <= NEARLY_REAL) add(&forms, re[k], &count, out);
  return count;
}

/* The pencil is the block companion matrix of the matrix polynomial sum M_k u^k of degree 2m. */
__attribute__((visibility("default"))) int rival_pencil(double a[4][4], double b[4][4],
                                                        struct rival_root out[RIVAL_ROOTS])
{
  double minor[6][7], left[DEGREE * DEGREE] = {0}, right[DEGREE * DEGREE] = {0};
  double re[DEGREE], im[DEGREE], scale[DEGREE], work[WORK];
  static const int pair[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};
  struct forms forms;
  make_forms(a, b, &forms);
  const int block = forms.n, power = 2 * forms.m, n = block * power, one = 1, room = WORK;
  for (int k = 0; k < 6; k++)
    if (pair[k][1] <= block) bezout_minor(forms.m, pair[k][0], pair[k][1], forms.A, forms.B, minor[k]);
  for (int k = 0; k <= power; k++) {
    double M[3][3] = {{minor[0][k]}};
    if (block > 1) M[0][1] = M[1][0] = minor[1][k], M[1][1] = minor[3][k];
    if (block > 2)
      M[0][2] = M[2][0] = minor[2][k], M[1][1] += minor[2][k], M[1][2] = M[2][1] = minor[4][k], M[2][2] = minor[5][k];
    for (int at = 0; at < block * block; at++) {
      const int row = at / block, column = at % block;
      if (k == power) right[n * column + row] = M[row][column];
      else left[n * (block * (power - 1 - k) + column) + row] = -M[row][column];
    }
  }
  for (int k = block; k < n; k++) right[n * k + k] = left[n * (k - block) + k] = 1;
  int info = 0, count = 0;
  dggev_("N", "N", &n, left, &n, right, &n, re, im, scale, NULL, &one, NULL, &one, work, &room, &info);
  for (int k = 0; k < n && info == 0; k++)
    if (scale[k] != 0 && fabs(im[k]) <= NEARLY_REAL * fabs(scale[k])) add(&forms, re[k] / scale[k], &count, out);
  return count;
}

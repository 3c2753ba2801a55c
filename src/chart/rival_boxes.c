/* Two methods that halve the square of the parameters: plain subdivision (T. Whitted, "An Improved Illumination Model for
 * Shaded Display", 1980), which drops boxes by the hull of the control points, and interval Newton with Krawczyk's test
 * (D. Toth, "On Ray Tracing Parametric Surfaces", SIGGRAPH 1985). Bounds are those of the control points; their
 * roundings are not counted, as outside a proof nobody does. */
#include "chart/rivals.h"

/* A box of less than this a side is a root of plain subdivision. Its best: smaller ones gain no digit of T. */
#define SMALLEST 0x1p-40

/* Boxes examined on one part, and that may wait. */
enum { MOST_BOXES = 4096, WAITING = 2 * 64 };

struct box {
  double u, v, width[2];
  double a[4][4], b[4][4]; /* nets over it */
};

/* Splits a net in its middle along u (0) or v (1) by de Casteljau's algorithm: `net` becomes the first half. */
static void halve_net(double net[4][4], int along, double out_second[4][4])
{
  for (int n = 0; n < 4; n++) {
    double c[4];
    for (int k = 0; k < 4; k++) c[k] = along == 0 ? net[k][n] : net[n][k];
    const double c01 = 0.5 * (c[0] + c[1]), c12 = 0.5 * (c[1] + c[2]), c23 = 0.5 * (c[2] + c[3]);
    const double c012 = 0.5 * (c01 + c12), c123 = 0.5 * (c12 + c23), middle = 0.5 * (c012 + c123);
    const double first[4] = {c[0], c01, c012, middle}, second[4] = {middle, c123, c23, c[3]};
    for (int k = 0; k < 4; k++) {
      *(along == 0 ? &net[k][n] : &net[n][k]) = first[k];
      *(along == 0 ? &out_second[k][n] : &out_second[n][k]) = second[k];
    }
  }
}

static void halve(struct box *box, int along, struct box *out_second)
{
  box->width[along] *= 0.5;
  out_second->u = box->u + (along == 0 ? box->width[0] : 0), out_second->v = box->v + (along == 1 ? box->width[1] : 0);
  out_second->width[0] = box->width[0], out_second->width[1] = box->width[1];
  halve_net(box->a, along, out_second->a), halve_net(box->b, along, out_second->b);
}

enum verdict { NO_ROOT, ONE_ROOT, OPEN };

/* Judges a box; *root is a root in it, in its parameters. */
typedef enum verdict judge_box(struct box *box, struct rival_root *root);

/* Boxes on either side of a root's box may keep it, too. */
static bool same(const struct rival_root *x, const struct rival_root *y)
{
  return fabs(x->u - y->u) < 16 * SMALLEST && fabs(x->v - y->v) < 16 * SMALLEST;
}

static int search(double a[4][4], double b[4][4], judge_box *judge, struct rival_root out[RIVAL_ROOTS])
{
  struct box stack[WAITING];
  int top = 1, count = 0;
  stack[0] = (struct box){.width = {1, 1}};
  for (int n = 0; n < 16; n++) stack[0].a[n / 4][n % 4] = a[n / 4][n % 4], stack[0].b[n / 4][n % 4] = b[n / 4][n % 4];
  for (int boxes = 0; top > 0 && boxes < MOST_BOXES && count < RIVAL_ROOTS; boxes++) {
    struct box *box = &stack[top - 1];
    struct rival_root root = {0.5, 0.5};
    const enum verdict verdict = rival_keeps_sign(box->a) || rival_keeps_sign(box->b) ? NO_ROOT
                                 : fmax(box->width[0], box->width[1]) < SMALLEST      ? ONE_ROOT
                                                                                      : judge(box, &root);
    if (verdict == ONE_ROOT) {
      root.u = box->u + root.u * box->width[0], root.v = box->v + root.v * box->width[1];
      if (count == 0 || !same(&root, &out[count - 1])) out[count++] = root;
    }
    if (verdict != OPEN || top == WAITING) top--;
    else halve(box, box->width[0] < box->width[1], &stack[top]), top++;
  }
  return count;
}

static enum verdict judge_none(struct box *box, struct rival_root *root)
{
  (void)box, (void)root;
  return OPEN;
}

int rival_subdivision(double a[4][4], double b[4][4], struct rival_root out[RIVAL_ROOTS])
{
  return search(a, b, judge_none, out);
}

/* The middle and the half width of a derivative's range over a box: along u (0) or v (1). */
static void slope_range(double net[4][4], int along, double *middle, double *half)
{
  double low = INFINITY, high = -INFINITY;
  for (int n = 0; n < 4; n++)
    for (int k = 0; k < 3; k++) {
      const double slope = 3 * (along == 0 ? net[k + 1][n] - net[k][n] : net[n][k + 1] - net[n][k]);
      low = fmin(low, slope), high = fmax(high, slope);
    }
  *middle = 0.5 * (low + high), *half = 0.5 * (high - low);
}

/* Krawczyk's operator on the box, with Y the inverse of the middle Jacobian: K = m - Y f(m) + (I - Y J)(X - m). Outside
 * the box, it has no root; within, exactly one, to which Newton's method converges. */
static enum verdict judge_krawczyk(struct box *box, struct rival_root *root)
{
  enum { STEPS = 8 };
  double J[4], half[4]; /* a_u, a_v, b_u, b_v */
  for (int k = 0; k < 4; k++) slope_range(k < 2 ? box->a : box->b, k % 2, &J[k], &half[k]);
  const double det = J[0] * J[3] - J[1] * J[2];
  if (det == 0) return OPEN;
  const double Y[4] = {J[3] / det, -J[1] / det, -J[2] / det, J[0] / det};
  const double f = patch_evaluate(box->a, 0.5, 0.5).value, g = patch_evaluate(box->b, 0.5, 0.5).value;
  bool within = true;
  double at[2];
  for (int k = 0; k < 2; k++) {
    const double off = -(Y[2 * k] * f + Y[2 * k + 1] * g), *y = &Y[2 * k];
    const double reach = 0.5 * (fabs(y[0]) * (half[0] + half[1]) + fabs(y[1]) * (half[2] + half[3]));
    if (fabs(off) > 0.5 + reach) return NO_ROOT;
    within = within && fabs(off) + reach < 0.5;
    at[k] = 0.5 + off;
  }
  if (!within) return OPEN;
  *root = (struct rival_root){at[0], at[1]};
  for (int n = 0; n < STEPS && !(rival_step(box->a, box->b, root) < 1e-8); n++) continue;
  return ONE_ROOT;
}

int rival_krawczyk(double a[4][4], double b[4][4], struct rival_root out[RIVAL_ROOTS])
{
  return search(a, b, judge_krawczyk, out);
}

/* The story of a ray. See explain.h. */
#include "command/explain.h"

#include <math.h>
#include <stdio.h>

#include "base/number.h"
#include "geometry/vector.h"
#include "intersect/explain.h"

struct teller {
  const struct scene *scene;
  double length;  /* of the direction: T is t times it */
  double nearest; /* T so far */
  size_t candidates, left_open;
};

static void put_number(double value)
{
  char text[NUMBER_TEXT_SIZE];
  text[number_write_17(value, text)] = '\0';
  printf(" %s", text);
}

static void put_row(const char *name, const double c[], int count)
{
  printf("  %s:", name);
  for (int k = 0; k < count; k++) put_number(c[k]);
  putchar('\n');
}

/* Prints an equation of eq 3: the rows of its net, one by one. */
static void put_net(const char *name, const struct explained_candidate *candidate, const double net[16])
{
  double c[16];
  int count = 0;
  for (int i = 0; i <= candidate->kept_degree; i++)
    for (int j = 0; j <= candidate->other_degree; j++) c[count++] = net[4 * i + j];
  put_row(name, c, count);
}

static void put_fate(const struct teller *teller, const struct explained_candidate *candidate, int k)
{
  const struct explained_roots *found = &candidate->found;
  const char other = candidate->v_kept ? 'u' : 'v';
  const double T = candidate->t[k] * teller->length;
  switch (found->fate[k]) {
  case ROOT_COMPLEX: printf(", refused: not real"); break;
  case ROOT_OUTSIDE: printf(", refused: outside [0,1]"); break;
  case ROOT_ELSEWHERE:
    if (isnan(found->other[k])) printf(", refused: no %c follows", other);
    else printf(", refused: %c = %.6g is outside", other, found->other[k]);
    break;
  case ROOT_NO_SOLUTION: printf(", refused: with %c = %.6g it does not solve eq 3", other, found->other[k]); break;
  case ROOT_OFFERED:
    printf(", %c =", other);
    put_number(found->other[k]);
    printf(", T =");
    put_number(T);
    break;
  }
}

/* Prints r in the format of pscn roots, and its roots. */
static void put_roots(const struct teller *teller, const struct explained_candidate *candidate)
{
  const struct explained_roots *found = &candidate->found;
  const struct method *method = &teller->scene->solvers[teller->scene->patches[candidate->patch].solver];
  const char kept = candidate->v_kept ? 'v' : 'u';
  const struct polynomial r = {found->degree, found->basis, found->c, NULL};
  double highest_first[EXPLAIN_COEFFICIENTS];
  for (int k = 0; k <= found->degree; k++) highest_first[k] = found->c[found->degree - k];
  if (found->basis == BASIS_POWER) printf("  r(%c), highest power first:\n", kept);
  else printf("  r, highest power of x = %c/(1-%c) first:\n", kept, kept);
  if (found->degree > 0) put_row("r", highest_first, found->degree + 1);
  printf("  %d roots by %s%s\n", found->roots.count, method->roots.solver->name,
         candidate->by_solver ? "" : ", found for this explanation only; the ray needed no solver");
  for (int k = 0; k < found->roots.count; k++) {
    const struct root *root = &found->roots.root[k];
    printf("    %c =", kept);
    put_number(root->re);
    if (root->im != 0) printf(" %+.6g i", root->im);
    printf(", %d iterations, eq 11: %.3g", root->iterations, polynomial_eq11(&r, root->re, root->im));
    put_fate(teller, candidate, k);
    putchar('\n');
  }
}

static void put_outcome(struct teller *teller, const struct explained_candidate *candidate)
{
  if (candidate->taken) {
    printf("  accepted: T =");
    put_number(candidate->hit_t * teller->length);
    printf(", the nearest so far%s\n", candidate->left_open ? "; a part is left to the last resort" : "");
    printf("  certificate: ");
    if (candidate->proven)
      printf("a and b have exactly one common root within %.2g of u = %.17g and %.2g of v = %.17g\n",
             candidate->radius_u, candidate->hit_u, candidate->radius_v, candidate->hit_v);
    else printf("none: with 'polish off' the solver's roots are the answer\n");
    teller->nearest = candidate->hit_t * teller->length;
  } else if (candidate->left_open) {
    printf("  left to the last resort: double precision cannot decide it (a border, a tangency, an end of the ray)\n");
  } else if (candidate->reached == STAGE_PLANES) {
    printf("  missed, proven: a, b or a combination of them keeps one sign on the leaf\n");
  } else if (candidate->reached == STAGE_RESULTANT) {
    printf("  missed, proven: the coefficients of r have no change of sign\n");
  } else {
    bool behind = false;
    for (int k = 0; k < candidate->found.roots.count; k++)
      behind |= candidate->found.fate[k] == ROOT_OFFERED && candidate->t[k] * teller->length >= teller->nearest;
    printf("  nothing accepted: %s\n", behind ? "not nearer than the nearest so far, or not on the leaf"
                                              : "no root on the leaf in front of the ray's start");
  }
  teller->left_open += candidate->left_open;
}

static void tell(void *context, const struct explained_candidate *candidate)
{
  static const char *const stages[STAGE_COUNT] = {"its bilinear part", "the planes a and b", "the resultant r",
                                                  "the roots of r"};
  struct teller *teller = context;
  const int *split = candidate->split;
  printf("candidate %zu: patch %u", ++teller->candidates, candidate->patch);
  if (split[0] * split[1] > 1)
    printf(", its part [%d,%d]/%d x [%d,%d]/%d, on which u, v run from 0 to 1 here", candidate->column_u,
           candidate->column_u + 1, split[0], candidate->column_v, candidate->column_v + 1, split[1]);
  if (candidate->blind) {
    printf("\n  left to the last resort: the ray starts so far away that rounding leaves nothing of a and b\n");
    teller->left_open++;
    return;
  }
  printf("; last stage: %s\n", stages[candidate->reached]);
  printf("  eq 3, Bernstein coefficients of degree %d in %c and %d in %c:\n", candidate->kept_degree,
         candidate->v_kept ? 'v' : 'u', candidate->other_degree, candidate->v_kept ? 'u' : 'v');
  put_net("a", candidate, candidate->a);
  put_net("b", candidate, candidate->b);
  if (candidate->solved) put_roots(teller, candidate);
  put_outcome(teller, candidate);
}

void explain_ray(const struct scene *scene, struct tracer *tracer, size_t number, const struct ray *ray)
{
  struct teller teller = {.scene = scene, .length = vector_length(ray->direction), .nearest = INFINITY};
  struct hit hit;
  printf("ray %zu: from", number);
  for (int k = 0; k < 3; k++) put_number(ray->origin[k]);
  printf(" along");
  for (int k = 0; k < 3; k++) put_number(ray->direction[k] / teller.length);
  putchar('\n');
  tracer_explain(tracer, ray, tell, &teller, &hit);
  if (teller.left_open > 0)
    printf("last resort: %zu of %zu candidates, searched in their order along the ray\n", teller.left_open,
           teller.candidates);
  if (hit.patch == HIT_NONE) {
    printf("answer: miss");
  } else {
    printf("answer: hit");
    put_number(hit.t * teller.length);
    put_number(hit.u);
    put_number(hit.v);
    printf(" %u", hit.patch);
    for (int k = 0; k < 3; k++) put_number(hit.normal[k] + 0.0);
  }
  printf(" %s\n", hit.certainty == CERTAINTY_CERTAIN ? "certain" : "grazing");
  if (hit.patch != HIT_NONE) printf("  the point is within %.2g of the exact patch\n", hit.point_error);
}

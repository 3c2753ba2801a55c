/* Reports what becomes of a ray while it is traced: its candidates in the order in which it comes to them, the polynomial
 * of each, the roots that the solver finds, and which root is taken.
 *
 * A tracer that explains nothing is not slowed down.
 */
#ifndef PSCN_INTERSECT_EXPLAIN_H
#define PSCN_INTERSECT_EXPLAIN_H

#include "algebra/solver.h"
#include "intersect/intersect.h"

enum { EXPLAIN_COEFFICIENTS = 19 };

/* What the back-substitution makes of a root of r. */
enum root_fate {
  ROOT_COMPLEX,     /* not real within the tolerance (section 2.2 of the paper) */
  ROOT_OUTSIDE,     /* its parameter is outside [0,1] */
  ROOT_ELSEWHERE,   /* the other parameter, which follows from it, is far outside */
  ROOT_NO_SOLUTION, /* `polish off`: the two do not solve eq 3 within `residual` */
  ROOT_OFFERED      /* a point; with polish, a start for Newton's method */
};

/* The resultant of a candidate, and its roots by the scene's solver, in no order. */
struct explained_roots {
  enum basis basis;               /* scaled Bernstein: c are also powers of x = z/(1-z), z the kept parameter */
  int degree;                     /* 0 or less: there is nothing to solve */
  double c[EXPLAIN_COEFFICIENTS]; /* c[0..degree], exact roots at the ends removed */
  struct root_set roots;          /* radii mean nothing */
  enum root_fate fate[POLYNOMIAL_MAX_DEGREE];
  double other[POLYNOMIAL_MAX_DEGREE]; /* the other parameter, except for ROOT_COMPLEX and ROOT_OUTSIDE */
};

/* A leaf whose boxes the ray passes: a part of a patch, with its own parameters. */
struct explained_candidate {
  uint32_t patch;                   /* of the scene */
  int split[2], column_u, column_v; /* the leaf is [column, column + 1]/split, along u and v */
  bool v_kept;                      /* r is a polynomial in v, and u follows; otherwise the other way round */
  int kept_degree, other_degree;
  bool blind; /* the ray starts too far away for double precision: left to the last resort, and no stage follows */
  double a[16], b[16]; /* eq 3: Bernstein coefficients [4 i + j], i of the kept parameter */
  enum stage reached;  /* the last stage it came to (intersect.h) */
  bool solved;         /* it came to STAGE_BILINEAR or STAGE_ROOTS; the rest is what the solver makes of r */
  bool by_solver;      /* these very roots were used; else the kernel's lanes found theirs by a shorter way */
  struct explained_roots found;
  double t[POLYNOMIAL_MAX_DEGREE];                /* of the points that are ROOT_OFFERED, units of |direction| */
  bool left_open;                                 /* something was left to the last resort */
  bool taken;                                     /* a root is the ray's nearest hit so far, ... */
  bool proven;                                    /* ... is the only exact one within the radii, ... */
  double hit_t, hit_u, hit_v, radius_u, radius_v; /* ... and is here, in parameters of the whole patch */
};

typedef void explain_listener(void *context, const struct explained_candidate *candidate);

/* As tracer_closest for one ray; calls `listener` for every candidate that its slab does not close at once. */
void tracer_explain(struct tracer *tracer, const struct ray *ray, explain_listener *listener, void *context,
                    struct hit *out_hit);

/* ---- internal to src/intersect ---- */

/* The listener, and the candidate under way (lanes/explain.c). */
struct explainer {
  explain_listener *listener;
  void *context;
  struct intersect_counts before; /* at the start of the candidate */
  double t_before;
  bool warmed; /* `warm` holds the warm start of the candidate's solver */
  struct solver_warm warm;
  struct explained_candidate story;
};

#endif

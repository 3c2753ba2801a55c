/* Root finding: the run-time table of solvers, the options of one, and its answer.
 *
 * A solver takes one real polynomial and returns its roots, each with an error radius. Nothing here knows of rays. All
 * functions are safe on any thread and allocate nothing. Nothing fails: for each root, the result says whether it was
 * found.
 */
#ifndef PSCN_ALGEBRA_SOLVER_H
#define PSCN_ALGEBRA_SOLVER_H

#include <stdbool.h>
#include <stddef.h>

#include "algebra/polynomial.h"

enum root_status {
  ROOT_CONVERGED, /* the stopping rule was met, and the true polynomial has a root within radius of the value */
  ROOT_LIMIT,     /* the iteration limit came first, or no bound was found: the radius is true but may be infinite */
  ROOT_CLUSTER    /* converged, but discs meet: perhaps one multiple root, perhaps a pair of which none is real */
};

struct root {
  double re, im; /* im is 0 where it is within the value's guessed error; only |im| > radius excludes a real root */
  double radius; /* absolute: at least one root of p is within it (disc in the complex plane of u); may be INFINITY */
  int iterations;
  enum root_status status;
};

/* The roots found, in no promised order. Roots at infinity (vanishing leading coefficients, or roots that their bound
 * does not tell from infinity) are not listed. A polynomial that is zero within its own error, or not finite, gives
 * identically_zero or not_finite, and no roots. Exact zero coefficients at the ends are exact roots at 0 (and in
 * Bernstein form at 1) with radius 0, one entry for each multiplicity. */
struct root_set {
  int count;
  int missing; /* roots neither listed nor known to be at infinity; 0 of a solver of real roots, which misses none */
  bool identically_zero;
  bool not_finite;
  struct root root[POLYNOMIAL_MAX_DEGREE];
};

enum start { START_COLD, START_PREVIOUS };

/* Choices of the complex solvers that go beyond the paper. Each can be set alone; solver_options_form sets them all. */
enum radii { RADII_CIRCLE, RADII_POLYGON };         /* start values on Aberth's circle, or by Newton's polygon (Bini) */
enum stop { STOP_STEP, STOP_ROUNDING };             /* eq 10 alone, or also where |p| is below its own rounding bound */
enum update { UPDATE_JACOBI, UPDATE_GAUSS_SEIDEL }; /* all at once: the last sweep's values, or the newest ones */
enum horner { HORNER_PLAIN, HORNER_CHARTS };        /* values in powers of z, or of 1/z where |z| > 1 */
enum deflation { DEFLATION_FORWARD, DEFLATION_COMPOSITE };

/* A watcher: `tell` receives the values z, in u, that the iterations of a solver pass, in their order.
 * `root` counts the roots of the polynomial as the solver does, from 0; step 0 is the start. */
struct solver_watch {
  void (*tell)(void *context, int root, int step, double re, double im);
  void *context;
};

struct solver;

/* The options of a solver. Filled by solver_options_default, then changed one by one. */
struct solver_options {
  const struct solver *solver;
  double tolerance;   /* eps of the paper's eq 10, > 0; absolute in u with STOP_STEP, as in the paper, else relative */
  int max_iterations; /* per root, >= 1 */
  enum start start;
  enum radii radii;
  enum stop stop;
  enum horner horner;
  enum update update;
  bool rest; /* all at once: a root that has converged is left alone while others still move */
  enum deflation deflation;
  bool refine;                      /* newton, laguerre: last steps on the polynomial before deflation */
  const struct solver_watch *watch; /* borrowed; NULL, the default: no watcher */
};

/* Roots of the previous polynomial of a family, kept for `start previous`. Zero-initialised means "none yet". */
struct solver_warm {
  int count;
  double re[POLYNOMIAL_MAX_DEGREE], im[POLYNOMIAL_MAX_DEGREE];
};

/* How a solver handles many polynomials in scaled Bernstein form at once, one per lane, if all choices are the improved
 * ones: not at all; by sign variations, with nothing to be solved where these are 0 or 1; by its iteration in
 * roots_lanes.h. */
enum solver_lanes {
  SOLVER_LANES_NONE,
  SOLVER_LANES_SIGNS,
  SOLVER_LANES_NEWTON,
  SOLVER_LANES_LAGUERRE,
  SOLVER_LANES_ABERTH,
  SOLVER_LANES_DURAND_KERNER
};

struct root_problem; /* internal: root_problem.h */

struct solver {
  const char *name;    /* the keyword in a scene */
  const char *summary; /* one line for `pscn help solver` */
  bool real_only;      /* finds only real roots in [0,1] */
  enum solver_lanes lanes;
  int max_iterations; /* for a bare `solver NAME` */
  /* The method itself, called by solver_solve. Contract in root_problem.h. */
  void (*find)(const struct root_problem *problem, const struct solver_options *options, const struct solver_warm *warm,
               struct root_set *out);
};

/* The table: bernstein first (the default). */
size_t solver_count(void);
const struct solver *solver_at(size_t index);
const struct solver *solver_find(const char *name, size_t length); /* NULL where there is none */

/* The defaults of a solver: the improved form. */
void solver_options_default(const struct solver *solver, struct solver_options *out);

/* solver_options_form sets radii, stop, horner, update, rest, deflation and refine: to what docs/paper.md found best,
 * or to the paper's iterations as printed. The others tell whether they are set so. */
void solver_options_form(struct solver_options *options, bool improved);
bool solver_options_improved(const struct solver_options *options);
bool solver_options_paper(const struct solver_options *options);

/* Solves p with options->solver and judges the answer: one validation, shared by all solvers, sets radii and statuses.
 * p may be in either basis; the roots are found in p's own. warm may be NULL. With start previous it is read, and
 * afterwards holds the new roots. */
void solver_solve(const struct polynomial *p, const struct solver_options *options, struct solver_warm *warm,
                  struct root_set *out);

/* As solver_solve, without the judge, for a caller who makes of the roots what he can prove by himself. Radii mean
 * nothing, a root may be off the real axis by rounding, and a root of a vanishing leading coefficient may be far away
 * instead of absent. */
void solver_roots(const struct polynomial *p, const struct solver_options *options, struct solver_warm *warm,
                  struct root_set *out);

#endif

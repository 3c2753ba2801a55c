/* A model under trial: the same patches given to the intersector and to the reference; rays asked of both; the answers
 * compared and counted.
 */
#ifndef TESTS_ACCURACY_TRIAL_H
#define TESTS_ACCURACY_TRIAL_H

#include <stdbool.h>
#include <stddef.h>

#include "intersect/intersect.h"
#include "reference/reference.h"

struct trial {
  struct scene scene; /* lives as long as the trial; where the trial made it, arena is NULL */
  struct solver_options solver;
  struct intersector *intersector;
  struct tracer *tracer;
  struct reference *reference;
  bool reference_borrowed;
  struct scene_patch *own_patches;
};

/* What was found out, over any number of trials. Zero-initialise; free by tally_free. */
struct tally {
  const char *name;
  size_t rays, hits, misses; /* by the reference */
  size_t undecided;          /* the reference said grazing */
  size_t grazing;            /* the intersector said grazing */
  size_t bold;               /* the intersector said certain where the reference said grazing */
  size_t lost;               /* a proven hit, and the intersector answers a miss or a later hit */
  size_t holes;              /* those of the lost where it answers a miss */
  size_t invented;           /* the intersector answers a hit where, or nearer than, the reference proves none */
  size_t over;               /* the same, but said to be grazing and TRIAL_NEAR the ray: allowed, see intersect.h */
  size_t bad_normal;         /* N differs from the true normal by more than TRIAL_NORMAL where it is well defined */
  double worst_t_floor, worst_u_floor, worst_v_floor; /* errors in units of the data floor */
  double worst_t_local, worst_u_local, worst_v_local; /* of the local floor (T: plus one rounding of the origin) */
  double worst_normal;
  double worst_t_grazing; /* relative error of T of hits said to be grazing; all the other errors are of certain ones */
  double *t_errors;       /* relative errors of T of the hits both agree on */
  size_t t_count, t_capacity;
  size_t shown; /* disagreements printed so far */
  bool quiet;   /* set by the caller: print none */
};

/* A grazing hit that is no hit may be off the ray by this, relative to the largest coordinate. */
#define TRIAL_NEAR 1e-9

/* Answers of this distance are the same hit: 64 floors, or this relative distance where that is more. */
#define TRIAL_SAME 1e-9

/* For a hit said to be grazing. Where a root is nearly double, a change of 2^-53 of the input moves it by the square
 * root of that, 1e-8, times the patch's size over its curvature and over the distance: 100 is allowed for the two. */
#define TRIAL_SAME_GRAZING 1e-6

/* Bounds issue 4 sets. */
#define TRIAL_T_RELATIVE 1e-12
#define TRIAL_FLOORS 4

#define TRIAL_NORMAL 1e-7

/* Makes intersector, tracer and reference of `count` nets. solver may be NULL (the default). Aborts the running
 * cmocka test where that fails. */
void trial_create(struct trial *trial, const double (*P)[4][4][3], size_t count, const struct solver_options *solver);

/* The patches of `first` with another solver. Borrows patches and reference: `first` must outlive it. */
void trial_create_beside(struct trial *trial, const struct trial *first, const struct solver_options *solver);

/* As trial_create, of a scene, which is borrowed. */
void trial_of_scene(struct trial *trial, const struct scene *scene);
void trial_destroy(struct trial *trial);

/* Asks both for `count` rays (any number) and adds what comes out to the tally; prints the first disagreements. */
void trial_rays(struct trial *trial, const struct ray *rays, size_t count, struct tally *tally);

/* Compares one answer. Exposed for answers that came another way (the command). */
void trial_judge(const struct trial *trial, const struct ray *ray, const struct hit *hit, struct tally *tally);

/* The same, where the caller has asked the reference of the trial. */
void trial_judge_by(const struct trial *trial, const struct ray *ray, const struct hit *hit,
                    const struct reference_answer *truth, struct tally *tally);

/* One line of counts, one of errors. */
void tally_print(struct tally *tally);

/* Fails the running cmocka test where anything is lost, invented or beyond its bound. */
void tally_assert(struct tally *tally);
void tally_free(struct tally *tally);

#endif

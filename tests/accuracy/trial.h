/* A model under trial: the same patches given to the intersector and to the reference; rays asked of both; the answers
 * compared and counted.
 */
#ifndef TESTS_ACCURACY_TRIAL_H
#define TESTS_ACCURACY_TRIAL_H

#include <stdbool.h>
#include <stddef.h>

#include "intersect/intersect.h"
#include "reference/facts.h"

struct trial {
  struct scene scene; /* lives as long as the trial; where the trial made it, arena is NULL */
  struct method solver;
  struct intersector *intersector;
  struct tracer *tracer;
  struct reference *reference;
  bool reference_borrowed;
  bool bare; /* some patch has `polish off` */
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
  size_t over;               /* the same, but said to be grazing, and TRIAL_NEAR the ray: allowed, see intersect.h */
  size_t bad_normal;         /* N differs from the true normal by more than its floors allow, see trial.c */
  double worst_t_floor, worst_u_floor, worst_v_floor; /* errors in units of the data floor */
  double worst_t_local, worst_u_local, worst_v_local; /* of the local floor (T: plus one rounding of the origin) */
  double worst_normal, worst_normal_floor;            /* absolute; in units of its bound */
  double worst_t_grazing; /* relative error of T of hits said to be grazing; all the other errors are of certain ones */
  double *t_errors;       /* relative errors of T of the hits both agree on */
  size_t t_count, t_capacity;
  size_t shown; /* disagreements printed so far */
  bool quiet;   /* set by the caller: print none */
};

/* How near to each other ray and patch are at a grazing answer, relative to the largest coordinate of both: a box
 * that subdivision leaves undecided is 2^-44 long in the patch's frame, or as seen along the ray within 5 error
 * bounds of 100 2^-53 of either plane, which is as much; the frame is up to 4 times as large as its patch, and the
 * planes are two: 2 x 4 x 2 x 2^-44. */
#define TRIAL_NEAR 0x1p-40

/* Answers of this distance are the same hit. Certain ones and the reference differ by a few floors. Where a hit is
 * grazing the floor, a first-order bound, holds but for a factor of 4 all the same: along the ray the distance from
 * the surface is c x^2 + s x - d, s the incidence, d what rounding can do; its root is off by d/s at most where it
 * stays, and by some sqrt(d/c) where a second one is so near that d can remove both; but then s^2 < 4 c d, so that
 * d/s > sqrt(d/c)/2. To that comes TRIAL_NEAR. */
#define TRIAL_SAME_FLOORS 64

/* Without polish nothing is proven, and what is counted is how often the hit is found, within this relative distance
 * of t; 100 times the square root of 2^-53 where roots are nearly double. */
#define TRIAL_BARE_SAME 1e-6

/* What is asked: of certain hits, relative, and in floors. */
#define TRIAL_T_RELATIVE 1e-12
#define TRIAL_FLOORS 4

/* The largest coordinate of the origin and of the point at t, in units of t. */
double trial_size(const struct ray *ray, double t);

/* How far off T of a certain hit (and U, V) may be, but for a small factor: what one rounding of each input moves it, or one of
 * the patch's extent, up to TRIAL_EXTENT of T; or TRIAL_LEAST of the largest coordinate, which is well below a
 * rounding: where a patch is thin, its floor is smaller still. */
#define TRIAL_EXTENT 0x1p-22
#define TRIAL_LEAST 0x1p-62
struct facts_floor trial_floor(const struct reference *reference, const struct ray *ray, uint32_t patch, double t,
                               double u, double v);

/* Makes intersector, tracer and reference of `count` nets. solver may be NULL (the default). Aborts the running
 * cmocka test where that fails. */
void trial_create(struct trial *trial, const double (*P)[4][4][3], size_t count, const struct method *solver);

/* The patches of `first` with another solver. Borrows patches and reference: `first` must outlive it. */
void trial_create_beside(struct trial *trial, const struct trial *first, const struct method *solver);

/* As trial_create, of a scene, which is borrowed. */
void trial_of_scene(struct trial *trial, const struct scene *scene);
void trial_destroy(struct trial *trial);

/* The scene of a file, every patch with `solver` where that is not NULL, as behind --solver; its errors are told on
 * standard error. NULL where it has some. The caller destroys it. */
struct scene *trial_load(const char *path, const char *solver, int width, int height);

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

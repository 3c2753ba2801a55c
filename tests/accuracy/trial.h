/* A model under trial: the same patches are given to the intersector and to the reference, both are asked the same
 * rays, and the answers are compared and counted. */
#ifndef TESTS_ACCURACY_TRIAL_H
#define TESTS_ACCURACY_TRIAL_H

#include <stdbool.h>
#include <stddef.h>

#include "intersect/intersect.h"
#include "reference/facts.h"

struct trial {
  struct scene scene; /* lives as long as the trial; arena is NULL if the trial made it */
  struct method solver;
  struct intersector *intersector;
  struct tracer *tracer;
  struct reference *reference;
  bool reference_borrowed;
  bool bare; /* some patch has `polish off` */
  struct scene_patch *own_patches;
};

/* The findings of any number of trials. Zero-initialise; free with tally_free. */
struct tally {
  const char *name;
  size_t rays, hits, misses; /* by the reference */
  size_t undecided;          /* the reference said grazing */
  size_t grazing;            /* the intersector said grazing */
  size_t bold;               /* the intersector said certain where the reference said grazing */
  size_t lost;               /* the intersector answers a miss or a later hit than a proven one */
  size_t holes;              /* those of `lost` answered by a miss */
  size_t invented;           /* the intersector answers a hit where the reference proves none, or before that */
  size_t over;               /* the same, but called grazing, and TRIAL_NEAR the ray: allowed, see intersect.h */
  size_t bad_normal;         /* N differs from the true normal by more than its floors allow, see trial.c */
  double worst_t_floor, worst_u_floor, worst_v_floor; /* errors in units of the data floor */
  double worst_t_local, worst_u_local, worst_v_local; /* of the local floor (T: plus one rounding of the origin) */
  double worst_normal, worst_normal_floor;            /* absolute; in units of its bound */
  double worst_t_grazing; /* relative error of T of grazing hits; all the other errors are of certain ones */
  double *t_errors;       /* relative errors of T of the hits on which both agree */
  size_t t_count, t_capacity;
  size_t shown; /* disagreements printed so far */
  bool quiet;   /* set by the caller: print none */
};

/* How near ray and patch are at a grazing answer, relative to the largest coordinate of both. A box that subdivision
 * leaves undecided is 2^-44 long in the patch's frame. Or, seen along the ray, it is within 5 error bounds of 100 2^-53
 * of either plane, which is as much. The frame is up to 4 times as large as its patch, and there are two planes: 2 x 4
 * x 2 x 2^-44. */
#define TRIAL_NEAR 0x1p-40

/* Answers within this many floors are the same hit. Certain ones differ from the reference by a few floors. For a
 * grazing hit the floor, a first-order bound, still holds up to a factor of 4. Along the ray the distance from the
 * surface is c x^2 + s x - d, s being the incidence, and d what rounding can do. If the root stays, it moves by at most
 * d/s. If a second root is so near that d can remove both, it moves by some sqrt(d/c); but then s^2 < 4 c d, so that
 * d/s > sqrt(d/c)/2. TRIAL_NEAR is added to that. */
#define TRIAL_SAME_FLOORS 64

/* Without polish nothing is proven. What counts is how often the hit is found, within this relative distance of t: 100
 * times the square root of 2^-53, the error where roots are nearly double. */
#define TRIAL_BARE_SAME 1e-6

/* Required of certain hits: relative, and in floors. */
#define TRIAL_T_RELATIVE 1e-12
#define TRIAL_FLOORS 4

/* The largest coordinate of the origin and of the point at t, in units of t. */
double trial_size(const struct ray *ray, double t);

/* The allowed error of T (and U, V) of a certain hit, up to a small factor. It is what one rounding of each input, or
 * of the patch's extent, moves it, the latter up to TRIAL_EXTENT of T. It is at least TRIAL_LEAST of the largest
 * coordinate, which is well below a rounding, because the floor of a thin patch is smaller still. */
#define TRIAL_EXTENT 0x1p-22
#define TRIAL_LEAST 0x1p-62
struct facts_floor trial_floor(const struct reference *reference, const struct ray *ray, uint32_t patch, double t,
                               double u, double v);

/* Makes intersector, tracer and reference for `count` nets. solver may be NULL (the default). Aborts the running cmocka
 * test on failure. */
void trial_create(struct trial *trial, const double (*P)[4][4][3], size_t count, const struct method *solver);

/* The patches of `first` with another solver. Borrows patches and reference, so `first` must outlive it. */
void trial_create_beside(struct trial *trial, const struct trial *first, const struct method *solver);

/* As trial_create, for a scene, which is borrowed. */
void trial_of_scene(struct trial *trial, const struct scene *scene);
void trial_destroy(struct trial *trial);

/* The scene of a file, every patch with `solver` unless that is NULL, as with --solver. Its errors go to standard
 * error; NULL if there are any. The caller destroys the scene. */
struct scene *trial_load(const char *path, const char *solver, int width, int height);

/* Asks both for `count` rays (any number) and adds the results to the tally. Prints the first disagreements. */
void trial_rays(struct trial *trial, const struct ray *rays, size_t count, struct tally *tally);

/* Compares one answer. For answers that came another way (the command). */
void trial_judge(const struct trial *trial, const struct ray *ray, const struct hit *hit, struct tally *tally);

/* As trial_judge, if the caller has asked the trial's reference. */
void trial_judge_by(const struct trial *trial, const struct ray *ray, const struct hit *hit,
                    const struct reference_answer *truth, struct tally *tally);

/* Prints one line of counts, and one of errors. */
void tally_print(struct tally *tally);

/* Fails the running cmocka test if anything is lost, invented or beyond its bound. */
void tally_assert(struct tally *tally);
void tally_free(struct tally *tally);

#endif

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
  struct scene_patch *own_patches;
};

/* The findings of any number of trials. Zero-initialise. */
struct tally {
  const char *name;
  size_t rays, hits; /* by the reference */
  size_t undecided;  /* the reference said grazing */
  size_t grazing;    /* the intersector said grazing */
  size_t lost;       /* the intersector answers a miss or a later hit than a proven one */
  size_t invented; /* it answers a hit where the reference proves none, or before that, and not a grazing one so near */
  size_t bad_normal; /* N differs from the true normal by more than its floors allow, see trial.c */
  double worst_t_floor, worst_u_floor, worst_v_floor; /* errors of certain hits in units of the data floor */
  size_t shown;                                       /* disagreements printed so far */
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

/* Required of certain hits, in floors. */
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

/* Makes intersector, tracer and reference for `count` nets. `solver` is its text, or NULL (the default). Aborts the
 * running cmocka test on failure. */
void trial_create(struct trial *trial, const double (*P)[4][4][3], size_t count, const char *solver);

/* The patches of `first` with another solver. Borrows the reference, so `first` must outlive it. */
void trial_create_beside(struct trial *trial, const struct trial *first, const char *solver);

/* As trial_create, for a scene, which is borrowed. */
void trial_of_scene(struct trial *trial, const struct scene *scene);
void trial_destroy(struct trial *trial);

/* The scene of a file, every patch with `solver` unless that is NULL, as with --solver. Its errors go to standard
 * error; NULL if there are any. The caller destroys the scene. */
struct scene *trial_load(const char *path, const char *solver, int width, int height);

/* Asks both for `count` rays (any number) and adds the results to the tally. Prints the first disagreements. */
void trial_rays(struct trial *trial, const struct ray *rays, size_t count, struct tally *tally);

/* Prints the counts; fails the running cmocka test if anything is lost, invented or beyond its bound. */
void tally_assert(const struct tally *tally);

/* Print a ray, an answer, and patches as a scene has them. */
void print_ray(const struct ray *ray);
void print_hit(const char *name, const struct hit *hit);
void print_patches(const struct scene *scene);

#endif

/* Small scenes of patches, and rays that are hard for them, for property tests of the intersector. */
#ifndef TESTS_PROPERTY_WORLD_H
#define TESTS_PROPERTY_WORLD_H

#include <stdbool.h>
#include <stddef.h>

#include "intersect/tracer.h"
#include "random.h"

typedef double world_net[4][4][3];

/* A prepared scene of bare patches with one solver, and one tracer. */
struct world {
  struct scene scene;
  struct method solver;
  struct intersector *intersector;
  struct tracer *tracer;
};

/* The kinds of scene. */
enum world_kind {
  WORLD_GRID,       /* 3 x 3 patches of a wavy height field that share their edges */
  WORLD_WILD,       /* patches with random control points, folded and self-intersecting */
  WORLD_DOME,       /* four patches round a pole where an edge collapses */
  WORLD_FLAT,       /* coplanar patches, some exactly on top of each other */
  WORLD_LOW,        /* patches of lower true degree: bilinear, biquadratic, ruled */
  WORLD_DEGENERATE, /* patches that are a point, a line, a curve or folded flat */
  WORLD_KINDS
};

enum { WORLD_MAX = 16 };

/* Fills nets[0..count) and returns count <= WORLD_MAX. Coordinates are multiples of 2^-20, of size about 1. */
size_t world_fill(enum world_kind kind, struct random *random, world_net nets[WORLD_MAX]);

/* Copies the nets and prepares the scene; options == NULL means the default. Asserts that this succeeds. */
void world_open(struct world *world, world_net *nets, size_t count, const struct method *options);

/* Prepares the scene that the caller has filled, whose patches and copies world_close frees. */
void world_prepare(struct world *world);
void world_close(struct world *world);

/* A ray at the nets, of one of RAY_KINDS kinds: through the interior; at borders, corners and lines of constant u
 * and v; tangent; along an axis; from far away; from the surface itself. t_min is 0, t_max INFINITY. */
enum { RAY_KINDS = 8 };
struct ray world_ray(struct random *random, world_net *nets, size_t count, int kind);

/* A ray from a place within 6 of 0 along each axis, at a point, or off it by at most `off`. Sets only origin and
 * direction. */
void world_towards(struct random *random, const double at[3], double off, struct ray *ray);

/* A scene, and rays at it. */
enum { STAGE_RAYS = 96 };
struct set_up {
  int kind; /* of the scene */
  struct random *random;
  struct world *world;
  world_net *nets; /* `count` of them */
  size_t count;
  struct ray rays[STAGE_RAYS];
};

/* Calls `body` for `scenes` scenes of each kind, one after the other; options == NULL means the default. */
void on_all_stages(uint64_t seed, int scenes, const struct method *options, void (*body)(struct set_up *stage));

/* A packet of rays, and two tracers' answers to them, to each in three ways. */
enum { ASKED_RAYS = 8 };
struct asked {
  struct ray rays[ASKED_RAYS];
  struct hit hit[2][ASKED_RAYS];
  bool occluded[2][ASKED_RAYS];
  struct hit_list list[2][ASKED_RAYS]; /* of tracer_all: valid until the tracer is asked again */
};

/* Asks both tracers about rays at the nets; ray n has kind `first` + n, modulo RAY_KINDS. */
void world_ask_both(struct tracer *const tracers[2], struct random *random, world_net *nets, size_t count, int first,
                    struct asked *out);

/* Whether two hits are the same to the last bit. For misses only the certainty counts. */
bool same_hit(const struct hit *a, const struct hit *b);

/* Whether two lists are. */
bool same_list(const struct hit_list *a, const struct hit_list *b);

/* Whether two nearest hits of the ray may both be right: if both are certain, they must be equal within rounding. */
bool hits_agree(const struct ray *ray, const struct hit *a, const struct hit *b);

/* The answer to one ray alone. */
struct hit world_closest(const struct world *world, const struct ray *ray);

/* All hits of one ray alone; valid until the tracer is asked again. */
struct hit_list world_all(const struct world *world, const struct ray *ray);

/* Prints a ray and two answers that should agree; `kind` is the scene's. */
void world_print_case(const char *what, int kind, const struct ray *ray, const struct hit *a, const struct hit *b);

/* Asserts that the two hits are the same to the last bit; prints the case if they are not. */
void assert_same_hit(const char *what, int kind, const struct ray *ray, const struct hit *a, const struct hit *b);

/* Multiplies every coordinate by a factor, then adds the offset. */
void world_scale_net(world_net net, double factor, double offset, world_net out);

#endif

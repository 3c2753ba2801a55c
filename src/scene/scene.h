/* A scene after all names, includes, arithmetic and transforms have been resolved.
 *
 * The world is left-handed, as in POV-Ray. Colours are RGB in the space that scene.gamma names. Everything is
 * finite. A scene and all it points to live in its arena. Once built, it is read-only and may be shared by threads.
 */
#ifndef PSCN_SCENE_SCENE_H
#define PSCN_SCENE_SCENE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "base/arena.h"
#include "base/status.h"
#include "scene/method.h"

/* POV-Ray's finish; render/shade.h has the formulas. All numbers but the roughness may be negative. */
struct scene_finish {
  double ambient[3];          /* factor of ambient_light, by colour */
  double diffuse, brilliance; /* factor, exponent */
  double phong, phong_size;   /* factor, exponent */
  double specular, roughness; /* factor, inverse of the exponent, > 0 */
};

struct scene_texture {
  double pigment[3];
  struct scene_finish finish;
};

struct scene_patch {
  double P[4][4][3]; /* control net in world space; u runs across rows (first index), v along a row */
  uint32_t texture;  /* index into scene.textures */
  uint32_t solver;   /* index into scene.solvers */
  /* Kept only for POV-Ray; they do not affect our rays. */
  int type;             /* 0 or 1 */
  int u_steps, v_steps; /* 0 to 16: POV-Ray cuts the patch into at most 2^u_steps x 2^v_steps */
  double flatness;      /* >= 0, scene units */
};

/* A declared object that occurs in the scene more than once: its control nets as declared. */
struct scene_object {
  double (*P)[4][4][3];
  size_t patch_count;
};

/* One occurrence of it. The patches from `first_patch` on, as many as the object has and in its order, are the object's
 * with every point p moved to p A + b (row vectors), up to the rounding of p, A and b. */
struct scene_copy {
  uint32_t object; /* index into scene.objects */
  size_t first_patch;
  double A[3][3], b[3];
};

struct scene_light {
  double position[3], color[3]; /* a part of the colour may be negative */
  bool shadowless;              /* nothing blocks it */
};

/* Perspective. The primary ray of the point (s,t) of the picture, s and t in [0,1] from the left and top edges, leaves
 * `location` along direction + (s - 1/2) right + (1/2 - t) up. All POV-Ray camera items are already folded in. */
struct scene_camera {
  double location[3], direction[3], right[3], up[3];
};

/* As a gamma, the curve of sRGB; any other is an exponent, which makes linear light of a part of a colour. */
#define GAMMA_SRGB 0.0

enum { SCENE_HASH_SIZE = 33 };

struct scene {
  struct arena *arena;
  struct scene_camera camera;
  bool has_camera;    /* it was given; otherwise it is POV-Ray's default */
  double gamma;       /* of the space of all colours, in which light is added up: POV-Ray's assumed_gamma */
  bool gamma_assumed; /* neither it nor a version of the language was given */
  double background[3], ambient_light[3];
  struct scene_light *lights;
  size_t light_count;
  struct scene_patch *patches; /* in the order of the text, with objects expanded */
  size_t patch_count;
  struct scene_object *objects;
  size_t object_count;
  struct scene_copy *copies; /* by first_patch; they do not overlap, and nothing that occurs only once is listed */
  size_t copy_count;
  struct scene_texture *textures; /* if from a text: all different, in the order in which patches first use them */
  size_t texture_count;
  struct method *solvers; /* [0] is that of global_settings, the default of every patch */
  size_t solver_count;
  const char **files; /* paths of the files read for it */
  size_t file_count;
  char text_hash[SCENE_HASH_SIZE]; /* of all text read for it, in hexadecimal digits */
};

/* Makes `method` the solver of every patch (--solver and --tolerance on the command line). */
void scene_override_solver(struct scene *scene, const struct method *method);

/* Whether some solver has `start previous`, so that a ray may depend on the one before it. */
bool scene_starts_warm(const struct scene *scene);

/* Frees the scene's arena. NULL is allowed. */
void scene_destroy(struct scene *scene);

/* Linear light of a part of a colour; finite as a float. Negative parts give negative light. */
double gamma_to_light(double gamma, double part);

/* The part of a colour that is as light as an sRGB code, which is at least 0 and need not end at 1. */
double gamma_of_srgb(double gamma, double code);

/* Writes the scene as canonical text, readable by pscn and by POV-Ray 3.7.
 *
 * Every number is the shortest that reads back to the same double. Transforms are applied. The camera is location,
 * direction, right and up. Textures are declared by number in the order of their first use. `solver` statements are
 * inside #ifdef (pscn) and leave out defaults. Reading the text gives a scene whose dump is the same text, byte for
 * byte. STATUS_FILE if writing fails (errno says why). Does not flush or close `file`. */
STATUS_MUST_CHECK enum status scene_dump(const struct scene *scene, FILE *file);

/* Only the patches, as `#declare NAME = union { ... }`, preceded by the textures they use. */
STATUS_MUST_CHECK enum status scene_dump_union(const struct scene *scene, const char *name, FILE *file);

#endif

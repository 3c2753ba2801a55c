/* pscn: where rays meet bicubic Bezier patches, answered exactly.
 *
 *     struct pscn_scene *scene;
 *     if (pscn_scene_from_file("teapot.pscn", NULL, &scene) != PSCN_OK) fputs(pscn_scene_messages(scene), stderr);
 *     struct pscn_ray ray = {.origin = {0, 5, -8}, .direction = {0, -0.5, 1}, .t_max = INFINITY};
 *     struct pscn_hit hit;
 *     pscn_nearest(scene, 1, &ray, sizeof ray, &hit, sizeof hit);
 *     pscn_scene_free(scene);
 *
 * A scene is built once, from a file, from text or from control points, and never changes. Any number of threads may
 * ask it at once; what each is answered depends on nothing but the ray: not on the other rays of the call, their order
 * or their number, nor on what other threads do. (Where another hit, or a border of the patch, is so near that double
 * precision cannot tell which comes first, the last places of t, u, v and the normal may.) To change a scene build another,
 * and free the old one when nobody asks it any more.
 *
 * Nothing is ever printed, no signal handled, no thread started, the process never ended. The locale means nothing. Of the
 * environment PSCN_KERNEL is looked at: baseline, avx2, avx512 or avx512_narrow is the instruction set that scenes are made
 * for; where the processor has it not, making one is PSCN_USAGE.
 * The caller's rounding mode, flush-to-zero and floating-point traps mean nothing either, and are, with the flags, as before
 * after each call. Functions answer a status; what was wrong, and where, is kept with the scene until it is asked for.
 *
 * What an answer promises: of all points where the ray meets the patches, as both are given in doubles, the hit is the
 * nearest with t_min < t < t_max, and a miss has none. (Points no farther apart than 2^-95 of their patches, or 2^-105
 * of t, have one t; of these the hit is on the patch that stands first.) `certain` is 1 where this is proven. It is 0,
 * "grazing", where a change of the input within the rounding of the last digits could turn the answer: a tangency, the
 * border of an open surface, a ray that lies in a surface. Then a hit is answered where one cannot be excluded; only
 * what may lie on either side of t_min or t_max is left out. The corner of a patch, or a
 * border that is one point, is a given point: a ray that meets it exactly hits it, and the nearest hit is certain,
 * though the surface may be open there; of all hits it is grazing then, and both are where the ray touches a patch
 * there. What one ray may cost is limited: where that ends first the answer is grazing, and the nearest hit known by
 * then, or a miss; what asks for any hit is told of one. (Of patches whose solver says `polish off` nothing is
 * proven, and of roots no farther apart than that solver's errors any one may be the answer, in one call or another.)
 *
 * C11 or later, or C++. Link with -lpscn; the static library needs -lm besides. `pkg-config pscn` and CMake's
 * find_package(pscn), targets pscn::pscn and pscn::static, know where both are.
 */
#ifndef PSCN_H
#define PSCN_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#if defined(__GNUC__)
#define PSCN_API __attribute__((visibility("default")))
#else
#define PSCN_API
#endif

/* ---- version ----
 *
 * While the major version is 0 another minor version is another library: its soname changes with both, and a program
 * runs with any library of the minor version it was compiled for. Structures with a member `size` grow at their end;
 * others do not change.
 */
#define PSCN_VERSION_MAJOR 0
#define PSCN_VERSION_MINOR 1
#define PSCN_VERSION_PATCH 0
#define PSCN_VERSION_NUMBER (10000 * PSCN_VERSION_MAJOR + 100 * PSCN_VERSION_MINOR + PSCN_VERSION_PATCH)
#define PSCN_VERSION "0.1.0"

/* Of the library that is running: the same number, the same text. */
PSCN_API int pscn_version(void);
PSCN_API const char *pscn_version_text(void);

/* ---- status ---- */

/* The values are the exit codes of the command pscn. */
enum pscn_status {
  PSCN_OK = 0,
  PSCN_USAGE = 2, /* an argument is wrong: options, sizes, NULL, the solver, a scene that was not built */
  PSCN_INPUT = 3, /* the scene's text, a control point or a ray is wrong */
  PSCN_FILE = 4,  /* the file cannot be read */
  PSCN_LIMIT = 5  /* memory is short, or a limit was passed */
};

/* In English, "out of memory or beyond a limit"; never NULL. */
PSCN_API const char *pscn_status_text(enum pscn_status status);

/* ---- scenes ---- */

struct pscn_scene;

/* Where a scene's memory comes from. `resize` is as realloc, and frees where `size` is 0; it is called by the threads
 * that build and free scenes and by those in pscn_all, never by pscn_nearest and pscn_occluded. It may answer NULL:
 * what asked for memory then fails with PSCN_LIMIT and nothing is lost. */
struct pscn_memory {
  void *(*resize)(void *context, void *block, size_t size); /* NULL: realloc and free */
  void *context;
};

/* A number that the scene's text finds declared. */
struct pscn_number {
  const char *name;
  double value;
};

/* How a scene is built. PSCN_OPTIONS, or all zero but `size`, asks for the defaults; so does NULL instead. Messages
 * call some by the names that they have for the program: --solver, --max-memory. */
struct pscn_options {
  size_t size;        /* sizeof(struct pscn_options) */
  const char *solver; /* what may follow `solver` in a scene, as "aberth { polish off }": instead of every solver
                         statement of the scene; NULL: as the scene says. `start previous` means `start cold` here,
                         for with it an answer would depend on the ray before */
  double tolerance;   /* instead of every solver's tolerance; 0: as those say */
  size_t max_memory;  /* bytes that the text and the patches may take, as counted before the scene is built, which takes
                         more: 1500 a patch of a text, 416 of control points; 0: no limit */
  const char *const *folders;        /* where files that the text includes are looked for besides its own folder, ended
                                        by NULL; or NULL */
  const struct pscn_number *numbers; /* number_count of them */
  size_t number_count;
  int image_width, image_height; /* what these words mean in the text; 0: 800 and 600 */
  struct pscn_memory memory;
};

#define PSCN_OPTIONS                                                             \
  {                                                                              \
    sizeof(struct pscn_options), NULL, 0, 0, NULL, NULL, 0, 0, 0, { NULL, NULL } \
  }

/* Each builds a scene and writes it to *out, also where it fails: then it answers no rays but holds the messages, and
 * is to be freed as any other. It is NULL only where there was no memory even for that. Every function takes NULL for
 * such a scene. Nothing that is passed need stay.
 *
 * The language of files and texts is docs/language.md's, a subset of POV-Ray's. `name` is what messages call the text;
 * what it includes is looked for in the folder that the name says. */
PSCN_API enum pscn_status pscn_scene_from_file(const char *path, const struct pscn_options *options,
                                               struct pscn_scene **out);
PSCN_API enum pscn_status pscn_scene_from_text(const char *name, const char *text, size_t length,
                                               const struct pscn_options *options, struct pscn_scene **out);

/* Control points P[i][j], i = 0..3 along u, j = 0..3 along v: patch n's is the three doubles at
 * points + n patch_stride + (4 i + j) point_stride, strides in bytes; for an array double[count][4][4][3] they are
 * sizeof(double[4][4][3]) and sizeof(double[3]). Edges that patches share are shared where their control points are
 * equal to the last bit: then no ray slips through. */
PSCN_API enum pscn_status pscn_scene_from_points(const double *points, size_t count, ptrdiff_t patch_stride,
                                                 ptrdiff_t point_stride, const struct pscn_options *options,
                                                 struct pscn_scene **out);

/* When no call asks it any more. NULL is allowed. */
PSCN_API void pscn_scene_free(struct pscn_scene *scene);

/* What its building answered. */
PSCN_API enum pscn_status pscn_scene_status(const struct pscn_scene *scene);

/* All errors and warnings as one text, lines as a compiler writes them, "" where there are none; and one of them. The
 * texts live as long as the scene. pscn_message answers PSCN_USAGE where there is none of that number, and then writes
 * an empty one. */
struct pscn_message {
  const char *text;    /* one line, without its end: "unknown word 'loaction'; did you mean 'location'?" */
  const char *file;    /* "" where it has no place */
  size_t line, column; /* from 1, in characters; 0 where it has no place */
  int32_t warning;     /* 1, or 0: an error */
};
PSCN_API const char *pscn_scene_messages(const struct pscn_scene *scene);
PSCN_API size_t pscn_message_count(const struct pscn_scene *scene);
PSCN_API enum pscn_status pscn_message(const struct pscn_scene *scene, size_t number, struct pscn_message *out);

/* Patches count from 0 as they stand in the text, objects expanded. pscn_patch writes the control net of one,
 * transforms applied; PSCN_USAGE where there is none of that number, and then zeros. */
PSCN_API size_t pscn_patch_count(const struct pscn_scene *scene);
PSCN_API enum pscn_status pscn_patch(const struct pscn_scene *scene, size_t number, double out[4][4][3]);

/* The camera, POV-Ray's default where the text has none: the ray through the point (s,t) of the picture, s and t from 0
 * to 1 from the left and from the top, leaves `location` along direction + (s - 1/2) right + (1/2 - t) up. Zeros where
 * the scene was not built. */
struct pscn_camera {
  double location[3], direction[3], right[3], up[3];
};
PSCN_API void pscn_scene_camera(const struct pscn_scene *scene, struct pscn_camera *out);

/* ---- rays ----
 *
 * `count` rays are read, ray k at rays + k ray_stride, and as many answers written, strides in bytes: a ray or an
 * answer may be a member of a structure of the caller's. A stride of 0 or below is fine where that makes sense. A call
 * is fastest with many rays, those that lie near each other side by side, and takes up to 1.5 MB of stack: a hard ray,
 * as one that passes a pole at 1e-9, is searched within a search, up to twelve deep.
 *
 * PSCN_OK; or PSCN_INPUT where some ray is not as it should be: that one has the verdict PSCN_NO_ANSWER, the others are
 * answered. PSCN_USAGE where the scene was not built, or a pointer is NULL: whatever can be written then has no answer.
 */
struct pscn_ray {
  double origin[3];
  double direction[3]; /* any length but 0: points origin + t direction */
  /* 0 <= t_min; points with t_min < t < t_max are met, so none where t_max <= t_min. That is asked of the exact t. A hit's is
   * rounded, so a ray that goes on from there, t_min being that, may meet it once more, one double farther (pscn_leave goes on
   * behind it, pscn_all has all). Where no double lies between the two t of a hit is t_max. */
  double t_min, t_max;
};

enum pscn_verdict { PSCN_MISS = 0, PSCN_HIT = 1, PSCN_NO_ANSWER = 2 };

#define PSCN_NO_PATCH UINT32_MAX

/* Every member is written, whatever the verdict. Where it is no hit, t is infinite, patch is PSCN_NO_PATCH and all
 * other numbers are 0. */
struct pscn_hit {
  double t;            /* in units of the direction's length; beyond the doubles the last of them, and grazing */
  double u, v;         /* of the whole patch, in [0,1] */
  double point[3];     /* S(u,v), a little more exact than origin + t direction */
  double point_error;  /* no further from `point` than this is the exact surface */
  double clearance;    /* see pscn_leave */
  double normal[3];    /* unit, facing the ray's origin; back along the ray where the surface has none */
  double du[3], dv[3]; /* dS/du, dS/dv, to roundings of the patch's size; no numbers where that is near DBL_MAX */
  uint32_t patch;
  int32_t verdict;  /* enum pscn_verdict */
  int32_t certain;  /* 1: proven; 0: grazing, or no answer */
  int32_t reserved; /* 0 */
};

/* The nearest hit of each ray. */
PSCN_API enum pscn_status pscn_nearest(const struct pscn_scene *scene, size_t count, const struct pscn_ray *rays,
                                       ptrdiff_t ray_stride, struct pscn_hit *hits, ptrdiff_t hit_stride);

/* Whether each ray hits anything, which is faster: an enum pscn_verdict in one byte. Grazing counts as a hit, and so does
 * what may be hit by a ray that comes to the end of what one may cost. */
PSCN_API enum pscn_status pscn_occluded(const struct pscn_scene *scene, size_t count, const struct pscn_ray *rays,
                                        ptrdiff_t ray_stride, uint8_t *verdicts, ptrdiff_t verdict_stride);

/* How many hits a ray has. `certain`: it is proven that these are all, and that their order is right. A point of an
 * edge that patches share is one hit where the ray crosses the surface there, and so is a pole; a ray with t_max
 * infinite starts inside a closed surface where `count` is odd, outside where it is even. Grazing: what may be a hit
 * is counted as well, up to 64, and its own `certain` is 0; or what a ray may cost ended first, and some are not
 * counted. The first of proven hits is pscn_nearest's, but for last places. */
struct pscn_hits {
  size_t count;
  int32_t verdict; /* PSCN_HIT where count > 0 */
  int32_t certain;
};

/* All hits of each ray in order of t: how many, and the first `most` of them, those of ray k at hits + k row_stride,
 * one behind the other; what is left over of `most` is written as misses. `most` may be 0 and `hits` NULL where only
 * their number matters. This call takes memory while it lasts, by the scene's hooks, which several threads may then
 * call at once: where there is none, PSCN_LIMIT, and rays that are not answered have the verdict PSCN_NO_ANSWER. */
PSCN_API enum pscn_status pscn_all(const struct pscn_scene *scene, size_t count, const struct pscn_ray *rays,
                                   ptrdiff_t ray_stride, struct pscn_hits *counts, ptrdiff_t counts_stride,
                                   struct pscn_hit *hits, ptrdiff_t row_stride, size_t most);

/* An origin for a ray that leaves the surface at `hit` along `direction`, as a shadow's or a mirror's: moved off the
 * surface by the clearance, to the side where the direction points. It meets neither the sheet it leaves nor skips one
 * beyond. */
PSCN_API void pscn_leave(const struct pscn_hit *hit, const double direction[3], double out_origin[3]);

#ifdef __cplusplus
}
#endif

#endif

/* pscn: exact intersection of rays with bicubic Bezier patches.
 *
 *     struct pscn_scene *scene;
 *     if (pscn_scene_from_file("teapot.pscn", NULL, &scene) != PSCN_OK) fputs(pscn_scene_messages(scene), stderr);
 *     struct pscn_ray ray = {.origin = {0, 5, -8}, .direction = {0, -0.5, 1}, .t_max = INFINITY};
 *     struct pscn_hit hit;
 *     pscn_nearest(scene, 1, &ray, sizeof ray, &hit, sizeof hit);
 *     pscn_scene_free(scene);
 *
 * A scene is built once, from a file, from text or from control points, and never changes. Any number of threads may
 * query it at once. An answer depends only on its ray: not on the other rays of the call, their order or their number,
 * nor on what other threads do. There is one exception. Where another hit, or a border of the patch, is so near that
 * double precision cannot tell which comes first, the last places of t, u, v and the normal may vary. To change a
 * scene, build another one, and free the old one when no call uses it any more.
 *
 * The library prints nothing, handles no signal, starts no thread and never ends the process. It ignores the locale. It
 * reads one environment variable, PSCN_KERNEL, which chooses the instruction set that scenes are made for: baseline,
 * avx2 or avx512. If the processor lacks it, building a scene returns PSCN_USAGE. The caller's rounding
 * mode, flush-to-zero and floating-point traps have no effect on answers; each call restores them, and the exception
 * flags. Functions return a status. Messages, which say what was wrong and where, are kept with the scene.
 *
 * Rays and patches are taken exactly as given in doubles. A hit is the nearest point with t_min < t < t_max where they
 * meet; a miss means that there is none. `certain` is 1 if this is proven. It is 0, "grazing", if exact arithmetic does
 * not decide within the ray's limit of work: at a tangency, on some borders (below), or if the ray lies in a surface. A
 * hit is then reported wherever one cannot be excluded, except one that may lie on either side of t_min or t_max.
 *
 * Points no farther apart than 2^-106 of their patches, or 2^-105 of t, count as one t, and the hit is on the patch that
 * comes first. On which side of a border a ray passes is decided to some 1e-48 of the patch's size. Nearer to a border
 * of two patches the hit is on either of them, and grazing.
 *
 * A ray that meets a border or corner of a patch exactly hits it. The hit is certain in a corner, at a pole, on a border
 * in one plane with the ray, such as a straight one, and where u and v are multiples of 2^-16, even if the surface is
 * open there; pscn_all's answer is then grazing, because the ray neither crosses the surface nor passes it by. Both are
 * grazing exactly at another place of a border, with few exceptions, and if the ray touches a patch at such a point.
 *
 * t of a certain hit is off by no more than four times what one rounding of each number of the ray and the patch can
 * change it. In tests with cusps, poles and near tangencies no t was off by more than 3e-16 of itself. Where the ray
 * sees the surface edge-on, or the surface has a cusp, u and v have fewer digits.
 *
 * The work for one ray is limited. If it runs out, the answer is grazing: the nearest hit known by then, or a miss;
 * pscn_occluded reports a hit. (Nothing is proven for patches whose solver says `polish off`. Among roots no
 * farther apart than that solver's errors, any one may be the answer, and not the same one in every call.)
 *
 * The numbers of scenes and rays are at most 1e100, or they are refused: those of a text, control points, origins and
 * directions, but not t_min and t_max. Coordinates below 1e-100 are read as 0.
 *
 * C11 or later, or C++. Link with -lpscn; the static library also needs -lm. `pkg-config pscn` and CMake's
 * find_package(pscn), with the targets pscn::pscn and pscn::static, know where both are.
 */
#ifndef PSCN_H
#define PSCN_H

#include <math.h> /* INFINITY, of PSCN_RAY */
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
 * While the major version is 0, each minor version is a different library: the soname contains both numbers, and a
 * program runs with any library of the minor version that it was compiled for. Structures with a member `size` grow at
 * their end; others do not change.
 */
#define PSCN_VERSION_MAJOR 0
#define PSCN_VERSION_MINOR 1
#define PSCN_VERSION_PATCH 0
#define PSCN_VERSION_NUMBER (10000 * PSCN_VERSION_MAJOR + 100 * PSCN_VERSION_MINOR + PSCN_VERSION_PATCH)
#define PSCN_VERSION "0.1.0"

/* The same number and text, of the library that is running. */
PSCN_API int pscn_version(void);
PSCN_API const char *pscn_version_text(void);

/* ---- status ---- */

/* The values are the exit codes of the command pscn. */
enum pscn_status {
  PSCN_OK = 0,
  PSCN_USAGE = 2, /* a wrong argument: options, sizes, NULL, the solver, a scene that was not built */
  PSCN_INPUT = 3, /* an error in the scene's text, a control point or a ray */
  PSCN_FILE = 4,  /* the file cannot be read */
  PSCN_LIMIT = 5  /* out of memory, or beyond a limit */
};

/* English text, such as "out of memory or beyond a limit"; never NULL. */
PSCN_API const char *pscn_status_text(enum pscn_status status);

/* ---- scenes ---- */

struct pscn_scene;

/* Where a scene's memory comes from. `resize` works as realloc does, and frees the block if `size` is 0. The threads
 * that build and free scenes call it, and those in pscn_all; pscn_nearest and pscn_occluded never do. It may return
 * NULL: the call that needed the memory then fails with PSCN_LIMIT, and nothing leaks. */
struct pscn_memory {
  void *(*resize)(void *context, void *block, size_t size); /* NULL: realloc and free */
  void *context;
};

/* A number that is declared before the scene's text is read. */
struct pscn_number {
  const char *name;
  double value;
};

/* How a scene is built. PSCN_OPTIONS, or a structure that is zero except for `size`, asks for the defaults; so does
 * NULL in its place. Messages call some options by the names that they have in the program: --solver, --max-memory. */
struct pscn_options {
  size_t size;        /* sizeof(struct pscn_options) */
  const char *solver; /* what may follow `solver` in a scene, as "aberth { polish off }"; replaces every solver
                         statement of the scene. NULL: as the scene says. `start previous` means `start cold` here,
                         because with it an answer would depend on the ray before */
  double tolerance;   /* replaces every solver's tolerance; 0: as those say */
  size_t max_memory;  /* limit in bytes on what the scene takes; 0: no limit. Where memory is short, patches are cut
                         into fewer leaves. With hooks, which can limit themselves, only an estimate is limited: 1500
                         bytes for a patch of a text, 416 for one of control points */
  const char *const *folders;        /* more folders to search for included files, besides the text's own, ended by
                                        NULL; or NULL */
  const struct pscn_number *numbers; /* number_count of them */
  size_t number_count;
  int image_width, image_height; /* the values of these words in the text; 0: 800 and 600 */
  struct pscn_memory memory;
  /* 1: the text is not trusted. It includes only files in its folder (of a text: the one in its name, if any) and in
   * `folders`, or below them, wherever links lead. It may not say `solver`, and has at most 64 lights. Its #debug and
   * the like are messages, a thousand at most. If max_memory is 0, it is 256 MB. (In any case reading ends after
   * max_work, and each ray after some 10 ms. The number of rays is up to the caller.) */
  int32_t untrusted;
  int32_t lenient; /* 1: what pscn does not support of POV-Ray's language is left out, with warnings */
  double clock;    /* the value of that word in the text */
  size_t max_work; /* limit on the tokens that loops and macros of the text may read; 0: 15 million, about a second */
};

#define PSCN_OPTIONS                                                                       \
  {                                                                                        \
    sizeof(struct pscn_options), NULL, 0, 0, NULL, NULL, 0, 0, 0, {NULL, NULL}, 0, 0, 0, 0 \
  }

/* Each function builds a scene and writes it to *out, even when it fails: such a scene answers no rays, but holds the
 * messages, and must be freed like any other. *out is NULL only if there was no memory even for that. Every function
 * accepts NULL as such a scene. No argument need outlive the call.
 *
 * Files and texts are in the language of docs/language.md, a subset of POV-Ray's. `name` is the name of the text in
 * messages; files that it includes are looked for in the folder that this name has. */
PSCN_API enum pscn_status pscn_scene_from_file(const char *path, const struct pscn_options *options,
                                               struct pscn_scene **out);
PSCN_API enum pscn_status pscn_scene_from_text(const char *name, const char *text, size_t length,
                                               const struct pscn_options *options, struct pscn_scene **out);

/* Control points P[i][j], i = 0..3 along u, j = 0..3 along v. That of patch n is the three doubles at
 * points + n patch_stride + (4 i + j) point_stride, strides in bytes. For an array double[count][4][4][3] the strides
 * are sizeof(double[4][4][3]) and sizeof(double[3]). Two patches share an edge if its control points are equal to the
 * last bit; no ray slips through between them. */
PSCN_API enum pscn_status pscn_scene_from_points(const double *points, size_t count, ptrdiff_t patch_stride,
                                                 ptrdiff_t point_stride, const struct pscn_options *options,
                                                 struct pscn_scene **out);

/* The same for floats; each becomes the double of the same value. */
PSCN_API enum pscn_status pscn_scene_from_float_points(const float *points, size_t count, ptrdiff_t patch_stride,
                                                       ptrdiff_t point_stride, const struct pscn_options *options,
                                                       struct pscn_scene **out);

/* Patches as sixteen indices each, in the order of P, of vertices, three doubles each. Patches that have the indices of
 * an edge in common share it. If there are instances, matrices M[4][3], all patches stand in the scene once for each of
 * them, points p moved to p[0] M[0] + p[1] M[1] + p[2] M[2] + M[3]; patch n of instance m has the number m count + n.
 * NULL and 0: once, as they are. */
PSCN_API enum pscn_status pscn_scene_from_indexed(const double *vertices, size_t vertex_count, const uint32_t *patches,
                                                  size_t count, const double *instances, size_t instance_count,
                                                  const struct pscn_options *options, struct pscn_scene **out);
PSCN_API enum pscn_status pscn_scene_from_float_indexed(const float *vertices, size_t vertex_count,
                                                        const uint32_t *patches, size_t count, const double *instances,
                                                        size_t instance_count, const struct pscn_options *options,
                                                        struct pscn_scene **out);

/* Frees a scene that no call uses any more. NULL is allowed. */
PSCN_API void pscn_scene_free(struct pscn_scene *scene);

/* The status that building the scene returned. */
PSCN_API enum pscn_status pscn_scene_status(const struct pscn_scene *scene);

/* All errors and warnings as one text, in lines as compilers write them, "" if there are none; and one message by its
 * number. The texts live as long as the scene. If no message has that number, pscn_message returns PSCN_USAGE and
 * writes an empty one. */
struct pscn_message {
  const char *text;    /* one line without its newline: "unknown word 'loaction'; did you mean 'location'?" */
  const char *file;    /* "" if the message has no place */
  size_t line, column; /* from 1, in characters; 0 if the message has no place */
  int32_t warning;     /* 1, or 0: an error */
};
PSCN_API const char *pscn_scene_messages(const struct pscn_scene *scene);
PSCN_API size_t pscn_message_count(const struct pscn_scene *scene);
PSCN_API enum pscn_status pscn_message(const struct pscn_scene *scene, size_t number, struct pscn_message *out);

/* Patches are numbered from 0 in the order of the text, objects expanded. pscn_patch writes the control net of one,
 * transforms applied. If no patch has that number, it returns PSCN_USAGE and writes zeros. */
PSCN_API size_t pscn_patch_count(const struct pscn_scene *scene);
PSCN_API enum pscn_status pscn_patch(const struct pscn_scene *scene, size_t number, double out[4][4][3]);

/* The object of the text that a patch belongs to: of nested objects the outermost, such as `object { Lid scale 2 }` or a
 * union. `number` counts those that have patches, from 0. `name` is "Lid" here, and "" for an object that is written out
 * where it stands; it lives as long as the scene. If no patch has that number, or the scene is not from a text, the
 * call returns PSCN_USAGE and writes zeros, and "". */
struct pscn_object {
  const char *name;
  size_t number, first_patch, patch_count;
};
PSCN_API enum pscn_status pscn_object(const struct pscn_scene *scene, size_t patch, struct pscn_object *out);

/* The least and the greatest coordinates of a patch's control points, or of all patches': the surface is between them.
 * If no patch has that number, or there is none, it returns PSCN_USAGE and writes zeros. */
#define PSCN_ALL_PATCHES SIZE_MAX
PSCN_API enum pscn_status pscn_bounds(const struct pscn_scene *scene, size_t number, double out[2][3]);

/* Points of patches: S, its derivatives, and the unit normal along dS/du x dS/dv or, where that is 0, its limit from
 * inside the patch; 0 if there is none. Exact to a few roundings of the patch's size. Strides are as for rays,
 * below. For a place of no patch, or with u or v outside [0,1], all numbers are NAN and the call returns PSCN_INPUT. */
struct pscn_place {
  double u, v;
  uint32_t patch, reserved;
};
struct pscn_surface {
  double point[3], du[3], dv[3], normal[3];
};
PSCN_API enum pscn_status pscn_surface(const struct pscn_scene *scene, size_t count, const struct pscn_place *places,
                                       ptrdiff_t place_stride, struct pscn_surface *out, ptrdiff_t out_stride);

/* The camera, or POV-Ray's default if the text has none. The ray through the point (s,t) of the picture, s from 0 at
 * the left to 1 and t from 0 at the top to 1, leaves `location` along direction + (s - 1/2) right + (1/2 - t) up. Zeros
 * if the scene was not built. */
struct pscn_camera {
  double location[3], direction[3], right[3], up[3];
};
PSCN_API void pscn_scene_camera(const struct pscn_scene *scene, struct pscn_camera *out);

/* ---- rays ----
 *
 * Each call reads `count` rays, ray k at rays + k ray_stride, and writes as many answers. Strides are in bytes, so a
 * ray or an answer may be a member of the caller's own structure. A stride may be 0 or negative where that makes sense.
 * A call is fastest with many rays, neighbouring ones side by side. Hard rays take up to 1 MB of stack
 * (0.7 MB is the most that was measured); building a scene takes 0.1 MB.
 *
 * The status is PSCN_OK; PSCN_INPUT if some ray is invalid: it gets the verdict PSCN_NO_ANSWER, and the others are
 * answered; or PSCN_USAGE if the scene was not built or a pointer is NULL: all rays that can be then get that verdict.
 */
struct pscn_ray {
  double origin[3];
  double direction[3]; /* any length but 0; the ray's points are origin + t direction */
  /* 0 <= t_min. A hit has t_min < t < t_max, so there is none if t_max <= t_min. The exact t decides. The t of a hit is
   * rounded: a ray that continues with t_min = t may meet the same point again, one double farther; pscn_all
   * gives all hits. If no double lies between t_min and t_max, the t of a hit is
   * t_max. */
  double t_min, t_max;
};

/* Initializes a ray, so that no member is forgotten: origin and direction are 0, the range is everything. */
#define PSCN_RAY                      \
  {                                   \
    {0, 0, 0}, {0, 0, 0}, 0, INFINITY \
  }

enum pscn_verdict { PSCN_MISS = 0, PSCN_HIT = 1, PSCN_NO_ANSWER = 2 };

#define PSCN_NO_PATCH UINT32_MAX

/* Every member is written, whatever the verdict. Without a hit, t is infinite, patch is PSCN_NO_PATCH and the other
 * numbers are 0. */
struct pscn_hit {
  double t;            /* in units of the direction's length */
  double u, v;         /* of the whole patch, in [0,1] */
  double point[3];     /* S(u,v), slightly more exact than origin + t direction */
  double point_error;  /* bound on the distance from `point` to the exact surface */
  double clearance;    /* see pscn_leave */
  double normal[3];    /* of unit length, facing the ray's origin; against the ray if the surface has none */
  double du[3], dv[3]; /* dS/du, dS/dv, to a few roundings of the patch's size */
  uint32_t patch;
  int32_t verdict;  /* enum pscn_verdict */
  int32_t certain;  /* 1: proven; 0: grazing, or no answer */
  int32_t reserved; /* 0 */
};

/* The nearest hit of each ray. */
PSCN_API enum pscn_status pscn_nearest(const struct pscn_scene *scene, size_t count, const struct pscn_ray *rays,
                                       ptrdiff_t ray_stride, struct pscn_hit *hits, ptrdiff_t hit_stride);

/* The same in 40 bytes, without point and normal: faster. */
struct pscn_answer {
  double t, u, v;
  uint32_t patch;
  int32_t verdict, certain, reserved;
};
PSCN_API enum pscn_status pscn_nearest_answer(const struct pscn_scene *scene, size_t count, const struct pscn_ray *rays,
                                              ptrdiff_t ray_stride, struct pscn_answer *answers,
                                              ptrdiff_t answer_stride);

/* Whether each ray hits anything: one byte, an enum pscn_verdict. Faster than the nearest hit. A grazing hit counts as
 * a hit; so does any possible hit of a ray whose work runs out. */
PSCN_API enum pscn_status pscn_occluded(const struct pscn_scene *scene, size_t count, const struct pscn_ray *rays,
                                        ptrdiff_t ray_stride, uint8_t *verdicts, ptrdiff_t verdict_stride);

/* How many hits a ray has. `certain`: it is proven that these are all hits, and in the right order. A point of an edge
 * that patches share is one hit where the ray crosses the surface there, and so is a pole. A ray with infinite t_max
 * therefore starts inside a closed surface if `count` is odd, and outside if it is even. Grazing: possible hits are
 * counted too, up to 64, each with its own `certain` 0; or the ray's work ran out, and some hits are not counted.
 *
 * If this and pscn_nearest are certain, the first hit is the same, except for last places. If only pscn_nearest is, its
 * hit may be a possible one here, as in a corner of an open surface, or missing, because the work ran out. */
struct pscn_hits {
  size_t count;
  int32_t verdict; /* PSCN_HIT where count > 0 */
  int32_t certain;
};

/* All hits of each ray in order of t: their number, and the first `most` of them. Those of ray k are stored one after
 * another from hits + k row_stride; the rest of the `most` are written as misses. If only the number matters, `most`
 * may be 0 and `hits` NULL. This call allocates temporary memory by the scene's hooks, which several threads may then
 * call at once. If there is too little, it returns PSCN_LIMIT, and rays that were not answered get the verdict
 * PSCN_NO_ANSWER. */
PSCN_API enum pscn_status pscn_all(const struct pscn_scene *scene, size_t count, const struct pscn_ray *rays,
                                   ptrdiff_t ray_stride, struct pscn_hits *counts, ptrdiff_t counts_stride,
                                   struct pscn_hit *hits, ptrdiff_t row_stride, size_t most);

/* An origin for a ray that leaves the surface at the `hit` of `ray` along `direction`, such as a shadow or a mirrored
 * ray: a point of `ray` itself, before the hit, from which the surface is `clearance` away; or where `ray` starts, if
 * that is nearer. If the hit is certain, nothing lies between the ray's start and this point. So where surfaces close a
 * space in, a ray from this point is in the same space as the ray's start, even in an acute crease. (Proven up to the
 * rounding of the point, by 2^-51 of its coordinates. Another surface may lie within that only if the ray runs along it
 * at an angle with 1/64 of the sine of the angle at the hit, or less. Next to a border of the patch even that is
 * excluded, by tracing a ray back from the point. Light within the clearance before a surface may be missed.)
 *
 * If `direction` points to the other side, the point lies as far behind the hit, and nothing is proven: surfaces nearer
 * to it are skipped. pscn_all skips nothing. Any thread may call this; it allocates nothing.
 *
 * PSCN_USAGE if `hit` is not a hit, a pointer is NULL, or the scene was not built, and PSCN_INPUT if the ray is
 * invalid; the origin is then NAN. */
PSCN_API enum pscn_status pscn_leave(const struct pscn_scene *scene, const struct pscn_ray *ray,
                                     const struct pscn_hit *hit, const double direction[3], double out_origin[3]);

#ifdef __cplusplus
}
#endif

#endif

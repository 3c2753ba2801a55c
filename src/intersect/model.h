/* The scene as the intersector sees it: prepared patches, their leaves, the hierarchy over the leaves.
 *
 * Internal to src/intersect. Read-only after model_create, shared by all threads.
 *
 * Every patch has a frame of its own: world = center + scale * local, scale a power of two, center with few bits, so
 * that |local| <= 1 and going to local coordinates rounds almost nothing. All algebra is done in local coordinates,
 * so scale and offset of a scene cost no accuracy. A patch is cut into N x N leaves, a slender one along its long side
 * only: they are the units the hierarchy holds and rays are tried on. Where leaves for all patches would be too many,
 * copies of a declared object share the object's (copies.h). Where they would be too many all the same, neither patches
 * nor leaves are kept: they are made anew from the scene whenever a ray comes to one, always the same.
 */
#ifndef PSCN_INTERSECT_MODEL_H
#define PSCN_INTERSECT_MODEL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/team.h"
#include "geometry/bvh.h"
#include "geometry/edges.h"
#include "geometry/flats.h"
#include "intersect/certificate.h"
#include "scene/scene.h"

/* How far outside [0,1] a leaf's polynomials are still used (its second-derivative bounds hold up to there). */
#define LEAF_MARGIN 0.125

/* Newton's method on a leaf ends with a step no longer than this, in leaf parameters. */
#define NEWTON_LAST_STEP CERTIFICATE_STEP

/* What is found out about a patch once. */
struct model_cut {
  double loose; /* how far off its surface a ray may be met by leaves of an object, in the scene; 0 where not copied */
  uint16_t split[2]; /* cut into split[0] x split[1] leaves, along u and v */
  uint8_t m, n;      /* true bidegree in u, v */
  bool copied;       /* its leaves are those of the object it is copied from; then m and n mean nothing */
};

struct model_patch {
  double center[3], scale;
  double x[3][4][4]; /* local control net, x[coordinate][i][j], |x| <= 1 */
  /* rest[3][4][4], what its rounding has taken away: x + rest is exact. Nothing of most patches, who share the zeros */
  const double (*rest)[4][4];
  bool pole[4]; /* borders (geometry/edges.h) that are one point exactly: in x ones that nearly are may be, too */
  struct model_cut cut;
  enum solver_lanes lanes; /* of its method, polished; NONE: tried on one ray after the other */
  const struct method *method;
};

/* The polynomials a resultant is formed of: the leaf's net at its true degree, the parameter that is kept first. */
struct leaf_form {
  double x[3][16]; /* x[coordinate][4 * i + j], i = 0..degree kept, j = 0..degree eliminated; zero beyond */
  double size;     /* bound on |x| and 1: a net of lower degree may reach beyond the leaf's own */
  /* bound on the distance of any coordinate, on the leaf, from the leaf's: the degree is one within rounding */
  double excess;
};

/* A leaf as x = c + s A + t B + st C + rest(s,t), s = u - 1/2 and t = v - 1/2: the Taylor polynomial about its middle,
 * the first four coefficients taken out with few bits, as multiples of LEAF_GRAIN. So s A and the like are exact where s
 * has few bits as well, and what is rounded is of the size of the rest, which is how far the leaf bends and what the
 * four have beyond the grain. */
struct leaf_parts {
  double base[4][3];  /* c, A, B, C; a coordinate behind the other, for they are also read side by side */
  double rest[16][3]; /* coefficient of s^i t^j at rest[4 * i + j] */
  double error;       /* bound on what rounding the rest adds to local_ray.error in either plane's polynomial */
  bool final;         /* rounded so little that its roots need no last step */
  /* steps up to these, in leaf parameters, leave the root right to the rounding of its coordinates, and derivatives
   * right to their own */
  double last_step, slope_step;
};

#define LEAF_GRAIN 0x1p-24

/* The leaf's net lies where |g x - offset| <= half; |g_x| + |g_y| + |g_z| = 1, but for rounding. Of a leaf whose middle is a
 * point g is 0 and half infinite. */
struct leaf_slab {
  double g[3], offset, half;
};

/* The quadric that the leaf lies along. With z, y1, y2 for g x - offset of slab[0], slab[1], slab[2] let
 *
 *     rest = z - (c[0] + c[1] y1 + c[2] y2 + c[3] y1^2 + c[4] y1 y2 + c[5] y2^2).
 *
 * On the leaf |rest| <= off, and from one point of it to another rest changes by no more than turn[0] times what y1 does and
 * turn[1] times what y2 does; on the leaf widened by LEAF_MARGIN by turn_wide. So of the exact patch, and of points and forms
 * of a ray that are off by no more than QUADRIC_ERROR makes of them; what that makes of a derivative along the ray is up to
 * `slack`. Infinite where there is no such bound. */
struct leaf_quadric {
  double c[6], off, turn[2], turn_wide[2], slack;
};

/* In the frame of a patch. Planes' polynomials are off by a 2^8th of it, but of rays from far away and of copies. */
#define QUADRIC_ERROR 0x1p-38

struct leaf {
  /* a box along the leaf: across the normal in its middle, and the two that run with its parameters */
  struct leaf_slab slab[3];
  uint32_t patch;
  uint16_t column_u, column_v; /* the leaf is [column_u, column_u + 1] / split[0] in u, and so on */
  uint8_t kept_degree, eliminated_degree;
  bool v_kept;      /* the form keeps v and eliminates u */
  bool has_quadric; /* one that is not kept gets its quadric when that is first asked for */
  uint8_t zeros[2]; /* r(kept) has this many exact roots at 0 and at 1: collapsed edges */
  uint8_t pole;     /* 1 + the first border (geometry/edges.h) that is one, 0: none */
  /* bounds on |Suu|, |Suv|, |Svv| over the leaf widened by LEAF_MARGIN, leaf parameters */
  double second[3];
  double first[2]; /* bounds on |Su|, |Sv| there */
  double third[2]; /* and on |Suuv|, |Suvv|, where there is a pole */
  struct leaf_parts parts;
  double x[3][16]; /* local net over the leaf, x[coordinate][4 * i + j], in the frame of its patch */
  struct leaf_quadric quadric;
  const struct leaf_form *form; /* NULL: x itself is the form (3,3), u kept */
};

/* A leaf's slabs in the frame of its tree, for a walk to look at before the leaf: as floats, a line of the processor's caches.
 * What rounding moves is for the ray's side to allow (lanes/view.h). */
struct oriented_box {
  float g[3][3]; /* g[k][q]: component k of slab q's */
  float offset[3], half[3];
  uint32_t patch; /* the leaf's, of which some is wanted at the same time */
};

/* Which part of which patch a leaf is. */
struct leaf_place {
  uint32_t patch;
  uint16_t column_u, column_v;
};

/* Room for a patch that is not kept, and for a leaf with all that belongs to it. */
struct patch_room {
  struct model_patch patch;
  double rest[3][4][4];
};

struct leaf_room {
  struct patch_room of;
  struct leaf leaf;
  struct leaf_form form;
};

/* A declared object whose leaves serve all its copies. */
struct model_object {
  const struct scene_object *declared;
  struct model *model; /* of its patches as declared, about its middle; no scene, no neighbours; owned */
  /* bound on how far a point of a copy, or of a ray near it, may be off in the object's coordinates */
  double error;
};

/* One of its places: object coordinates are (x - b) W, for a row vector x of the scene. */
struct model_copy {
  struct model_object *object;
  uint32_t first_patch;
  bool twin; /* all of its patches are */
  double W[3][3], b[3];
};

/* So many frames may be within one another, for the walk goes down by recursion. What is still smaller is passed over less
 * well, and found all the same: sizes in one place that go down by 2^8 each, so many times and more, are no scene. */
enum { MODEL_FRAMES = 48 };

/* A hierarchy in a frame of its own: (world - origin)/frame, all within about [-1,1], frame a power of two. Its boxes
 * are floats, which tell little of what is far smaller than the frame: small boxes that lie together have a tree of theirs
 * where there are others far away, or far larger. In the hierarchy box k < leaf_count is a leaf's, those behind are the copies',
 * and behind these come the trees in this one. */
struct model_tree {
  double origin[3], frame;
  struct bvh bvh;
  struct model_tree *inner; /* in the arena */
  size_t inner_count;
  double crossings; /* how many surfaces a line that comes by the tree crosses, on average, about */
};

struct model {
  const struct scene *scene;
  struct arena *arena;
  double size; /* the largest coordinate of a control point */
  struct model_cut *cuts;
  struct model_patch *patches;       /* NULL where they are not kept, */
  struct leaf *leaves;               /* nor are the leaves then, */
  struct leaf_place *places;         /* but where they are; else NULL */
  struct oriented_box *oriented;     /* the leaves' */
  void *oriented_room;               /* what they are in where leaves are not kept; owned */
  struct edge_neighbour *neighbours; /* [4 * patch + border], see geometry/edges.h; none of `twin` ones */
  /* patches that lie exactly on an earlier one (geometry/twins.h), an object's wherever it is copied: never the nearest;
   * NULL for none */
  bool *twin;
  /* the plane across an axis that a patch lies in (geometry/flats.h), 0 for none; NULL where there are none. What a ray meets of
   * one plane is at one t: the patch that stands first is before the others */
  uint32_t *plane;
  struct flat_plane *planes; /* by these numbers */
  size_t leaf_count;
  struct model_object *objects;
  size_t object_count;
  struct model_copy *copies; /* box leaf_count + k of the hierarchy is copy k */
  size_t copy_count;
  double error; /* widens the boxes of the hierarchy; an object's, or 0 */
  struct model_tree tree;
  bool unproven; /* some patch has `polish off`: no answer is proven */
};

/* Prepares all patches of the scene, which is borrowed; a large one by a team, with the same outcome. STATUS_LIMIT
 * where memory is short, or threads are; then *out is NULL. */
enum status model_create(const struct scene *scene, const struct team *team, struct model **out) STATUS_MUST_CHECK;
void model_destroy(struct model *model);

/* The number of the plane across an axis that the patch lies in, or 0. */
static inline uint32_t model_plane(const struct model *model, size_t patch)
{
  return model->plane ? model->plane[patch] : 0;
}

/* That plane; NULL for none. */
static inline const struct flat_plane *model_flat_plane(const struct model *model, size_t patch)
{
  const uint32_t number = model_plane(model, patch);
  return number ? &model->planes[number] : NULL;
}

/* What is across a border (geometry/edges.h) of the patch. */
static inline const struct edge_neighbour *model_neighbour(const struct model *model, uint32_t patch, int border)
{
  return &model->neighbours[4 * (size_t)patch + (size_t)border];
}

/* Whether a box of the hierarchy, or of a tree in it, is a tree's. */
static inline bool model_is_tree(const struct model *model, uint32_t box)
{
  return box >= model->leaf_count + model->copy_count;
}

/* That tree, which is in `tree`. */
static inline struct model_tree *model_inner(const struct model *model, const struct model_tree *tree, uint32_t box)
{
  return &tree->inner[box - model->leaf_count - model->copy_count];
}

/* The patch, in `room` where it is not kept. */
struct model_patch *model_patch_at(const struct model *model, uint32_t index, struct patch_room *room);

/* A leaf that is not kept, without its quadric. */
void model_make_leaf(const struct model *model, uint32_t number, struct leaf_room *out);

/* Where `split` is auto a patch is cut until its leaves' derivatives turn by no more than about this fraction of their size, or
 * by `coarse` where there would be more leaves than a picture shows, the second where there still were four times as many, and
 * into so many leaves a side at most: any patch, and one that is bent all over; and where leaves are thicker than they are apart finer
 * (prepare/crowd.h), while there are no more than `leaves` a patch on average. Choices of speed, not of correctness. */
enum { COARSER = 2 };
struct split_limit {
  double turn, coarse[COARSER];
  int any, bent;
  double leaves;
};

/* The model of an object: the patches of `nets`, which is borrowed for the call, their boxes wider by `error`. */
enum status model_create_object(const struct scene *nets, const struct team *team, const struct split_limit *limit,
                                double error, struct model **out) STATUS_MUST_CHECK;

#endif

/* The scene as the intersector sees it: prepared patches, their leaves, the hierarchy over the leaves.
 *
 * Internal to src/intersect. Read-only after model_create, shared by all threads.
 *
 * Every patch has its own frame: world = center + scale * local, where scale is a power of two and center has few bits,
 * so that |local| <= 1 and the conversion rounds almost nothing. All algebra is done in local coordinates, so scale and
 * offset of a scene cost no accuracy. A patch is cut into leaves (prepare/cut.h). The hierarchy holds leaves, and rays
 * are tried on leaves. Where there are many patches, copies of a declared object share the object's leaves
 * (prepare/copies.h). If there are still too many, neither patches nor leaves are kept: they are made anew from the
 * scene whenever a ray comes to one, with the same bits every time.
 */
#ifndef PSCN_INTERSECT_MODEL_H
#define PSCN_INTERSECT_MODEL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/team.h"
#include "geometry/bvh.h"
#include "geometry/edges.h"
#include "intersect/certificate.h"
#include "scene/scene.h"

/* How far outside [0,1] a leaf's polynomials are still used; its second-derivative bounds hold up to there. */
#define LEAF_MARGIN 0.125

/* The last step of Newton's method on a leaf is no longer than this, in leaf parameters. */
#define NEWTON_LAST_STEP CERTIFICATE_STEP

/* What is determined once for each patch. */
struct model_cut {
  double loose;      /* how far off the patch, in the scene, an object's leaves may meet a ray; 0 where not copied */
  uint16_t split[2]; /* cut into split[0] x split[1] leaves, along u and v */
  bool copied;       /* its leaves are those of the object it is copied from */
};

struct model_patch {
  double center[3], scale;
  double x[3][4][4]; /* local control net, x[coordinate][i][j], |x| <= 1 */
  /* rest[3][4][4], what rounding the net took away: x + rest is exact. Most patches have none and share one of zeros */
  const double (*rest)[4][4];
  bool pole[4]; /* borders (geometry/edges.h) that are exactly one point; in x, being rounded, others may be, too */
  struct model_cut cut;
  enum solver_lanes lanes; /* how its method, polished, works on lanes; NONE: on one ray after the other */
  const struct method *method;
};

/* A leaf as x = c + s A + t B + st C + rest(s,t), s = u - 1/2 and t = v - 1/2: the Taylor polynomial about its middle.
 * The first four coefficients have few bits, as multiples of LEAF_GRAIN; so products such as s A are exact where s has
 * few bits, too. Only the rest is rounded: how far the leaf bends, and what the four have beyond the grain. */
struct leaf_parts {
  double base[4][3];  /* c, A, B, C; coordinates are adjacent, because they are also read side by side */
  double rest[16][3]; /* coefficient of s^i t^j at rest[4 * i + j] */
  double error;       /* bound on what rounding the rest adds to PLANE_ERROR in either plane's polynomial */
  bool final;         /* its rounding is so small that its roots need no last step */
  double
    last_step; /* after a step up to this, in leaf parameters, the root is right to the rounding of its coordinates */
};

#define LEAF_GRAIN 0x1p-24

/* The leaf's net lies where |g x - offset| <= half; |g_x| + |g_y| + |g_z| = 1 up to rounding. If its corners give no
 * direction in its middle, g is 0 and half infinite. */
struct leaf_slab {
  double g[3], offset, half;
};

struct leaf {
  /* the box along the leaf: a slab across the normal in its middle, two along its parameters */
  struct leaf_slab slab[3];
  uint32_t patch;
  uint16_t column_u, column_v; /* the leaf is [column_u, column_u + 1] / split[0] in u, and the same in v */
  /* bounds on |Suu|, |Suv|, |Svv| over the leaf widened by LEAF_MARGIN, leaf parameters */
  double second[3];
  double first[2]; /* bounds on |Su|, |Sv| there */
  struct leaf_parts parts;
  double x[3][16]; /* local net over the leaf, x[coordinate][4 * i + j], in the frame of its patch */
};

/* A leaf's slabs in the frame of its tree, which the walk tests before it reads the leaf: floats, one line of the
 * processor's caches. The ray's side allows for rounding (lanes/view.h). */
struct oriented_box {
  float g[3][3]; /* g[k][q]: component k of slab q's g */
  float offset[3], half[3];
  uint32_t patch; /* the leaf's, from which data is needed at the same time */
};

/* Which part of which patch a leaf is. */
struct leaf_place {
  uint32_t patch;
  uint16_t column_u, column_v;
};

/* Room for a patch that is not kept, and for such a leaf. */
struct patch_room {
  struct model_patch patch;
  double rest[3][4][4];
};

struct leaf_room {
  struct patch_room of;
  struct leaf leaf;
};

/* A declared object whose leaves serve its copies. */
struct model_object {
  const struct scene_object *declared;
  struct model *model; /* its patches as declared, about its middle; no scene, no neighbours; owned */
  /* bound on how far a point of a copy, or of a ray near it, may be off in the object's coordinates */
  double error;
};

/* A copy of an object: object coordinates are (x - b) W, for a row vector x of the scene. */
struct model_copy {
  struct model_object *object;
  uint32_t first_patch;
  double W[3][3], b[3];
};

/* A hierarchy in its own frame: (world - origin)/frame, all within about [-1,1], frame a power of two. Its boxes are
 * floats, which resolve little of what is far smaller than the frame. So small boxes that lie together get their own
 * tree if others are far away or far larger. Box k < leaf_count of the hierarchy is a leaf's; the copies' follow, and in
 * the trees of all the model the inner trees'. */
struct model_tree {
  double origin[3], frame;
  struct bvh bvh;
};

struct model {
  const struct scene *scene;
  struct arena *arena;
  double size; /* the largest coordinate of a control point */
  /* how far a patch may be cut, and whether leaves may be kept: less than otherwise where memory is short */
  int most_split;
  bool never_keep;
  struct model_cut *cuts;
  struct model_patch *patches;       /* NULL if they are not kept */
  struct leaf *leaves;               /* NULL if they are not kept */
  struct leaf_place *places;         /* where leaves are that are not kept; else NULL */
  struct oriented_box *oriented;     /* the leaves' */
  void *oriented_room;               /* their memory if leaves are not kept; owned */
  struct edge_neighbour *neighbours; /* [4 * patch + border], see geometry/edges.h */
  /* the surface of each patch of the scene (geometry/edges.h), 0 for one of its own; NULL if no two patches share
   * one. A ray meets all patches of one surface at one t, and the first in the scene comes before the others */
  uint32_t *surface;
  size_t leaf_count;
  struct model_object *objects;
  size_t object_count;
  struct model_copy *copies; /* box leaf_count + k of the hierarchy is copy k */
  size_t copy_count;
  double error; /* widens the boxes of an object's hierarchy; else 0 */
  struct model_tree tree;
  struct model_tree *inner; /* in the arena; none has inner trees itself */
  size_t inner_count;
  bool unproven; /* `polish off` on some patch: no answer is proven */
};

/* Prepares all patches of the scene, which it borrows; a large scene by a team, with the same outcome. STATUS_LIMIT if
 * memory or threads are short; *out is then NULL. */
enum status model_create(const struct scene *scene, const struct team *team, struct model **out) STATUS_MUST_CHECK;
void model_destroy(struct model *model);

/* Whether some patch's method has more leaves than there was memory for. */
bool model_cut_less(const struct model *model);

/* Whether the patch lies exactly on an earlier one, and so is never the nearest. */
static inline bool model_again(const struct model *model, size_t patch)
{
  return model->surface && model->surface[patch] & SURFACE_AGAIN;
}

/* The neighbour across a border (geometry/edges.h) of the patch. */
static inline const struct edge_neighbour *model_neighbour(const struct model *model, uint32_t patch, int border)
{
  return &model->neighbours[4 * (size_t)patch + (size_t)border];
}

/* The patch, made in `room` if patches are not kept. */
struct model_patch *model_patch_at(const struct model *model, uint32_t index, struct patch_room *room);

/* Makes a leaf that is not kept. */
void model_make_leaf(const struct model *model, uint32_t number, struct leaf_room *out);

/* How far a patch with `split` auto may be cut (prepare/cut.h). */
struct cut_limit {
  double leaf_time; /* of making a leaf, for each ray of a picture that meets its patch; ns */
  int most;         /* leaves of a patch */
};

/* Makes the model of an object: of the patches of `nets`, which is borrowed for the call, their boxes wider by
 * object->error. */
enum status model_create_object(const struct scene *nets, const struct team *team, const struct cut_limit *limit,
                                struct model_object *object) STATUS_MUST_CHECK;

#endif

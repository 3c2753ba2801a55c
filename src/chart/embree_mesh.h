/* The peer of triangles: every patch is cut into a mesh, which Embree (https://www.embree.org) traces in single
 * precision.
 *
 * For measuring only; pscn never links it. The chart loads it as a module, EMBREE_MODULE_FILE, which is built if
 * PSCN_EMBREE is on and Embree 3 is found. The module has a symbol EMBREE_MODULE_SYMBOL of type struct embree_peer.
 */
#ifndef PSCN_CHART_EMBREE_MESH_H
#define PSCN_CHART_EMBREE_MESH_H

#include <stdbool.h>
#include <stddef.h>

#include "intersect/intersect.h"

#define EMBREE_MODULE_FILE "pscn_embree.so"
#define EMBREE_MODULE_SYMBOL "pscn_embree_peer"

struct embree_mesh;
struct embree_rays; /* rays in Embree's form, rounded to float */

struct embree_peer {
  /* Makes `side` x `side` squares of two triangles for each patch, corners on the patch, on one thread. The hierarchy
   * is of the best quality, or of Embree's default, which is built several times sooner. P[patch][i][j][xyz]. It uses
   * those of the processor's instructions that PSCN_KERNEL leaves pscn. NULL if memory is short or Embree fails. */
  struct embree_mesh *(*mesh_create)(const double (*P)[4][4][3], size_t patch_count, unsigned side, bool best);
  void (*mesh_destroy)(struct embree_mesh *mesh);
  struct embree_rays *(*rays_create)(const struct ray *rays, size_t count);
  void (*rays_destroy)(struct embree_rays *rays);

  /* How many rays together the processor has instructions for: 8 or 16. */
  unsigned (*widest)(const struct embree_mesh *mesh);

  /* Traces all rays in order: one by one (width 1), or 8 or 16 together, declared coherent or not; for the closest hit,
   * or for any. Returns a number made of all answers, so that none can be optimized away. */
  double (*trace)(const struct embree_mesh *mesh, const struct embree_rays *rays, unsigned width, bool coherent,
                  bool any);

  /* The answer to one ray: t of the closest hit, or for `any` a finite one, and the patch of the triangle; INFINITY and
   * HIT_NONE on a miss. */
  void (*answer)(const struct embree_mesh *mesh, const struct embree_rays *rays, size_t index, bool any, double *out_t,
                 uint32_t *out_patch);
};

extern const struct embree_peer pscn_embree_peer;

#endif

/* The peer of triangles: every patch cut into a mesh and traced by Embree (https://www.embree.org), single precision.
 *
 * For measuring only; pscn never links it. The chart loads it with a module, EMBREE_MODULE_FILE, which is built where
 * PSCN_EMBREE is on and Embree 3 is found, and has a symbol EMBREE_MODULE_SYMBOL of type struct embree_peer.
 */
#ifndef PSCN_CHART_EMBREE_MESH_H
#define PSCN_CHART_EMBREE_MESH_H

#include <stdbool.h>
#include <stddef.h>

#include "intersect/intersect.h"

#define EMBREE_MODULE_FILE "pscn_embree.so"
#define EMBREE_MODULE_SYMBOL "pscn_embree_peer"

struct embree_mesh;
struct embree_rays; /* rays as Embree wants them, rounded to float */

struct embree_peer {
  /* `side` x `side` squares of two triangles a patch, corners on the patch, one thread; the hierarchy of the best quality
   * or, several times sooner, of Embree's default. P[patch][i][j][xyz]. Of the processor's instructions it uses those
   * that PSCN_KERNEL leaves pscn. NULL where memory is short or Embree fails. */
  struct embree_mesh *(*mesh_create)(const double (*P)[4][4][3], size_t patch_count, unsigned side, bool best);
  void (*mesh_destroy)(struct embree_mesh *mesh);
  struct embree_rays *(*rays_create)(const struct ray *rays, size_t count);
  void (*rays_destroy)(struct embree_rays *rays);

  /* How many rays together it has the instructions for: 8 or 16. */
  unsigned (*widest)(const struct embree_mesh *mesh);

  /* Traces all rays in order: one by one (width 1), or 8 or 16 together, said to be coherent or not; for the closest
   * hit, or for any. Returns a number made of all answers, so that none can be left out. */
  double (*trace)(const struct embree_mesh *mesh, const struct embree_rays *rays, unsigned width, bool coherent,
                  bool any);

  /* What one ray answers: t of the closest hit, or where `any` will do a finite one, and the patch the triangle is of;
   * INFINITY and HIT_NONE on a miss. */
  void (*answer)(const struct embree_mesh *mesh, const struct embree_rays *rays, size_t index, bool any, double *out_t,
                 uint32_t *out_patch);
};

extern const struct embree_peer pscn_embree_peer;

#endif

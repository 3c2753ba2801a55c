/* The peer of triangles: every patch cut into a mesh and traced by Embree (https://www.embree.org), single precision.
 *
 * For measuring only; pscn itself never links it. Built where PSCN_EMBREE is on and Embree 3 is found.
 */
#ifndef PSCN_CHART_EMBREE_MESH_H
#define PSCN_CHART_EMBREE_MESH_H

#include <stdbool.h>
#include <stddef.h>

#include "intersect/intersect.h"

struct embree_mesh;

/* `side` x `side` squares of two triangles a patch, corners on the patch, one thread, best quality of the hierarchy.
 * P[patch][i][j][xyz]. NULL where memory is short or Embree fails. */
struct embree_mesh *embree_mesh_create(const double (*P)[4][4][3], size_t patch_count, unsigned side);
void embree_mesh_destroy(struct embree_mesh *mesh);

/* Rays as Embree wants them, rounded to float. */
struct embree_rays;
struct embree_rays *embree_rays_create(const struct ray *rays, size_t count);
void embree_rays_destroy(struct embree_rays *rays);

/* Traces all rays in order: one by one (width 1), or 8 together said to be coherent (width 8); for the closest hit,
 * or for any. Returns a number made of all answers, so that none can be left out. */
double embree_trace(const struct embree_mesh *mesh, const struct embree_rays *rays, unsigned width, bool any);

/* What one ray answers: t of the closest hit, and the patch the triangle is of; HIT_NONE on a miss. */
void embree_answer(const struct embree_mesh *mesh, const struct embree_rays *rays, size_t index, double *out_t,
                   uint32_t *out_patch);

/* Whether anything is hit by the ray. */
bool embree_answer_any(const struct embree_mesh *mesh, const struct embree_rays *rays, size_t index);

#endif

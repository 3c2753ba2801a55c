/* The peer of triangles. Embree's documentation is doc/src/api.md in its sources. */
#include "chart/embree_mesh.h"

#include <embree3/rtcore.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "geometry/patch.h"

struct embree_mesh {
  RTCDevice device;
  RTCScene scene;
  unsigned side;
};

/* 8 or 16 rays together are columns of words: of the ray, then of the hit (Embree's accessors of RTCRayN and
 * RTCHitN). */
enum column {
  ORIGIN = 0,
  NEAR = 3,
  DIRECTION = 4,
  TIME = 7,
  FAR = 8,
  MASK = 9,
  ID = 10,
  FLAGS = 11,
  GEOMETRY = 18,
  INSTANCE = 19,
  COLUMNS = 20,
  MOST_TOGETHER = 16
};

struct embree_rays {
  size_t count; /* rounded up to MOST_TOGETHER by repeating the last ray */
  struct RTCRay *ray;
};

static void mesh_point(const double P[4][4][3], double u, double v, float out[3])
{
  double net[4][4];
  for (int axis = 0; axis < 3; axis++) {
    for (int k = 0; k < 16; k++) net[k / 4][k % 4] = P[k / 4][k % 4][axis];
    out[axis] = (float)patch_evaluate(net, u, v).value;
  }
}

static bool mesh_fill(struct embree_mesh *mesh, const double (*P)[4][4][3], size_t patch_count,
                      enum RTCBuildQuality quality)
{
  const size_t side = mesh->side, row = side + 1;
  RTCGeometry geometry = rtcNewGeometry(mesh->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  if (geometry == NULL) return false;
  float *vertex = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof *vertex,
                                          patch_count * row * row);
  unsigned *index = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof *index,
                                            patch_count * side * side * 2);
  if (vertex == NULL || index == NULL) {
    rtcReleaseGeometry(geometry);
    return false;
  }
  for (size_t n = 0; n < patch_count; n++) {
    for (size_t k = 0; k < row * row; k++, vertex += 3)
      mesh_point(P[n], (double)(k / row) / (double)side, (double)(k % row) / (double)side, vertex);
    for (size_t k = 0; k < side * side; k++, index += 6) {
      const unsigned at = (unsigned)(n * row * row + k / side * row + k % side), below = at + (unsigned)row;
      const unsigned corners[6] = {at, below, at + 1, at + 1, below, below + 1};
      for (int c = 0; c < 6; c++) index[c] = corners[c];
    }
  }
  rtcSetGeometryBuildQuality(geometry, quality);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(mesh->scene, geometry);
  rtcReleaseGeometry(geometry);
  return true;
}

static void mesh_destroy(struct embree_mesh *mesh)
{
  if (mesh == NULL) return;
  if (mesh->scene != NULL) rtcReleaseScene(mesh->scene);
  if (mesh->device != NULL) rtcReleaseDevice(mesh->device);
  free(mesh);
}

/* Restricts the instructions to those that PSCN_KERNEL leaves pscn, if it excludes some. */
static RTCDevice device_open(void)
{
  const char *kernel = getenv("PSCN_KERNEL");
  if (kernel == NULL) kernel = "";
  return rtcNewDevice(strcmp(kernel, "avx2") == 0       ? "threads=1,set_affinity=0,isa=avx2"
                      : strcmp(kernel, "baseline") == 0 ? "threads=1,set_affinity=0,isa=sse2"
                                                        : "threads=1,set_affinity=0");
}

static struct embree_mesh *mesh_create(const double (*P)[4][4][3], size_t patch_count, unsigned side, bool best)
{
  const enum RTCBuildQuality quality = best ? RTC_BUILD_QUALITY_HIGH : RTC_BUILD_QUALITY_MEDIUM;
  struct embree_mesh *mesh = calloc(1, sizeof *mesh);
  if (mesh == NULL) return NULL;
  mesh->side = side;
  mesh->device = device_open();
  if (mesh->device != NULL) mesh->scene = rtcNewScene(mesh->device);
  if (mesh->scene == NULL || !mesh_fill(mesh, P, patch_count, quality)) {
    mesh_destroy(mesh);
    return NULL;
  }
  rtcSetSceneBuildQuality(mesh->scene, quality);
  rtcCommitScene(mesh->scene);
  if (rtcGetDeviceError(mesh->device) != RTC_ERROR_NONE) {
    mesh_destroy(mesh);
    return NULL;
  }
  return mesh;
}

static struct embree_rays *rays_create(const struct ray *rays, size_t count)
{
  struct embree_rays *out = calloc(1, sizeof *out);
  const size_t padded = (count + MOST_TOGETHER - 1) / MOST_TOGETHER * MOST_TOGETHER;
  if (out == NULL) return NULL;
  out->ray = aligned_alloc(64, padded * sizeof *out->ray);
  if (out->ray == NULL) {
    free(out);
    return NULL;
  }
  out->count = padded;
  for (size_t k = 0; k < padded; k++) {
    const struct ray *from = &rays[k < count ? k : count - 1];
    const double *o = from->origin, *d = from->direction;
    out->ray[k] = (struct RTCRay){.org_x = (float)o[0],
                                  .org_y = (float)o[1],
                                  .org_z = (float)o[2],
                                  .dir_x = (float)d[0],
                                  .dir_y = (float)d[1],
                                  .dir_z = (float)d[2],
                                  .tnear = (float)from->t_min,
                                  .tfar = (float)from->t_max,
                                  .mask = UINT32_MAX};
  }
  return out;
}

static void rays_destroy(struct embree_rays *rays)
{
  if (rays == NULL) return;
  free(rays->ray);
  free(rays);
}

static struct RTCRayHit single(const struct RTCRay *ray)
{
  struct RTCRayHit hit = {.ray = *ray};
  hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  hit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  return hit;
}

union word {
  float real;
  unsigned integer;
};

static double trace_singles(const struct embree_mesh *mesh, const struct embree_rays *rays, bool any)
{
  struct RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  double sum = 0;
  for (size_t k = 0; k < rays->count; k++) {
    if (any) {
      struct RTCRay ray = rays->ray[k];
      rtcOccluded1(mesh->scene, &context, &ray);
      sum += ray.tfar < 0;
    } else {
      struct RTCRayHit hit = single(&rays->ray[k]);
      rtcIntersect1(mesh->scene, &context, &hit);
      if (hit.hit.geomID != RTC_INVALID_GEOMETRY_ID) sum += (double)hit.ray.tfar;
    }
  }
  return sum;
}

/* Inlined, so that the compiler knows the width. */
__attribute__((always_inline)) static inline double trace_together(const struct embree_mesh *mesh,
                                                                   const struct embree_rays *rays, unsigned width,
                                                                   bool coherent, bool any)
{
  static const int VALID[MOST_TOGETHER]
    __attribute__((aligned(64))) = {-1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1};
  struct RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  double sum = 0;
  for (size_t first = 0; first < rays->count; first += width) {
    union word word[COLUMNS * MOST_TOGETHER] __attribute__((aligned(64)));
    for (unsigned k = 0; k < width; k++) {
      const struct RTCRay *from = &rays->ray[first + k];
      const float values[9] = {from->org_x, from->org_y, from->org_z, from->tnear, from->dir_x,
                               from->dir_y, from->dir_z, 0,           from->tfar};
      for (unsigned c = ORIGIN; c <= FAR; c++) word[c * width + k].real = values[c];
      word[MASK * width + k].integer = UINT32_MAX;
      word[ID * width + k].integer = word[FLAGS * width + k].integer = 0;
      word[GEOMETRY * width + k].integer = word[INSTANCE * width + k].integer = RTC_INVALID_GEOMETRY_ID;
    }
    if (any && width == 8) rtcOccluded8(VALID, mesh->scene, &context, (struct RTCRay8 *)(void *)word);
    else if (any) rtcOccluded16(VALID, mesh->scene, &context, (struct RTCRay16 *)(void *)word);
    else if (width == 8) rtcIntersect8(VALID, mesh->scene, &context, (struct RTCRayHit8 *)(void *)word);
    else rtcIntersect16(VALID, mesh->scene, &context, (struct RTCRayHit16 *)(void *)word);
    for (unsigned k = 0; k < width; k++) {
      const double t = (double)word[FAR * width + k].real;
      if (any) sum += t < 0;
      else if (word[GEOMETRY * width + k].integer != RTC_INVALID_GEOMETRY_ID) sum += t;
    }
  }
  return sum;
}

static double trace(const struct embree_mesh *mesh, const struct embree_rays *rays, unsigned width, bool coherent,
                    bool any)
{
  if (width == 16) return trace_together(mesh, rays, 16, coherent, any);
  if (width == 8) return trace_together(mesh, rays, 8, coherent, any);
  return trace_singles(mesh, rays, any);
}

static unsigned widest(const struct embree_mesh *mesh)
{
  return rtcGetDeviceProperty(mesh->device, RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED) ? 16 : 8;
}

static void answer(const struct embree_mesh *mesh, const struct embree_rays *rays, size_t index, bool any,
                   double *out_t, uint32_t *out_patch)
{
  struct RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  struct RTCRayHit hit = single(&rays->ray[index]);
  if (any) rtcOccluded1(mesh->scene, &context, &hit.ray);
  else rtcIntersect1(mesh->scene, &context, &hit);
  const bool missed = any ? hit.ray.tfar >= 0 : hit.hit.geomID == RTC_INVALID_GEOMETRY_ID;
  *out_t = missed ? INFINITY : any ? 0 : (double)hit.ray.tfar;
  *out_patch = missed || any ? HIT_NONE : hit.hit.primID / (2 * mesh->side * mesh->side);
}

__attribute__((visibility("default"))) const struct embree_peer pscn_embree_peer = {
  mesh_create, mesh_destroy, rays_create, rays_destroy, widest, trace, answer};

// The work of the rivals of src/chart: real operations a camera ray, and parts of patches tried, counted by compiling
// their sources with a counting number. Boxes of the hierarchy are included; comparisons are not counted. Eigenvalues
// alone cost LAPACK about 10 n^3 (dhseqr, of a matrix in Hessenberg form) and 30 n^3 operations (dggev), by G. Golub, C.
// Van Loan, Matrix Computations, 7.5 and 7.7.
//
//     rival_operations SCENE...     CSV on standard output
#include <atomic>
#include <cfloat>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "operations/counted.hpp"

using namespace std; // the atomic types of C

inline counted rint(counted a) { return std::rint(a.value); }
inline counted frexp(counted a, int *exponent) { return std::frexp(a.value, exponent); }

#undef isfinite
#undef isnan
#define double counted
#define volatile

// geometry/patch.h for a class of numbers, which has no vectors.
#define PSCN_GEOMETRY_PATCH_H
struct patch_jet {
  double value, du, dv;
};

static inline void patch_weights(double t, double w[4], double dw[4])
{
  const double s = 1 - t, ss = s * s, tt = t * t, st = s * t;
  w[0] = ss * s, w[1] = 3 * ss * t, w[2] = 3 * st * t, w[3] = tt * t;
  dw[0] = -3 * ss, dw[1] = 3 * (ss - 2 * st), dw[2] = 3 * (2 * st - tt), dw[3] = 3 * tt;
}

static inline struct patch_jet patch_evaluate(double net[4][4], double u, double v)
{
  double wu[4], du[4], wv[4], dv[4];
  struct patch_jet jet = {0, 0, 0};
  patch_weights(u, wu, du), patch_weights(v, wv, dv);
  for (int j = 0; j < 4; j++) {
    double across = 0, across_du = 0;
    for (int i = 0; i < 4; i++) across += wu[i] * net[i][j], across_du += du[i] * net[i][j];
    jet.value += across * wv[j], jet.du += across_du * wv[j], jet.dv += across * dv[j];
  }
  return jet;
}

// Kernels of control points, which no rival uses.
#include "base/kernel.h"
#undef KERNEL_BEST
#define KERNEL_BEST(name) no_kernel
template <class... arguments> static bool no_kernel(arguments...) { return false; }

extern "C" {
#include "base/arena.h"
#include "base/diagnostics.h"
#include "chart/rays.h"
#include "chart/rivals.h"
#include "geometry/bvh.h"
#include "geometry/vector.h"
#include "language/language.h"
}
#include "geometry/patch.c"
#include "chart/rivals.c"
namespace boxes
{
#include "chart/rival_boxes.c"
}
namespace clipping
{
#include "chart/rival_clipping.c"
}
namespace newton
{
#include "chart/rival_newton.c"
}
#ifdef HAVE_LAPACK
#define dhseqr_ counted_dhseqr
#define dggev_ counted_dggev
extern "C" {
#include "chart/rival_eigen.c"
}
#undef dhseqr_
#undef dggev_
#endif
#undef double
#undef volatile

#ifdef HAVE_LAPACK
extern "C" {
void dhseqr_(const char *, const char *, const int *, const int *, const int *, double *, const int *, double *,
             double *, double *, const int *, double *, const int *, int *);
void dggev_(const char *, const char *, const int *, double *, const int *, double *, const int *, double *, double *,
            double *, double *, const int *, double *, const int *, double *, const int *, int *);
}

static double *plain(counted *x) { return reinterpret_cast<double *>(x); }

static long eigen_operations;

void counted_dhseqr(const char *job, const char *compz, const int *n, const int *ilo, const int *ihi, counted *h,
                    const int *ldh, counted *wr, counted *wi, counted *z, const int *ldz, counted *work,
                    const int *lwork, int *info)
{
  eigen_operations += 10L * *n * *n * *n;
  dhseqr_(job, compz, n, ilo, ihi, plain(h), ldh, plain(wr), plain(wi), plain(z), ldz, plain(work), lwork, info);
}

void counted_dggev(const char *jobvl, const char *jobvr, const int *n, counted *a, const int *lda, counted *b,
                   const int *ldb, counted *alphar, counted *alphai, counted *beta, counted *vl, const int *ldvl,
                   counted *vr, const int *ldvr, counted *work, const int *lwork, int *info)
{
  eigen_operations += 30L * *n * *n * *n;
  dggev_(jobvl, jobvr, n, plain(a), lda, plain(b), ldb, plain(alphar), plain(alphai), plain(beta), plain(vl), ldvl,
         plain(vr), ldvr, plain(work), lwork, info);
}
#else
static long eigen_operations;
#endif

enum { WIDTH = 800, HEIGHT = 600, COUNTED_RAYS = 2048 };

static const struct {
  const char *name;
  rival_seek *seek;
} ways[] = {{"Newton from the middle", newton::rival_newton},
            {"Bezier clipping", clipping::rival_clipping},
            {"interval Newton with Krawczyk's test", boxes::rival_krawczyk},
            {"subdivision", boxes::rival_subdivision},
#ifdef HAVE_LAPACK
            {"companion matrix by dhseqr", rival_companion},
            {"Bezout's pencil by dggev", rival_pencil}
#endif
};

static rival_seek *current;
static long parts;

static int counting_seek(counted a[4][4], counted b[4][4], struct rival_root out[RIVAL_ROOTS])
{
  parts++;
  return current(a, b, out);
}

static bool count_scene(const char *path)
{
  struct language_settings settings = {};
  struct diagnostics diagnostics = {};
  struct scene *scene = nullptr;
  struct ray_list rays[RAY_KINDS] = {};
  settings.image_width = WIDTH, settings.image_height = HEIGHT, settings.tolerance = NAN;
  struct arena *arena = arena_create();
  if (arena == nullptr || language_load(path, &settings, &diagnostics, &scene) != STATUS_OK ||
      rays_of_camera(scene, WIDTH, HEIGHT, COUNTED_RAYS, arena, &rays[RAYS_CAMERA]) != STATUS_OK)
    return false;
  struct rivals *rivals = rivals_create(scene, rays);
  for (size_t k = 0; rivals != nullptr && k < sizeof ways / sizeof ways[0]; k++) {
    const struct runner runner = rivals_face(rivals, counting_seek);
    current = ways[k].seek, counter = {}, parts = 0, eigen_operations = 0;
    runner.run(runner.context, RAYS_CAMERA, nullptr);
    const long all = counter.additions + counter.multiplications + counter.divisions + counter.square_roots;
    const double count = (double)rays[RAYS_CAMERA].count;
    printf("%s,%s,%.0f,%.3f\n", path, ways[k].name, (double)(all + eigen_operations) / count, (double)parts / count);
  }
  rivals_destroy(rivals);
  scene_destroy(scene);
  arena_destroy(arena);
  return rivals != nullptr;
}

int main(int argc, char **argv)
{
  printf("scene,method,operations,parts\n");
  for (int k = 1; k < argc; k++)
    if (!count_scene(argv[k])) return 3;
  return argc > 1 ? 0 : 2;
}

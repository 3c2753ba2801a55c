/* Shared by plain_newton.c and plain_newton_kernel.c. The kernel is compiled once per instruction set. */
#ifndef PSCN_CHART_PLAIN_NEWTON_KERNEL_H
#define PSCN_CHART_PLAIN_NEWTON_KERNEL_H

#include "chart/judge.h"
#include "geometry/bvh.h"

struct plain_part {
  uint32_t patch;
  double u, v; /* its middle */
};

struct plain_model {
  double (*x)[3][4][4]; /* control points of each patch, by axis */
  struct plain_part *parts;
  struct bvh bvh; /* over the parts */
};

/* The answers to a packet; if `any`, of any hit. */
typedef void plain_newton_packet(const struct plain_model *model, size_t count, const struct ray *rays, bool any,
                                 struct answer *out);

plain_newton_packet plain_newton_baseline, plain_newton_avx2;

#endif

/* Many rays that leave hits for a point, such as shadow rays, at once. tracer_leave (intersect.h) says where they start
 * and why.
 */
#ifndef PSCN_INTERSECT_LEAVE_H
#define PSCN_INTERSECT_LEAVE_H

#include "intersect/intersect.h"

/* The rays from `count` <= PACKET_SIZE hits of `rays` to a point, from t = 0 to `end`; the point is at t = 1. If a ray
 * would start at the very point, it goes the way from the hit. Returns as bits those with a hit on whose normal's side
 * the point is; the others of `out` mean nothing. */
unsigned tracer_leave_for(struct tracer *tracer, size_t count, const struct ray rays[], const struct hit hits[],
                          const double point[3], double end, struct ray out[]);

/* Internal to src/intersect, between intersect.c and lanes/leave.c: where the rays go, to a point or along a direction,
 * for t up to `end`. They start `longer` times as far back as the hit's clearance asks. */
struct leaving {
  const double *to;
  bool is_point;
  double longer, end;
};

/* As bits, the hits on whose normals' side they go, and those before which another surface may lie: beside a border. */
struct left {
  unsigned facing, beside;
};

typedef struct left leave_some(size_t count, const struct ray rays[], const struct hit hits[], const struct leaving *to,
                               struct ray out[]);
leave_some leave_some_baseline, leave_some_avx2, leave_some_avx512;

#endif

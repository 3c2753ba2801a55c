/* What the solver did for a ray, for channels that show it. */
#ifndef PSCN_RENDER_MEASURE_H
#define PSCN_RENDER_MEASURE_H

#include "intersect/intersect.h"

struct solver_numbers {
  double iterations, roots; /* sums over all candidates of the ray */
  double residual; /* eq 11's ratio for the root nearest to the hit; 0 for a miss, infinite if there is no root */
};

/* As tracer_closest for one ray. */
void measure_ray(struct tracer *tracer, const struct ray *ray, struct hit *out_hit, struct solver_numbers *out_numbers);

#endif

/* Three-vectors as plain arrays double[3]: points, directions, linear RGB colours.
 *
 * All functions are exact up to one rounding per operation; none allocates; all are safe on any thread.
 */
#ifndef PSCN_GEOMETRY_VECTOR_H
#define PSCN_GEOMETRY_VECTOR_H

#include <math.h>

static inline double vector_dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static inline double vector_length(const double a[3]) { return sqrt(vector_dot(a, a)); }

/* out = a - b. out may be a or b. */
static inline void vector_subtract(const double a[3], const double b[3], double out[3])
{
  for (int k = 0; k < 3; k++) out[k] = a[k] - b[k];
}

/* out = a + s b. out may be a or b. */
static inline void vector_add_scaled(const double a[3], double s, const double b[3], double out[3])
{
  for (int k = 0; k < 3; k++) out[k] = a[k] + s * b[k];
}

/* out = s a. out may be a. */
static inline void vector_scale(double s, const double a[3], double out[3])
{
  for (int k = 0; k < 3; k++) out[k] = s * a[k];
}

/* out = a x b, right-handed formula. out must be neither a nor b. */
static inline void vector_cross(const double a[3], const double b[3], double out[3])
{
  out[0] = a[1] * b[2] - a[2] * b[1];
  out[1] = a[2] * b[0] - a[0] * b[2];
  out[2] = a[0] * b[1] - a[1] * b[0];
}

#endif

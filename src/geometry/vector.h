/* Three-vectors as plain arrays double[3]: points, directions, linear RGB colours.
 *
 * All functions are exact up to one rounding per operation; none allocates; all are safe on any thread.
 */
#ifndef PSCN_GEOMETRY_VECTOR_H
#define PSCN_GEOMETRY_VECTOR_H

#include <math.h>

static inline double vector_dot(const double a[3], const double b[3])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Squares within these lose nothing to over- or underflow. */
#define VECTOR_SQUARE_MIN 0x1p-900
#define VECTOR_SQUARE_MAX 0x1p1000

/* |a|, whatever the exponents. */
static inline double vector_length(const double a[3])
{
  const double square = vector_dot(a, a);
  if (square >= VECTOR_SQUARE_MIN && square <= VECTOR_SQUARE_MAX) return sqrt(square);
  const double largest = fmax(fabs(a[0]), fmax(fabs(a[1]), fabs(a[2])));
  if (!(largest > 0 && largest < INFINITY)) return largest;
  int exponent;
  (void)frexp(largest, &exponent);
  const double b[3] = {ldexp(a[0], -exponent), ldexp(a[1], -exponent), ldexp(a[2], -exponent)};
  return ldexp(sqrt(vector_dot(b, b)), exponent);
}

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

/* Complex numbers by hand: the arithmetic of <complex.h> without its library calls for infinities. Internal to
 * src/algebra. */
#ifndef PSCN_ALGEBRA_COMPLEX_NUMBER_H
#define PSCN_ALGEBRA_COMPLEX_NUMBER_H

#include <math.h>

struct complex_number {
  double re, im;
};

/* exp(i), a turn by one radian, an angle that no symmetry shares. */
#define COMPLEX_RADIAN_RE 0.5403023058681398
#define COMPLEX_RADIAN_IM 0.8414709848078965

static inline struct complex_number complex_add(struct complex_number a, struct complex_number b)
{
  return (struct complex_number){a.re + b.re, a.im + b.im};
}

static inline struct complex_number complex_subtract(struct complex_number a, struct complex_number b)
{
  return (struct complex_number){a.re - b.re, a.im - b.im};
}

static inline struct complex_number complex_multiply(struct complex_number a, struct complex_number b)
{
  return (struct complex_number){a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
}

static inline struct complex_number complex_scale(double s, struct complex_number a)
{
  return (struct complex_number){s * a.re, s * a.im};
}

/* a / b; not finite where b is zero. b is scaled by |re| + |im|, so no square overflows or underflows. */
static inline struct complex_number complex_divide(struct complex_number a, struct complex_number b)
{
  const double scale = 1.0 / (fabs(b.re) + fabs(b.im));
  const double re = b.re * scale, im = b.im * scale;
  const double inverse = scale / (re * re + im * im);
  return (struct complex_number){(a.re * re + a.im * im) * inverse, (a.im * re - a.re * im) * inverse};
}

static inline double complex_norm(struct complex_number a) /* |a|^2 */ { return a.re * a.re + a.im * a.im; }

static inline double complex_modulus(struct complex_number a) { return sqrt(complex_norm(a)); }

/* Squares of parts below this may underflow, above it they cannot; times LIFT, parts below it do not overflow. */
#define COMPLEX_SMALL 0x1p-400
#define COMPLEX_LIFT 0x1p600

/* |a| to a few roundings, however small it is. */
static inline double complex_small_modulus(struct complex_number a)
{
  if (fmax(fabs(a.re), fabs(a.im)) >= COMPLEX_SMALL) return complex_modulus(a);
  return complex_modulus(complex_scale(COMPLEX_LIFT, a)) * (1.0 / COMPLEX_LIFT);
}

/* The root with real part >= 0. */
static inline struct complex_number complex_sqrt(struct complex_number a)
{
  const double modulus = hypot(a.re, a.im);
  const double larger = sqrt(0.5 * (modulus + fabs(a.re)));
  if (!(larger > 0.0)) return (struct complex_number){0.0, 0.0};
  const double smaller = 0.5 * fabs(a.im) / larger;
  const double re = a.re >= 0.0 ? larger : smaller, im = a.re >= 0.0 ? smaller : larger;
  return (struct complex_number){re, copysign(im, a.im)};
}

#endif

/* Quadruple precision (113 bits of significand), and bicubic Bernstein nets in it.
 *
 * For tests and the chart; shares nothing with the other rooms. All functions are safe on any thread and allocate
 * nothing.
 */
#ifndef PSCN_REFERENCE_QUAD_H
#define PSCN_REFERENCE_QUAD_H

#include <float.h>

#if defined(__SIZEOF_FLOAT128__)
typedef __float128 quad;
#elif LDBL_MANT_DIG == 113
typedef long double quad;
#else
#error "the reference needs a quadruple-precision type"
#endif

/* Unit roundoffs: the relative error of a rounded operation is at most this. */
#define QUAD_UNIT 0x1p-113
#define DOUBLE_UNIT 0x1p-53

static inline quad quad_abs(quad x) { return x < 0 ? -x : x; }
static inline quad quad_max(quad x, quad y) { return x > y ? x : y; }

/* Square root to a few units in the last place, of a number of any size; 0 for x <= 0. */
quad quad_sqrt(quad x);

/* One coordinate of a bicubic patch: c[i][j] belongs to B_i(u) B_j(v). */
struct quad_net {
  quad c[4][4];
};

/* A value with its first derivatives. */
struct quad_jet {
  quad value, du, dv;
};

/* Largest |c[i][j]|. */
quad quad_net_magnitude(const struct quad_net *net);

/* Value and derivatives at (u,v), by de Casteljau's algorithm. With M the magnitude and u, v within 2^-40 of [0,1], the
 * error of each number is at most QUAD_JET_ROUNDOFFS QUAD_UNIT M: 6 levels of 4 roundings for the value, and a
 * derivative is 3 times a difference of values of degree one less. */
#define QUAD_JET_ROUNDOFFS 160
struct quad_jet quad_net_jet(const struct quad_net *net, quad u, quad v);

/* The net of the part over [u0, u0 + wu] x [v0, v0 + wv]. The error of each point is at most
 * QUAD_RESTRICT_ROUNDOFFS QUAD_UNIT M: two splits of 3 levels of 4 roundings in each direction. */
#define QUAD_RESTRICT_ROUNDOFFS 48
void quad_net_restrict(const struct quad_net *net, quad u0, quad wu, quad v0, quad wv, struct quad_net *out);

#endif

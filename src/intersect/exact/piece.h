/* A piece of a patch as a ray sees it: two polynomials whose common zeros are where the ray's line meets it, and where
 * along the ray that is, in integers.
 *
 * Internal to src/intersect/exact. Pure; safe on any thread.
 *
 * Let k be the axis along which the ray's direction d is longest, i and j the two others, and y = P - o the control
 * points from the ray's origin. The polynomials are the two planes of the ray (paper eq 2),
 *
 *     a = y_i d_k - y_k d_i,   b = y_j d_k - y_k d_j,
 *
 * and w = y_n for some axis n, so t = w / d_n at a root. Doubles are integers times powers of two, so the nets of a, b
 * and w are nets of integers, each times a power of two of its own, and so are those over any part of the patch whose
 * ends are multiples of a power of two: nothing is rounded. But tests work on the same nets in doubles, with a bound on
 * their errors, and pieces are cut in doubles. Where that leaves too few digits a piece is made exact, and its parts
 * begin anew from there.
 */
#ifndef PSCN_INTERSECT_EXACT_PIECE_H
#define PSCN_INTERSECT_EXACT_PIECE_H

#include "intersect/exact/limbs.h"

/* A number may have so many limbs; where one would have more, the search gives up. Coordinates and directions between
 * 1e-100 and 1e100 take 24 at first. */
enum { PIECE_LIMBS_MAX = 64 };

/* Memory for nets, used as a stack; and the work that is left, in quarters of what it takes to examine a piece in doubles,
 * some 1,500 instructions. */
struct pool {
  limb *at;
  size_t room, used;
  int64_t work;
};
enum { WORK_PIECE = 4 };

/* What it takes to make a net of numbers so long, and to multiply it. */
static inline int work_of_net(int limbs) { return limbs + limbs * limbs / 8; }

enum { NET_A, NET_B, NET_W, NETS };

struct piece {
  /* the exact piece that it is a part of: */
  limb *net[NETS];    /* coefficient 4 i + j at net + (4 i + j) limbs; in a pool */
  int limbs[NETS];    /* of each coefficient */
  int bits[NETS];     /* |coefficient| <= 2^bits; 0 if all are 0 */
  int exponent[NETS]; /* the polynomials are the integers times 2^exponent */
  /* which part, in u and v: [from, from + length] / 2^log2; if it is all, the piece is exact */
  limb from[2], length[2];
  int log2[2];
  /* the piece itself: */
  wide low[2], size[2];     /* it is [low, low + size] of the patch's u and v, to WIDE_ROUNDOFF; exactly above 2^-64 */
  unsigned borders;         /* of the patch, on which the piece's own borders lie: bits as of geometry/edges.h */
  double value[NETS][4][4]; /* nets of a, b and w - start over the piece, times powers of two, at most 1 in size */
  double error[NETS];       /* of value */
  int scale;                /* w is start + value[NET_W] 2^scale */
  double start;             /* off by less than its last place */
};

static inline bool piece_is_exact(const struct piece *piece) { return piece->log2[0] == 0 && piece->log2[1] == 0; }

/* An exact piece's */
#define PIECE_ERROR 0x1p-53

/* How far outside a piece its polynomials are used, in its parameters. There, a polynomial of degree 3 in one parameter
 * and 2 in the other, so a derivative, is at most PIECE_GROWTH = (1 + 2/16)^5 times as large as its coefficients, and
 * errors of values at most 2.03 = (1 + 2/16)^6 times as large as theirs. */
#define PIECE_MARGIN 0.0625
#define PIECE_GROWTH 1.81
#define PIECE_MARGIN_OFF 2.03

/* Takes memory for a net of so many limbs a coefficient. NULL if there is none, or the numbers are too long. */
limb *pool_net(struct pool *pool, int limbs);

/* Coefficient c of a net of an exact piece, with its exponent, as by limbs_wide. */
wide piece_coefficient(const struct piece *piece, int k, int c, bool *exact);

/* Sets bits, value, error and scale of an exact piece after its nets have been set. */
void piece_measure(struct piece *piece);

/* Makes the piece exact, on top of the pool. False if there is no room. */
bool piece_exact(struct piece *piece, struct pool *pool);

/* The part [from, to] / 2^log2 of the piece along u (axis 0) or v (axis 1), from < to <= 2^log2, log2 at most 40, to -
 * from at most 2^16. The piece may have to be made exact first; false if there is no room for that. */
bool piece_part(struct piece *piece, int axis, limb from, limb to, int log2, struct pool *pool, struct piece *out);

/* The part that holds the box [box[0][0], box[0][1]] x [box[1][0], box[1][1]], as far as that lies in the piece, with
 * its ends rounded outwards to an eighth of its length, but no further than to 2^-BOX_BITS. */
enum { BOX_BITS = 40 };
bool piece_box(struct piece *piece, const double box[2][2], struct pool *pool, struct piece *out);

/* Whether a or b keeps one sign on the piece: then it has no root. */
bool piece_misses(const struct piece *piece);

/* Whether a and b are 0 in the piece's corner at u = iu, v = iv, each 0 or 1; it is then exact. */
bool piece_corner_root(struct piece *piece, int iu, int iv, struct pool *pool);

/* The axis along which a and b change more. */
int piece_longer(const struct piece *piece);

enum piece_verdict {
  PIECE_EMPTY, /* no root in the piece, its borders included */
  PIECE_ROOT,  /* exactly one root within PIECE_MARGIN of it; it is in the piece or within its radius of it, which is no
                * more than half of that */
  PIECE_OPEN
};

/* A root, in parameters of the piece: `at` is off by at most `radius`, the same for both. */
struct piece_root {
  double at[2], radius;
  double box[2][2]; /* of an open piece: no root is outside of [box[k][0], box[k][1]] in u, v; always set */
};

/* Decides the piece by two combinations of a and b that aim along its parameters: the rows of the adjugate of the
 * Jacobian in the middle, so each has nearly no derivative by one of the parameters there. If one keeps its sign there
 * is no root. If, divided by its derivative in the middle, each has a Jacobian within `contraction` < 1 of the identity
 * all over the piece and its margin, in the maximum norm, then x -> x - F(x) contracts: there is at most one root, and
 * one within |F(x)| / (1 - contraction) of any x if that ball lies in the margin (Banach). The piece is made exact if
 * that takes more digits: a few to decide it, or, if `fine`, those that a small radius takes. */
enum piece_verdict piece_root(struct piece *piece, bool fine, struct pool *pool, struct piece_root *out);

/* w at a point of the piece, which is exact, known to within `radius` in both parameters. *error: absolute bound on what
 * it is off. If that is 0 and *exact is set, w is this number; if *exact is not set, it is larger by less than the last
 * place. */
wide piece_depth(const struct piece *piece, const double at[2], double radius, double *error, bool *exact);

/* Whether w changes all along every curve on which a (b, if a is 0 all over) is zero: their Jacobian is not singular. */
bool piece_depth_turns(struct piece *piece, struct pool *pool);

/* The net of w less its first coefficient, `limbs` long each, which takes one bit more than w. */
void piece_depth_changes(const struct piece *piece, int limbs, limb *out);

/* Bounds of w on the piece. */
void piece_depths(const struct piece *piece, double *least, double *most);

/* An integer. */
struct weight {
  const limb *at;
  int limbs;
};

/* The integers' net p a - q b, exponents left aside, in memory of the pool; NULL if there is no room. */
limb *piece_combine(const struct piece *piece, struct weight p, struct weight q, struct pool *pool, int *out_limbs);

/* A net of 16 such integers as doubles: times a power of two, so that the largest is 1/2 to 1, off by PIECE_ERROR. A
 * coefficient below 0 stays so, and one that is 0 or less does not become positive. Returns the bits of the largest. */
int net_round(const limb *net, int limbs, double out[4][4]);

#endif

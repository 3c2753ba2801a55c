/* See cycle_nets.h. */
#include "accuracy/cycle_nets.h"

#include <math.h>
#include <string.h>

#include "accuracy/generate.h"
#include "accuracy/models.h"

typedef double net[4][4][3];

/* ---- how the points of a net are strewn ---- */

enum strew { STREW_GENTLE, STREW_WILD, STREW_WHOLE, STREW_GRADED, STREWS };

/* A point near to (x,y,z), or anywhere. */
static void point(struct random *random, enum strew strew, double x, double y, double z, double out[3])
{
  const double at[3] = {x, y, z};
  for (int axis = 0; axis < 3; axis++) {
    switch (strew) {
    case STREW_GENTLE: out[axis] = at[axis] + 0.3 * random_between(random, -1, 1); break;
    case STREW_WILD: out[axis] = random_between(random, -2, 2); break;
    case STREW_WHOLE: out[axis] = (double)((int)choose(random, 7) - 3); break;
    default: out[axis] = at[axis] * random_decade(random, 0, 9) + random_decade(random, 0, 9); break;
    }
  }
}

static void sheet(struct random *random, enum strew strew, double height, net P)
{
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++) {
      const bool inner = i % 3 && j % 3;
      point(random, strew, i - 1.5, j - 1.5, inner ? height : 0, P[i][j]);
    }
}

/* Another sheet with the same borders. */
static void lid(struct random *random, enum strew strew, double height, const net base, net P)
{
  sheet(random, strew, height, P);
  for (int k = 0; k < 16; k++)
    if (k / 4 % 3 == 0 || k % 4 % 3 == 0) memcpy(P[k / 4][k % 4], base[k / 4][k % 4], sizeof P[0][0]);
}

/* The halves of a net along u, exact if the coordinates are whole numbers of few bits. */
static void halve(const net P, net low, net high)
{
  for (int k = 0; k < 12; k++) {
    const int j = k / 3, axis = k % 3;
    const double p = P[0][j][axis], q = P[1][j][axis], r = P[2][j][axis], s = P[3][j][axis];
    low[0][j][axis] = p, low[1][j][axis] = (p + q) / 2, low[2][j][axis] = (p + 2 * q + r) / 4;
    low[3][j][axis] = high[0][j][axis] = (p + 3 * q + 3 * r + s) / 8;
    high[1][j][axis] = (q + 2 * r + s) / 4, high[2][j][axis] = (r + s) / 2, high[3][j][axis] = s;
  }
}

static void reverse(net P)
{
  net old;
  memcpy(old, P, sizeof old);
  in_order(old, 2, P);
}

/* ---- shapes ---- */

/* Two sheets with the same borders. */
static void pillow(struct random *random, enum strew strew, struct cycle *out)
{
  out->count = 2;
  sheet(random, strew, 1, out->P[0]), lid(random, strew, -1, (const double(*)[4][3])out->P[0], out->P[1]);
}

/* A pillow with one sheet in two or three parts, whose corners lie within borders of others. */
static void tees(struct random *random, enum strew strew, struct cycle *out)
{
  net whole, halves[2];
  pillow(random, strew, out);
  for (int n = 0; n < 2; n++)
    for (int k = 0; k < 48; k++) {
      double *x = &out->P[n][k / 12][k / 3 % 4][k % 3];
      *x = nearbyint(ldexp(*x, 20)); /* so that halving is exact */
    }
  memcpy(whole, out->P[1], sizeof whole);
  halve((const double(*)[4][3])whole, halves[0], halves[1]);
  memcpy(out->P[1], halves[0], sizeof whole), memcpy(out->P[2], halves[1], sizeof whole);
  out->count = 3;
  if (choose(random, 2)) return;
  transpose(halves[1]);
  halve((const double(*)[4][3])halves[1], out->P[2], out->P[3]);
  out->count = 4;
}

/* Two pillows with a border in common: four patches meet there. */
static void book(struct random *random, enum strew strew, struct cycle *out)
{
  struct cycle other;
  pillow(random, strew, out), pillow(random, strew, &other);
  for (int n = 0; n < 2; n++) {
    memcpy(other.P[n][0], out->P[0][3], sizeof other.P[n][0]);
    memcpy(out->P[2 + n], other.P[n], sizeof other.P[n]);
  }
  out->count = 4;
}

/* A pillow, and a sheet that is there twice. */
static void twice(struct random *random, enum strew strew, struct cycle *out)
{
  pillow(random, strew, out);
  sheet(random, strew, 2, out->P[2]), memcpy(out->P[3], out->P[2], sizeof out->P[3]);
  out->count = 4;
}

/* Gores between two poles. */
static void gores(struct random *random, enum strew strew, struct cycle *out)
{
  double poles[2][3], side[CYCLE_MOST][2][3];
  out->count = 2 + choose(random, 5);
  for (int n = 0; n < 2; n++) point(random, strew, 0, 0, n ? -1.5 : 1.5, poles[n]);
  for (size_t n = 0; n < out->count; n++)
    for (int k = 0; k < 2; k++) {
      const double turn = 6.283185307179586 * (double)n / (double)out->count;
      point(random, strew, 2 * cos(turn), 2 * sin(turn), 1 - 2 * k, side[n][k]);
    }
  for (size_t n = 0; n < out->count; n++) {
    sheet(random, strew, 1, out->P[n]);
    for (int j = 0; j < 4; j++) {
      memcpy(out->P[n][0][j], poles[0], sizeof poles[0]), memcpy(out->P[n][3][j], poles[1], sizeof poles[1]);
      const size_t at = j == 3 ? (n + 1) % out->count : n;
      for (int k = 0; k < 2; k++) {
        double *p = out->P[n][1 + k][j];
        if (j % 3 == 0) memcpy(p, side[at][k], sizeof side[at][k]);
        else
          for (int axis = 0; axis < 3; axis++) p[axis] += side[at][k][axis];
      }
    }
  }
}

/* One patch that closes upon itself; its other borders are points. */
static void bag(struct random *random, enum strew strew, struct cycle *out)
{
  static const double across[4][2] = {{0, -1.5}, {4, 1.5}, {-4, 1.5}, {0, -1.5}};
  out->count = 1;
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++) {
      double *p = out->P[0][i][j];
      point(random, strew, across[i][0], across[i][1], j - 1.5, p);
      if (i == 3) memcpy(p, out->P[0][0][j], sizeof out->P[0][0][j]);
      if (j % 3 == 0) memcpy(p, out->P[0][0][j], sizeof out->P[0][0][j]);
    }
}

/* Six patches round a cube. */
static void box(struct random *random, enum strew strew, struct cycle *out)
{
  double grid[4][4][4][3];
  for (int k = 0; k < 64; k++)
    point(random, strew, k / 16 - 1.5, k / 4 % 4 - 1.5, k % 4 - 1.5, grid[k / 16][k / 4 % 4][k % 4]);
  out->count = 6;
  for (int face = 0; face < 6; face++)
    for (int k = 0; k < 16; k++) {
      int at[3];
      at[face / 2] = face % 2 * 3, at[(face / 2 + 1) % 3] = k / 4, at[(face / 2 + 2) % 3] = k % 4;
      memcpy(out->P[face][k / 4][k % 4], grid[at[0]][at[1]][at[2]], sizeof grid[0][0][0]);
    }
}

/* A pillow, and within it a far smaller bag or gores. */
static void speck(struct random *random, enum strew strew, struct cycle *out)
{
  struct cycle small;
  pillow(random, strew, out);
  if (choose(random, 2)) gores(random, strew, &small);
  else bag(random, strew, &small);
  const double size = random_decade(random, 2, 10);
  for (size_t n = 0; n < small.count; n++) {
    for (int k = 0; k < 48; k++) small.P[n][k / 12][k / 3 % 4][k % 3] *= size;
    memcpy(out->P[out->count++], small.P[n], sizeof small.P[n]);
  }
}

static const struct {
  const char *name;
  void (*make)(struct random *random, enum strew strew, struct cycle *out);
} shapes[] = {{"pillow", pillow}, {"box", box},   {"gores", gores}, {"bag", bag},
              {"tees", tees},     {"book", book}, {"twice", twice}, {"speck", speck}};

size_t cycle_shape_count(void) { return sizeof shapes / sizeof shapes[0]; }
const char *cycle_shape_name(size_t shape) { return shapes[shape].name; }
bool cycle_shape_moves(size_t shape) { return shapes[shape].make != tees; }

/* ---- in space ---- */

/* Makes it thin along an axis, skew, turned and shifted. The map is the same for every point, so equal points stay
 * equal. */
static void lay(struct random *random, struct cycle *cycle)
{
  struct placement placement;
  const double scale = choose(random, 2) ? 1 : random_decade(random, -6, 6);
  const double thin = choose(random, 2) ? 1 : random_decade(random, 1, 15);
  const double skew = choose(random, 3) ? 0 : random_decade(random, -6, 0);
  const size_t axis = choose(random, 3);
  const bool turned = choose(random, 2);
  placement_random(random, scale, choose(random, 2) ? scale * random_decade(random, -6, 3) : 0, &placement);
  for (size_t n = 0; n < cycle->count; n++)
    for (int k = 0; k < 16; k++) {
      double *p = cycle->P[n][k / 4][k % 4];
      p[axis] *= thin;
      p[(axis + 1) % 3] += skew * p[axis];
      if (turned) placement_apply(&placement, p, p);
    }
}

void cycle_make(size_t shape, struct random *random, struct cycle *out)
{
  const enum strew strew = (enum strew)choose(random, STREWS);
  shapes[shape].make(random, strew, out);
  if (cycle_shape_moves(shape) && choose(random, 2)) lay(random, out);
  for (size_t n = 0; n < out->count; n++) {
    if (choose(random, 2)) transpose(out->P[n]);
    if (choose(random, 2)) reverse(out->P[n]);
    if (choose(random, 2)) transpose(out->P[n]);
  }
}

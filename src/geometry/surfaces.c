/* Finds patches of one surface by a table of all nets. A net is looked up by its four inner control points, which stay
 * together in the middle in whatever order it is read, and by its plane if it lies in one: open addressing with linear
 * probing (Knuth, The Art of Computer Programming 3, 6.4, algorithm L). */
#include "geometry/edges.h"

#include <stdbool.h>

#include "base/memory.h"
#include "base/real.h"
#include "geometry/patch.h"

/* At most this many places of the table are examined for one net. As half of them are free, it takes a few, except in a
 * made-up scene, which must not take long either. */
enum { MOST_PLACES = 64 };

/* A place of the table. */
struct place {
  uint32_t net; /* counted from 1; 0 for a free place */
  uint32_t tag; /* bits of the hash */
};

/* The eight orders: a net or its transpose, with one parameter or both reversed, or none. */
enum { TRANSPOSED = 1, U_REVERSED = 2, V_REVERSED = 4, ORDERS = 8 };

static bool equal_as(const double P[48], const double Q[48], int order)
{
  for (int n = 0; n < 16; n++) {
    int i = n / 4, j = n % 4;
    if (order & TRANSPOSED) i = n % 4, j = n / 4;
    if (order & U_REVERSED) i = 3 - i;
    if (order & V_REVERSED) j = 3 - j;
    const double *p = P + 12 * i + 3 * j, *q = Q + 3 * n;
    if (p[0] != q[0] || p[1] != q[1] || p[2] != q[2]) return false;
  }
  return true;
}

static bool are_twins(const double P[48], const double Q[48])
{
  for (int order = 0; order < ORDERS; order++)
    if (equal_as(P, Q, order)) return true;
  return false;
}

/* The axis across which the net lies in a plane, or -1. */
static int flat_axis(const double P[48])
{
  for (int axis = 0; axis < 3; axis++) {
    int n = 1;
    while (n < 16 && P[3 * n + axis] == P[axis]) n++;
    if (n == 16) return axis;
  }
  return -1;
}

static bool in_one_plane(const double P[48], const double Q[48])
{
  const int axis = flat_axis(P);
  return axis >= 0 && axis == flat_axis(Q) && P[axis] == Q[axis];
}

static uint64_t mixed(uint64_t x)
{
  x = (x ^ x >> 32) * UINT64_C(0x9e3779b97f4a7c15);
  return x ^ x >> 29;
}

/* The same in any order of the points: a sum over them. */
static uint64_t inner_hash(const double P[48])
{
  uint64_t hash = 0;
  for (int n = 0; n < 4; n++) {
    uint64_t point = 0;
    for (int c = 0; c < 3; c++) /* of -0 the bits of 0 */
      point = mixed(point + real_bits(P[12 * (1 + n / 2) + 3 * (1 + n % 2) + c] + 0.0));
    hash += point;
  }
  return mixed(hash);
}

/* Of a net in a plane: the same for all nets in it. */
static uint64_t plane_hash(const double P[48], int axis)
{
  return mixed(mixed(real_bits(P[axis] + 0.0)) + (unsigned)axis);
}

struct table {
  const void *nets;
  size_t stride, places;
  struct place *at;
};

typedef bool same_net(const double P[48], const double Q[48]);

/* Counted from 1, the first net with that hash that is the same as net p; 0 if there is none, and then p is placed. */
static uint32_t first_of(const struct table *table, size_t p, uint64_t hash, same_net *same)
{
  const double *net = net_at(table->nets, table->stride, p);
  size_t at = (size_t)((hash >> 32) * table->places >> 32);
  for (int n = 0; n < MOST_PLACES; n++, at = at + 1 < table->places ? at + 1 : 0) {
    struct place *place = &table->at[at];
    if (place->net == 0) {
      *place = (struct place){(uint32_t)p + 1, (uint32_t)hash};
      return 0;
    }
    if (place->tag == (uint32_t)hash && same(net_at(table->nets, table->stride, place->net - 1), net))
      return place->net;
  }
  return 0;
}

enum status surfaces_find(const void *nets, size_t stride, size_t count, uint32_t out[])
{
  if (count >= UINT32_MAX / 8) return STATUS_LIMIT;
  struct table table = {nets, stride, 4 * count + 1, NULL};
  table.at = memory_alloc(table.places, sizeof *table.at);
  if (!table.at) return STATUS_LIMIT;
  for (size_t p = 0; p < count; p++) {
    const double *net = net_at(nets, stride, p);
    const int axis = flat_axis(net);
    const uint32_t twin = first_of(&table, p, inner_hash(net), are_twins);
    out[p] = 0;
    if (twin) {
      if (!out[twin - 1]) out[twin - 1] = twin;
      out[p] = out[twin - 1] | SURFACE_AGAIN;
    } else if (axis >= 0) {
      const uint32_t first = first_of(&table, p, plane_hash(net, axis), in_one_plane);
      out[p] = (uint32_t)(axis + 1) << 29 | (first ? first : (uint32_t)p + 1);
    }
  }
  memory_free(table.at);
  return STATUS_OK;
}

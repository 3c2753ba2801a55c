/* Finds equal nets by a table of all nets, looked up by their four inner control points, which stay together in the
 * middle in whatever order the net is read: open addressing with linear probing (Knuth, The Art of Computer Programming
 * 3, 6.4, algorithm L). */
#include "geometry/twins.h"

#include <stdint.h>

#include "base/memory.h"
#include "base/real.h"
#include "geometry/patch.h"

/* At most this many places of the table are examined for one net. As half of them are free, it takes a few, except in a
 * made-up scene, which must not take long either. */
enum { MOST_PLACES = 64 };

/* A net is looked up this many nets after its place is fetched from memory. */
enum { AHEAD = 16 };

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

bool net_equal(double P[4][4][3], double Q[4][4][3]) { return equal_as((const double *)P, (const double *)Q, 0); }

static bool are_twins(const double P[48], const double Q[48])
{
  for (int order = 0; order < ORDERS; order++)
    if (equal_as(P, Q, order)) return true;
  return false;
}

bool net_twins(double P[4][4][3], double Q[4][4][3]) { return are_twins((const double *)P, (const double *)Q); }

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

/* Where a net's search begins. */
static size_t home(uint64_t hash, size_t places) { return (size_t)((hash >> 32) * places >> 32); }

/* Whether net p has an earlier twin; if not, it is placed. */
static bool meets_twin(const void *nets, size_t stride, size_t p, uint64_t hash, struct place table[], size_t places)
{
  size_t at = home(hash, places);
  for (int n = 0; n < MOST_PLACES; n++, at = at + 1 < places ? at + 1 : 0) {
    struct place *place = &table[at];
    if (place->net == 0) {
      *place = (struct place){(uint32_t)p + 1, (uint32_t)hash};
      return false;
    }
    if (place->tag == (uint32_t)hash && are_twins(net_at(nets, stride, place->net - 1), net_at(nets, stride, p)))
      return true;
  }
  return false;
}

enum status twins_find(const void *nets, size_t stride, size_t count, bool out[])
{
  if (count >= UINT32_MAX / 4) return STATUS_LIMIT;
  const size_t places = 2 * count + 1;
  struct place *table = memory_alloc(places, sizeof *table);
  if (!table) return STATUS_LIMIT;
  uint64_t hash[AHEAD];
  for (size_t p = 0; p < count + AHEAD; p++) {
    if (p >= AHEAD) out[p - AHEAD] = meets_twin(nets, stride, p - AHEAD, hash[p % AHEAD], table, places);
    if (p >= count) continue;
    hash[p % AHEAD] = inner_hash(net_at(nets, stride, p));
    __builtin_prefetch(&table[home(hash[p % AHEAD], places)]);
  }
  memory_free(table);
  return STATUS_OK;
}

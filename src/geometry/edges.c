/* Finds shared borders and surfaces by tables with open addressing and linear probing (Knuth, The Art of Computer
 * Programming 3, 6.4, algorithm L). */
#include "geometry/edges.h"

#include <stdatomic.h>
#include <string.h>
#include <sys/random.h>

#include "base/memory.h"
#include "base/real.h"
#include "geometry/patch.h"

struct slot {
  uint32_t first; /* border or net of its kind, counted from 1; 0 for a free slot */
  uint32_t tag;   /* bits of the hash */
};

/* ---- borders, looked up by their control points. Each thread has its own part of the table, and enters the borders that
 * belong there. Slots are chosen by a hash with random keys, or a made-up scene could have all of its borders in one of
 * them; which patches share which borders does not depend on the keys. ---- */

struct border {
  double point[4][3]; /* in the direction that sorts first */
  bool reversed;      /* against the running parameter */
};

/* In a slot's `first`: more than two borders have its points. */
#define MANY (UINT32_C(1) << 31)

static const struct edge_neighbour alone = {EDGE_NONE, 0, false};

/* Two for each number of a border, and one more. */
enum { KEYS = 2 * 12 + 1 };

/* What the threads share. They write to their own slots and to what belongs to the borders in them. */
struct matching {
  const char *nets;
  size_t stride, count;
  const uint32_t *surface;
  size_t workers;
  uint64_t key[KEYS];
  uint64_t *hash; /* [4 * patch + border] */
  struct slot *slots;
  size_t slot_count;
  atomic_bool overflowed; /* a worker's part of the slots has no room for its borders */
  struct edge_neighbour *out;
};

/* Control point k of a border of this net. */
static const double *border_point(const double *net, int border, int k) { return net + 3 * edge_at(border, k); }

void edge_points(double P[4][4][3], int border, double out[4][3])
{
  for (int k = 0; k < 4; k++) memcpy(out[k], border_point(&P[0][0][0], border, k), sizeof out[k]);
}

static int compare_numbers(const double *a, const double *b, size_t count)
{
  for (size_t k = 0; k < count; k++)
    if (a[k] != b[k]) return a[k] < b[k] ? -1 : 1;
  return 0;
}

static struct border border_of(const struct matching *m, size_t index)
{
  struct border b;
  const double *net = net_at(m->nets, m->stride, index / 4);
  double points[4][3], back[4][3];
  for (int k = 0; k < 4; k++) {
    const double *p = border_point(net, (int)(index % 4), k);
    memcpy(points[k], p, sizeof points[k]), memcpy(back[3 - k], p, sizeof back[k]);
  }
  b.reversed = compare_numbers(&back[0][0], &points[0][0], 12) < 0;
  memcpy(b.point, b.reversed ? back : points, sizeof b.point);
  return b;
}

/* Whether the four points of a border are one. */
static bool collapsed(const double *points)
{
  for (int k = 1; k < 4; k++)
    if (compare_numbers(points + 3 * k, points, 3)) return false;
  return true;
}

bool edge_is_point(double P[4][4][3], int border)
{
  double point[4][3];
  edge_points(P, border, point);
  return collapsed(&point[0][0]);
}

/* The same for equal numbers, although there are two zeros. With keys that nobody knows, the upper halves of any two
 * borders' hashes are equal once in 2^32 times (Lemire and Kaser, Strongly universal string hashing is fast, 2014:
 * multilinear). */
static uint64_t border_hash(const struct border *b, const uint64_t key[KEYS])
{
  uint64_t hash = key[KEYS - 1];
  for (int k = 0; k < 12; k++) {
    const uint64_t bits = real_bits(b->point[k / 3][k % 3] + 0.0); /* of -0 those of 0 */
    hash += key[2 * k] * (uint32_t)bits + key[2 * k + 1] * (bits >> 32);
  }
  return hash;
}

/* Without random numbers, keys that are as good for scenes that nobody made to be slow. */
static void choose_keys(uint64_t key[KEYS])
{
  const size_t size = KEYS * sizeof *key;
  if (getrandom(key, size, 0) == (ssize_t)size) return;
  for (uint64_t k = 0; k < KEYS; k++) key[k] = (2 * k + 1) * UINT64_C(0x9e3779b97f4a7c15);
}

/* Where the worker's share of `count` things begins. */
static size_t share(const struct matching *m, size_t worker, size_t count)
{
  return count / m->workers * worker + count % m->workers * worker / m->workers;
}

static enum status hash_borders(void *context, size_t worker)
{
  struct matching *m = context;
  const size_t end = share(m, worker + 1, 4 * m->count);
  for (size_t k = share(m, worker, 4 * m->count); k < end; k++) {
    const struct border b = border_of(m, k);
    m->hash[k] = border_hash(&b, m->key);
    m->out[k] = alone;
  }
  return STATUS_OK;
}

/* Enters one more border with the points of the first one in this slot. */
static void meet(struct matching *m, struct slot *slot, size_t index, const struct border *b,
                 const struct border *first)
{
  const size_t k = slot->first - 1;
  struct edge_neighbour *here = &m->out[k];
  if (collapsed(&first->point[0][0])) return;
  if (here->patch != EDGE_NONE) {
    struct edge_neighbour *second = &m->out[4 * (size_t)here->patch + here->border];
    *second = *here = alone;
    slot->first |= MANY;
    return;
  }
  const bool reversed = b->reversed != first->reversed;
  *here = (struct edge_neighbour){(uint32_t)(index / 4), (uint8_t)(index % 4), reversed};
  m->out[index] = (struct edge_neighbour){(uint32_t)(k / 4), (uint8_t)(k % 4), reversed};
}

/* Puts the border into one of `count` slots; false if all are taken. */
static bool place_border(struct matching *m, size_t index, struct slot *slots, size_t count, size_t home)
{
  const uint32_t tag = (uint32_t)m->hash[index];
  for (size_t k = 0; k < count; k++, home = home + 1 < count ? home + 1 : 0) {
    struct slot *slot = &slots[home];
    if (slot->first == 0) {
      *slot = (struct slot){(uint32_t)index + 1, tag};
      return true;
    }
    if (slot->tag != tag) continue;
    const struct border b = border_of(m, index), first = border_of(m, (slot->first & ~MANY) - 1);
    if (compare_numbers(&first.point[0][0], &b.point[0][0], 12)) continue;
    if (!(slot->first & MANY)) meet(m, slot, index, &b, &first);
    return true;
  }
  return false;
}

static enum status match_borders(void *context, size_t worker)
{
  struct matching *m = context;
  const size_t begin = share(m, worker, m->slot_count), end = share(m, worker + 1, m->slot_count);
  for (size_t k = 0; k < 4 * m->count; k++) {
    const size_t home = (size_t)((m->hash[k] >> 32) * m->slot_count >> 32);
    if (home < begin || home >= end || (m->surface && m->surface[k / 4] & SURFACE_AGAIN)) continue;
    if (!place_border(m, k, m->slots + begin, end - begin, home - begin)) {
      atomic_store(&m->overflowed, true);
      break;
    }
  }
  return STATUS_OK;
}

enum status edges_match(const void *nets, size_t stride, size_t count, const uint32_t surface[],
                        const struct team *team, struct edge_neighbour *out)
{
  if (count == 0) return STATUS_OK;
  if (count >= MANY / 4) return STATUS_LIMIT;
  struct matching m = {.nets = nets,
                       .stride = stride,
                       .count = count,
                       .surface = surface,
                       .workers = team_count(team),
                       .slot_count = 6 * count,
                       .out = out};
  choose_keys(m.key);
  m.hash = memory_alloc(count, 4 * sizeof *m.hash);
  m.slots = memory_alloc(m.slot_count, sizeof *m.slots);
  enum status status = m.hash && m.slots ? team_run(team, m.workers, hash_borders, &m) : STATUS_LIMIT;
  if (status == STATUS_OK) status = team_run(team, m.workers, match_borders, &m);
  if (status == STATUS_OK && atomic_load(&m.overflowed)) { /* by chance, or malice: the whole table has enough room */
    memset(m.slots, 0, m.slot_count * sizeof *m.slots);
    m.workers = 1;
    (void)hash_borders(&m, 0);
    status = match_borders(&m, 0);
  }
  memory_free(m.hash);
  memory_free(m.slots);
  return status;
}

/* ---- surfaces. A net is looked up by its four inner control points, which stay together in the middle in whatever order
 * it is read, and by its plane if it lies in one. ---- */

/* At most this many slots of the table are examined for one net. As half of them are free, it takes a few, except in a
 * made-up scene, which must not take long either. */
enum { MOST_SLOTS = 64 };

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
  size_t stride, count;
  struct slot *slots;
};

typedef bool same_net(const double P[48], const double Q[48]);

/* Counted from 1, the first net with that hash that is the same as net p; 0 if there is none, and then p is placed. */
static uint32_t first_of(const struct table *table, size_t p, uint64_t hash, same_net *same)
{
  const double *net = net_at(table->nets, table->stride, p);
  size_t at = (size_t)((hash >> 32) * table->count >> 32);
  for (int n = 0; n < MOST_SLOTS; n++, at = at + 1 < table->count ? at + 1 : 0) {
    struct slot *slot = &table->slots[at];
    if (slot->first == 0) {
      *slot = (struct slot){(uint32_t)p + 1, (uint32_t)hash};
      return 0;
    }
    if (slot->tag == (uint32_t)hash && same(net_at(table->nets, table->stride, slot->first - 1), net))
      return slot->first;
  }
  return 0;
}

enum status surfaces_find(const void *nets, size_t stride, size_t count, uint32_t out[])
{
  if (count >= UINT32_MAX / 8) return STATUS_LIMIT;
  struct table table = {nets, stride, 4 * count + 1, NULL};
  table.slots = memory_alloc(table.count, sizeof *table.slots);
  if (!table.slots) return STATUS_LIMIT;
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
  memory_free(table.slots);
  return STATUS_OK;
}

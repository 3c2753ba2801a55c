/* Shared borders, by sorting all borders by their control points. */
#include "geometry/edges.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

struct border {
  double point[4][3]; /* in the direction that sorts first */
  uint32_t patch;
  uint8_t border;
  bool reversed; /* against the running parameter */
};

void edge_points(double P[4][4][3], int border, double out[4][3])
{
  for (int k = 0; k < 4; k++) {
    const double *p = border == 0 ? P[0][k] : border == 1 ? P[3][k] : border == 2 ? P[k][0] : P[k][3];
    memcpy(out[k], p, 3 * sizeof *p);
  }
}

static int compare_numbers(const double *a, const double *b, size_t count)
{
  for (size_t k = 0; k < count; k++)
    if (a[k] != b[k]) return a[k] < b[k] ? -1 : 1;
  return 0;
}

static int compare_borders(const void *a, const void *b)
{
  const struct border *x = a, *y = b;
  const int order = compare_numbers(&x->point[0][0], &y->point[0][0], 12);
  if (order) return order;
  const uint64_t i = (uint64_t)x->patch * 4 + x->border, j = (uint64_t)y->patch * 4 + y->border;
  return i < j ? -1 : i > j;
}

static struct border border_of(double P[4][4][3], uint32_t patch, int border)
{
  struct border b = {.patch = patch, .border = (uint8_t)border};
  double points[4][3], back[4][3];
  edge_points(P, border, points);
  for (int k = 0; k < 4; k++) memcpy(back[k], points[3 - k], sizeof back[k]);
  b.reversed = compare_numbers(&back[0][0], &points[0][0], 12) < 0;
  memcpy(b.point, b.reversed ? back : points, sizeof b.point);
  return b;
}

static bool collapsed(const struct border *b)
{
  for (int k = 1; k < 4; k++)
    if (compare_numbers(b->point[k], b->point[0], 3)) return false;
  return true;
}

enum status edges_match(const void *nets, size_t stride, size_t count, struct edge_neighbour *out)
{
  if (count == 0) return STATUS_OK;
  struct border *all = memory_alloc(count, 4 * sizeof *all);
  if (!all) return STATUS_LIMIT;
  for (size_t p = 0; p < count; p++) {
    double P[4][4][3];
    memcpy(P, (const char *)nets + p * stride, sizeof P);
    for (int k = 0; k < 4; k++) all[4 * p + (size_t)k] = border_of(P, (uint32_t)p, k);
  }
  qsort(all, count * 4, sizeof *all, compare_borders);
  for (size_t first = 0, end; first < count * 4; first = end) {
    for (end = first + 1; end < count * 4 && !compare_numbers(&all[first].point[0][0], &all[end].point[0][0], 12);)
      end++;
    const bool pair = end - first == 2 && !collapsed(&all[first]);
    for (size_t k = first; k < end; k++) {
      const struct border *here = &all[k], *other = &all[first + (k == first)];
      struct edge_neighbour none = {EDGE_NONE, 0, false};
      out[4 * (size_t)here->patch + here->border] =
        pair ? (struct edge_neighbour){other->patch, other->border, here->reversed != other->reversed} : none;
    }
  }
  memory_free(all);
  return STATUS_OK;
}

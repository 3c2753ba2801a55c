/* Finds nets in planes across the axes, and sorts them by their planes. */
#include "geometry/flats.h"

#include <stdlib.h>

#include "base/memory.h"
#include "geometry/patch.h"

struct flat {
  double value; /* of the coordinate */
  int axis;
  uint32_t net;
};

/* The axis across which the net lies in a plane, or -1. */
static int axis_of(const double P[48])
{
  for (int axis = 0; axis < 3; axis++) {
    int n = 1;
    while (n < 16 && P[3 * n + axis] == P[axis]) n++;
    if (n == 16) return axis;
  }
  return -1;
}

static int by_plane(const void *a, const void *b)
{
  const struct flat *x = a, *y = b;
  if (x->axis != y->axis) return x->axis - y->axis;
  return (x->value > y->value) - (x->value < y->value);
}

enum status flats_find(const void *nets, size_t stride, size_t count, uint32_t out[], struct flat_plane **out_planes)
{
  size_t flats = 0;
  *out_planes = NULL;
  if (count > UINT32_MAX / 4) return STATUS_LIMIT;
  for (size_t p = 0; p < count; p++) {
    out[p] = (uint32_t)(axis_of(net_at(nets, stride, p)) + 1);
    flats += out[p] != 0;
  }
  if (flats == 0) return STATUS_OK;
  struct flat *flat = memory_alloc(flats, sizeof *flat);
  struct flat_plane *plane = flat ? memory_alloc(flats + 1, sizeof *plane) : NULL;
  if (!plane) {
    memory_free(flat);
    return STATUS_LIMIT;
  }
  flats = 0;
  for (size_t p = 0; p < count; p++) {
    if (out[p] == 0) continue;
    const int axis = (int)out[p] - 1;
    flat[flats++] = (struct flat){net_at(nets, stride, p)[axis], axis, (uint32_t)p};
  }
  qsort(flat, flats, sizeof *flat, by_plane);
  uint32_t number = 0;
  for (size_t k = 0; k < flats; k++) {
    if (k == 0 || by_plane(&flat[k], &flat[k - 1]) != 0) number++;
    plane[number] = (struct flat_plane){flat[k].value, flat[k].axis};
    out[flat[k].net] = number;
  }
  memory_free(flat);
  *out_planes = plane;
  return STATUS_OK;
}

/* Nets in planes across the axes, put in order by their planes. */
#include "geometry/flats.h"

#include <stdlib.h>

#include "base/memory.h"

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

enum status flats_find(const void *nets, size_t stride, size_t count, uint32_t out[], size_t *out_count)
{
  size_t flats = 0, planes = 0;
  *out_count = 0;
  if (count > UINT32_MAX / 4) return STATUS_LIMIT;
  for (size_t p = 0; p < count; p++) {
    const double *P = (const double *)(const void *)((const char *)nets + p * stride);
    const int axis = axis_of(P);
    out[p] = (uint32_t)(axis + 1);
    flats += axis >= 0;
  }
  if (flats == 0) return STATUS_OK;
  struct flat *flat = memory_alloc(flats, sizeof *flat);
  if (!flat) return STATUS_LIMIT;
  flats = 0;
  for (size_t p = 0; p < count; p++) {
    if (out[p] == 0) continue;
    const int axis = (int)out[p] - 1;
    const double *P = (const double *)(const void *)((const char *)nets + p * stride);
    flat[flats++] = (struct flat){P[axis], axis, (uint32_t)p};
    out[p] = 0;
  }
  qsort(flat, flats, sizeof *flat, by_plane);
  for (size_t k = 0; k < flats; k++) {
    planes += k == 0 || by_plane(&flat[k], &flat[k - 1]) != 0;
    out[flat[k].net] = (uint32_t)(3 * planes) + (uint32_t)flat[k].axis;
  }
  memory_free(flat);
  *out_count = planes;
  return STATUS_OK;
}

/* A part of a picture. */
#ifndef PSCN_BASE_RECTANGLE_H
#define PSCN_BASE_RECTANGLE_H

#include <stddef.h>

/* Pixels x .. x + width - 1, y .. y + height - 1. */
struct rectangle {
  size_t x, y, width, height;
};

#endif

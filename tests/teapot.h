/* The patches of scenes/teapot.pscn. */
#ifndef TESTS_TEAPOT_H
#define TESTS_TEAPOT_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cmocka_test.h"

enum { TEAPOT_PATCHES = 32 };

/* Reads the control points in the order of the scene file: 48 numbers after each "bicubic_patch". */
static inline void teapot_read(double out[TEAPOT_PATCHES][4][4][3])
{
  char text[1 << 15];
  FILE *file = fopen(PSCN_SOURCE_DIR "/scenes/teapot.pscn", "r");
  assert_non_null(file);
  text[fread(text, 1, sizeof text - 1, file)] = '\0';
  fclose(file);
  char *at = text;
  for (size_t count = 0; count < TEAPOT_PATCHES; count++) {
    at = strstr(at, "bicubic_patch {");
    assert_non_null(at);
    at = strchr(at, '\n');
    for (int k = 0; k < 48; k++) {
      at += strcspn(at, "<,") + 1;
      at += strspn(at, " \n<");
      out[count][k / 12][k / 3 % 4][k % 3] = strtod(at, &at);
    }
  }
}

#endif

/* Writing files in tests, and checking what a file holds. */
#ifndef TESTS_FILES_H
#define TESTS_FILES_H

#include <stdio.h>
#include <string.h>

#include "cmocka_test.h"

/* Makes the file hold exactly these bytes, or this text. */
static inline void put_bytes(const char *path, const void *bytes, size_t size)
{
  FILE *file = fopen(path, "wb");
  assert_non_null(file);
  assert_int_equal(fwrite(bytes, 1, size, file), size);
  assert_int_equal(fclose(file), 0);
}

static inline void put_text(const char *path, const char *text) { put_bytes(path, text, strlen(text)); }

/* Asserts that the file holds exactly this text, of less than 512 bytes. */
static inline void expect_file(const char *path, const char *text)
{
  char held[512];
  FILE *file = fopen(path, "r");
  assert_non_null(file);
  const size_t length = fread(held, 1, sizeof held - 1, file);
  held[length] = '\0';
  assert_int_equal(fclose(file), 0);
  assert_int_equal(length, strlen(text));
  assert_string_equal(held, text);
}

#endif

/* What is in a file. */
#ifndef TESTS_EXPECT_FILE_H
#define TESTS_EXPECT_FILE_H

#include <stdio.h>
#include <string.h>

#include "cmocka_test.h"

/* Asserts that the file holds this text, of less than 256 bytes, and nothing else. */
static inline void expect_file(const char *path, const char *text)
{
  char held[256];
  FILE *file = fopen(path, "r");
  assert_non_null(file);
  const size_t length = fread(held, 1, sizeof held - 1, file);
  held[length] = '\0';
  assert_int_equal(fclose(file), 0);
  assert_int_equal(length, strlen(text));
  assert_string_equal(held, text);
}

#endif

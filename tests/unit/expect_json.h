/* Asserts a value's JSON text, its keys in order. */
#ifndef TESTS_UNIT_EXPECT_JSON_H
#define TESTS_UNIT_EXPECT_JSON_H

#include <jansson.h>
#include <stdlib.h>

static void expect_json(const json_t *value, const char *text)
{
  char *found = json_dumps(value, JSON_COMPACT | JSON_SORT_KEYS | JSON_ENCODE_ANY | JSON_REAL_PRECISION(12));
  assert_non_null(found);
  assert_string_equal(found, text);
  free(found);
}

#endif

/* The tests of a program. See cmocka_test.h. */
#include "cmocka_test.h"

#include <stdlib.h>

enum { MOST = 64 };

static struct CMUnitTest tests[MOST];
static size_t count;

void test_add(struct CMUnitTest test)
{
  if (count == MOST) abort();
  tests[count++] = test;
}

int test_run(void) { return _cmocka_run_group_tests("tests", tests, count, NULL, NULL); }

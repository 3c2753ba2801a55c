/* Includes cmocka after the headers that must precede it, and adds tests that need no list. */
#ifndef PSCN_TESTS_CMOCKA_TEST_H
#define PSCN_TESTS_CMOCKA_TEST_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

/* TEST(name) { ... } is a test of this program, run in the order of the file by the main of main.c; TEST_WITH also has
 * what is run before and after it. A program that has to do something before has its own main, which calls test_run. */
#define TEST(name) TEST_WITH(name, NULL, NULL)
#define TEST_WITH(name, set_up, tear_down)                                                 \
  static void name(void **state);                                                          \
  static void __attribute__((constructor)) add_##name(void)                                \
  {                                                                                        \
    test_add((struct CMUnitTest)cmocka_unit_test_setup_teardown(name, set_up, tear_down)); \
  }                                                                                        \
  static void name(void **state __attribute__((unused)))

void test_add(struct CMUnitTest test);

/* Runs them all; returns how many have failed. */
int test_run(void);

#endif

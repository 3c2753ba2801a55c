/* Includes cmocka after the headers that must precede it. */
#ifndef PSCN_TESTS_CMOCKA_TEST_H
#define PSCN_TESTS_CMOCKA_TEST_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#endif

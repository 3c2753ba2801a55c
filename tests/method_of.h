/* Methods by their text. */
#ifndef TESTS_METHOD_OF_H
#define TESTS_METHOD_OF_H

#include "cmocka_test.h"
#include "language/language.h"

/* What may follow `solver` in a scene, such as "aberth { polish off }", as a method. */
static inline struct method method_of(const char *text)
{
  struct diagnostics diagnostics = {0};
  struct method method;
  assert_int_equal(language_parse_solver(text, &diagnostics, &method), STATUS_OK);
  return method;
}

#endif

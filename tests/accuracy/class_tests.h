/* Tests that go through all classes of situations.h and hostile.h, each class a cmocka test of its own. The environment
 * variable PSCN_CLASS, a part of the name, leaves the others out.
 */
#ifndef TESTS_ACCURACY_CLASS_TESTS_H
#define TESTS_ACCURACY_CLASS_TESTS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "accuracy/hostile.h"
#include "cmocka_test.h"
#include "scene/method.h"

/* Whether PSCN_CLASS asks for the class. */
bool class_wanted(const struct situation_class *class);

/* What the rays are asked with; the first is the default. */
struct class_form {
  const char *solver;
  int split; /* 0: the solver's own */
};
enum { CLASS_FORMS = 6 };
extern const struct class_form class_forms[CLASS_FORMS];
void class_form_method(const struct class_form *form, struct method *out);

/* Asks `most` rays of the situation, no more than it has, from `first` on; returns how many. */
typedef size_t class_ask(const char *name, const struct class_form *form, const struct situation *s, size_t first,
                         size_t most, void *count);

/* Asks the class's rays with a form: of `full` with the default and a tenth of that with the others the fraction
 * PSCN_EFFORT, but some. `seed` is that of the default, from effort_seed. */
void class_ask_rays(const struct situation_class *class, int form, size_t full, uint64_t seed, class_ask *ask,
                    void *count);

/* The situation's patches, as a scene has them. */
void class_print_patches(const struct situation *s);

/* Runs `test` of every class, whose state is the const struct situation_class *, and then `last` where it is not NULL. */
int class_tests_run(const char *group, CMUnitTestFunction test, const struct CMUnitTest *last);

#endif

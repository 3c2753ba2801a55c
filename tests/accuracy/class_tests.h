/* Tests that go through all classes of situations.h and hostile.h, each class a cmocka test of its own. The environment
 * variable PSCN_CLASS, a name or a part of some, leaves the others out.
 */
#ifndef TESTS_ACCURACY_CLASS_TESTS_H
#define TESTS_ACCURACY_CLASS_TESTS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "accuracy/hostile.h"
#include "accuracy/trial.h"
#include "cmocka_test.h"

/* Whether PSCN_CLASS asks for the class. */
bool class_wanted(const struct situation_class *class);

/* What the rays are asked with: every solver, and other splits than its own; the first is the default. */
struct class_form {
  const char *solver;
  int split; /* 0: the solver's own */
};
enum { CLASS_FORMS = 7 };
extern const struct class_form class_forms[CLASS_FORMS];

/* A situation given to all forms; the reference is that of the first. */
struct class_trials {
  struct trial form[CLASS_FORMS];
};
void class_trials_create(struct class_trials *trials, const struct situation *s);
void class_trials_destroy(struct class_trials *trials);

/* Asks the first `most` rays of the situation. */
typedef void class_ask(const char *name, const struct situation *s, size_t most, void *context);

/* Asks of `full` rays of the class, times its share, the fraction PSCN_EFFORT, but some. */
void class_ask_rays(const struct situation_class *class, size_t full, uint64_t seed, class_ask *ask, void *context);

/* The situation's patches, as a scene has them. */
void class_print_patches(const struct situation *s);

/* Runs `test` of every class, whose state is the const struct situation_class *, and then the others. */
int class_tests_run(const char *group, CMUnitTestFunction test, const struct CMUnitTest *others, size_t other_count);

#endif

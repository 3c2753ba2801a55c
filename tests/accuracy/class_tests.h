/* Tests that go through all classes of situations.h, each class as a cmocka test of its own. The environment variable
 * PSCN_CLASS, a name or a part of some names, leaves the others out. */
#ifndef TESTS_ACCURACY_CLASS_TESTS_H
#define TESTS_ACCURACY_CLASS_TESTS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "accuracy/situations.h"
#include "accuracy/trial.h"
#include "cmocka_test.h"

/* Whether PSCN_CLASS selects the class. */
bool class_wanted(const struct situation_class *class);

/* How rays are asked: with every solver, and with splits other than its own; the default comes first. */
enum { CLASS_FORMS = 7 };
extern const char *const class_forms[CLASS_FORMS];

/* A situation given to all forms; they share the reference of the first. */
struct class_trials {
  struct trial form[CLASS_FORMS];
};
void class_trials_create(struct class_trials *trials, const struct situation *s);
void class_trials_destroy(struct class_trials *trials);

/* Asks the first `most` rays of the situation. */
typedef void class_ask(const char *name, const struct situation *s, size_t most, void *context);

/* Asks rays of the class: `full` times its share times PSCN_EFFORT, but at least `least`. */
void class_ask_rays(const struct situation_class *class, size_t full, size_t least, uint64_t seed, class_ask *ask,
                    void *context);

/* Runs `test` for the first `count` classes, with the const struct situation_class * as its state, and then the
 * others. */
int class_tests_run(const char *group, size_t count, CMUnitTestFunction test, const struct CMUnitTest *others,
                    size_t other_count);

#endif

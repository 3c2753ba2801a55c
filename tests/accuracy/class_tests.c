/* See class_tests.h. */
#include "accuracy/class_tests.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "effort.h"
#include "random.h"

enum { MOST_CLASSES = 64, MOST_OTHERS = 4 };

const char *const class_forms[CLASS_FORMS] = {
  "bernstein", "newton", "laguerre", "aberth", "durand_kerner", "bernstein { split 1 }", "bernstein { split 8 }",
};

bool class_wanted(const struct situation_class *class)
{
  const char *only = getenv("PSCN_CLASS");
  for (size_t n = 0; only && n < every_class_count(); n++)
    if (!strcmp(only, every_class_at(n)->name)) return class == every_class_at(n);
  return !only || strstr(class->name, only);
}

void class_trials_create(struct class_trials *trials, const struct situation *s)
{
  trial_create(&trials->form[0], (const double(*)[4][4][3])s->P, s->count, class_forms[0]);
  for (int m = 1; m < CLASS_FORMS; m++) trial_create_beside(&trials->form[m], &trials->form[0], class_forms[m]);
}

void class_trials_destroy(struct class_trials *trials)
{
  for (int m = CLASS_FORMS; m-- > 0;) trial_destroy(&trials->form[m]);
}

void class_ask_rays(const struct situation_class *class, size_t full, size_t least, uint64_t seed, class_ask *ask,
                    void *context)
{
  const size_t wanted = effort_count((size_t)(class->share * (double)full), least);
  struct random random = {.state = seed};
  size_t asked = 0;
  for (size_t index = 0; asked < wanted; index++) {
    struct situation situation;
    class->generate(&random, index, &situation);
    const size_t left = wanted - asked, most = left < SITUATION_RAYS ? left : SITUATION_RAYS;
    ask(class->name, &situation, most, context);
    asked += most;
  }
}

int class_tests_run(const char *group, size_t count, CMUnitTestFunction test, const struct CMUnitTest *others,
                    size_t other_count)
{
  struct CMUnitTest tests[MOST_CLASSES + MOST_OTHERS];
  assert_true(count <= MOST_CLASSES && other_count <= MOST_OTHERS);
  for (size_t n = 0; n < count; n++) {
    void *class = (void *)(uintptr_t)every_class_at(n); /* cmocka's state is not const */
    tests[n] = (struct CMUnitTest){.name = every_class_at(n)->name, .test_func = test, .initial_state = class};
  }
  for (size_t n = 0; n < other_count; n++) tests[count + n] = others[n];
  return _cmocka_run_group_tests(group, tests, count + other_count, NULL, NULL);
}

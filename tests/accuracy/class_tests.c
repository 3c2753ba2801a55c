/* See class_tests.h. */
#include "accuracy/class_tests.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "effort.h"
#include "random.h"

enum { LEAST_RAYS = 16, MOST_CLASSES = 64, MOST_OTHERS = 4 };

const struct class_form class_forms[CLASS_FORMS] = {
  {"bernstein", 0},     {"newton", 0},    {"laguerre", 0},  {"aberth", 0},
  {"durand_kerner", 0}, {"bernstein", 1}, {"bernstein", 8},
};

bool class_wanted(const struct situation_class *class)
{
  const char *only = getenv("PSCN_CLASS");
  for (size_t n = 0; only && n < every_class_count(); n++)
    if (!strcmp(only, every_class_at(n)->name)) return class == every_class_at(n);
  return !only || strstr(class->name, only);
}

void class_method(const struct class_form *form, struct method *out)
{
  const struct solver *solver = solver_find(form->solver, strlen(form->solver));
  assert_non_null(solver);
  method_default(solver, out);
  if (form->split) out->split = form->split;
}

void class_trials_create(struct class_trials *trials, const struct situation *s)
{
  for (int m = 0; m < CLASS_FORMS; m++) {
    struct method method;
    class_method(&class_forms[m], &method);
    if (m > 0) trial_create_beside(&trials->form[m], &trials->form[0], &method);
    else trial_create(&trials->form[0], (const double(*)[4][4][3])s->P, s->count, &method);
  }
}

void class_trials_destroy(struct class_trials *trials)
{
  for (int m = CLASS_FORMS; m-- > 0;) trial_destroy(&trials->form[m]);
}

void class_ask_rays(const struct situation_class *class, size_t full, uint64_t seed, class_ask *ask, void *context)
{
  const size_t wanted = effort_count((size_t)(class->share * (double)full), LEAST_RAYS);
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

void class_print_patches(const struct situation *s)
{
  for (size_t n = 0; n < s->count; n++) {
    printf("bicubic_patch { type 1 flatness 0 u_steps 5 v_steps 5\n");
    for (int k = 0; k < 16; k++)
      printf("  <%.17g, %.17g, %.17g>%s\n", s->P[n][k / 4][k % 4][0], s->P[n][k / 4][k % 4][1],
             s->P[n][k / 4][k % 4][2], k < 15 ? "," : "\n pigment { color rgb 1 } }");
  }
}

int class_tests_run(const char *group, CMUnitTestFunction test, const struct CMUnitTest *others, size_t other_count)
{
  struct CMUnitTest tests[MOST_CLASSES + MOST_OTHERS];
  const size_t count = every_class_count();
  assert_true(count <= MOST_CLASSES && other_count <= MOST_OTHERS);
  for (size_t n = 0; n < count; n++) {
    void *class = (void *)(uintptr_t)every_class_at(n); /* cmocka's state is not const */
    tests[n] = (struct CMUnitTest){.name = every_class_at(n)->name, .test_func = test, .initial_state = class};
  }
  for (size_t n = 0; n < other_count; n++) tests[count + n] = others[n];
  return _cmocka_run_group_tests(group, tests, count + other_count, NULL, NULL);
}

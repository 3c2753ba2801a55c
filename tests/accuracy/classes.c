/* Proves that the default solver is right where methods fail: the situations of situations.h, judged by the reference.
 *
 * In every class no proven hit may be lost, none invented, and T, U, V must be within their floors. In classes whose
 * rays are degenerate by design (a curve in common, a collapsed edge met exactly) the reference leaves many rays
 * undecided. There the answer must not pass a proven hit, nor come before the first possible one. */
#include "accuracy/class_tests.h"
#include "cmocka_test.h"
#include "effort.h"

enum { FULL_RAYS = 50000, LEAST_RAYS = 64 };

static void ask(const char *name, const struct situation *s, size_t most, void *tally)
{
  (void)name;
  struct trial trial;
  trial_create(&trial, (const double(*)[4][4][3])s->P, s->count, NULL);
  trial_rays(&trial, s->rays, most, tally);
  trial_destroy(&trial);
}

static void test_class(void **state)
{
  const struct situation_class *class = *state;
  struct tally tally = {.name = class->name};
  if (!class_wanted(class)) return;
  class_ask_rays(class, FULL_RAYS, LEAST_RAYS, effort_seed(class->seed), ask, &tally);
  tally_assert(&tally);
}

int main(void) { return class_tests_run("classes", situation_class_count(), test_class, NULL, 0); }

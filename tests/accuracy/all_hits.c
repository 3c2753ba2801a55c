/* Proves that all hits are all roots. For all classes of situations.h and hostile.h, with every solver and with whole
 * patches, each list of hits is compared with what the exact judge finds on each patch (exact.h). A certain list has a
 * hit for each root inside a patch, and one at each point of a border; a certain hit is a root, in any list. Prints for
 * each class and solver the counts, and the share of lists that are grazing although the judge has no doubt. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "accuracy/class_tests.h"
#include "accuracy/exact.h"
#include "accuracy/lists.h"
#include "accuracy/trial.h"
#include "cmocka_test.h"
#include "effort.h"
#include "random.h"

enum { FULL_RAYS = 20000, MOST_SHOWN = 6 };

struct count {
  size_t rays, answers[2][LIST_FINDINGS]; /* certain, grazing */
  size_t roots, sure; /* sure: grazing although the judge has no doubt, and no root is on a border */
};

static void show(const char *name, const struct class_form *form, const struct situation *s, const struct ray *ray,
                 const struct hit_list *list, const struct list_truth *truth, const char *what)
{
  static size_t shown = 0;
  if (shown++ >= MOST_SHOWN && !getenv("PSCN_SHOW")) return;
  const double *o = ray->origin, *d = ray->direction;
  printf("%s, %s, split %d: %s %s\n  ray %.17g %.17g %.17g %.17g %.17g %.17g\n", name, form->solver, form->split,
         list->certainty == CERTAINTY_CERTAIN ? "certain" : "grazing", what, o[0], o[1], o[2], d[0], d[1], d[2]);
  for (size_t k = 0; k < list->count; k++)
    printf("  hit  t %.17g u %.17g v %.17g patch %u%s\n", list->hits[k].t, list->hits[k].u, list->hits[k].v,
           (unsigned)list->hits[k].patch, list->hits[k].certainty == CERTAINTY_CERTAIN ? "" : " open");
  for (size_t k = 0; k < truth->count; k++)
    printf("  root t %.17g u %.17g v %.17g patch %u, floor %.3g%s\n", truth->root[k].t, truth->root[k].u,
           truth->root[k].v, (unsigned)truth->root[k].patch, truth->root[k].floor.t,
           truth->root[k].met ? "" : ", not met");
  if (truth->doubt) printf("  and a doubt\n");
  if (!getenv("PSCN_SHOW")) return;
  class_print_patches(s);
}

static void ask(const char *name, const struct situation *s, size_t most, void *context)
{
  static struct list_truth truth;
  struct count *counts = context;
  struct class_trials trials;
  class_trials_create(&trials, s);
  for (size_t n = 0; n < most; n++) {
    const struct ray *ray = &s->rays[n];
    list_truth_find(&trials.form[0].scene, trials.form[0].reference, ray, &truth);
    bool clear = !truth.doubt;
    for (size_t k = 0; k < truth.count; k++) clear &= !truth.root[k].border;
    for (int m = 0; m < CLASS_FORMS; m++) {
      struct count *count = &counts[m];
      struct hit_list list;
      assert_int_equal(tracer_all(trials.form[m].tracer, 1, ray, &list), STATUS_OK);
      const enum list_finding finding = list_judge(&list, &truth);
      const bool grazing = list.certainty != CERTAINTY_CERTAIN;
      count->rays++, count->answers[grazing][finding]++, count->roots += truth.count, count->sure += grazing && clear;
      if (finding > LIST_UNDECIDED) show(name, &class_forms[m], s, ray, &list, &truth, list_finding_names[finding]);
      else if (grazing && clear && getenv("PSCN_SHOW_SURE"))
        show(name, &class_forms[m], s, ray, &list, &truth, "but clear");
    }
  }
  class_trials_destroy(&trials);
}

static size_t refuted(const size_t answers[LIST_FINDINGS])
{
  size_t sum = 0;
  for (int n = LIST_UNDECIDED + 1; n < LIST_FINDINGS; n++) sum += answers[n];
  return sum;
}

static void print_count(const char *name, const struct class_form *form, uint64_t seed, const struct count *c)
{
  printf(
    "%-36s %-9s %2d %6zu rays, %6zu roots: certain %zu, %zu undecided, %zu refuted; grazing %zu, %zu of them clear, "
    "%zu refuted; seed %llu\n",
    name, form->solver, form->split, c->rays, c->roots, c->answers[0][LIST_RIGHT], c->answers[0][LIST_UNDECIDED],
    refuted(c->answers[0]), c->answers[1][LIST_RIGHT] + refuted(c->answers[1]), c->sure, refuted(c->answers[1]),
    (unsigned long long)seed);
  fflush(stdout);
}

static void test_class(void **state)
{
  const struct situation_class *class = *state;
  struct count counts[CLASS_FORMS] = {{.rays = 0}};
  const uint64_t seed = effort_seed(class->seed + 7000);
  size_t bad = 0;
  if (!class_wanted(class)) return;
  class_ask_rays(class, FULL_RAYS, seed, ask, counts);
  for (int m = 0; m < CLASS_FORMS; m++) {
    print_count(class->name, &class_forms[m], seed, &counts[m]);
    bad += refuted(counts[m].answers[0]) + refuted(counts[m].answers[1]);
  }
  exact_cleanup();
  if (!class_told_only(class)) assert_int_equal(bad, 0);
}

int main(void) { return class_tests_run("all hits", test_class, NULL, 0); }

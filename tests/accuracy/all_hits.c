/* Proves that all hits are all roots. For all classes of situations.h, with every solver and with whole patches, each
 * list of hits is compared with what the exact judge finds on each patch (exact.h). A certain list has a hit for each
 * root inside a patch, and one at each point of a border; a certain hit is a root, in any list. Prints for each class
 * and solver the counts. */
#include <stdio.h>
#include <stdlib.h>

#include "accuracy/certificate.h"
#include "accuracy/class_tests.h"
#include "cmocka_test.h"
#include "effort.h"
#include "random.h"

enum { FULL_RAYS = 20000, LEAST_RAYS = 16, MOST_SHOWN = 6 };

struct count {
  size_t rays, roots, answers[2][LIST_FINDINGS]; /* certain, grazing */
};

static void show(const char *name, const struct trial *trial, const struct ray *ray, const struct hit_list *list,
                 const struct truth *truth, enum list_finding finding)
{
  static size_t shown = 0;
  if (shown++ >= MOST_SHOWN && !getenv("PSCN_SHOW")) return;
  printf("%s: %s %s\n", name, list->certainty == CERTAINTY_CERTAIN ? "certain" : "grazing",
         list_finding_names[finding]);
  print_ray(ray);
  for (size_t k = 0; k < list->count; k++) print_hit("hit", &list->hits[k]);
  for (size_t k = 0; k < truth->count; k++) {
    const struct truth_root *root = &truth->root[k];
    printf("  root: t %.17g u %.17g v %.17g patch %u, floor %.3g%s\n", root->at.t, root->at.u, root->at.v,
           (unsigned)root->patch, root->floor.t,
           !root->at.proven ? ", perhaps"
           : root->met      ? ""
                            : ", not met");
  }
  if (getenv("PSCN_SHOW")) print_patches(&trial->scene);
}

static void ask(const char *name, const struct situation *s, size_t most, void *context)
{
  struct count *counts = context;
  struct class_trials trials;
  struct certifier certifier;
  class_trials_create(&trials, s);
  certifier_create(&certifier, &trials.form[0].scene, trials.form[0].reference);
  for (size_t n = 0; n < most; n++) {
    for (int m = 0; m < CLASS_FORMS; m++) {
      struct hit_list list;
      assert_int_equal(tracer_all(trials.form[m].tracer, 1, &s->rays[n], &list), STATUS_OK);
      const enum list_finding finding = certify_list(&certifier, &s->rays[n], &list);
      counts[m].rays++, counts[m].answers[list.certainty != CERTAINTY_CERTAIN][finding]++;
      counts[m].roots += certifier.truth.count;
      if (finding > LIST_UNDECIDED) show(name, &trials.form[m], &s->rays[n], &list, &certifier.truth, finding);
    }
  }
  certifier_destroy(&certifier);
  class_trials_destroy(&trials);
}

static size_t refuted(const size_t answers[LIST_FINDINGS])
{
  size_t sum = 0;
  for (int n = LIST_UNDECIDED + 1; n < LIST_FINDINGS; n++) sum += answers[n];
  return sum;
}

static void test_class(void **state)
{
  const struct situation_class *class = *state;
  struct count counts[CLASS_FORMS] = {{.rays = 0}};
  const uint64_t seed = effort_seed(class->seed + 7000);
  size_t bad = 0;
  if (!class_wanted(class)) return;
  class_ask_rays(class, FULL_RAYS, LEAST_RAYS, seed, ask, counts);
  for (int m = 0; m < CLASS_FORMS; m++) {
    const struct count *c = &counts[m];
    printf("%-36s %-21s %6zu rays, %6zu roots: certain %zu, %zu undecided, %zu refuted; grazing %zu, %zu refuted; seed "
           "%llu\n",
           class->name, class_forms[m], c->rays, c->roots, c->answers[0][LIST_RIGHT], c->answers[0][LIST_UNDECIDED],
           refuted(c->answers[0]), c->answers[1][LIST_RIGHT], refuted(c->answers[1]), (unsigned long long)seed);
    bad += refuted(c->answers[0]) + refuted(c->answers[1]);
  }
  fflush(stdout);
  exact_cleanup();
  if (!class_told_only(class)) assert_int_equal(bad, 0);
}

int main(void) { return class_tests_run("all hits", every_class_count(), test_class, NULL, 0); }

/* Proves that all hits are all roots. For all classes of situations.h and hostile.h, with every solver and with whole
 * patches, each list of hits is compared with what the exact judge finds on each patch (exact.h). A certain list has a
 * hit for each root inside a patch, and one at each point of a border; a certain hit is a root, in any list. Prints for
 * each class and solver the counts, and the share of lists that are grazing although the judge has no doubt. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "accuracy/class_tests.h"
#include "accuracy/exact.h"
#include "accuracy/trial.h"
#include "cmocka_test.h"
#include "effort.h"
#include "random.h"

enum { FULL_RAYS = 20000, MOST_SHOWN = 6, MOST_ROOTS = 512 };

/* The allowed error of a hit's t, in floors. Next to a tangency floors are only of the first order; roots nearer to
 * each other than this are told apart by their order. */
#define SAME_FLOORS 16

struct truth {
  uint32_t patch;
  double t, u, v, floor;
  bool border, met; /* on a border; a hit has been found for it */
};

struct truths {
  size_t count;
  bool doubt; /* the judge has left something open */
  struct truth root[MOST_ROOTS];
};

enum finding { FOUND_RIGHT, FOUND_UNDECIDED, FOUND_LOST, FOUND_INVENTED, FOUND_BORDER_LOST, FOUND_ORDER, FINDINGS };
static const char *const finding_names[FINDINGS] = {"right",    "undecided",        "lost",
                                                    "invented", "lost on a border", "out of order"};

struct count {
  size_t rays, answers[2][FINDINGS]; /* certain, grazing */
  size_t roots, sure;                /* sure: grazing although the judge has no doubt, and no root is on a border */
};

/* The parameter is the nearest double to a root's. A root that 113 bits cannot tell from a border counts as a hit on
 * it, of the first of the patches that share it, although it may be in the other one. */
#define AT_BORDER 0x1p-90

static bool on_border(double parameter) { return parameter <= AT_BORDER || parameter >= 1; }

static void find_truths(const struct trial *trial, const struct ray *ray, struct truths *out)
{
  out->count = 0, out->doubt = false;
  for (size_t n = 0; n < trial->scene.patch_count; n++) {
    struct exact_roots roots;
    exact_patch_roots((const double(*)[4][3])trial->scene.patches[n].P, ray->origin, ray->direction, ray->t_min,
                      ray->t_max, &roots);
    out->doubt |= roots.count == EXACT_MOST_ROOTS;
    for (size_t k = 0; k < roots.count; k++) {
      const struct exact_root *r = &roots.root[k];
      out->doubt |= !r->proven;
      if (!r->proven || out->count == MOST_ROOTS) continue;
      const bool border = on_border(r->u) || on_border(r->v);
      const double floor = trial_floor(trial->reference, ray, (uint32_t)n, r->t, r->u, r->v).t;
      out->root[out->count++] = (struct truth){(uint32_t)n, r->t, r->u, r->v, floor, border, false};
    }
  }
}

/* The root that a hit is: the nearest one not met yet, of the hit's patch, or on a border if the hit is. NULL if none
 * is near enough. */
static struct truth *root_of(struct truths *truths, const struct hit *hit)
{
  struct truth *best = NULL;
  double least = INFINITY;
  const bool border = on_border(hit->u) || on_border(hit->v);
  for (size_t k = 0; k < truths->count; k++) {
    struct truth *r = &truths->root[k];
    const double off = fabs(r->t - hit->t) / r->floor;
    if (r->met || !(off <= SAME_FLOORS) || (r->patch != hit->patch && !(border && r->border))) continue;
    /* Of two that t cannot tell apart, takes the one whose parameters are nearer. */
    const double aside = r->patch != hit->patch ? 1 : fmax(fabs(r->u - hit->u), fabs(r->v - hit->v));
    if (aside < least) best = r, least = aside;
  }
  return best;
}

static enum finding judge(const struct hit_list *list, struct truths *truths)
{
  for (size_t k = 0; k < list->count; k++) {
    const struct hit *hit = &list->hits[k];
    if (k > 0 && !(hit[-1].t <= hit->t)) return FOUND_ORDER;
    if (hit->certainty != CERTAINTY_CERTAIN) continue;
    struct truth *root = root_of(truths, hit);
    if (root) root->met = true;
    else if (!truths->doubt) return FOUND_INVENTED;
  }
  if (list->certainty != CERTAINTY_CERTAIN) return FOUND_RIGHT;
  for (size_t k = 0; k < truths->count; k++) {
    const struct truth *r = &truths->root[k];
    bool met = r->met;
    for (size_t n = 0; n < list->count && r->border; n++) met |= fabs(list->hits[n].t - r->t) <= SAME_FLOORS * r->floor;
    if (!met) return r->border ? FOUND_BORDER_LOST : FOUND_LOST;
  }
  return truths->doubt ? FOUND_UNDECIDED : FOUND_RIGHT;
}

static void show(const char *name, const struct class_form *form, const struct situation *s, const struct ray *ray,
                 const struct hit_list *list, const struct truths *truths, const char *what)
{
  static size_t shown = 0;
  if (shown++ >= MOST_SHOWN && !getenv("PSCN_SHOW")) return;
  const double *o = ray->origin, *d = ray->direction;
  printf("%s, %s, split %d: %s %s\n  ray %.17g %.17g %.17g %.17g %.17g %.17g\n", name, form->solver, form->split,
         list->certainty == CERTAINTY_CERTAIN ? "certain" : "grazing", what, o[0], o[1], o[2], d[0], d[1], d[2]);
  for (size_t k = 0; k < list->count; k++)
    printf("  hit  t %.17g u %.17g v %.17g patch %u%s\n", list->hits[k].t, list->hits[k].u, list->hits[k].v,
           (unsigned)list->hits[k].patch, list->hits[k].certainty == CERTAINTY_CERTAIN ? "" : " open");
  for (size_t k = 0; k < truths->count; k++)
    printf("  root t %.17g u %.17g v %.17g patch %u, floor %.3g%s\n", truths->root[k].t, truths->root[k].u,
           truths->root[k].v, (unsigned)truths->root[k].patch, truths->root[k].floor,
           truths->root[k].met ? "" : ", not met");
  if (truths->doubt) printf("  and a doubt\n");
  if (!getenv("PSCN_SHOW")) return;
  class_print_patches(s);
}

static void ask(const char *name, const struct situation *s, size_t most, void *context)
{
  static struct truths truths;
  struct count *counts = context;
  struct class_trials trials;
  class_trials_create(&trials, s);
  for (size_t n = 0; n < most; n++) {
    const struct ray *ray = &s->rays[n];
    find_truths(&trials.form[0], ray, &truths);
    bool clear = !truths.doubt;
    for (size_t k = 0; k < truths.count; k++) clear &= !truths.root[k].border;
    for (int m = 0; m < CLASS_FORMS; m++) {
      struct count *count = &counts[m];
      struct hit_list list;
      for (size_t k = 0; k < truths.count; k++) truths.root[k].met = false;
      assert_int_equal(tracer_all(trials.form[m].tracer, 1, ray, &list), STATUS_OK);
      const enum finding finding = judge(&list, &truths);
      const bool grazing = list.certainty != CERTAINTY_CERTAIN;
      count->rays++, count->answers[grazing][finding]++, count->roots += truths.count, count->sure += grazing && clear;
      if (finding > FOUND_UNDECIDED) show(name, &class_forms[m], s, ray, &list, &truths, finding_names[finding]);
      else if (grazing && clear && getenv("PSCN_SHOW_SURE"))
        show(name, &class_forms[m], s, ray, &list, &truths, "but clear");
    }
  }
  class_trials_destroy(&trials);
}

static size_t refuted(const size_t answers[FINDINGS])
{
  size_t sum = 0;
  for (int n = FOUND_UNDECIDED + 1; n < FINDINGS; n++) sum += answers[n];
  return sum;
}

static void print_count(const char *name, const struct class_form *form, uint64_t seed, const struct count *c)
{
  printf(
    "%-36s %-9s %2d %6zu rays, %6zu roots: certain %zu, %zu undecided, %zu refuted; grazing %zu, %zu of them clear, "
    "%zu refuted; seed %llu\n",
    name, form->solver, form->split, c->rays, c->roots, c->answers[0][FOUND_RIGHT], c->answers[0][FOUND_UNDECIDED],
    refuted(c->answers[0]), c->answers[1][FOUND_RIGHT] + refuted(c->answers[1]), c->sure, refuted(c->answers[1]),
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

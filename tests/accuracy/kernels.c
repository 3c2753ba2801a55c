/* Proves that every kernel of the processor gives the same answers to every ray: the same hit or miss, certainty and
 * patch; T, U, V differ in their last places only. Whatever rays are beside it, a ray's answer is the same to the last
 * bit. The exception is a ray for which another hit, or a border, is too near for doubles to tell apart: there T, U, V
 * may differ in their last places. Any hit is found exactly where a closest one is. Runs all classes of situations.h, and
 * prints for each what differs. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "accuracy/class_tests.h"
#include "cmocka_test.h"
#include "effort.h"
#include "intersect/tracer.h"

enum { FULL_RAYS = 100000, LEAST_RAYS = 48, MOST_SHOWN = 4 };

struct count {
  size_t rays;
  size_t verdict, certainty, patch; /* these differ between kernels */
  size_t place;                     /* T differs by more than DIFFERENT: not only the last bits of certain hits */
  size_t bits;                      /* T, U or V differ at all */
  size_t company;                   /* an answer depends on the rays beside it */
  size_t tied;                      /* it does, in its last places, with another hit at hand */
  size_t occlusion;                 /* any hit is found where no closest hit is, or the reverse */
  double worst;                     /* the largest difference of T in floors, of two certain hits */
};

/* T of certain answers may differ by this many floors: of one rounding of the inputs or of the patch's extent. */
#define DIFFERENT 8

static bool same(const struct hit *a, const struct hit *b)
{
  if (a->patch != b->patch || a->certainty != b->certainty) return false;
  return a->patch == HIT_NONE || (a->t == b->t && a->u == b->u && a->v == b->v);
}

static void show(const char *class, const char *what, const struct ray *ray, const struct hit *a, const struct hit *b)
{
  static size_t shown = 0;
  if (shown++ >= MOST_SHOWN && !getenv("PSCN_SHOW")) return;
  printf("%s: %s\n", class, what);
  print_ray(ray), print_hit("one", a), print_hit("other", b);
}

static void compare(const char *class, const char *kernel, const struct reference *reference, const struct ray *ray,
                    const struct hit *plain, const struct hit *other, struct count *count)
{
  if (same(plain, other)) return;
  size_t *which = &count->bits;
  const bool both = plain->patch != HIT_NONE && other->patch != HIT_NONE;
  if (!both && plain->patch != other->patch) which = &count->verdict;
  else if (plain->certainty != other->certainty) which = &count->certainty;
  else if (plain->patch != other->patch) which = &count->patch;
  else if (plain->certainty == CERTAINTY_CERTAIN) {
    const double floor = trial_floor(reference, ray, plain->patch, plain->t, plain->u, plain->v).t;
    const double off = plain->t == other->t ? 0 : fabs(plain->t - other->t) / floor;
    count->worst = fmax(count->worst, off);
    if (off > DIFFERENT) which = &count->place;
  }
  ++*which;
  if (which != &count->bits) show(class, kernel, ray, plain, other);
}

/* A hit this many floors behind or before may be found first. */
#define TIED 256

/* This near a border, in parameters of the patch, a hit may be found on either side of it first. */
#define BORDER 0x1p-40

/* Whether these answers to a ray differ in last places only, and doubles cannot tell the first hit from another one, or
 * from one on a neighbouring patch. */
static bool is_tied(struct trial *trial, const struct ray *ray, const struct hit *a, const struct hit *b)
{
  if (a->patch == HIT_NONE || a->patch != b->patch || a->certainty != b->certainty) return false;
  const double floor = trial_floor(trial->reference, ray, a->patch, a->t, a->u, a->v).t;
  if (fabs(a->t - b->t) > DIFFERENT * floor) return false;
  if (fmin(fmin(a->u, 1 - a->u), fmin(a->v, 1 - a->v)) <= BORDER) return true;
  struct hit_list list;
  size_t near = 0;
  assert_int_equal(tracer_all(trial->tracer, 1, ray, &list), STATUS_OK);
  for (size_t k = 0; k < list.count; k++) near += fabs(list.hits[k].t - a->t) <= TIED * floor;
  return near > 1;
}

static void ask(const char *class, const struct situation *s, size_t most, void *context)
{
  struct count *count = context;
  struct trial trial;
  trial_create(&trial, (const double(*)[4][4][3])s->P, s->count, NULL);
  const struct kernel *kernels[KERNELS_MAX];
  struct hit plain[SITUATION_RAYS], hits[SITUATION_RAYS];
  for (size_t k = kernels_here(kernels), first = k; k-- > 0;) {
    trial.tracer->kernel = kernels[k];
    tracer_closest(trial.tracer, most, s->rays, hits);
    if (k + 1 == first) memcpy(plain, hits, sizeof plain); /* the last is the plainest */
    for (size_t n = 0; n < most; n++) {
      struct hit single;
      bool occluded;
      compare(class, kernels[k]->name, trial.reference, &s->rays[n], &plain[n], &hits[n], count);
      tracer_closest(trial.tracer, 1, &s->rays[n], &single);
      tracer_occluded(trial.tracer, 1, &s->rays[n], &occluded);
      if (!same(&single, &hits[n]) && is_tied(&trial, &s->rays[n], &single, &hits[n])) count->tied++;
      else if (!same(&single, &hits[n])) count->company++, show(class, "company", &s->rays[n], &single, &hits[n]);
      /* what is left undecided counts as hidden */
      const bool hit = single.patch != HIT_NONE, open = single.certainty != CERTAINTY_CERTAIN;
      if (occluded != hit && !(occluded && open))
        count->occlusion++, show(class, "occlusion", &s->rays[n], &single, &single);
    }
  }
  count->rays += most;
  trial_destroy(&trial);
}

static void test_class(void **state)
{
  const struct situation_class *class = *state;
  if (!class_wanted(class)) return;
  struct count c = {0};
  const uint64_t seed = effort_seed(class->seed);
  class_ask_rays(class, FULL_RAYS, LEAST_RAYS, seed, ask, &c);
  printf("%-36s %7zu rays: verdict %zu, certainty %zu, patch %zu, T %zu, last bits %zu differ; T by %.2g floors; "
         "company %zu, and %zu tied, "
         "occlusion %zu; seed %llu\n",
         class->name, c.rays, c.verdict, c.certainty, c.patch, c.place, c.bits, c.worst, c.company, c.tied, c.occlusion,
         (unsigned long long)seed);
  assert_int_equal(c.verdict + c.certainty + c.patch + c.place + c.company + c.occlusion, 0);
}

int main(void) { return class_tests_run("kernels", every_class_count(), test_class, NULL, 0); }

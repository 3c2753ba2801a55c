/* Every answer proven or refuted by the exact judge: all classes of situations.h and hostile.h, with every solver and
 * with whole patches. Nothing may be refuted, whatever the answer called itself. Prints for each class and solver the
 * counts, the share of grazing answers, and the slowest ray. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "accuracy/certificate.h"
#include "accuracy/class_tests.h"
#include "accuracy/exact.h"
#include "accuracy/trial.h"
#include "cmocka_test.h"
#include "effort.h"
#include "random.h"

/* No ray of any scene may take longer, in seconds. Timing decides no test; it is printed. */
#define SLOW 2e-3

enum { FULL_RAYS = 40000, FULL_SITUATIONS = 50, MOST_SHOWN = 6 };

struct count {
  size_t rays, answers[2][FINDINGS]; /* certain, grazing */
  size_t grazing_sure;               /* grazing though the judge proves the answer */
  size_t company;                    /* answered otherwise in a packet than alone */
  size_t slow;                       /* above SLOW */
  double slowest;                    /* seconds */
};

static double seconds(void)
{
  struct timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* With PSCN_SHOW set everything is shown, and the scene too. */
static void show(const char *name, const struct class_form *form, const struct situation *s, const struct ray *ray,
                 const struct hit *hit, const char *what)
{
  const double *o = ray->origin, *d = ray->direction;
  printf("%s, %s, split %d: %s %s\n  ray %.17g %.17g %.17g %.17g %.17g %.17g\n", name, form->solver, form->split,
         hit->certainty == CERTAINTY_CERTAIN ? "certain" : "grazing", what, o[0], o[1], o[2], d[0], d[1], d[2]);
  if (hit->patch != HIT_NONE)
    printf("  answer t %.17g u %.17g v %.17g patch %u\n", hit->t, hit->u, hit->v, (unsigned)hit->patch);
  if (!getenv("PSCN_SHOW")) return;
  class_print_patches(s);
}

static void show_refuted(const char *name, const struct class_form *form, const struct situation *s,
                         const struct ray *ray, const struct hit *hit, const struct certificate *c)
{
  static size_t shown = 0;
  if (shown++ >= MOST_SHOWN && !getenv("PSCN_SHOW")) return;
  if (c->patch != REFERENCE_NONE)
    printf("  truth  t %.17g u %.17g v %.17g patch %u, %.3g floors\n", c->t, c->u, c->v, (unsigned)c->patch, c->off);
  show(name, form, s, ray, hit, finding_names[c->finding]);
}

/* Traces the ray, twice where the first time is long: the machine may have been busy. */
static double trace(struct trial *trial, const struct ray *ray, struct hit *out)
{
  double least = INFINITY;
  for (int n = 0; n < 2 && least > SLOW; n++) {
    const double start = seconds();
    tracer_closest(trial->tracer, 1, ray, out);
    least = fmin(least, seconds() - start);
  }
  return least;
}

/* Whether the answer in a packet is as good as the one alone: of one verdict, and where last places differ proven as
 * well. */
static bool fits(const struct hit *alone, const struct hit *packed, const struct certifier *certifier,
                 const struct ray *ray)
{
  if (alone->patch != packed->patch || alone->certainty != packed->certainty) return false;
  if (alone->patch == HIT_NONE || alone->t == packed->t) return true;
  struct certificate certificate;
  certify(certifier, ray, packed, &certificate);
  return certificate.finding <= FINDING_UNDECIDED;
}

static size_t ask(const char *name, const struct class_form *form, const struct situation *s, size_t first, size_t most,
                  void *context)
{
  struct count *count = context;
  struct method method;
  class_form_method(form, &method);
  struct trial trial;
  struct certifier certifier;
  trial_create(&trial, (const double(*)[4][4][3])s->P, s->count, &method);
  certifier_create(&certifier, &trial.scene, trial.reference);
  struct hit packet[SITUATION_RAYS]; /* a packet's lanes do what they do on a picture; alone a ray goes another way */
  tracer_closest(trial.tracer, SITUATION_RAYS, s->rays, packet);
  for (size_t n = 0; n < most; n++) {
    const struct ray *ray = &s->rays[(first + n) % SITUATION_RAYS];
    struct hit hit;
    struct certificate certificate;
    const double time = trace(&trial, ray, &hit);
    certify(&certifier, ray, &hit, &certificate);
    if (!fits(&hit, &packet[(first + n) % SITUATION_RAYS], &certifier, ray))
      count->company++, show(name, form, s, ray, &hit, "otherwise in a packet");
    const bool grazing = hit.certainty != CERTAINTY_CERTAIN;
    count->rays++, count->answers[grazing][certificate.finding]++;
    count->grazing_sure += grazing && certificate.finding == FINDING_PROVEN && certificate.sure;
    count->slowest = fmax(count->slowest, time), count->slow += time > SLOW;
    if (time > SLOW && getenv("PSCN_SHOW")) show(name, form, s, ray, &hit, "slow");
    if (certificate.finding == FINDING_UNDECIDED && getenv("PSCN_SHOW")) show(name, form, s, ray, &hit, "undecided");
    if (certificate.finding > FINDING_UNDECIDED) show_refuted(name, form, s, ray, &hit, &certificate);
  }
  certifier_destroy(&certifier);
  trial_destroy(&trial);
  return most;
}

static size_t refuted(const size_t answers[FINDINGS])
{
  size_t sum = 0;
  for (int n = FINDING_UNDECIDED + 1; n < FINDINGS; n++) sum += answers[n];
  return sum;
}

static void print_count(const char *name, const struct class_form *form, uint64_t seed, const struct count *c)
{
  const size_t *certain = c->answers[0], *grazing = c->answers[1];
  const size_t grazes = grazing[FINDING_PROVEN] + grazing[FINDING_UNDECIDED] + refuted(grazing);
  printf("%-36s %-9s %2d %7zu rays: certain %6zu, %zu undecided, %zu refuted; grazing %zu, %zu provable, %zu refuted; "
         "lost %zu later %zu invented %zu surface %zu; %zu slow, slowest %.2f ms; seed %llu\n",
         name, form->solver, form->split, c->rays, certain[FINDING_PROVEN], certain[FINDING_UNDECIDED],
         refuted(certain), grazes, c->grazing_sure, refuted(grazing), certain[FINDING_LOST] + grazing[FINDING_LOST],
         certain[FINDING_LATER] + grazing[FINDING_LATER], certain[FINDING_INVENTED] + grazing[FINDING_INVENTED],
         certain[FINDING_SURFACE] + grazing[FINDING_SURFACE], c->slow, 1e3 * c->slowest, (unsigned long long)seed);
  fflush(stdout);
}

static void test_class(void **state)
{
  const struct situation_class *class = *state;
  size_t bad = 0, certain_bad = 0;
  if (!class_wanted(class)) return;
  for (int m = 0; m < CLASS_FORMS; m++) {
    struct count count = {0};
    const uint64_t seed = effort_seed(class->seed);
    class_ask_rays(class, m, FULL_RAYS, seed, ask, &count);
    print_count(class->name, &class_forms[m], seed, &count);
    certain_bad += refuted(count.answers[0]) + count.company, bad += refuted(count.answers[1]);
  }
  exact_cleanup();
  assert_int_equal(certain_bad, 0);
  if (!class_told_only(class)) assert_int_equal(bad, 0);
}

/* What the reference says, as an answer. */
static struct hit hit_of(const struct reference_answer *truth)
{
  struct hit hit = {.patch = HIT_NONE, .certainty = CERTAINTY_CERTAIN};
  if (truth->verdict == REFERENCE_MISS) return hit;
  hit.patch = truth->patch, hit.t = (double)truth->t;
  hit.u = fmin(fmax((double)truth->u, 0), 1), hit.v = fmin(fmax((double)truth->v, 0), 1);
  hit.point_error = INFINITY, hit.normal[0] = 1;
  return hit;
}

/* From so far away, in sizes of the patch, the reference's 113 bits do not tell U and V to a double's. */
#define FAR 0x1p48

static bool is_far(const struct certifier *certifier, const struct ray *ray, const struct hit *hit)
{
  if (hit->patch == HIT_NONE) return false;
  const double(*box)[3] = (const double(*)[3])certifier->boxes[hit->patch], *d = ray->direction;
  double extent = 0, way = 0;
  for (int k = 0; k < 3; k++) extent = fmax(extent, box[1][k] - box[0][k]), way = fmax(way, fabs(hit->t * d[k]));
  return way > FAR * extent;
}

/* The two judges agree on what either decides, and the exact one refutes what is wrong. */
static void test_judges(void **state)
{
  (void)state;
  size_t found[4][FINDINGS] = {{0}};
  for (size_t n = 0; n < every_class_count(); n++) {
    const struct situation_class *class = every_class_at(n);
    if (!class_wanted(class)) continue;
    struct random random = {.state = effort_seed(class->seed)};
    for (size_t index = 0; index < effort_count(FULL_SITUATIONS, 1); index++) {
      struct situation s;
      struct trial trial;
      struct certifier certifier;
      class->generate(&random, index, &s);
      trial_create(&trial, (const double(*)[4][4][3])s.P, s.count, NULL);
      certifier_create(&certifier, &trial.scene, trial.reference);
      for (int r = 0; r < SITUATION_RAYS; r++) {
        struct reference_answer truth;
        reference_closest(trial.reference, s.rays[r].origin, s.rays[r].direction, &truth);
        if (truth.verdict == REFERENCE_GRAZING) continue;
        struct hit hit = hit_of(&truth);
        struct certificate c;
        if (is_far(&certifier, &s.rays[r], &hit)) continue;
        certify(&certifier, &s.rays[r], &hit, &c);
        found[0][c.finding]++;
        if (c.finding > FINDING_PROVEN)
          show_refuted(class->name, &(struct class_form){"reference", 0}, &s, &s.rays[r], &hit, &c);
        if (hit.patch == HIT_NONE || c.finding != FINDING_PROVEN) continue;
        const double t = hit.t, floor = trial_floor(trial.reference, &s.rays[r], hit.patch, t, hit.u, hit.v).t;
        if (!(floor < 1e-6 * t)) continue;
        hit.t = t - 64 * floor;
        certify(&certifier, &s.rays[r], &hit, &c);
        found[1][c.finding]++;
        hit.t = t + 64 * floor;
        certify(&certifier, &s.rays[r], &hit, &c);
        found[2][c.finding]++;
        hit.patch = HIT_NONE;
        certify(&certifier, &s.rays[r], &hit, &c);
        found[3][c.finding]++;
      }
      certifier_destroy(&certifier);
      trial_destroy(&trial);
    }
  }
  exact_cleanup();
  static const char *const names[4] = {"the reference's", "nearer", "farther", "denied"};
  for (int n = 0; n < 4; n++) {
    printf("%s:", names[n]);
    for (int k = 0; k < FINDINGS; k++) printf(" %s %zu", finding_names[k], found[n][k]);
    printf("\n");
  }
  for (int k = FINDING_UNDECIDED + 1; k < FINDINGS; k++) assert_int_equal(found[0][k], 0);
  assert_int_equal(found[1][FINDING_PROVEN] + found[3][FINDING_PROVEN], 0);
  /* of coincident patches the other one may be there */
  assert_true(found[2][FINDING_PROVEN] * 50 <= found[2][FINDING_LATER]);
}

int main(void)
{
  const struct CMUnitTest judges = cmocka_unit_test(test_judges);
  return class_tests_run("certificates", test_class, &judges);
}

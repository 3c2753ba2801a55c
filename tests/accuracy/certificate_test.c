/* Proves that no answer is wrong. The exact judge proves or refutes every answer to all classes of situations.h: each
 * ray in several ways, with every solver and several splits, all judged by one proof. None may be refuted, whether it
 * is called certain or grazing. Prints for each class and solver the counts by verdict. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "accuracy/certificate.h"
#include "accuracy/class_tests.h"
#include "accuracy/cycle_scenes.h"
#include "accuracy/generators.h"
#include "cmocka_test.h"
#include "effort.h"
#include "random.h"

/* This many rays, with 7 forms and in 4 ways, make a million answers. */
enum { FULL_RAYS = 36000, LEAST_RAYS = 16, FULL_SITUATIONS = 5, MOST_SHOWN = 6 };

/* The number of crowds of each kind, and of packets at each. */
static const size_t FULL_CROWDS[] = {2000, 200};
enum { FIRST_CROWD = 740, CROWD_PACKETS = 32 };

enum verdict { CERTAIN_HIT, CERTAIN_MISS, GRAZING_HIT, GRAZING_MISS, VERDICTS };

struct count {
  size_t answers[VERDICTS][FINDINGS];
  size_t grazing_sure; /* grazing although the judge proves the answer */
  size_t company;      /* answered differently in a packet than alone, or when asked for any hit */
};

struct asking {
  struct random random;
  struct count counts[CLASS_FORMS];
};

/* With PSCN_SHOW set, shows everything, and the patches too. */
static void show(const char *name, const struct trial *trial, const struct ray *ray, const struct hit *hit,
                 const char *what)
{
  static size_t shown = 0;
  if (shown++ >= MOST_SHOWN && !getenv("PSCN_SHOW")) return;
  printf("%s: %s\n", name, what);
  print_ray(ray);
  print_hit("answer", hit);
  if (getenv("PSCN_SHOW")) print_patches(&trial->scene);
}

static void show_refuted(const char *name, const struct trial *trial, const struct ray *ray, const struct hit *hit,
                         const struct certificate *c)
{
  show(name, trial, ray, hit, finding_names[c->finding]);
  if (c->patch != REFERENCE_NONE)
    printf("  truth: t %.17g u %.17g v %.17g patch %u, %.3g floors\n", c->t, c->u, c->v, (unsigned)c->patch, c->off);
}

/* Whether the answer to a ray alone is as good as that in a packet, which `tally` judges: the same if it is grazing; of
 * the same verdict, and not refuted either, if it is certain. */
static bool fits(const struct hit *alone, const struct hit *packed, struct certifier *certifier, const struct ray *ray)
{
  struct certificate certificate;
  if (alone->patch != packed->patch || alone->certainty != packed->certainty) return false;
  if (alone->certainty != CERTAINTY_CERTAIN) return alone->patch == HIT_NONE || alone->t == packed->t;
  certify(certifier, ray, alone, &certificate);
  return certificate.finding <= FINDING_UNDECIDED;
}

static enum verdict verdict_of(const struct hit *hit)
{
  if (hit->certainty == CERTAINTY_CERTAIN) return hit->patch == HIT_NONE ? CERTAIN_MISS : CERTAIN_HIT;
  return hit->patch == HIT_NONE ? GRAZING_MISS : GRAZING_HIT;
}

static void tally(const char *name, const struct trial *trial, struct certifier *certifier, const struct ray *ray,
                  const struct hit *hit, struct count *count)
{
  struct certificate certificate;
  certify(certifier, ray, hit, &certificate);
  const enum verdict verdict = verdict_of(hit);
  count->answers[verdict][certificate.finding]++;
  count->grazing_sure += verdict >= GRAZING_HIT && certificate.finding == FINDING_PROVEN && certificate.sure;
  if (certificate.finding > FINDING_UNDECIDED) show_refuted(name, trial, ray, hit, &certificate);
}

/* Checks that a ray asked alone is answered as among the situation's other rays. A packet's lanes do what they do for a
 * picture; a ray alone takes another path. */
static void ask_alone(const char *name, struct trial *trial, struct certifier *certifier, const struct ray *ray,
                      const struct hit *packed, struct count *count)
{
  struct hit hit;
  tracer_closest(trial->tracer, 1, ray, &hit);
  if (!fits(&hit, packed, certifier, ray)) count->company++, show(name, trial, ray, &hit, "otherwise in a packet");
}

/* The ways to ask a ray of a class: as it is; back from beyond its hit; ending or starting at the hit, exactly or off
 * by 2^-20 to 2^-53. For a miss the generators' target, t = 1, replaces the hit. */
enum way { AS_IT_IS, BACK, ENDING, STARTING, WAYS };

static struct ray ray_of_way(const struct ray *ray, const struct hit *hit, enum way way, struct random *random)
{
  struct ray out = *ray;
  const double t = hit->patch == HIT_NONE ? 1 : hit->t;
  const double end = t + t * (double)((int)choose(random, 3) - 1) * ldexp(1, -20 - (int)choose(random, 34));
  for (int axis = 0; way == BACK && axis < 3; axis++) {
    const double from = ray->origin[axis] + 2 * t * ray->direction[axis];
    if (!(fabs(from) < 0x1p1000)) return *ray;
    out.origin[axis] = from, out.direction[axis] = -ray->direction[axis];
  }
  if (way == ENDING && end > ray->t_min) out.t_max = end;
  if (way == STARTING && end < ray->t_max) out.t_min = end;
  return out;
}

/* Checks that a ray with an end, asked for any hit, is answered as its nearest hit says if that is certain. */
static void ask_shadows(const char *name, struct trial *trial, const struct ray *rays, size_t most,
                        const struct hit *hits, struct count *count)
{
  bool occluded[SITUATION_RAYS];
  tracer_occluded(trial->tracer, most, rays, occluded);
  for (size_t n = 0; n < most; n++) {
    if (hits[n].certainty != CERTAINTY_CERTAIN || occluded[n] == (hits[n].patch != HIT_NONE)) continue;
    count->company++, show(name, trial, &rays[n], &hits[n], "otherwise asked for any hit");
  }
}

static void ask(const char *name, const struct situation *s, size_t most, void *context)
{
  struct asking *asking = context;
  struct class_trials trials;
  struct certifier certifier;
  struct hit first[SITUATION_RAYS], hits[CLASS_FORMS][SITUATION_RAYS];
  struct ray rays[SITUATION_RAYS];
  class_trials_create(&trials, s);
  certifier_create(&certifier, &trials.form[0].scene, trials.form[0].reference);
  tracer_closest(trials.form[0].tracer, most, s->rays, first);
  for (enum way way = 0; way < WAYS; way++) {
    for (size_t n = 0; n < most; n++) rays[n] = ray_of_way(&s->rays[n], &first[n], way, &asking->random);
    for (int m = 0; m < CLASS_FORMS; m++) {
      struct trial *trial = &trials.form[m];
      tracer_closest(trial->tracer, most, rays, hits[m]);
      if (way == ENDING) ask_shadows(name, trial, rays, most, hits[m], &asking->counts[m]);
    }
    for (size_t n = 0; n < most; n++) {
      for (int m = 0; m < CLASS_FORMS; m++) {
        struct count *count = &asking->counts[m];
        tally(name, &trials.form[m], &certifier, &rays[n], &hits[m][n], count);
        if (way == AS_IT_IS) ask_alone(name, &trials.form[m], &certifier, &rays[n], &hits[m][n], count);
      }
    }
  }
  certifier_destroy(&certifier);
  class_trials_destroy(&trials);
}

/* The number of answers in a range of verdicts with findings in a range. */
static size_t sum(const struct count *c, int verdict, int last_verdict, int finding, int last_finding)
{
  size_t all = 0;
  for (int v = verdict; v <= last_verdict; v++)
    for (int n = finding; n <= last_finding; n++) all += c->answers[v][n];
  return all;
}

static size_t refuted(const struct count *c, int verdict, int last_verdict)
{
  return sum(c, verdict, last_verdict, FINDING_UNDECIDED + 1, FINDINGS - 1);
}

static void print_count(const char *name, const char *form, uint64_t seed, const struct count *c)
{
  printf("%-36s %-21s %7zu answers: proven %zu hits, %zu misses; grazing %zu, %zu of them provable; undecided %zu; "
         "refuted %zu certain, %zu grazing; seed %llu\n",
         name, form, sum(c, 0, VERDICTS - 1, 0, FINDINGS - 1), c->answers[CERTAIN_HIT][FINDING_PROVEN],
         c->answers[CERTAIN_MISS][FINDING_PROVEN], sum(c, GRAZING_HIT, GRAZING_MISS, 0, FINDINGS - 1), c->grazing_sure,
         sum(c, CERTAIN_HIT, CERTAIN_MISS, FINDING_UNDECIDED, FINDING_UNDECIDED), refuted(c, CERTAIN_HIT, CERTAIN_MISS),
         refuted(c, GRAZING_HIT, GRAZING_MISS), (unsigned long long)seed);
  fflush(stdout);
}

/* A grazing answer is a guess. One wrong guess in so many answers is none too many. */
enum { MOST_GUESSED_WRONG = 300 };

static void test_class(void **state)
{
  const struct situation_class *class = *state;
  const uint64_t seed = effort_seed(class->seed);
  struct asking asking = {.random = {.state = seed + 1}};
  size_t bad = 0, certain_bad = 0, answers = 0;
  if (!class_wanted(class)) return;
  class_ask_rays(class, FULL_RAYS, LEAST_RAYS, seed, ask, &asking);
  for (int m = 0; m < CLASS_FORMS; m++) {
    print_count(class->name, class_forms[m], seed, &asking.counts[m]);
    certain_bad += refuted(&asking.counts[m], CERTAIN_HIT, CERTAIN_MISS) + asking.counts[m].company;
    bad += refuted(&asking.counts[m], GRAZING_HIT, GRAZING_MISS);
    answers += sum(&asking.counts[m], 0, VERDICTS - 1, 0, FINDINGS - 1);
  }
  exact_cleanup();
  assert_int_equal(certain_bad, 0);
  if (!class_told_only(class)) assert_true(bad * MOST_GUESSED_WRONG <= answers);
}

/* Asks rays at one crowd. */
static void ask_crowd(const char *name, bool copied, struct random *random, struct count *count)
{
  struct cycle_scene crowd;
  struct trial trial;
  struct certifier certifier;
  size_t shape;
  do shape = choose(random, cycle_shape_count());
  while (!cycle_shape_moves(shape));
  cycle_crowd_create(shape, copied, random, &crowd);
  trial_of_scene(&trial, &crowd.scene);
  certifier_create(&certifier, &crowd.scene, trial.reference);
  for (int packet = 0; packet < CROWD_PACKETS; packet++) {
    struct situation s = {.count = 1};
    struct hit hits[SITUATION_RAYS];
    memcpy(s.P[0], crowd.scene.patches[choose(random, crowd.scene.patch_count)].P, sizeof s.P[0]);
    const double size = situation_size(&s);
    for (int n = 0; n < SITUATION_RAYS; n++) threshold_aim(random, (const double(*)[4][3])s.P[0], size, &s.rays[n]);
    tracer_closest(trial.tracer, SITUATION_RAYS, s.rays, hits);
    for (int n = 0; n < SITUATION_RAYS; n++) tally(name, &trial, &certifier, &s.rays[n], &hits[n], count);
  }
  certifier_destroy(&certifier);
  trial_destroy(&trial);
  cycle_scene_destroy(&crowd);
}

/* The same proof for crowds: copies, which share their leaves, and scenes so large that no leaves are kept. */
static void test_crowds(void **state)
{
  (void)state;
  static const char *const names[] = {"copies of one object", "leaves made for each ray"};
  for (int kind = 0; kind < 2; kind++) {
    const uint64_t seed = effort_seed(FIRST_CROWD + (uint64_t)kind);
    const size_t wanted = effort_count(FULL_CROWDS[kind], kind == 0); /* a quick run makes none of the large ones */
    struct random random = {.state = seed};
    struct count count = {.company = 0};
    if (getenv("PSCN_CLASS") && !strstr(names[kind], getenv("PSCN_CLASS"))) continue;
    for (size_t n = 0; n < wanted; n++) ask_crowd(names[kind], kind == 0, &random, &count);
    print_count(names[kind], class_forms[0], seed, &count);
    assert_int_equal(refuted(&count, CERTAIN_HIT, CERTAIN_MISS) + count.company, 0);
    assert_true(refuted(&count, GRAZING_HIT, GRAZING_MISS) * MOST_GUESSED_WRONG <=
                sum(&count, 0, VERDICTS - 1, 0, FINDINGS - 1));
  }
  exact_cleanup();
}

/* The reference's statement as an answer. */
static struct hit hit_of(const struct reference_answer *truth)
{
  struct hit hit = {.patch = HIT_NONE, .certainty = CERTAINTY_CERTAIN};
  if (truth->verdict == REFERENCE_MISS) return hit;
  hit.patch = truth->patch, hit.t = (double)truth->t;
  hit.u = fmin(fmax((double)truth->u, 0), 1), hit.v = fmin(fmax((double)truth->v, 0), 1);
  hit.point_error = INFINITY, hit.normal[0] = 1;
  return hit;
}

/* From this far away, in sizes of the patch, the reference's 113 bits do not give U and V to a double's precision. */
#define FAR 0x1p48

static bool is_far(const struct certifier *certifier, const struct ray *ray, const struct hit *hit)
{
  if (hit->patch == HIT_NONE) return false;
  const double(*box)[3] = (const double(*)[3])certifier->boxes[hit->patch], *d = ray->direction;
  double extent = 0, way = 0;
  for (int k = 0; k < 3; k++) extent = fmax(extent, box[1][k] - box[0][k]), way = fmax(way, fabs(hit->t * d[k]));
  return way > FAR * extent;
}

/* What the judge is asked to judge: the reference's answer, and wrong ones. */
enum wrong { RIGHT, NEARER, FARTHER, DENIED, MADE_UP, WRONGS };
static const char *const wrong_names[WRONGS] = {"the reference's", "nearer", "farther", "denied", "made up"};

/* An answer this many floors off is wrong. More than CERTIFICATE_FLOORS, because next to a tangency floors change from
 * place to place. */
#define WRONG_FLOORS 16

static void judge_wrong(const char *name, const struct trial *trial, struct certifier *certifier, const struct ray *ray,
                        size_t found[WRONGS][FINDINGS])
{
  struct reference_answer truth;
  reference_closest(certifier->reference, ray->origin, ray->direction, &truth);
  if (truth.verdict == REFERENCE_GRAZING) return;
  struct hit hit = hit_of(&truth);
  struct certificate c;
  if (is_far(certifier, ray, &hit)) return;
  certify(certifier, ray, &hit, &c);
  /* The reference takes a root on a border and one next to it as one, and a border is as wide as REFERENCE_BORDER. */
  if (c.finding == FINDING_LATER && hit.t - c.t <= REFERENCE_SAME_POINT * hit.t) return;
  if (c.finding > FINDING_UNDECIDED && truth.shared) return;
  found[RIGHT][c.finding]++;
  if (c.finding > FINDING_PROVEN) show_refuted(name, trial, ray, &hit, &c);
  if (c.finding != FINDING_PROVEN) return;
  if (hit.patch == HIT_NONE) {
    hit = (struct hit){.t = 1, .u = 0.5, .v = 0.5, .point_error = INFINITY, .normal = {1, 0, 0}};
    certify(certifier, ray, &hit, &c);
    found[MADE_UP][c.finding]++;
    return;
  }
  const double t = hit.t, floor = trial_floor(certifier->reference, ray, hit.patch, t, hit.u, hit.v).t;
  if (!(floor < 1e-6 * t)) return;
  hit.t = t - WRONG_FLOORS * floor;
  certify(certifier, ray, &hit, &c);
  found[NEARER][c.finding]++;
  hit.t = t + WRONG_FLOORS * floor;
  certify(certifier, ray, &hit, &c);
  found[FARTHER][c.finding]++;
  hit.patch = HIT_NONE;
  certify(certifier, ray, &hit, &c);
  found[DENIED][c.finding]++;
}

/* Proves that the two judges agree on what either decides, and that the exact one refutes wrong answers. */
static void test_judges(void **state)
{
  (void)state;
  size_t found[WRONGS][FINDINGS] = {{0}};
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
      for (int r = 0; r < SITUATION_RAYS; r++) judge_wrong(class->name, &trial, &certifier, &s.rays[r], found);
      certifier_destroy(&certifier);
      trial_destroy(&trial);
    }
  }
  exact_cleanup();
  for (int n = 0; n < WRONGS; n++) {
    printf("%s:", wrong_names[n]);
    for (int k = 0; k < FINDINGS; k++) printf(" %s %zu", finding_names[k], found[n][k]);
    printf("\n");
  }
  for (int k = FINDING_UNDECIDED + 1; k < FINDINGS; k++) assert_int_equal(found[RIGHT][k], 0);
  assert_int_equal(found[NEARER][FINDING_PROVEN] + found[DENIED][FINDING_PROVEN] + found[MADE_UP][FINDING_PROVEN], 0);
  /* If patches coincide, the root of the other one may be there; in some classes most patches coincide. */
  if (!getenv("PSCN_CLASS")) assert_true(found[FARTHER][FINDING_PROVEN] * 50 <= found[FARTHER][FINDING_LATER]);
}

int main(void)
{
  const struct CMUnitTest others[] = {cmocka_unit_test(test_crowds), cmocka_unit_test(test_judges)};
  return class_tests_run("certificates", every_class_count(), test_class, others, sizeof others / sizeof others[0]);
}

/* Checks the answers of a scene, for hunting by hand. Reads rays from stdin, one `ox oy oz dx dy dz` a line; prints
 * every refuted answer, then the counts.
 *
 *   certify SCENE [SOLVER] [--all] < rays */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "accuracy/certificate.h"
#include "accuracy/exact.h"
#include "accuracy/trial.h"
#include "base/clock.h"
#include "cmocka_test.h"

static void show(size_t line, const struct ray *ray, const struct hit *hit, const struct certificate *c)
{
  const double *o = ray->origin, *d = ray->direction;
  printf("%s, line %zu: %.17g %.17g %.17g %.17g %.17g %.17g\n", finding_names[c->finding], line, o[0], o[1], o[2], d[0],
         d[1], d[2]);
  printf("  answer: %s ", hit->certainty == CERTAINTY_CERTAIN ? "certain" : "grazing");
  if (hit->patch == HIT_NONE) printf("miss");
  else printf("t %.17g u %.17g v %.17g patch %u", hit->t, hit->u, hit->v, (unsigned)hit->patch);
  printf("\n  truth:  ");
  if (c->patch == REFERENCE_NONE) printf("none proven");
  else printf("t %.17g u %.17g v %.17g patch %u", c->t, c->u, c->v, (unsigned)c->patch);
  printf(" (%.3g floors, %zu boxes)\n", c->off, c->boxes);
}

int main(int argc, char **argv)
{
  const bool all = argc > 2 && !strcmp(argv[argc - 1], "--all");
  if (argc < 2) return 2;
  struct scene *scene = trial_load(argv[1], argc > 2 + all ? argv[2] : NULL, 800, 600);
  if (!scene) return 3;
  struct trial trial;
  trial_of_scene(&trial, scene);
  struct certifier certifier;
  certifier_create(&certifier, scene, trial.reference);
  struct ray ray = {.t_min = 0, .t_max = INFINITY};
  double *o = ray.origin, *d = ray.direction, slowest = 0, judging = 0;
  size_t line = 0, slowest_line = 0, counts[2][FINDINGS] = {{0}};
  while (scanf("%lf %lf %lf %lf %lf %lf", &o[0], &o[1], &o[2], &d[0], &d[1], &d[2]) == 6) {
    struct hit hit;
    struct certificate certificate;
    const double start = clock_seconds(CLOCK_PROCESS_CPUTIME_ID);
    tracer_closest(trial.tracer, 1, &ray, &hit);
    const double end = clock_seconds(CLOCK_PROCESS_CPUTIME_ID);
    line++;
    if (end - start > slowest) slowest = end - start, slowest_line = line;
    certify(&certifier, &ray, &hit, &certificate);
    judging += clock_seconds(CLOCK_PROCESS_CPUTIME_ID) - end;
    counts[hit.certainty != CERTAINTY_CERTAIN][certificate.finding]++;
    if (all || certificate.finding > FINDING_UNDECIDED) show(line, &ray, &hit, &certificate);
  }
  for (int graze = 0; graze < 2; graze++) {
    printf("%s:", graze ? "grazing" : "certain");
    for (int n = 0; n < FINDINGS; n++) printf(" %s %zu", finding_names[n], counts[graze][n]);
    printf("\n");
  }
  printf("slowest: line %zu, %.3g ms; judging took %.3g s\n", slowest_line, 1e3 * slowest, judging);
  certifier_destroy(&certifier);
  trial_destroy(&trial);
  scene_destroy(scene);
  exact_cleanup();
  return 0;
}

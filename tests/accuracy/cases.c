/* Rays that were once answered wrongly must stay right, with whatever solver. Each is a scene of tests/accuracy/cases; the
 * exact judge judges it. Its first lines say the fault, the solver of which the rest is true, the ray, and
 *   from: T         the ray begins there
 *   to: T           it ends there
 *   certain: yes    the answer must be certain; `no`: it must not be
 *   t: T  uv: U V   where the hit must be, to the last places
 *   patch: N        its patch
 *   all: N          there must be N hits in all, certainly; `grazing`: it must not be certain how many
 *   facing: X Y Z   the side of the normal */
#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "accuracy/certificate.h"
#include "accuracy/class_tests.h"
#include "cmocka_test.h"
#include "geometry/vector.h"

#define FOLDER PSCN_SOURCE_DIR "/tests/accuracy/cases/"

enum { LINE_SIZE = 512 };

#define OFF 0x1p-50 /* relative: a unit in the last place or two */

/* The rest of the line that starts with `// KEY: `, or "". */
static void header(const char *path, const char *key, char out[LINE_SIZE])
{
  char line[LINE_SIZE], start[32];
  const int length = snprintf(start, sizeof start, "// %s: ", key);
  FILE *file = fopen(path, "r");
  assert_non_null(file);
  out[0] = 0;
  while (!out[0] && fgets(line, sizeof line, file))
    if (!strncmp(line, start, (size_t)length)) strcpy(out, line + length);
  fclose(file);
  out[strcspn(out, "\n")] = 0;
}

/* Whether the numbers in `text`, if any, are these. */
static bool numbers_are(const char *text, size_t count, const double x[])
{
  char *rest;
  for (size_t k = 0; k < count && text[0]; k++, text = rest)
    if (!(fabs(x[k] - strtod(text, &rest)) <= OFF * fabs(x[k]))) return false;
  return true;
}

/* Whether the normal is on the side of the vector in `text`, if there is one. */
static bool faces(const char *text, const double normal[3])
{
  double side[3] = {0};
  return !text[0] || (sscanf(text, "%lf %lf %lf", &side[0], &side[1], &side[2]) == 3 && vector_dot(side, normal) > 0);
}

/* Whether the list of all hits is right, and there are as many as in `count`, if that is given; if list and nearest hit
 * are certain, the first must be the nearest. */
static bool all_good(const struct trial *trial, struct certifier *certifier, const struct ray *ray,
                     const struct hit *nearest, const char *count)
{
  struct hit_list list;
  assert_int_equal(tracer_all(trial->tracer, 1, ray, &list), STATUS_OK);
  if (certify_list(certifier, ray, &list) > LIST_UNDECIDED) return false;
  if (list.certainty == CERTAINTY_CERTAIN && nearest->certainty == CERTAINTY_CERTAIN &&
      (list.count > 0 ? list.hits[0].patch : HIT_NONE) != nearest->patch)
    return false;
  if (!strcmp(count, "grazing")) return list.certainty == CERTAINTY_GRAZING;
  return !count[0] || (list.certainty == CERTAINTY_CERTAIN && list.count == strtoul(count, NULL, 10));
}

/* Whether the nearest hit is what the file says of it. */
static bool as_said(const char *path, const struct hit *hit)
{
  char certain[LINE_SIZE], t[LINE_SIZE], uv[LINE_SIZE], patch[LINE_SIZE], facing[LINE_SIZE];
  header(path, "certain", certain), header(path, "t", t), header(path, "uv", uv);
  header(path, "patch", patch), header(path, "facing", facing);
  return (!certain[0] || (hit->certainty == CERTAINTY_CERTAIN) == !strcmp(certain, "yes")) &&
         numbers_are(t, 1, &hit->t) && numbers_are(uv, 2, (double[]){hit->u, hit->v}) &&
         numbers_are(patch, 1, (double[]){hit->patch}) && faces(facing, hit->normal);
}

/* How many answers are wrong: by the case's own solver, and by those of all classes, of which the file says nothing. */
static int wrong_answers(const char *path)
{
  char solver[LINE_SIZE], text[LINE_SIZE], from[LINE_SIZE], to[LINE_SIZE], count[LINE_SIZE];
  header(path, "solver", solver), header(path, "ray", text), header(path, "from", from), header(path, "to", to);
  header(path, "all", count);
  struct ray ray = {.t_min = from[0] ? strtod(from, NULL) : 0, .t_max = to[0] ? strtod(to, NULL) : INFINITY};
  double *o = ray.origin, *d = ray.direction;
  assert_int_equal(sscanf(text, "%lf %lf %lf %lf %lf %lf", &o[0], &o[1], &o[2], &d[0], &d[1], &d[2]), 6);
  struct scene *scene = trial_load(path, solver[0] ? solver : NULL, 800, 600);
  assert_non_null(scene);
  struct trial own;
  struct certifier certifier;
  int wrong = 0;
  trial_of_scene(&own, scene);
  certifier_create(&certifier, scene, own.reference);
  const int forms = scene->copy_count > 0 ? 0 : CLASS_FORMS; /* preparing many copies takes long */
  for (int m = -1; m < forms; m++) {
    struct trial other;
    struct hit hit;
    struct certificate certificate;
    if (m >= 0) trial_create_beside(&other, &own, class_forms[m]);
    const struct trial *trial = m < 0 ? &own : &other;
    tracer_closest(trial->tracer, 1, &ray, &hit);
    certify(&certifier, &ray, &hit, &certificate);
    const bool all = all_good(trial, &certifier, &ray, &hit, m < 0 ? count : "");
    if (!all || certificate.finding > FINDING_UNDECIDED || (m < 0 && !as_said(path, &hit)))
      wrong++, printf("%s, %s:%s %s, %s\n", strrchr(path, '/') + 1, m < 0 ? "its own solver" : class_forms[m],
                      all ? "" : " not all, a wrong one, or grazing;",
                      hit.certainty == CERTAINTY_CERTAIN ? "certain" : "grazing", finding_names[certificate.finding]);
    if (m >= 0) trial_destroy(&other);
  }
  certifier_destroy(&certifier);
  trial_destroy(&own);
  scene_destroy(scene);
  return wrong;
}

TEST(test_cases)
{
  struct dirent **entries;
  const int count = scandir(FOLDER, &entries, NULL, alphasort);
  assert_true(count > 0);
  int bad = 0, cases = 0;
  for (int n = 0; n < count; n++) {
    if (strstr(entries[n]->d_name, ".pscn")) {
      char path[LINE_SIZE];
      snprintf(path, sizeof path, "%s%s", FOLDER, entries[n]->d_name);
      bad += wrong_answers(path), cases++;
    }
    free(entries[n]);
  }
  free(entries);
  exact_cleanup();
  printf("%d cases, %d answers wrong\n", cases, bad);
  assert_int_equal(bad, 0);
}

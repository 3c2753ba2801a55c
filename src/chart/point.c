/* Points of a chart. */
#include "chart/point.h"

#include <math.h>
#include <string.h>

const char *family_name(enum family family)
{
  static const char *const NAMES[FAMILIES] = {"bernstein", "newton",       "laguerre", "aberth",
                                              "paper",     "plain-newton", "embree",   "povray"};
  return NAMES[family];
}

static double tolerance_at(int power) { return pow(10, -power); }

/* Every combination of one solver. `bernstein` works in its own basis from its own start values. */
static size_t sweep_solver(const struct solver *solver, enum family family, bool quick, struct sweep_point *out)
{
  enum { FIRST = 1, LAST = 15, QUICK_STEP = 7 };
  const int starts = solver->real_only ? 1 : 2, bases = starts;
  size_t count = 0;
  for (int power = FIRST; power <= LAST; power += quick ? QUICK_STEP : 1) {
    for (int way = 0; way < 2 * starts * bases; way++) {
      if (out != NULL) {
        struct sweep_point *point = &out[count];
        point->family = family;
        method_default(solver, &point->options);
        point->options.roots.tolerance = tolerance_at(power);
        point->options.polish = way % 2 == 0;
        if (starts > 1) {
          point->options.roots.start = way / 2 % 2 == 0 ? START_PREVIOUS : START_COLD;
          point->options.basis = way / 4 == 0 ? BASIS_BERNSTEIN : BASIS_POWER;
        }
      }
      count++;
    }
    for (int start = 0; start < 2 && !solver->real_only; start++, count++) {
      if (out == NULL) continue;
      out[count].family = FAMILY_PAPER;
      method_default(solver, &out[count].options);
      out[count].options.roots.tolerance = tolerance_at(power);
      out[count].options.roots.start = start == 0 ? START_PREVIOUS : START_COLD;
      method_item_find("form")->set(&out[count].options, 0);
    }
  }
  for (int start = 0; start < starts; start++, count++) { /* whole patches, otherwise as by default */
    if (out == NULL) continue;
    out[count].family = family;
    method_default(solver, &out[count].options);
    out[count].options.split = 1;
    if (starts > 1) out[count].options.roots.start = start == 0 ? START_PREVIOUS : START_COLD;
  }
  return count;
}

size_t point_sweep(bool quick, struct sweep_point *out)
{
  static const struct {
    const char *name;
    enum family family;
  } SOLVERS[] = {
    {"bernstein", FAMILY_DEFAULT}, {"newton", FAMILY_NEWTON}, {"laguerre", FAMILY_LAGUERRE}, {"aberth", FAMILY_ABERTH}};
  if (out != NULL) {
    out[0].family = FAMILY_DEFAULT;
    method_default(solver_at(0), &out[0].options);
  }
  size_t count = 1;
  for (size_t k = 0; k < sizeof SOLVERS / sizeof SOLVERS[0]; k++) {
    const struct solver *solver = solver_find(SOLVERS[k].name, strlen(SOLVERS[k].name));
    if (solver != NULL) count += sweep_solver(solver, SOLVERS[k].family, quick, out == NULL ? NULL : out + count);
  }
  return count;
}

void point_level(struct chart_point *points, size_t count, const double yard[RAY_KINDS])
{
  for (size_t k = 0; k < count; k++) {
    for (int kind = 0; kind < RAY_KINDS; kind++) {
      struct timing *time = &points[k].time[kind];
      const double factor = yard[kind] * time->ratio / time->median;
      if (!isfinite(factor)) continue;
      time->least *= factor, time->lower *= factor, time->median *= factor, time->upper *= factor, time->most *= factor;
    }
  }
}

static bool beats(const struct chart_point *a, const struct chart_point *b)
{
  const double ta = a->time[RAYS_CAMERA].median, tb = b->time[RAYS_CAMERA].median;
  const double ea = a->camera.most_of_all, eb = b->camera.most_of_all;
  return ta <= tb && ea <= eb && (ta < tb || ea < eb);
}

/* Times whose quartiles overlap are not told apart. */
static bool ties(const struct chart_point *a, const struct chart_point *b)
{
  const struct timing *p = &a->time[RAYS_CAMERA], *q = &b->time[RAYS_CAMERA];
  return a->camera.most_of_all <= b->camera.most_of_all && p->lower <= q->upper && q->lower <= p->upper;
}

/* Whether another one is no less exact, and faster by more than the noise. */
static bool clearly_beaten(const struct chart_point *points, size_t count, const struct chart_point *point)
{
  for (size_t k = 0; k < count; k++)
    if (points[k].camera.most_of_all <= point->camera.most_of_all &&
        points[k].time[RAYS_CAMERA].upper < point->time[RAYS_CAMERA].lower)
      return true;
  return false;
}

void point_front(struct chart_point *points, size_t count)
{
  for (size_t k = 0; k < count; k++) {
    points[k].front = isfinite(points[k].time[RAYS_CAMERA].median) && isfinite(points[k].camera.most_of_all);
    for (size_t other = 0; points[k].front && other < count; other++)
      points[k].front = !beats(&points[other], &points[k]);
  }
  for (size_t k = 0; k < count; k++) {
    for (size_t first = 0; points[k].front && first < k; first++) {
      if (!ties(&points[first], &points[k]) || clearly_beaten(points, count, &points[first])) continue;
      points[k].front = false, points[first].front = true;
    }
  }
}

/* Points of a chart. */
#include "chart/point.h"

#include <assert.h>
#include <math.h>
#include <string.h>

const char *family_name(enum family family)
{
  static const char *const NAMES[FAMILIES] = {"bernstein", "newton", "laguerre", "aberth", "paper",
                                              "other",     "rival",  "embree",   "povray"};
  return NAMES[family];
}

static double tolerance_at(int power) { return pow(10, -power); }

/* Points that are written one after another. */
struct sweep {
  struct sweep_point *out;
  size_t count;
};

/* Adds the next point: the solver with its defaults, which the caller changes. */
static struct method *add(struct sweep *sweep, const struct solver *solver, enum family family)
{
  struct sweep_point *point = &sweep->out[sweep->count++];
  assert(sweep->count <= SWEEP_MOST);
  point->family = family;
  method_default(solver, &point->options);
  return &point->options;
}

static enum start start_at(int number) { return number == 0 ? START_PREVIOUS : START_COLD; }

/* Every combination of one solver. One that finds only the real roots works only in its own basis and from its own
 * start values. */
static void sweep_solver(struct sweep *sweep, const struct solver *solver, enum family family, bool quick)
{
  enum { FIRST = 1, LAST = 15, QUICK_STEP = 7 };
  const int starts = solver->real_only ? 1 : 2, bases = starts;
  for (int power = FIRST; power <= LAST; power += quick ? QUICK_STEP : 1) {
    for (int way = 0; way < bases * starts * 2; way++) {
      struct method *method = add(sweep, solver, family);
      method->roots.tolerance = tolerance_at(power);
      method->polish = way % 2 == 0;
      if (solver->real_only) continue;
      method->roots.start = start_at(way / 2 % 2);
      method->basis = way / 4 == 0 ? BASIS_BERNSTEIN : BASIS_POWER;
    }
    for (int start = 0; start < 2 && !solver->real_only; start++) {
      struct method *method = add(sweep, solver, FAMILY_PAPER);
      method->roots.tolerance = tolerance_at(power);
      method->roots.start = start_at(start);
      method_item_find("form")->set(method, 0);
    }
  }
  for (int start = 0; start < starts; start++) { /* whole patches, otherwise the defaults */
    struct method *method = add(sweep, solver, family);
    method->split = 1;
    if (!solver->real_only) method->roots.start = start_at(start);
  }
}

static const struct {
  const char *name;
  enum family family;
} SOLVERS[] = {
  {"bernstein", FAMILY_DEFAULT}, {"newton", FAMILY_NEWTON}, {"laguerre", FAMILY_LAGUERRE}, {"aberth", FAMILY_ABERTH}};

void point_choice(const struct method solvers[], size_t count, struct sweep_point out[])
{
  out[0].family = FAMILY_DEFAULT;
  method_default(solver_at(0), &out[0].options);
  for (size_t k = 0; k < count; k++) {
    out[1 + k] = (struct sweep_point){FAMILY_OTHER, solvers[k]};
    for (size_t n = 0; n < sizeof SOLVERS / sizeof SOLVERS[0]; n++)
      if (strcmp(solvers[k].roots.solver->name, SOLVERS[n].name) == 0) out[1 + k].family = SOLVERS[n].family;
  }
}

size_t point_sweep(bool quick, struct sweep_point out[SWEEP_MOST])
{
  struct sweep sweep = {.out = out};
  (void)add(&sweep, solver_at(0), FAMILY_DEFAULT);
  for (size_t k = 0; k < sizeof SOLVERS / sizeof SOLVERS[0]; k++) {
    const struct solver *solver = solver_find(SOLVERS[k].name, strlen(SOLVERS[k].name));
    if (solver != NULL) sweep_solver(&sweep, solver, SOLVERS[k].family, quick);
  }
  return sweep.count;
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
  const double ea = a->camera.p99_of_all, eb = b->camera.p99_of_all;
  return ta <= tb && ea <= eb && (ta < tb || ea < eb || a < b);
}

void point_front(struct chart_point *points, size_t count)
{
  for (size_t k = 0; k < count; k++) {
    points[k].front = isfinite(points[k].time[RAYS_CAMERA].median) && isfinite(points[k].camera.p99_of_all);
    for (size_t other = 0; points[k].front && other < count; other++)
      points[k].front = !beats(&points[other], &points[k]);
  }
}

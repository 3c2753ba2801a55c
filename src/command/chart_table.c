/* The points of a chart as CSV, and its front as text. */
#include <math.h>
#include <stdio.h>

#include "command/chart.h"

static void put_number(struct page *out, double value)
{
  page_put(out, ",");
  if (isfinite(value))
    page_number(out, value, 6);
}

static void put_count(struct page *out, size_t value)
{
  page_format(out, ",%zu", value);
}

static void put_solver(const struct chart_point *point, struct page *out)
{
  const struct method *method = &point->options;
  if (!point->ours) {
    page_put(out, ",,,,,,");
    return;
  }
  page_format(out, ",%s,%s", method->roots.solver->name, method->basis == BASIS_POWER ? "power" : "bernstein");
  put_number(out, method->roots.tolerance);
  page_format(out, ",%s,%s,", method->polish ? "on" : "off", method->roots.start == START_PREVIOUS ? "previous" : "cold");
  if (method->split == 0)
    page_put(out, "auto");
  else
    page_format(out, "%d", method->split);
}

static void put_time(const struct timing *time, struct page *out)
{
  const double values[] = { time->least, time->lower, time->median, time->upper, time->most, time->ratio };
  for (size_t k = 0; k < sizeof values / sizeof values[0]; k++)
    put_number(out, values[k]);
}

static void put_point(const struct chart_point *point, struct page *out)
{
  const struct judgement *camera = &point->camera, *shadow = &point->shadow;
  const double errors[] = { camera->median, camera->most, camera->max, camera->most_of_all };
  const size_t counts[] = { camera->rays,     camera->hits,  camera->undecided,   camera->lost,
                            camera->invented, camera->wrong, camera->other_patch };
  page_format(out, "%s,\"%s\"", family_name(point->family), point->name);
  put_solver(point, out);
  for (int kind = 0; kind < RAY_KINDS; kind++)
    put_time(&point->time[kind], out);
  for (size_t k = 0; k < sizeof errors / sizeof errors[0]; k++)
    put_number(out, errors[k]);
  for (size_t k = 0; k < sizeof counts / sizeof counts[0]; k++)
    put_count(out, counts[k]);
  if (point->has_shadow) {
    const size_t shadows[] = { shadow->rays, shadow->hits, shadow->undecided, shadow->lost, shadow->invented };
    for (size_t k = 0; k < sizeof shadows / sizeof shadows[0]; k++)
      put_count(out, shadows[k]);
  } else {
    page_put(out, ",,,,,");
  }
  page_format(out, ",%d\n", point->front);
}

void chart_csv(const struct chart *chart, struct page *out)
{
  *out = (struct page){ 0 };
  page_put(out, "family,name,solver,basis,tolerance,polish,start,split,"
                "ns_least,ns_lower,ns_median,ns_upper,ns_most,ratio,"
                "shadow_ns_least,shadow_ns_lower,shadow_ns_median,shadow_ns_upper,shadow_ns_most,shadow_ratio,"
                "t_median,t_99,t_max,t_99_of_all,rays,hits,undecided,lost,invented,wrong,other_patch,"
                "shadow_rays,shadow_hits,shadow_undecided,shadow_lost,shadow_invented,front\n");
  for (size_t k = 0; k < chart->point_count; k++)
    put_point(&chart->points[k], out);
}

/* With `digits` behind the point, or with two significant ones where digits is 0. */
static void print_number(double value, int width, int digits)
{
  if (!isfinite(value))
    printf("%*s", width, "-");
  else if (digits > 0)
    printf("%*.*f", width, digits, value);
  else
    printf("%*.2g", width, value);
}

void chart_print(const struct chart *chart)
{
  printf("%9s %9s  %9s %9s %9s  %6s %6s %6s\n", "ns a ray", "ratio", "T median", "T 99 %", "T max", "lost", "inv.",
         "wrong");
  for (size_t k = 0; k < chart->point_count; k++) {
    const struct chart_point *point = &chart->points[k];
    if (!point->front && k > 0)
      continue;
    print_number(point->time[RAYS_CAMERA].median, 9, 1);
    print_number(point->time[RAYS_CAMERA].ratio, 10, 3);
    print_number(point->camera.median, 11, 0);
    print_number(point->camera.most, 10, 0);
    print_number(point->camera.max, 10, 0);
    printf("  %6zu %6zu %6zu  %s%s\n", point->camera.lost, point->camera.invented, point->camera.wrong, point->name,
           point->front ? " (front)" : "");
  }
}

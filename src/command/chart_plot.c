/* The figure, by gnuplot: time over error, both logarithmic. */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "command/chart.h"
#include "command/interrupt.h"
#include "command/process.h"

/* What is drawn for an error below it: no error at all has no place on a logarithmic axis. */
#define LEAST_ERROR 1e-17

static const struct look {
  const char *title, *color;
  int symbol, hollow; /* gnuplot's point types: all answers right, some wrong */
} LOOKS[FAMILIES] = {
  [FAMILY_DEFAULT] = { "bernstein (default)", "#c02020", 7, 6 },
  [FAMILY_NEWTON] = { "newton", "#2b6cb0", 9, 8 },
  [FAMILY_LAGUERRE] = { "laguerre", "#2f855a", 11, 10 },
  [FAMILY_ABERTH] = { "aberth", "#b7791f", 13, 12 },
  [FAMILY_PAPER] = { "as in the paper", "#718096", 15, 14 },
  [FAMILY_PLAIN_NEWTON] = { "plain 2-D Newton", "#000000", 3, 3 },
  [FAMILY_EMBREE] = { "Embree (triangles a side)", "#6b46c1", 5, 4 },
  [FAMILY_POVRAY] = { "POV-Ray (u\\\\_steps)", "#0891b2", 5, 4 },
};

static bool drawn(const struct chart_point *point)
{
  return isfinite(point->time[RAYS_CAMERA].median) && isfinite(point->camera.most_of_all);
}

static bool all_right(const struct chart_point *point)
{
  return point->camera.lost + point->camera.invented + point->camera.wrong == 0;
}

static double error_of(const struct chart_point *point)
{
  return fmax(point->camera.most_of_all, LEAST_ERROR);
}

static int by_error(const void *a, const void *b)
{
  const struct chart_point *const *p = a, *const *q = b;
  const double x = (*p)->camera.most_of_all, y = (*q)->camera.most_of_all;
  return (x > y) - (x < y);
}

/* The points of the front from the most exact to the fastest, as one data block. */
static bool write_front(const struct chart *chart, FILE *file)
{
  const struct chart_point **front = calloc(chart->point_count + 1, sizeof *front);
  size_t count = 0;
  if (front == NULL)
    return false;
  for (size_t k = 0; k < chart->point_count; k++) {
    if (chart->points[k].front)
      front[count++] = &chart->points[k];
  }
  qsort(front, count, sizeof *front, by_error);
  fputs("$front << EOD\n", file);
  for (size_t k = 0; k < count; k++)
    fprintf(file, "%.6g %.6g\n", error_of(front[k]), front[k]->time[RAYS_CAMERA].median);
  fputs("EOD\n", file);
  free(front);
  return true;
}

/* Writes the points of a family that are all right, or not; returns whether there are any. */
static bool write_family(const struct chart *chart, enum family family, bool right, FILE *file)
{
  bool any = false;
  for (size_t k = 0; k < chart->point_count; k++) {
    const struct chart_point *point = &chart->points[k];
    if (point->family != family || !drawn(point) || all_right(point) != right)
      continue;
    if (!any)
      fprintf(file, "$family%d%d << EOD\n", (int)family, right);
    any = true;
    const struct timing *time = &point->time[RAYS_CAMERA];
    fprintf(file, "%.6g %.6g %.6g %.6g \"%s\"\n", error_of(point), time->median, time->lower, time->upper,
            point->label);
  }
  if (any)
    fputs("EOD\n", file);
  return any;
}

/* Bars first, symbols over them, then what stands beside the symbols. */
static void plot_family(const struct look *look, int family, bool right, bool titled, FILE *file)
{
  fprintf(file, ", \\\n  $family%d%d using 1:3:(0):($4-$3) with vectors nohead lc rgb '%s' notitle", family, right,
          look->color);
  fprintf(file, ", \\\n  '' using 1:2 with points pt %d ps 0.75 lw 1.3 lc rgb '%s' ",
          right ? look->symbol : look->hollow, look->color);
  if (titled)
    fprintf(file, "title \"%s\"", look->title);
  else
    fputs("notitle", file);
  fprintf(file, ", \\\n  '' using 1:2:5 with labels font ',10' tc rgb '%s' offset 0.3,-0.7 left notitle", look->color);
}

static bool write_script(const struct chart *chart, FILE *file)
{
  bool any[FAMILIES][2];
  fputs("set terminal svg size 900,700 enhanced font 'sans-serif,13' background '#ffffff'\n"
        "set output 'chart.svg'\nset logscale xy\nset format xy '10^{%T}'\n"
        "set xlabel 'error of T, relative: 99 % of the rays (a lost, invented or wrong hit counts as 1)'\n"
        "set ylabel 'ns a camera ray, one thread'\nset grid lc rgb '#dddddd'\nset tics scale 0.7\nset mxtics 2\n"
        "set key outside top center horizontal Left reverse samplen 1.5 width 1\nset xrange [5e-18:4]\n",
        file);
  if (!write_front(chart, file))
    return false;
  for (int f = 0; f < FAMILIES; f++) {
    for (int right = 0; right < 2; right++)
      any[f][right] = write_family(chart, (enum family)f, right != 0, file);
  }
  fputs("plot $front using 1:2 with steps lw 2 lc rgb '#c02020' dt 2 title 'Pareto front'", file);
  for (int f = 0; f < FAMILIES; f++) {
    for (int right = 1; right >= 0; right--) {
      if (any[f][right])
        plot_family(&LOOKS[f], f, right != 0, right || !any[f][1], file);
    }
  }
  fputs(", \\\n  NaN with points pt 6 lc rgb '#444444' title 'hollow: some are wrong'\n", file);
  return true;
}

static enum status run_gnuplot(struct chart *chart, const struct scratch *folder, char **out, size_t *out_length)
{
  char log[SCRATCH_PATH_SIZE];
  scratch_path(folder, "gnuplot.log", log);
  const char *const arguments[] = { "gnuplot", "chart.gp", NULL };
  const char *const environment[] = { "LC_ALL", "C", NULL };
  const struct process_request request = { arguments, folder->path, environment, log };
  struct process_result result;
  const enum status status = process_run(&request, &interrupt_signal, &result);
  if (status == STATUS_INTERRUPTED)
    return status;
  if (status == STATUS_OK && result.exit_code == 0)
    *out = scratch_read(folder, "chart.svg", out_length);
  if (*out == NULL && result.missing)
    fputs("pscn chart: warning: gnuplot is not installed, so there is no figure; the numbers are written all the same. "
          "On Debian 'apt-get install gnuplot-nox' installs it.\n",
          stderr);
  else if (*out == NULL) {
    char *said = scratch_read(folder, "gnuplot.log", out_length);
    fprintf(stderr, "pscn chart: warning: gnuplot made no figure: %.400s\n", said == NULL ? "" : said);
    free(said);
  }
  (void)chart;
  return STATUS_OK;
}

enum status chart_plot(struct chart *chart, char **out, size_t *out_length)
{
  struct scratch folder;
  *out = NULL;
  *out_length = 0;
  size_t points = 0;
  for (size_t k = 0; k < chart->point_count; k++)
    points += drawn(&chart->points[k]);
  if (points == 0) {
    fputs("pscn chart: warning: the rays hit nothing, so there is no figure\n", stderr);
    return STATUS_OK;
  }
  if (scratch_create(&folder) != STATUS_OK) {
    command_error(chart->command, "cannot make a temporary folder: %s", strerror(errno));
    return STATUS_FILE;
  }
  FILE *file = scratch_open(&folder, "chart.gp");
  enum status status = STATUS_FILE;
  if (file != NULL) {
    const bool written = write_script(chart, file);
    status = scratch_close(file);
    if (!written)
      status = STATUS_LIMIT;
  }
  if (status != STATUS_OK)
    command_error(chart->command, "cannot write '%s/chart.gp': %s", folder.path, strerror(errno));
  else
    status = run_gnuplot(chart, &folder, out, out_length);
  scratch_remove(&folder);
  return status;
}

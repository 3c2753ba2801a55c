/* The page of a chart. */
#include <math.h>
#include <string.h>

#include "command/chart.h"

static void put_cell(struct page *page, double value, int digits)
{
  page_put(page, "<td>");
  if (isfinite(value))
    page_number(page, value, digits);
  page_put(page, "</td>");
}

static void put_row(const struct chart_point *point, struct page *page)
{
  const struct timing *time = &point->time[RAYS_CAMERA];
  const struct judgement *camera = &point->camera;
  page_put(page, point->front ? "<tr><td><b>" : "<tr><td>");
  page_text(page, point->name);
  page_put(page, point->front ? "</b></td>" : "</td>");
  put_cell(page, time->median, 4);
  page_put(page, "<td>");
  if (isfinite(time->lower)) {
    page_number(page, time->lower, 4);
    page_put(page, " - ");
    page_number(page, time->upper, 4);
  }
  page_put(page, "</td>");
  put_cell(page, time->ratio, 3);
  put_cell(page, point->time[RAYS_SHADOW].median, 4);
  put_cell(page, camera->median, 2);
  put_cell(page, camera->most, 2);
  put_cell(page, camera->max, 2);
  page_format(page, "<td>%zu</td><td>%zu</td><td>%zu</td><td>%zu</td>", camera->lost, camera->invented, camera->wrong,
              camera->other_patch);
  if (point->has_shadow)
    page_format(page, "<td>%zu</td><td>%zu</td></tr>\n", point->shadow.lost, point->shadow.invented);
  else
    page_put(page, "<td></td><td></td></tr>\n");
}

static void put_table(const struct chart *chart, bool all, struct page *page)
{
  page_put(page, "<table>\n<tr><th></th><th>ns a camera ray</th><th>quartiles</th><th>ratio to the "
                 "default</th><th>ns a shadow ray</th><th>T median</th><th>99 %</th><th>largest</th><th>lost</th>"
                 "<th>invented</th><th>wrong</th><th>other patch</th><th>shadows lost</th><th>invented</th></tr>\n");
  for (size_t k = 0; k < chart->point_count; k++) {
    if (all || chart->points[k].front || k == 0)
      put_row(&chart->points[k], page);
  }
  page_put(page, "</table>\n");
}

static void put_method(const struct chart *chart, struct page *page)
{
  const struct judgement *camera = &chart->points[0].camera;
  page_format(page, "<p>%zu camera rays of a picture of %zux%zu pixels, chosen evenly in strips of %dx%d, and their "
                    "%zu shadow rays; one thread; CPU time, median of %zu rounds in which all take turns. The ratio to "
                    "the default solver is the median of the ratios within a round. T is judged by subdivision and "
                    "Krawczyk's test in quadruple precision, which shares nothing with the renderer and left %zu rays "
                    "undecided (they count nowhere).</p>\n",
              chart->rays[RAYS_CAMERA].count, chart->scene_request.width, chart->scene_request.height, STRIP_WIDTH,
              STRIP_HEIGHT, chart->rays[RAYS_SHADOW].count, chart->rounds, camera->undecided);
  page_put(page, "<p><b>lost</b>: a hit answered by a miss; <b>invented</b>: a miss answered by a hit; <b>wrong</b>: "
                 "both hit, but more than 1 % apart; <b>other patch</b>: the right place, named as of another patch. "
                 "In the figure the error is that of 99 % of all these rays, where a lost, invented or wrong hit "
                 "counts as 1; hollow symbols have some of those; bars are quartiles of the time. The front joins what "
                 "nothing else beats in both.</p>\n");
  const double *yard = chart->yard[RAYS_CAMERA];
  page_put(page, "<p>Noise: the default solver took part in every batch of points; the medians of its batches lie "
                 "between ");
  page_number(page, yard[0], 4);
  page_put(page, " and ");
  page_number(page, yard[chart->yard_count - 1], 4);
  page_put(page, " ns a camera ray. Times are those of a batch in which it takes the median of these: its time times "
                 "the ratio.</p>\n<p>The solver <code>bernstein</code> has neither a basis nor a start to choose: it "
                 "works in the Bernstein form, from its control polygon.</p>\n");
  for (size_t k = 0; k < chart->note_count; k++) {
    page_put(page, "<p>");
    page_text(page, chart->notes[k]);
    page_put(page, "</p>\n");
  }
}

void chart_page(const struct chart *chart, const char *svg, struct page *out)
{
  const char *slash = strrchr(chart->scene_request.path, '/');
  const char *name = slash == NULL ? chart->scene_request.path : slash + 1;
  char title[256];
  snprintf(title, sizeof title, "Speed against accuracy: %.200s", name);
  page_begin(out, title, "svg { max-width: 100%; height: auto } table { font-size: 13px } "
                         "td:first-child { min-width: 15em } td:nth-child(3) { white-space: nowrap }\n");
  if (svg != NULL) {
    const char *body = strstr(svg, "<svg");
    page_put(out, "<figure>\n");
    page_put(out, body == NULL ? svg : body);
    page_put(out, "</figure>\n");
  } else {
    page_put(out, "<p>There is no figure: gnuplot was not there to draw it, or the rays hit nothing.</p>\n");
  }
  page_put(out, "<h2>The front, and the default</h2>\n");
  put_table(chart, false, out);
  page_put(out, "<h2>How it was measured</h2>\n");
  put_method(chart, out);
  page_put(out, "<details><summary>All points</summary>\n");
  put_table(chart, true, out);
  page_put(out, "</details>\n");
}

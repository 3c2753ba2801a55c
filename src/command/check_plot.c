/* How POV-Ray's answer nears ours with u_steps: two plots with logarithmic axes, as SVG. */
#include <math.h>

#include "command/check.h"

enum { WIDTH = 470, HEIGHT = 320, LEFT = 62, RIGHT = 14, TOP = 34, BOTTOM = 44, MAX_CURVES = 3 };

struct curve {
  const char *label, *color;
  double value[CHECK_MAX_STEPS]; /* of u_steps 1, 2, ...; what is not positive is not drawn */
};

struct plot {
  const char *title;
  struct curve curve[MAX_CURVES];
  size_t curves, steps;
  int low, high; /* powers of ten */
};

static double place_x(const struct plot *plot, size_t k)
{
  const double part = plot->steps == 1 ? 0.5 : (double)k / (double)(plot->steps - 1);
  return LEFT + 14 + part * (WIDTH - LEFT - RIGHT - 28);
}

static double place_y(const struct plot *plot, double value)
{
  const double part = (log10(value) - plot->low) / (plot->high - plot->low);
  return HEIGHT - BOTTOM - part * (HEIGHT - TOP - BOTTOM);
}

/* The powers of ten that hold all values. */
static void find_range(struct plot *plot)
{
  double low = INFINITY, high = 0;
  for (size_t c = 0; c < plot->curves; c++) {
    for (size_t k = 0; k < plot->steps; k++) {
      const double value = plot->curve[c].value[k];
      if (!(value > 0) || !isfinite(value))
        continue;
      low = fmin(low, value);
      high = fmax(high, value);
    }
  }
  plot->low = high > 0 ? (int)floor(log10(low)) : 0;
  plot->high = high > 0 ? (int)ceil(log10(high)) : 1;
  if (plot->high == plot->low)
    plot->high++;
}

static void put_axes(const struct plot *plot, struct page *page)
{
  page_format(page, "<text x=\"%d\" y=\"18\" class=\"title\">%s</text>\n", LEFT, plot->title);
  const int every = (plot->high - plot->low) / 8 + 1;
  for (int power = plot->low; power <= plot->high; power += every) {
    const int y = (int)lround(place_y(plot, pow(10, power)));
    page_format(page, "<path class=\"grid\" d=\"M%d %dH%d\"/><text x=\"%d\" y=\"%d\" text-anchor=\"end\">10"
                      "<tspan dy=\"-5\" font-size=\"9\">%d</tspan></text>\n",
                LEFT, y, WIDTH - RIGHT, LEFT - 8, y + 4, power);
  }
  for (size_t k = 0; k < plot->steps; k++)
    page_format(page, "<text x=\"%d\" y=\"%d\" text-anchor=\"middle\">%zu</text>\n", (int)lround(place_x(plot, k)),
                HEIGHT - BOTTOM + 18, k + 1);
  page_format(page, "<text x=\"%d\" y=\"%d\" text-anchor=\"middle\">u_steps = v_steps</text>\n",
              (LEFT + WIDTH - RIGHT) / 2, HEIGHT - 8);
}

static void put_curve(const struct plot *plot, size_t c, struct page *page)
{
  const struct curve *curve = &plot->curve[c];
  char begin = 'M';
  page_format(page, "<path fill=\"none\" stroke=\"%s\" stroke-width=\"2\" d=\"", curve->color);
  for (size_t k = 0; k < plot->steps; k++) {
    if (!(curve->value[k] > 0) || !isfinite(curve->value[k]))
      continue;
    page_format(page, "%c%d %d", begin, (int)lround(place_x(plot, k)), (int)lround(place_y(plot, curve->value[k])));
    begin = 'L';
  }
  page_put(page, "\"/>\n");
  for (size_t k = 0; k < plot->steps; k++) {
    if (curve->value[k] > 0 && isfinite(curve->value[k]))
      page_format(page, "<circle r=\"3.5\" fill=\"%s\" cx=\"%d\" cy=\"%d\"/>", curve->color,
                  (int)lround(place_x(plot, k)), (int)lround(place_y(plot, curve->value[k])));
  }
  page_format(page, "\n<text x=\"%d\" y=\"%zu\" text-anchor=\"end\" fill=\"%s\">%s</text>\n", WIDTH - RIGHT - 6,
              TOP + 14 + 16 * c, curve->color, curve->label);
}

static void put_plot(struct plot *plot, struct page *page)
{
  find_range(plot);
  page_format(page, "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\" viewBox=\"0 0 %d %d\" "
                    "role=\"img\" font-family=\"sans-serif\" font-size=\"12\">\n"
                    "<style>.grid { stroke: #ddd } .title { font-weight: 600; font-size: 13px }</style>\n",
              WIDTH, HEIGHT, WIDTH, HEIGHT);
  put_axes(plot, page);
  for (size_t c = 0; c < plot->curves; c++)
    put_curve(plot, c, page);
  page_put(page, "</svg>\n");
}

void check_plot(const struct check *check, struct page *page)
{
  const size_t steps = check->row_count - 1;
  struct plot pictures = { .title = "pixels beyond, in percent", .curves = 3, .steps = steps,
                           .curve = { { "1/255", "#2b6cb0", { 0 } }, { "4/255", "#c05621", { 0 } },
                                      { "16/255", "#9b2c2c", { 0 } } } };
  struct plot distances = { .title = "difference of distances, relative", .curves = 2, .steps = steps,
                            .curve = { { "99 %", "#c05621", { 0 } }, { "median", "#2b6cb0", { 0 } } } };
  for (size_t k = 0; k < steps; k++) {
    const struct check_row *row = &check->row[k + 1];
    for (int c = 0; c < CHECK_CODES; c++)
      pictures.curve[c].value[k] = 100 * (double)row->over[c] / (double)row->result.pixels;
    distances.curve[0].value[k] = row->distances.most;
    distances.curve[1].value[k] = row->distances.median;
  }
  put_plot(&pictures, page);
  if (check->request->grid > 0)
    put_plot(&distances, page);
}

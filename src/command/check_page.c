/* The page of `pscn check`. It is read without script: the slider is a box that the reader makes wider; where scripts
 * run, a control below it does the same. */
#include <math.h>
#include <stdio.h>

#include "command/check.h"

/* Differences are shown so many times as large: 16 codes are full light. */
static const double MAGNIFIED = 16;

enum { CROP = 15, CROP_SHOWN = 150 }; /* pixels around a worst one, and their size on the page */

static const char STYLE[] =
  ".pixels { image-rendering: pixelated; border: 1px solid #aaa }\n"
  ".slider { position: relative; max-width: 100%; overflow: hidden; outline: 1px solid #aaa;\n"
  "  container-type: inline-size }\n"
  ".slider img { max-width: none; width: 100%; height: 100% }\n"
  ".slider .over { position: absolute; left: 0; top: 0; bottom: 0; width: 50%; overflow: hidden; resize: horizontal;\n"
  "  border-right: 2px solid #e33; max-width: 100% }\n"
  ".slider .over img { position: absolute; left: 0; top: 0; width: 100cqw }\n"
  ".worst { display: flex; flex-wrap: wrap; gap: 0 2.5em } .worst section { width: 500px }\n"
  ".worst figure { margin-right: .6em }\n"
  "td { white-space: nowrap }\n"
  ".key { display: inline-block; width: .8em; height: .8em; margin-right: .5em; border: 1px solid #888 }\n"
  ".control { width: 100%; margin: .3em 0 }\n"
  ".verdict { padding: .5em .8em; background: #eef5ee; border-left: 4px solid #4a4 }\n"
  ".verdict.beyond { background: #f8eaea; border-color: #c33 }\n";

static void put_figure(struct page *page, const struct image *image, size_t shown_width, const char *caption)
{
  page_format(page, "<figure><img alt=\"%s\" width=\"%zu\" src=\"", caption, shown_width);
  page_image_data(page, image);
  page_format(page, "\"><figcaption>%s</figcaption></figure>\n", caption);
}

static void put_percent(struct page *page, size_t count, size_t of)
{
  page_put(page, "<td>");
  page_number(page, 100 * (double)count / (double)of, 3);
  page_put(page, " %</td>");
}

static void put_cell(struct page *page, double value, int digits)
{
  page_put(page, "<td>");
  if (!isnan(value))
    page_number(page, value, digits);
  page_put(page, "</td>");
}

static void put_name(struct page *page, const struct check_row *row)
{
  if (row->steps == 0)
    page_put(page, "<tr><td>as written</td>");
  else
    page_format(page, "<tr><td>u_steps %zu</td>", row->steps);
}

static void put_picture_table(const struct check *check, struct page *page)
{
  page_put(page, "<h2>Pictures</h2>\n<p>Each row is POV-Ray's picture beside ours, which is the same in all rows. "
                 "Rows with u_steps n have every patch cut into 2<sup>n</sup> by 2<sup>n</sup> pieces (flatness "
                 "0).</p>\n"
                 "<table>\n<tr><th>POV-Ray</th><th>beyond<br>1/255</th><th>beyond<br>4/255</th>"
                 "<th>beyond<br>16/255</th>"
                 "<th>max</th><th>PSNR,<br>dB</th><th>beyond the limit,<br>not on an edge</th><th>hit only<br>here</th>"
                 "<th>hit only<br>there</th><th>seconds</th><th>CPU<br>seconds</th></tr>\n");
  for (size_t k = 0; k < check->row_count; k++) {
    const struct check_row *row = &check->row[k];
    put_name(page, row);
    for (int c = 0; c < CHECK_CODES; c++)
      put_percent(page, row->over[c], row->result.pixels);
    page_format(page, "<td>%d/255</td>", (int)lround(255 * row->result.max));
    put_cell(page, row->result.psnr, 4);
    page_format(page, "<td>%zu</td><td>%zu</td><td>%zu</td>", row->over_limit_on[CHECK_EDGE_NONE], row->mask_ours,
                row->mask_theirs);
    put_cell(page, row->picture.wall, 3);
    put_cell(page, row->picture.cpu, 3);
    page_put(page, "</tr>\n");
  }
  page_put(page, "<tr><td>pscn, one thread</td>"
                 "<td></td><td></td><td></td><td></td><td></td><td></td><td></td><td></td>");
  put_cell(page, check->ours.time.wall, 3);
  put_cell(page, check->ours.time.cpu, 3);
  page_put(page, "</tr>\n</table>\n");
}

static void put_distance_table(const struct check *check, struct page *page)
{
  page_format(page, "<h2>Hits</h2>\n<p>POV-Ray's <code>trace()</code> asked for the point that the ray of every "
                    "%zuth pixel of every %zuth row meets: the difference of its distance, relative to ours.</p>\n"
                    "<table>\n"
                    "<tr><th>POV-Ray</th><th>rays</th><th>hit by both</th><th>only here</th><th>only there</th>"
                    "<th>median</th><th>99 %%</th><th>max</th></tr>\n",
              check->request->grid, check->request->grid);
  for (size_t k = 0; k < check->row_count; k++) {
    const struct check_distances *d = &check->row[k].distances;
    put_name(page, &check->row[k]);
    page_format(page, "<td>%zu</td><td>%zu</td><td>%zu</td><td>%zu</td>", d->rays, d->both, d->only_ours,
                d->only_theirs);
    put_cell(page, d->median, 3);
    put_cell(page, d->most, 3);
    put_cell(page, d->max, 3);
    page_put(page, "</tr>\n");
  }
  page_put(page, "</table>\n");
}

static void put_slider(const struct check *check, const struct image *theirs, struct page *page)
{
  page_format(page, "<h2>One over the other</h2>\n<p>Left of the red line pscn, right of it POV-Ray. The line "
                    "follows the control below it, and without script the corner at its foot.</p>\n"
                    "<div class=\"slider\" style=\"width:%zupx;aspect-ratio:%zu/%zu\"><img alt=\"POV-Ray\" src=\"",
              check->width, check->width, check->height);
  page_image_data(page, theirs);
  page_format(page, "\"><div class=\"over\" id=\"over\"><img alt=\"pscn\" src=\"");
  page_image_data(page, &check->ours.picture);
  page_format(page, "\"></div></div>\n<input class=\"control\" style=\"max-width:%zupx\" type=\"range\" min=\"0\" "
                    "max=\"100\" value=\"50\" aria-label=\"share of pscn\" "
                    "oninput=\"document.getElementById('over').style.width = this.value + '%%'\">\n",
              check->width);
}

static void put_differences(const struct check *check, struct page *page)
{
  page_format(page, "<h2>Differences, %d times as large</h2>\n", (int)MAGNIFIED);
  for (size_t k = 0; k < check->row_count; k++) {
    struct image difference;
    char caption[64];
    if (check_difference(check, &check->row[k], MAGNIFIED, &difference) != STATUS_OK) {
      page->failed = true;
      return;
    }
    if (check->row[k].steps == 0)
      snprintf(caption, sizeof caption, "as written");
    else
      snprintf(caption, sizeof caption, "u_steps %zu", check->row[k].steps);
    put_figure(page, &difference, k + 1 == check->row_count ? 800 : 380, caption);
    image_destroy(&difference);
  }
}

static void put_key(struct page *page, const float color[3], const char *name)
{
  page_format(page, "<tr><td><span class=\"key\" style=\"background: rgb(%d, %d, %d)\"></span>%s</td>",
              (int)lroundf(255 * color[0]), (int)lroundf(255 * color[1]), (int)lroundf(255 * color[2]), name);
}

/* The pixels over the limit in the last row, and what they lie on. */
static void put_places(const struct check *check, struct page *page)
{
  static const char *const NAME[CHECK_EDGES] = { "not on an edge", "on creases", "on edges of shadows",
                                                 "on silhouettes" };
  const struct check_row *last = &check->row[check->row_count - 1];
  struct image map;
  if (check_map(check, last, &map) != STATUS_OK) {
    page->failed = true;
    return;
  }
  page_put(page, "<h2>Where they differ</h2>\n<p>The pixels of the last row beyond ");
  page_number(page, 255 * check->request->fail.each, 4);
  page_put(page, "/255, as spots larger than a pixel, on our picture with its edges. A pixel is on an edge where it "
                 "or one beside it sees a silhouette, the edge of a shadow, or a crease: there half a pixel's "
                 "difference of the shape is a difference of the whole colour.</p>\n");
  put_figure(page, &map, 800, "pixels beyond the limit");
  page_put(page, "<table style=\"display: inline-table\">\n<tr><th>beyond the limit</th><th>pixels</th></tr>\n");
  for (int edge = CHECK_EDGES - 1; edge >= 0; edge--) {
    put_key(page, CHECK_SPOT_COLOR[edge == CHECK_EDGE_NONE], NAME[edge]);
    page_format(page, "<td>%zu</td></tr>\n", last->over_limit_on[edge]);
  }
  page_put(page, "<tr><th>edges</th><th></th></tr>\n");
  for (int edge = CHECK_EDGES - 1; edge > CHECK_EDGE_NONE; edge--) {
    put_key(page, CHECK_EDGE_COLOR[edge], CHECK_EDGE_NAME[edge]);
    page_put(page, "<td></td></tr>\n");
  }
  page_put(page, "</table>\n");
  image_destroy(&map);
}

/* ---- the worst pixels ---- */

/* CROP x CROP pixels around (x, y), black beyond the border. */
static void put_crop(const struct image *image, size_t x, size_t y, struct page *page, const char *caption)
{
  struct image crop;
  if (image_create(CROP, CROP, 3, &crop) != STATUS_OK) {
    page->failed = true;
    return;
  }
  for (size_t v = 0; v < CROP; v++) {
    for (size_t u = 0; u < CROP; u++) {
      const size_t from_x = x + u - CROP / 2, from_y = y + v - CROP / 2; /* wraps to something large */
      if (from_x >= image->width || from_y >= image->height)
        continue;
      for (size_t c = 0; c < 3; c++)
        image_pixel(&crop, u, v)[c] = image_pixel(image, from_x, from_y)[c];
    }
  }
  for (int c = 0; c < 3; c++)
    snprintf(crop.channel[c].name, IMAGE_NAME_SIZE, "%c", "RGB"[c]);
  page_format(page, "<figure><img class=\"pixels\" alt=\"%s\" width=\"%d\" height=\"%d\" src=\"", caption, CROP_SHOWN,
              CROP_SHOWN);
  page_image_data(page, &crop);
  page_format(page, "\"><figcaption>%s</figcaption></figure>\n", caption);
  image_destroy(&crop);
}

static void put_codes(struct page *page, const struct image *image, size_t x, size_t y)
{
  const float *value = image_pixel(image, x, y);
  page_format(page, "%d %d %d", (int)lroundf(255 * value[0]), (int)lroundf(255 * value[1]),
              (int)lroundf(255 * value[2]));
}

static void put_distance(struct page *page, double distance)
{
  if (isinf(distance)) {
    page_put(page, "miss");
    return;
  }
  page_put(page, "hit at distance ");
  page_number(page, distance, 10);
}

static void put_worst(const struct check *check, const struct check_worst *worst, const struct image *difference,
                      struct page *page)
{
  const struct image *theirs = &check->row[check->row_count - 1].picture.image;
  const struct check_pixel *pixel = &check->ours.pixel[worst->y * check->width + worst->x];
  page_format(page, "<section><h3>Pixel %zu, %zu: %d of 255, %s</h3>\n", worst->x, worst->y,
              (int)lround(255 * worst->difference), CHECK_EDGE_NAME[pixel->edge]);
  put_crop(&check->ours.picture, worst->x, worst->y, page, "pscn");
  put_crop(theirs, worst->x, worst->y, page, "POV-Ray");
  put_crop(difference, worst->x, worst->y, page, "difference");
  page_put(page, "<p>pscn: colour ");
  put_codes(page, &check->ours.picture, worst->x, worst->y);
  page_put(page, "; ");
  put_distance(page, pixel->distance);
  if (pixel->hit.patch != HIT_NONE) {
    page_format(page, ", patch %lu at u ", (unsigned long)pixel->hit.patch);
    page_number(page, pixel->hit.u, 6);
    page_put(page, ", v ");
    page_number(page, pixel->hit.v, 6);
    page_format(page, ", %s", pixel->hit.certainty == CERTAINTY_CERTAIN ? "certain" : "grazing");
  }
  page_put(page, "<br>POV-Ray: colour ");
  put_codes(page, theirs, worst->x, worst->y);
  page_put(page, "; ");
  put_distance(page, worst->distance);
  page_put(page, "</p></section>\n");
}

static void put_all_worst(const struct check *check, struct page *page)
{
  struct image difference;
  if (check_difference(check, &check->row[check->row_count - 1], MAGNIFIED, &difference) != STATUS_OK) {
    page->failed = true;
    return;
  }
  page_format(page, "<h2>The worst pixels of the last row</h2>\n%s<div class=\"worst\">\n",
              check->worst_count == 0 ? "<p>The pictures are the same.</p>\n" : "");
  for (size_t k = 0; k < check->worst_count; k++)
    put_worst(check, &check->worst[k], &difference, page);
  page_put(page, "</div>\n");
  image_destroy(&difference);
}

void check_page(const struct check *check, const char *verdict, struct page *page)
{
  char title[512], message[256];
  const struct check_row *last = &check->row[check->row_count - 1];
  snprintf(title, sizeof title, "%.300s by pscn and by POV-Ray %s", check->request->scene.path, check->povray.version);
  page_begin(page, title, STYLE);
  page_format(page, "<p class=\"verdict%s\">", check_within_limits(check, message, sizeof message) ? "" : " beyond");
  page_text(page, verdict);
  page_put(page, "</p>\n");
  put_figure(page, &check->ours.picture, 590, "pscn");
  if (last->steps == 0)
    snprintf(message, sizeof message, "POV-Ray, as written");
  else
    snprintf(message, sizeof message, "POV-Ray, u_steps %zu", last->steps);
  put_figure(page, &last->picture.image, 590, message);
  put_picture_table(check, page);
  if (check->request->grid > 0)
    put_distance_table(check, page);
  if (check->row_count > 1) {
    page_put(page, "<h2>Convergence</h2>\n");
    check_plot(check, page);
  }
  put_places(check, page);
  put_slider(check, &last->picture.image, page);
  put_differences(check, page);
  put_all_worst(check, page);
  if (check->warnings != NULL) {
    page_put(page, "<h2>What POV-Ray warns of</h2>\n<pre>");
    page_text(page, check->warnings);
    page_put(page, "</pre>\n");
  }
}

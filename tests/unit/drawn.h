/* Replaces gnuplot (-Wl,--wrap=plot_draw): keeps the values that a figure would be drawn from, and draws an empty one. */
#ifndef TESTS_UNIT_DRAWN_H
#define TESTS_UNIT_DRAWN_H

#include "page/page.h"

static json_t *drawn; /* the last values */

enum status __wrap_plot_draw(const struct listener *listener, const char *template, const json_t *values,
                             struct text_buffer *out);
enum status __wrap_plot_draw(const struct listener *listener, const char *template, const json_t *values,
                             struct text_buffer *out)
{
  (void)listener, (void)template;
  *out = (struct text_buffer){0};
  drawn = json_deep_copy(values);
  text_buffer_add_text(out, "<svg></svg>");
  return STATUS_OK;
}

#endif

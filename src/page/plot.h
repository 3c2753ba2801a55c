/* Figures, drawn by gnuplot if it is installed. */
#ifndef PSCN_PAGE_PLOT_H
#define PSCN_PAGE_PLOT_H

#include <jansson.h>

#include "base/listener.h"
#include "base/text_buffer.h"

/* Fills in a template of a gnuplot script, which writes figure.svg, and runs it. *out receives the complete figure as
 * an <svg> element; points that the script draws `with labels hypertext` show their text under a pointer. The listener
 * is told if gnuplot is missing, and warned if it fails; then *out is empty, and the status is STATUS_OK all the
 * same. */
enum status plot_draw(const struct listener *listener, const char *template, const json_t *values,
                      struct text_buffer *out) STATUS_MUST_CHECK;

#endif

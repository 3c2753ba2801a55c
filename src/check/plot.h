/* Figures, drawn by gnuplot where it is installed. */
#ifndef PSCN_CHECK_PLOT_H
#define PSCN_CHECK_PLOT_H

#include <jansson.h>

#include "base/listener.h"
#include "base/text_buffer.h"

/* Fills in a template of a gnuplot script, which writes figure.svg, and has gnuplot run it. *out receives the figure,
 * complete, as an <svg> element; points that the script draws `with labels hypertext` tell their text to a pointer
 * over them. Where gnuplot is missing or fails that is told, where it fails as a warning, *out is empty and the
 * status STATUS_OK all the same. */
enum status plot_draw(const struct listener *listener, const char *template, const json_t *values,
                      struct text_buffer *out) STATUS_MUST_CHECK;

#endif

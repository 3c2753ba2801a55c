/* Fills in templates.
 *
 * A template is a text file (HTML, a gnuplot script) that is built into the program. It may contain
 *
 *     {{name}}          the value of that name: a text with HTML's reserved characters escaped, or a number
 *     {{name:9.3f}}     a number as printf writes it, with %f, %e or %g; {{name:9d}} and {{name:-9s}} in that width;
 *                       {{name:6}} with at most so many significant digits
 *     {{&name}}         a text as it is
 *     {{#name}}...{{/name}}   once for each value of a list, the names in its objects hiding those outside;
 *                       once for an object, a text, a number, true; not at all for null, false or a missing value
 *     {{^name}}...{{/name}}   once where {{#name}} writes nothing
 *
 * A section must not contain another one of its own name. The values are a tree of jansson's. Numbers are written in
 * the same way in every locale.
 */
#ifndef PSCN_PAGE_FILL_H
#define PSCN_PAGE_FILL_H

#include <jansson.h>

#include "base/text_buffer.h"

/* Appends the filled-in template to `out`. Fails if `values` is NULL, which means that memory was short. */
void fill_template(struct text_buffer *out, const char *template, const json_t *values);

#endif

/* Templates filled in.
 *
 * A template is a file of text (HTML, a script of gnuplot) that is built into the program. In it stand
 *
 *     {{name}}          the value of that name: text with what HTML reserves escaped, a whole number, a number
 *     {{name:9.3f}}     a number as printf writes it, with %f, %e or %g; {{name:9d}} and {{name:-9s}} in that width;
 *                       {{name:6}} with so many significant digits at most
 *     {{&name}}         text as it is
 *     {{#name}}...{{/name}}   once for each value of a list, the names of its objects going before those outside;
 *                       once for an object, a text, a number, true; not at all for null, false, what there is not
 *     {{^name}}...{{/name}}   once where {{#name}} writes nothing
 *
 * A section holds no other one of its own name. The values are a tree of jansson's. Numbers are written the same in
 * every locale.
 */
#ifndef PSCN_CHECK_FILL_H
#define PSCN_CHECK_FILL_H

#include <jansson.h>

#include "base/text_buffer.h"

/* Adds the template filled in; `values` may be NULL, for which memory was short: that fails. */
void fill_template(struct text_buffer *out, const char *template, const json_t *values);

#endif

/* Pages: values, the templates that they fill, figures, and files.
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
#ifndef PSCN_PAGE_PAGE_H
#define PSCN_PAGE_PAGE_H

#include <jansson.h>
#include <stddef.h>

#include "base/listener.h"
#include "base/text_buffer.h"
#include "image/image.h"

/* Appends the filled-in template to `out`. Fails if `values` is NULL, which means that memory was short. */
void fill_template(struct text_buffer *out, const char *template, const json_t *values);

/* Fills in a template of a gnuplot script, which writes figure.svg, and runs it. *out receives the complete figure as
 * an <svg> element; points that the script draws `with labels hypertext` show their text under a pointer. The listener
 * is told if gnuplot is missing, and warned if it fails; then *out is empty, and the status is STATUS_OK all the
 * same. */
enum status plot_draw(const struct listener *listener, const char *template, const json_t *values,
                      struct text_buffer *out) STATUS_MUST_CHECK;

/* Writes pages under their names in the folder, all or none (base/atomic_file.h); for an empty page, removes the file.
 * Errors go to the listener. */
enum status page_write(const struct listener *listener, const char *folder, size_t count, const char *const names[],
                       const struct text_buffer pages[]) STATUS_MUST_CHECK;

/* Values; NULL if memory is short. A number becomes null if it is NAN or infinite; a foreign text becomes printable. */
json_t *page_of_number(double value);
json_t *page_of_text(const char *text);

/* The name of a file without its folders. */
json_t *page_of_file(const char *path);

/* The values common to all pages: version, date, machine, command (the command line), and `head`, the first lines. */
json_t *page_of_head(const char *command_line);

/* A picture with display codes in [0,1] as the bytes of an 8-bit PNG; and those as a value, a data: URI. */
void page_png(const struct image *image, struct text_buffer *out);
json_t *page_of_png(const struct text_buffer *png);

#endif

/* Runs gnuplot. */

#include <errno.h>
#include <string.h>

#include "page/page.h"
#include "page/process.h"
#include "page/scratch.h"

static const char SCRIPT[] = "figure.gp", FIGURE[] = "figure.svg", LOG[] = "gnuplot.log";

#define TIMEOUT 120.0 /* seconds; a figure takes less than one */

/* gnuplot shows the texts of points by a script of its own; HTML and SVG have titles for that. */
static void copy_with_titles(const char *svg, struct text_buffer *out)
{
  static const char BEGIN[] = " onmousemove=\"gnuplot_svg.showHypertext(evt,'", END[] = "</title>";
  for (const char *at; (at = strstr(svg, BEGIN)) != NULL;) {
    const char *text = at + sizeof BEGIN - 1, *close = strstr(text, "')\""), *end = strstr(text, END);
    if (close == NULL || end == NULL) break;
    text_buffer_add(out, svg, (size_t)(at - svg));
    text_buffer_format(out, "><title>%.*s", (int)(close - text), text);
    svg = end;
  }
  text_buffer_add_text(out, svg);
}

/* Reads the figure that gnuplot wrote, if it is complete. */
static void read_figure(const char *folder, struct text_buffer *out)
{
  static const char LAST[] = "</svg>";
  struct text_buffer svg = scratch_read(folder, FIGURE);
  const char *begin = svg.text == NULL ? NULL : strstr(svg.text, "<svg");
  char *end = begin == NULL ? NULL : strstr(begin, LAST);
  out->failed = svg.failed;
  if (end != NULL) {
    end[sizeof LAST - 1] = '\0';
    copy_with_titles(begin, out);
  }
  text_buffer_free(&svg);
}

static enum status run_gnuplot(const struct listener *listener, const char *folder, struct text_buffer *out)
{
  char log[SCRATCH_PATH_SIZE];
  scratch_path(folder, LOG, log);
  const char *const arguments[] = {"gnuplot", SCRIPT, NULL};
  const char *const environment[] = {"LC_ALL", "C", NULL};
  const struct process_request request = {
    .arguments = arguments, .folder = folder, .environment = environment, .output = log, .timeout = TIMEOUT};
  struct process_result result;
  const enum status status = process_run(&request, listener->stop, &result);
  if (status == STATUS_INTERRUPTED) return status;
  if (status == STATUS_OK && result.exit_code == 0) read_figure(folder, out);
  if (out->length == 0 && result.missing) {
    listener_tell(listener, TOLD_PROGRESS,
                  "gnuplot is not installed, so there is no figure; the numbers are written "
                  "all the same. On Debian 'apt-get install gnuplot-nox' installs it.");
  } else if (out->length == 0) {
    struct text_buffer text = scratch_read(folder, LOG), said = {0};
    out->failed = text.failed || out->failed;
    if (status == STATUS_LIMIT) text_buffer_format(&said, "it took more than %g seconds", TIMEOUT);
    else if (status != STATUS_OK) text_buffer_add_text(&said, strerror(result.reason));
    else if (text.text != NULL) text_buffer_add_printable(&said, text.text, text.length < 400 ? text.length : 400);
    listener_tell(listener, TOLD_WARNING, "gnuplot made no figure: %s",
                  said.text == NULL ? "its file cannot be read" : said.text);
    text_buffer_free(&said);
    text_buffer_free(&text);
  }
  return out->failed ? listener_out_of_memory(listener) : STATUS_OK;
}

enum status plot_draw(const struct listener *listener, const char *template, const json_t *values,
                      struct text_buffer *out)
{
  char folder[SCRATCH_PATH_SIZE];
  struct text_buffer script = {0};
  *out = (struct text_buffer){0};
  fill_template(&script, template, values);
  if (script.failed) {
    text_buffer_free(&script);
    return listener_out_of_memory(listener);
  }
  enum status status = scratch_create(folder);
  FILE *file = status == STATUS_OK ? scratch_open(folder, SCRIPT) : NULL;
  if (file != NULL) {
    (void)fwrite(script.text, 1, script.length, file);
    status = scratch_close(file);
  }
  if (status != STATUS_OK || file == NULL)
    status = listener_fail(listener, STATUS_FILE, "cannot write a temporary file: %s", strerror(errno));
  else status = run_gnuplot(listener, folder, out);
  scratch_remove(folder);
  text_buffer_free(&script);
  return status;
}

/* Progress of a rendering on stderr. */
#include "command/progress.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

/* Seconds between two tellings. */
static const double TERMINAL_PERIOD = 0.2;
static const double LINE_PERIOD = 5;

enum { BAR_WIDTH = 30 };

struct progress progress_start(void)
{
  return (struct progress){ .terminal = isatty(STDERR_FILENO) == 1 };
}

/* "1 h 02 min", "3 min 20 s" or "12 s". */
static void write_duration(double seconds, char *out, size_t size)
{
  const double limit = 359999; /* under 100 hours */
  const long whole = (long)((seconds < limit ? seconds : limit) + 0.5);
  if (whole >= 3600)
    snprintf(out, size, "%ld h %02ld min", whole / 3600, whole / 60 % 60);
  else if (whole >= 60)
    snprintf(out, size, "%ld min %02ld s", whole / 60, whole % 60);
  else
    snprintf(out, size, "%ld s", whole);
}

/* "1.25 M rays/s" */
static void write_rate(double rate, char *out, size_t size)
{
  if (rate >= 1e6)
    snprintf(out, size, "%.2f M rays/s", rate / 1e6);
  else
    snprintf(out, size, "%.1f k rays/s", rate / 1e3);
}

void progress_tell(void *context, const struct render_progress *progress)
{
  struct progress *state = context;
  if (progress->seconds - state->told < (state->terminal ? TERMINAL_PERIOD : LINE_PERIOD))
    return;
  state->told = progress->seconds;
  const double done = (double)progress->pixels / (double)progress->pixels_total;
  char left[32] = "?", rate[32];
  if (done > 0)
    write_duration(progress->seconds * (1 - done) / done, left, sizeof left);
  write_rate((double)progress->rays / progress->seconds, rate, sizeof rate);
  if (state->terminal) {
    char bar[BAR_WIDTH + 1];
    const size_t full = (size_t)(done * BAR_WIDTH);
    memset(bar, '.', BAR_WIDTH);
    memset(bar, '#', full < BAR_WIDTH ? full : BAR_WIDTH);
    bar[BAR_WIDTH] = '\0';
    fprintf(stderr, "\r[%s] %3.0f %%, %s, %s left\033[K", bar, 100 * done, rate, left);
    fflush(stderr);
  } else {
    fprintf(stderr, "%.0f %%, %s, %s left\n", 100 * done, rate, left);
  }
}

void progress_end(const struct progress *progress)
{
  if (progress->terminal && progress->told > 0)
    fputs("\r\033[K", stderr);
}

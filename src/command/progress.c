/* Progress of a rendering on stderr. */
#include "command/progress.h"

#include <stdio.h>
#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>

/* Seconds between two reports. */
static const double TERMINAL_PERIOD = 0.2;
static const double LINE_PERIOD = 5;

enum { BAR_WIDTH = 30, LEAST_BAR = 4, LINE_SIZE = 128 };

struct progress progress_start(void) { return (struct progress){.terminal = isatty(STDERR_FILENO) == 1}; }

/* "1 h 02 min", "3 min 20 s" or "12 s". */
static void write_duration(double seconds, char *out, size_t size)
{
  const double limit = 359999; /* under 100 hours */
  const long whole = (long)((seconds < limit ? seconds : limit) + 0.5);
  if (whole >= 3600) snprintf(out, size, "%ld h %02ld min", whole / 3600, whole / 60 % 60);
  else if (whole >= 60) snprintf(out, size, "%ld min %02ld s", whole / 60, whole % 60);
  else snprintf(out, size, "%ld s", whole);
}

/* "1.25 M rays/s" */
static void write_rate(double rate, char *out, size_t size)
{
  if (rate >= 1e6) snprintf(out, size, "%.2f M rays/s", rate / 1e6);
  else snprintf(out, size, "%.1f k rays/s", rate / 1e3);
}

static bool is_time(struct progress *state, double seconds)
{
  if (seconds - state->told < (state->terminal ? TERMINAL_PERIOD : LINE_PERIOD)) return false;
  state->told = seconds;
  return true;
}

/* Prints a line; on a terminal one that the next one overwrites. It must therefore fit the terminal's width; if space is
 * short, the bar shrinks first. */
static void put_line(const struct progress *state, const char *line, double done)
{
  struct winsize window;
  const size_t columns = ioctl(STDERR_FILENO, TIOCGWINSZ, &window) == 0 && window.ws_col > 0 ? window.ws_col : 80;
  const size_t around = strlen("[]  "); /* the bar's brackets, a blank, and the last column, which may wrap the line */
  const size_t length = strlen(line);
  char bar[BAR_WIDTH + 4] = "";
  if (!state->terminal) {
    fprintf(stderr, "%s\n", line);
    return;
  }
  if (columns >= length + around + LEAST_BAR) {
    const size_t room = columns - length - around, width = room < BAR_WIDTH ? room : BAR_WIDTH;
    const size_t full = (size_t)(done * (double)width);
    bar[0] = '[';
    memset(bar + 1, '.', width);
    memset(bar + 1, '#', full < width ? full : width);
    memcpy(bar + 1 + width, "] ", 3);
  }
  fprintf(stderr, "\r%s%.*s\033[K", bar, (int)(columns - 1), line);
  fflush(stderr);
}

void progress_tell(struct progress *state, double seconds, double done, uint64_t rays)
{
  char left[32] = "?", rate[32], line[LINE_SIZE];
  if (!is_time(state, seconds)) return;
  if (done > 0) write_duration(seconds * (1 - done) / done, left, sizeof left);
  write_rate((double)rays / seconds, rate, sizeof rate);
  snprintf(line, sizeof line, "%.0f %%, %s, %s left", 100 * done, rate, left);
  put_line(state, line, done);
}

void progress_write(struct progress *state, double seconds, double done)
{
  char line[LINE_SIZE];
  if (!is_time(state, seconds)) return;
  snprintf(line, sizeof line, "%.0f %% of the file", 100 * done);
  put_line(state, line, done);
}

void progress_end(const struct progress *progress)
{
  if (progress->terminal && progress->told > 0) fputs("\r\033[K", stderr);
}

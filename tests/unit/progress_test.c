/* The progress of a rendering and of writing a file: a line now and then, or a bar on a terminal. */
#include "command/progress.h"

#include <stdarg.h>
#include <stdio.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "cmocka_test.h"

/* The width of the terminal; 0: it is not known. */
static unsigned short columns;

int __wrap_ioctl(int descriptor, unsigned long request, ...);

int __wrap_ioctl(int descriptor, unsigned long request, ...)
{
  va_list arguments;
  va_start(arguments, request);
  struct winsize *window = va_arg(arguments, struct winsize *);
  va_end(arguments);
  if (descriptor != STDERR_FILENO || request != TIOCGWINSZ || columns == 0) return -1;
  *window = (struct winsize){.ws_col = columns};
  return 0;
}

static struct {
  size_t pixels; /* of 1000 */
  uint64_t rays;
  double seconds;
} rendered;

static void tell_rendered(struct progress *progress)
{
  progress_tell(progress, rendered.seconds, (double)rendered.pixels / 1000, rendered.rays);
}

static void tell_written(struct progress *progress) { progress_write(progress, 10, 0.25); }

/* Expects this text on standard error, which is a file meanwhile. */
static void expect(void (*tell)(struct progress *progress), struct progress progress, const char *line)
{
  char told[1000];
  FILE *file = tmpfile();
  const int saved = dup(STDERR_FILENO);
  assert_true(file != NULL && saved >= 0 && dup2(fileno(file), STDERR_FILENO) >= 0);
  tell(&progress);
  progress_end(&progress);
  assert_true(dup2(saved, STDERR_FILENO) >= 0 && close(saved) == 0);
  rewind(file);
  told[fread(told, 1, sizeof told - 1, file)] = '\0';
  assert_int_equal(fclose(file), 0);
  assert_string_equal(told, line);
}

TEST(test_rendering)
{
  const struct progress lines = {.terminal = false}, bar = {.terminal = true};
  const struct {
    size_t pixels;
    uint64_t rays;
    double seconds;
    const char *line;
  } cases[] = {{500, 5000, 4.9, ""}, /* too early */
               {0, 0, 5, "0 %, 0.0 k rays/s, ? left\n"},
               {1, 4000, 10, "0 %, 0.4 k rays/s, 2 h 46 min left\n"},
               {1, 4000, 1e6, "0 %, 0.0 k rays/s, 99 h 59 min left\n"},
               {100, 40000000, 10, "10 %, 4.00 M rays/s, 1 min 30 s left\n"},
               {500, 1000000, 8, "50 %, 125.0 k rays/s, 8 s left\n"},
               {500, 1000000, 8.6, "50 %, 116.3 k rays/s, 9 s left\n"},
               {1000, 1000000, 8, "100 %, 125.0 k rays/s, 0 s left\n"}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    rendered.pixels = cases[k].pixels, rendered.rays = cases[k].rays, rendered.seconds = cases[k].seconds;
    expect(tell_rendered, lines, cases[k].line);
  }
  expect(tell_rendered, (struct progress){.told = 4}, ""); /* too soon after the last */
  rendered.pixels = 500;
  expect(tell_rendered, bar, "\r[###############...............] 50 %, 125.0 k rays/s, 8 s left\033[K\r\033[K");
  rendered.seconds = 0.1;
  expect(tell_rendered, bar, ""); /* nothing was written, so nothing is wiped away */
}

/* The line stays in one row of the terminal, and leaves its last column free. The bar is dropped first. */
TEST(test_narrow_terminals)
{
  const struct {
    unsigned short columns;
    const char *line;
  } cases[] = {{38, "\r[##..] 50 %, 125.0 k rays/s, 8 s left\033[K\r\033[K"},
               {37, "\r50 %, 125.0 k rays/s, 8 s left\033[K\r\033[K"},
               {31, "\r50 %, 125.0 k rays/s, 8 s left\033[K\r\033[K"},
               {30, "\r50 %, 125.0 k rays/s, 8 s lef\033[K\r\033[K"},
               {1, "\r\033[K\r\033[K"}};
  rendered.pixels = 500, rendered.rays = 1000000, rendered.seconds = 8;
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    columns = cases[k].columns;
    expect(tell_rendered, (struct progress){.terminal = true}, cases[k].line);
  }
  columns = 0;
}

TEST(test_writing)
{
  expect(tell_written, (struct progress){.told = 9}, "");
  expect(tell_written, (struct progress){.told = 5}, "25 % of the file\n");
  expect(tell_written, (struct progress){.terminal = true},
         "\r[#######.......................] 25 % of the file\033[K\r\033[K");
}

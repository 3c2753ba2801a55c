/* pscn roots: polynomials from a file or stdin, roots on stdout. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "algebra/solver.h"
#include "base/clock.h"
#include "base/json_text.h"
#include "base/number.h"
#include "command/command.h"
#include "command/output.h"
#include "command/report.h"
#include "command/scene_file.h"
#include "command/stream.h"
#include "language/language.h"
#include "scene/method.h"

enum {
  MAX_COEFFICIENTS = POLYNOMIAL_MAX_DEGREE + 1,
  OUTPUT_BUFFER = 1 << 16,
  MOST_TOLD = 20 /* lines with unknown roots that are printed; more are only counted */
};

/* All roots are wanted, so the default is not the scene's, which finds only those in [0,1]. */
static const char DEFAULT_SOLVER[] = "aberth";

/* FORMAT_ITERATES is not a value of --format, but stands for --iterates. */
enum format { FORMAT_PLAIN, FORMAT_TABLE, FORMAT_JSON, FORMAT_ITERATES };

struct request {
  struct scene_request scene; /* only its solver and tolerance */
  enum format format;
  const char *path, *stats; /* path NULL: standard input */
  bool iterates, quiet;
};

static const struct command_option OPTIONS[] = {
  COMMAND_HELP_OPTION,
  SCENE_SOLVER_OPTION("text that may follow 'solver' in a scene; default aberth"),
  SCENE_TOLERANCE_OPTION("replaces the solver's tolerance"),
  COMMAND_OPTION("format", 0, 0, "plain: pairs re im (default); table, json: with radius, status, eq 11", "FORMAT"),
  COMMAND_TRUE("iterates", 0, iterates, "all values of the iteration, step by step, instead of the roots"),
  COMMAND_TEXT("stats", 0, stats, "statistics as JSON; - is standard output, after the roots", "FILE"),
  COMMAND_TRUE("quiet", 'q', quiet, "no summary on a terminal"),
  COMMAND_OPTIONS_END,
};

/* Takes the format, the only option that is not stored directly. */
static enum status take_option(const struct command *command, void *context, int val, const char *argument)
{
  static const char *const names[] = {"plain", "table", "json"};
  (void)val;
  for (int k = 0; k < 3; k++) {
    if (strcmp(argument, names[k]) == 0) {
      ((struct request *)context)->format = (enum format)k;
      return STATUS_OK;
    }
  }
  return command_usage(command, "'%s' is not a format; use plain, table or json", argument);
}

struct session {
  const char *name; /* of the input */
  enum format format;
  struct method method;
  struct solver_warm warm;
  struct solver_watch watch;
  size_t line; /* of the polynomial that is being solved */
  size_t polynomials, roots, iterations, accurate, missing;
  size_t doubtful; /* lines printed in plain format with unknown roots */
  size_t statuses[ROOT_CLUSTER + 1];
  struct seconds solve;
  bool failed; /* memory was too short for an answer */
  bool judged; /* eq 11 is evaluated, which takes several times as long as finding the roots */
};

/* Reads coefficients from the highest power to the constant. The fault's text is NULL if all is well. */
static struct stream_fault parse_line(const struct stream_line *line, double out_c[MAX_COEFFICIENTS], int *out_degree)
{
  struct stream_number number[MAX_COEFFICIENTS];
  size_t count;
  const struct stream_fault fault = stream_numbers(
    line, 2, MAX_COEFFICIENTS, "a polynomial has at least two coefficients, from the highest power to the constant",
    "a polynomial has at most 65 coefficients", number, &count);
  if (fault.text != NULL) return fault;
  bool zero = true;
  for (size_t k = 0; k < count; k++) {
    out_c[k] = number[count - 1 - k].value;
    zero = zero && out_c[k] == 0;
  }
  *out_degree = (int)count - 1;
  return (struct stream_fault){zero ? "all coefficients are zero: every number is a root" : NULL, 0, line->length};
}

static int by_place(const void *a, const void *b)
{
  const struct root *x = a, *y = b;
  if (x->re != y->re) return x->re < y->re ? -1 : 1;
  return (x->im > y->im) - (x->im < y->im);
}

/* ---- the formats ---- */

/* One polynomial's answer. */
struct answer {
  size_t line;
  bool first;              /* of all */
  struct polynomial power; /* as it was written */
  struct root_set roots;
};

static bool is_known(const struct root *root) { return root->radius < INFINITY; }

static const char *status_word(const struct root *root)
{
  static const char *const words[] = {"converged", "limit", "cluster"};
  return is_known(root) ? words[root->status] : "unknown";
}

static double eq11_of(const struct answer *answer, const struct root *root)
{
  return polynomial_eq11(&answer->power, root->re, root->im);
}

static void write_plain(const struct root_set *roots)
{
  for (int k = 0; k < roots->count; k++) {
    char pair[2 * NUMBER_TEXT_SIZE + 2];
    size_t length = 0;
    if (k > 0) pair[length++] = ' ';
    length += number_write_17(roots->root[k].re, pair + length);
    pair[length++] = ' ';
    length += number_write_17(roots->root[k].im, pair + length);
    fwrite(pair, 1, length, stdout);
  }
  putc('\n', stdout);
}

/* A value that prints, in three digits, as no less than the radius: otherwise the disc might lose its root. */
static double radius_told(double radius)
{
  char text[NUMBER_TEXT_SIZE];
  snprintf(text, sizeof text, "%.3g", radius);
  return strtod(text, NULL) < radius ? radius + 0.501 * pow(10, floor(log10(radius)) - 2) : radius;
}

/* A row for each root, and one for the missing roots. */
static void write_table(const struct answer *answer)
{
  if (answer->first)
    printf("%6s %24s %24s %10s %-9s %10s %10s\n", "line", "re", "im", "radius", "status", "iterations", "eq11");
  for (int k = 0; k < answer->roots.count; k++) {
    const struct root *root = &answer->roots.root[k];
    char re[NUMBER_TEXT_SIZE], im[NUMBER_TEXT_SIZE];
    number_write_17(root->re, re);
    number_write_17(root->im, im);
    printf("%6zu %24s %24s %10.3g %-9s %10d %10.3g\n", answer->line, re, im, radius_told(root->radius),
           status_word(root), root->iterations, eq11_of(answer, root));
  }
  if (answer->roots.missing > 0)
    printf("%6zu %24s %24s %10s %-9s %10s %10s\n", answer->line, "-", "-", "-", "missing", "-", "-");
}

/* JSON has no infinity. */
static json_t *finite_or_null(double value) { return isfinite(value) ? json_real(value) : json_null(); }

/* One object on one line. The caller frees it; NULL if memory is short. */
static char *json_line(const struct answer *answer)
{
  json_t *roots = json_array();
  for (int k = 0; k < answer->roots.count; k++) {
    const struct root *root = &answer->roots.root[k];
    json_t *row = json_pack("{s:f, s:f, s:o, s:s, s:i, s:o}", "re", root->re, "im", root->im, "radius",
                            finite_or_null(root->radius), "status", status_word(root), "iterations", root->iterations,
                            "eq11", finite_or_null(eq11_of(answer, root)));
    roots = json_append(roots, row);
  }
  json_t *whole = json_pack("{s:I, s:i, s:o, s:i}", "line", (json_int_t)answer->line, "degree", answer->power.degree,
                            "roots", roots, "missing", answer->roots.missing);
  char *text = json_text(whole, JSON_COMPACT | JSON_REAL_PRECISION(17) | JSON_ENSURE_ASCII);
  json_decref(whole);
  return text;
}

/* After memory was too short for one line, no more are written. */
static void write_json(struct session *session, const struct answer *answer)
{
  char *text = session->failed ? NULL : json_line(answer);
  session->failed = text == NULL;
  if (text != NULL) puts(text);
  free(text);
}

/* --iterates: one row for each step, while it is taken. */
static void write_iterate(void *context, int root, int step, double re, double im)
{
  const struct session *session = context;
  char real[NUMBER_TEXT_SIZE], imaginary[NUMBER_TEXT_SIZE];
  number_write_17(re, real);
  number_write_17(im, imaginary);
  printf("%6zu %6d %6d %24s %24s\n", session->line, step, root, real, imaginary);
}

/* The plain format cannot show what is unknown about a line's roots, so it is printed to stderr. */
static void tell_unknown(struct session *session, const struct answer *answer)
{
  int unknown = 0;
  for (int k = 0; k < answer->roots.count; k++) unknown += !is_known(&answer->roots.root[k]);
  if (unknown == 0 && answer->roots.missing == 0) return;
  session->doubtful++;
  if (session->doubtful > MOST_TOLD) return;
  fflush(stdout);
  if (unknown > 0) {
    command_print(stderr, session->name);
    fprintf(stderr, ":%zu: error: %d of the printed values may be far from any root\n", answer->line, unknown);
  }
  if (answer->roots.missing > 0) {
    command_print(stderr, session->name);
    fprintf(stderr, ":%zu: error: %d root%s missing: not found, or too large\n", answer->line, answer->roots.missing,
            answer->roots.missing == 1 ? " is" : "s are");
  }
}

/* ---- a polynomial ---- */

/* Coefficients that would overflow in the change of basis are scaled down by a common power of two. What the smallest
 * of them lose goes into their error bounds. */
#define LARGE 0x1p900
#define SMALLER 0x1p-200

static void to_bernstein(int degree, const double c[], double out_c[], double out_error[])
{
  double scaled[MAX_COEFFICIENTS], error[MAX_COEFFICIENTS], largest = 0;
  for (int k = 0; k <= degree; k++) largest = fmax(largest, fabs(c[k]));
  for (int k = 0; k <= degree; k++) {
    scaled[k] = largest > LARGE ? c[k] * SMALLER : c[k];
    error[k] = scaled[k] / SMALLER == c[k] || scaled[k] == c[k] ? 0 : DBL_TRUE_MIN;
  }
  const struct polynomial power = {degree, BASIS_POWER, scaled, error};
  polynomial_to_bernstein(&power, out_c, out_error);
}

/* `basis bernstein` solves the same polynomial in scaled Bernstein form, and tells the solver the rounding errors of
 * the change of basis. Leading zeros are removed before it, because they could not be recognized after it. */
static void solve(struct session *session, struct answer *answer)
{
  const struct seconds start = seconds_now();
  const double *c = answer->power.c;
  struct polynomial p = answer->power;
  while (p.degree > 1 && c[p.degree] == 0) p.degree--;
  double bernstein[MAX_COEFFICIENTS], error[MAX_COEFFICIENTS];
  if (session->method.basis == BASIS_BERNSTEIN && c[p.degree] != 0) {
    to_bernstein(p.degree, c, bernstein, error);
    p = (struct polynomial){p.degree, BASIS_BERNSTEIN, bernstein, error};
  }
  solver_solve(&p, &session->method.roots, &session->warm, &answer->roots);
  const struct seconds taken = seconds_since(start);
  session->solve.wall += taken.wall;
  session->solve.cpu += taken.cpu;
}

static void count_roots(struct session *session, const struct answer *answer)
{
  const struct root_set *roots = &answer->roots;
  session->roots += (size_t)roots->count;
  for (int k = 0; k < roots->count; k++) {
    const struct root *root = &roots->root[k];
    session->iterations += (size_t)root->iterations;
    session->accurate += session->judged && eq11_of(answer, root) < 1;
    session->statuses[root->status]++;
  }
  session->missing += (size_t)roots->missing;
}

static void write_answer(struct session *session, const struct answer *answer)
{
  switch (session->format) {
  case FORMAT_PLAIN:
    write_plain(&answer->roots);
    tell_unknown(session, answer);
    break;
  case FORMAT_TABLE: write_table(answer); break;
  case FORMAT_JSON: write_json(session, answer); break;
  case FORMAT_ITERATES: break; /* written while solving */
  }
}

static struct stream_fault take(void *context, const struct stream_line *line)
{
  struct session *session = context;
  double c[MAX_COEFFICIENTS];
  int degree = 0;
  const struct stream_fault fault = parse_line(line, c, &degree);
  if (fault.text != NULL) return fault;
  session->line = line->number;
  struct answer answer = {
    .line = line->number, .first = ++session->polynomials == 1, .power = {degree, BASIS_POWER, c, NULL}};
  solve(session, &answer);
  count_roots(session, &answer);
  qsort(answer.roots.root, (size_t)answer.roots.count, sizeof answer.roots.root[0], by_place);
  write_answer(session, &answer);
  return fault;
}

static enum status answered(void *context)
{
  return ((const struct session *)context)->failed ? STATUS_LIMIT : STATUS_OK;
}

static double share(size_t part, size_t whole) { return whole == 0 ? 0 : (double)part / (double)whole; }

static json_t *statistics(const struct session *session)
{
  char solver[METHOD_TEXT_SIZE];
  method_text(&session->method, solver, sizeof solver);
  return json_pack(
    "{s:o, s:o, s:o, s:o, s:f, s:{s:o, s:o, s:o}, s:s, s:f, s:{s:f}, s:{s:f}}", "polynomials",
    json_count(session->polynomials), "roots", json_count(session->roots), "missing", json_count(session->missing),
    "iterations", json_count(session->iterations), "accurate", share(session->accurate, session->roots), "status",
    "converged", json_count(session->statuses[ROOT_CONVERGED]), "cluster", json_count(session->statuses[ROOT_CLUSTER]),
    "limit", json_count(session->statuses[ROOT_LIMIT]), "solver", solver, "tolerance", session->method.roots.tolerance,
    "time", "solve", session->solve.wall, "cpu", "solve", session->solve.cpu);
}

static void print_summary(const struct session *session)
{
  char solver[METHOD_TEXT_SIZE];
  method_text(&session->method, solver, sizeof solver);
  fprintf(stderr, "solver   %s\n", solver);
  fprintf(stderr, "roots    %zu of %zu polynomials: %zu converged, %zu in clusters, %zu at the limit\n", session->roots,
          session->polynomials, session->statuses[ROOT_CONVERGED], session->statuses[ROOT_CLUSTER],
          session->statuses[ROOT_LIMIT]);
  fprintf(stderr, "accurate %.4f of them (eq 11); %.2f iterations a root; %.6f s\n",
          share(session->accurate, session->roots), share(session->iterations, session->roots), session->solve.wall);
}

static enum status choose_solver(const struct command *command, const struct request *request, struct method *out)
{
  const char *text = request->scene.solver_text == NULL ? DEFAULT_SOLVER : request->scene.solver_text;
  struct diagnostics diagnostics = stderr_diagnostics(command);
  const enum status status = language_parse_solver(text, &diagnostics, out);
  if (status != STATUS_OK) return status;
  if (!out->basis_said) out->basis = BASIS_POWER;
  return language_set_tolerance(request->scene.tolerance, 1, out, &diagnostics);
}

static void begin_iterates(struct session *session)
{
  session->format = FORMAT_ITERATES;
  session->watch = (struct solver_watch){write_iterate, session};
  session->method.roots.watch = &session->watch;
  printf("%6s %6s %6s %24s %24s\n", "line", "step", "root", "re", "im");
}

static enum status roots(const struct command *command, const struct request *request)
{
  const bool summary = !request->quiet && isatty(STDERR_FILENO) == 1;
  struct session session = {
    .name = stream_name(request->path), .format = request->format, .judged = summary || request->stats != NULL};
  const struct stream_reader reader = {.take = take, .answer = answered, .context = &session, .path = request->path};
  if (request->iterates && request->format != FORMAT_PLAIN)
    return command_usage(command, "--iterates cannot be used with --format");
  const char *input = request->path == NULL || output_is_standard(request->path) ? "/dev/stdin" : request->path;
  enum status status = output_spare_input(command, request->stats, input);
  if (status == STATUS_OK) status = output_probe(command, request->stats);
  if (status == STATUS_OK) status = choose_solver(command, request, &session.method);
  if (status == STATUS_OK && request->iterates) begin_iterates(&session);
  if (status == STATUS_OK) status = stream_read(command, &reader);
  if (status == STATUS_OK && request->stats != NULL)
    status = report_write(command, statistics(&session), request->stats);
  if (status == STATUS_OK && summary) print_summary(&session);
  if (session.doubtful > MOST_TOLD)
    command_error(command, "and %zu more lines with unknown roots", session.doubtful - MOST_TOLD);
  return status == STATUS_OK && session.doubtful > 0 ? STATUS_DIFFERENT : status;
}

static const struct request DEFAULTS = {.scene.tolerance = NAN};

static enum status run(const struct command *command, void *context, const struct command_line *line)
{
  struct request *request = context;
  static char buffer[OUTPUT_BUFFER];
  (void)setvbuf(stdout, buffer, _IOFBF, sizeof buffer);
  request->path = line->positional_count == 0 ? NULL : line->positional[0];
  return roots(command, request);
}

const struct command command_roots = {
  .name = "roots",
  .arguments = "[FILE]",
  .summary = "Reads polynomials and prints their roots",
  .description =
    "FILE, or standard input, has one polynomial a line: its real coefficients from the highest power to the\n"
    "constant, with blanks or commas between them, of degree 1 to 64; # begins a comment. Standard output has one\n"
    "line for each, in order: 're im' pairs, sorted by real part. Multiple roots are repeated. A bad line ends the\n"
    "run with its number, after the answers to the lines before it. If a value is not known to be near a root, or a\n"
    "root is missing, standard error says so, and the exit code is 1; the formats table and json show it\n"
    "themselves, and end with 0.\n"
    "\n"
    "The solver works on the coefficients as they are (basis power). With 'basis bernstein' in --solver the\n"
    "polynomial is first converted to scaled Bernstein form on [0,1]. The solver 'bernstein' finds the real roots\n"
    "in [0,1], multiple ones once or twice. With 'start previous' each polynomial starts from the roots of the one\n"
    "before.\n"
    "\n"
    "--iterates: a row for every value of the solver's iteration, in order: number of the line, step (0: the\n"
    "start), number of the root as the solver counts them, re, im. Roots that need no iteration have no rows.\n",
  COMMAND_RUNS(0, take_option),
};

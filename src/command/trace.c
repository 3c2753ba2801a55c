/* pscn trace SCENE: rays from a file or stdin, hits on stdout. */
#define _DEFAULT_SOURCE /* htole64, le64toh */
#include <endian.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>
#include <unistd.h>

#include "base/number.h"
#include "base/real.h"
#include "command/command.h"
#include "command/output.h"
#include "command/report.h"
#include "command/scene_file.h"
#include "command/stream.h"
#include "geometry/vector.h"
#include "intersect/explain.h"
#include "intersect/intersect.h"

enum {
  RAY_VALUES = 6,                                      /* ox oy oz dx dy dz */
  ANSWER_VALUES = 8,                                   /* T U V PATCH NX NY NZ, and with --certainty 1 or 0 */
  ANSWER_SIZE = ANSWER_VALUES * NUMBER_TEXT_SIZE + 16, /* bytes of an answer as text, at most */
  OUTPUT_BUFFER = 1 << 16
};

struct request {
  struct scene_request scene; /* first: passed to scene_request_take */
  const char *rays, *stats;   /* rays NULL: standard input */
  bool binary, certainty, all, explain;
};

static const struct command_option OPTIONS[] = {
  COMMAND_HELP_OPTION,
  SCENE_OPTIONS,
  COMMAND_TRUE("binary", 0, binary, "little-endian doubles instead of text"),
  COMMAND_TRUE("all", 0, all, "all hits of each ray: a line with their number, then a line for each"),
  COMMAND_TRUE("certainty", 0, certainty, "add 'certain' or 'grazing' to each answer"),
  COMMAND_TRUE("explain", 0, explain, "how each answer is found, instead of the answer"),
  COMMAND_TEXT("stats", 0, stats, "statistics as JSON; - is standard output, after the hits", "FILE"),
  COMMAND_TRUE("quiet", 'q', scene.quiet, "no summary on a terminal"),
  COMMAND_OPTIONS_END,
};

/* Rays that wait for an answer, and the tracer that answers them. */
struct session {
  const struct request *request;
  const struct scene *scene;
  struct tracer *tracer;
  size_t number; /* of the rays explained */
  size_t count;
  struct ray rays[PACKET_SIZE];
  enum status status; /* if not STATUS_OK, nothing more is answered */
};

/* The numbers of an answer, the last of them for --certainty. A miss has T infinite and PATCH -1. */
static void answer_values(const struct ray *ray, const struct hit *hit, double out[ANSWER_VALUES])
{
  const bool missed = hit->patch == HIT_NONE;
  memset(out, 0, ANSWER_VALUES * sizeof *out);
  out[0] = missed ? INFINITY : hit->t * vector_length(ray->direction);
  out[3] = missed ? -1 : (double)hit->patch;
  out[7] = hit->certainty == CERTAINTY_CERTAIN;
  if (!missed) {
    out[1] = hit->u;
    out[2] = hit->v;
    for (int k = 0; k < 3; k++) out[4 + k] = hit->normal[k] + 0.0; /* -0 becomes 0 */
  }
}

/* Ends a line. Returns its end. */
static char *append_end(bool tells, bool certain, char *to)
{
  if (tells) memcpy(to, certain ? " certain" : " grazing", 8), to += 8;
  *to++ = '\n';
  return to;
}

static char *append_double(double value, char *to)
{
  const uint64_t bits = htole64(real_bits(value));
  memcpy(to, &bits, sizeof bits);
  return to + sizeof bits;
}

static void write_hit(const struct request *request, const struct ray *ray, const struct hit *hit)
{
  const bool missed = hit->patch == HIT_NONE;
  double value[ANSWER_VALUES];
  char answer[ANSWER_SIZE], *to = answer;
  answer_values(ray, hit, value);
  if (request->binary) {
    for (int k = 0; k < ANSWER_VALUES - !request->certainty; k++) to = append_double(value[k], to);
  } else {
    memcpy(to, "miss", 4);
    to += 4;
    if (!missed) memcpy(to - 4, "hit", 3), to--;
    for (int k = 0; k < ANSWER_VALUES - 1 && !missed; k++) {
      *to++ = ' ';
      to += number_write_17(value[k], to);
    }
    to = append_end(request->certainty, value[ANSWER_VALUES - 1] == 1, to);
  }
  (void)fwrite(answer, 1, (size_t)(to - answer), stdout);
}

/* Writes the line, or the record, before a ray's hits. */
static void write_count(const struct request *request, const struct hit_list *list)
{
  char answer[ANSWER_SIZE], *to = answer;
  const double count = (double)list->count;
  if (request->binary) to = append_double(list->certainty == CERTAINTY_CERTAIN, append_double(count, to));
  else to = append_end(true, list->certainty == CERTAINTY_CERTAIN, to + number_write_17(count, to));
  (void)fwrite(answer, 1, (size_t)(to - answer), stdout);
}

/* ---- --explain: the story of a ray ---- */

struct teller {
  const struct scene *scene;
  double length;  /* of the direction: T is t times it */
  double nearest; /* T so far */
  size_t candidates, left_open;
};

static void put_number(double value)
{
  char text[NUMBER_TEXT_SIZE];
  text[number_write_17(value, text)] = '\0';
  printf(" %s", text);
}

static void put_row(const char *name, const double c[], int count)
{
  printf("  %s:", name);
  for (int k = 0; k < count; k++) put_number(c[k]);
  putchar('\n');
}

/* Prints an equation of eq 3: the rows of its net, one by one. */
static void put_net(const char *name, const struct explained_candidate *candidate, const double net[16])
{
  double c[16];
  int count = 0;
  for (int i = 0; i <= candidate->kept_degree; i++)
    for (int j = 0; j <= candidate->other_degree; j++) c[count++] = net[4 * i + j];
  put_row(name, c, count);
}

static void put_fate(const struct teller *teller, const struct explained_candidate *candidate, int k)
{
  const struct explained_roots *found = &candidate->found;
  const char other = candidate->v_kept ? 'u' : 'v';
  const double T = candidate->t[k] * teller->length;
  switch (found->fate[k]) {
  case ROOT_COMPLEX: printf(", refused: not real"); break;
  case ROOT_OUTSIDE: printf(", refused: outside [0,1]"); break;
  case ROOT_ELSEWHERE:
    if (isnan(found->other[k])) printf(", refused: no %c follows", other);
    else printf(", refused: %c = %.6g is outside", other, found->other[k]);
    break;
  case ROOT_NO_SOLUTION: printf(", refused: with %c = %.6g it does not solve eq 3", other, found->other[k]); break;
  case ROOT_OFFERED:
    printf(", %c =", other);
    put_number(found->other[k]);
    printf(", T =");
    put_number(T);
    break;
  }
}

/* Prints r in the format of pscn roots, and its roots. */
static void put_roots(const struct teller *teller, const struct explained_candidate *candidate)
{
  const struct explained_roots *found = &candidate->found;
  const struct method *method = &teller->scene->solvers[teller->scene->patches[candidate->patch].solver];
  const char kept = candidate->v_kept ? 'v' : 'u';
  const struct polynomial r = {found->degree, found->basis, found->c, NULL};
  double highest_first[EXPLAIN_COEFFICIENTS];
  for (int k = 0; k <= found->degree; k++) highest_first[k] = found->c[found->degree - k];
  if (found->basis == BASIS_POWER) printf("  r(%c), highest power first:\n", kept);
  else printf("  r, highest power of x = %c/(1-%c) first:\n", kept, kept);
  if (found->degree > 0) put_row("r", highest_first, found->degree + 1);
  printf("  %d roots by %s%s\n", found->roots.count, method->roots.solver->name,
         candidate->by_solver ? "" : ", found for this explanation only; the ray needed no solver");
  for (int k = 0; k < found->roots.count; k++) {
    const struct root *root = &found->roots.root[k];
    printf("    %c =", kept);
    put_number(root->re);
    if (root->im != 0) printf(" %+.6g i", root->im);
    printf(", %d iterations, eq 11: %.3g", root->iterations, polynomial_eq11(&r, root->re, root->im));
    put_fate(teller, candidate, k);
    putchar('\n');
  }
}

static void put_outcome(struct teller *teller, const struct explained_candidate *candidate)
{
  if (candidate->taken) {
    printf("  accepted: T =");
    put_number(candidate->hit_t * teller->length);
    printf(", the nearest so far%s\n", candidate->left_open ? "; a part is left to the last resort" : "");
    printf("  certificate: ");
    if (candidate->proven)
      printf("a and b have exactly one common root within %.2g of u = %.17g and %.2g of v = %.17g\n",
             candidate->radius_u, candidate->hit_u, candidate->radius_v, candidate->hit_v);
    else printf("none: with 'polish off' the solver's roots are the answer\n");
    teller->nearest = candidate->hit_t * teller->length;
  } else if (candidate->left_open) {
    printf("  left to the last resort: double precision cannot decide it (a border, a tangency, an end of the ray)\n");
  } else if (candidate->reached == STAGE_PLANES) {
    printf("  missed, proven: a, b or a combination of them keeps one sign on the leaf\n");
  } else if (candidate->reached == STAGE_RESULTANT) {
    printf("  missed, proven: the coefficients of r have no change of sign\n");
  } else {
    bool behind = false;
    for (int k = 0; k < candidate->found.roots.count; k++)
      behind |= candidate->found.fate[k] == ROOT_OFFERED && candidate->t[k] * teller->length >= teller->nearest;
    printf("  nothing accepted: %s\n", behind ? "not nearer than the nearest so far, or not on the leaf"
                                              : "no root on the leaf in front of the ray's start");
  }
  teller->left_open += candidate->left_open;
}

static void tell(void *context, const struct explained_candidate *candidate)
{
  static const char *const stages[STAGE_COUNT] = {"its bilinear part", "the planes a and b", "the resultant r",
                                                  "the roots of r"};
  struct teller *teller = context;
  const int *split = candidate->split;
  printf("candidate %zu: patch %u", ++teller->candidates, candidate->patch);
  if (split[0] * split[1] > 1)
    printf(", its part [%d,%d]/%d x [%d,%d]/%d, on which u, v run from 0 to 1 here", candidate->column_u,
           candidate->column_u + 1, split[0], candidate->column_v, candidate->column_v + 1, split[1]);
  if (candidate->blind) {
    printf("\n  left to the last resort: the ray starts so far away that rounding leaves nothing of a and b\n");
    teller->left_open++;
    return;
  }
  printf("; last stage: %s\n", stages[candidate->reached]);
  printf("  eq 3, Bernstein coefficients of degree %d in %c and %d in %c:\n", candidate->kept_degree,
         candidate->v_kept ? 'v' : 'u', candidate->other_degree, candidate->v_kept ? 'u' : 'v');
  put_net("a", candidate, candidate->a);
  put_net("b", candidate, candidate->b);
  if (candidate->solved) put_roots(teller, candidate);
  put_outcome(teller, candidate);
}

/* Traces ray `number`, whose direction may have any length, and prints its story to stdout. */
static void explain_ray(const struct scene *scene, struct tracer *tracer, size_t number, const struct ray *ray)
{
  struct teller teller = {.scene = scene, .length = vector_length(ray->direction), .nearest = INFINITY};
  struct hit hit;
  printf("ray %zu: from", number);
  for (int k = 0; k < 3; k++) put_number(ray->origin[k]);
  printf(" along");
  for (int k = 0; k < 3; k++) put_number(ray->direction[k] / teller.length);
  putchar('\n');
  tracer_explain(tracer, ray, tell, &teller, &hit);
  if (teller.left_open > 0)
    printf("last resort: %zu of %zu candidates, searched in their order along the ray\n", teller.left_open,
           teller.candidates);
  if (hit.patch == HIT_NONE) {
    printf("answer: miss");
  } else {
    printf("answer: hit");
    put_number(hit.t * teller.length);
    put_number(hit.u);
    put_number(hit.v);
    printf(" %u", hit.patch);
    for (int k = 0; k < 3; k++) put_number(hit.normal[k] + 0.0);
  }
  printf(" %s\n", hit.certainty == CERTAINTY_CERTAIN ? "certain" : "grazing");
  if (hit.patch != HIT_NONE) printf("  the point is within %.2g of the exact patch\n", hit.point_error);
}

/* ---- rays ---- */

/* Answers the waiting rays. */
static enum status answer(void *context)
{
  struct session *session = context;
  const struct request *request = session->request;
  struct hit hits[PACKET_SIZE];
  struct hit_list lists[PACKET_SIZE];
  const size_t count = session->status == STATUS_OK ? session->count : 0;
  session->count = 0;
  if (request->explain) {
    for (size_t k = 0; k < count; k++)
      explain_ray(session->scene, session->tracer, ++session->number, &session->rays[k]);
    return STATUS_OK;
  }
  if (request->all && count > 0) session->status = tracer_all(session->tracer, count, session->rays, lists);
  else if (count > 0) tracer_closest(session->tracer, count, session->rays, hits);
  for (size_t k = 0; k < count && session->status == STATUS_OK; k++) {
    if (request->all) write_count(request, &lists[k]);
    else lists[k] = (struct hit_list){.count = 1, .hits = &hits[k]};
    for (size_t n = 0; n < lists[k].count; n++) write_hit(request, &session->rays[k], &lists[k].hits[n]);
  }
  return session->status;
}

#define DIRECTION_IS_ZERO "the direction is zero; numbers below 1e-100 are read as 0"

/* Makes a ray of six numbers; returns false if the direction is zero. The direction is scaled by a power of two,
 * so that its length neither overflows nor underflows, and no t exceeds a distance. */
static bool make_ray(const double value[RAY_VALUES], struct ray *out)
{
  const double largest = fmax(fmax(fabs(value[3]), fabs(value[4])), fabs(value[5]));
  int exponent;
  if (largest == 0) return false;
  (void)frexp(largest, &exponent);
  for (int k = 0; k < 3; k++) {
    out->origin[k] = value[k];
    out->direction[k] = ldexp(value[k + 3], 1 - exponent);
  }
  out->t_min = 0;
  out->t_max = INFINITY;
  return true;
}

/* Reads "ox oy oz dx dy dz". The fault's text is NULL if all is well. */
static struct stream_fault parse_line(const struct stream_line *line, struct ray *out)
{
  struct stream_number number[RAY_VALUES];
  double value[RAY_VALUES];
  size_t count;
  const struct stream_fault fault = stream_numbers(line, RAY_VALUES, RAY_VALUES,
                                                   "a ray has six numbers: ox oy oz dx dy dz",
                                                   "a ray has only six numbers", number, &count);
  for (size_t k = 0; k < count; k++) {
    value[k] = number[k].value;
    if (!number_in_range(&value[k]))
      return (struct stream_fault){"a ray's numbers are at most 1e100", number[k].begin, number[k].end};
  }
  if (fault.text != NULL) return fault;
  return (struct stream_fault){make_ray(value, out) ? NULL : DIRECTION_IS_ZERO, number[3].begin, number[5].end};
}

/* The same for six little-endian doubles. */
static struct stream_fault parse_record(const struct stream_line *record, struct ray *out)
{
  double value[RAY_VALUES];
  if (record->length < sizeof value)
    return (struct stream_fault){.text = "the stream ends inside a record of 48 bytes"};
  for (int k = 0; k < RAY_VALUES; k++) {
    uint64_t bits;
    memcpy(&bits, record->text + sizeof bits * (size_t)k, sizeof bits);
    bits = le64toh(bits);
    memcpy(&value[k], &bits, sizeof bits);
    if (!number_in_range(&value[k])) return (struct stream_fault){.text = "a ray's numbers are at most 1e100"};
  }
  return (struct stream_fault){.text = make_ray(value, out) ? NULL : DIRECTION_IS_ZERO};
}

static struct stream_fault take(void *context, const struct stream_line *line)
{
  struct session *session = context;
  struct ray *ray = &session->rays[session->count];
  const struct stream_fault fault = session->request->binary ? parse_record(line, ray) : parse_line(line, ray);
  if (fault.text == NULL && ++session->count == PACKET_SIZE) (void)answer(session); /* fails again at the end */
  return fault;
}

/* Checks the request before anything is read: options that exclude each other, and files that would be overwritten. */
static enum status check_request(const struct command *command, struct request *request)
{
  if (request->explain && request->all)
    return command_usage(command, "--explain cannot be used with --all: it explains the nearest hit");
  if (request->explain && request->binary)
    return command_usage(command, "--explain cannot be used with --binary: it writes text");
  const bool standard = request->rays == NULL || output_is_standard(request->rays);
  if (standard && output_is_standard(request->scene.path))
    return command_usage(command, "scene and rays cannot both come from standard input");
  enum status status = scene_file_spare(command, &request->scene, NULL, request->stats);
  if (status == STATUS_OK)
    status = output_spare_input(command, request->stats, standard ? "/dev/stdin" : request->rays);
  if (status == STATUS_OK) status = output_probe(command, request->stats);
  return status;
}

static enum status trace(const struct command *command, struct request *request)
{
  struct scene *scene = NULL;
  struct intersector *intersector = NULL;
  struct session session = {.request = request};
  struct seconds start = seconds_now();
  enum status status = check_request(command, request);
  if (status != STATUS_OK) return status;
  status = scene_file_load(command, &request->scene, &scene);
  if (status == STATUS_OK) status = scene_file_spare(command, &request->scene, scene, request->stats);
  struct report report = {.scene_path = request->scene.path, .scene = scene, .threads = 1};
  report.parse = seconds_since(start);
  if (status != STATUS_OK) goto done;

  start = seconds_now();
  status = intersector_create(scene, &intersector);
  if (status == STATUS_OK) status = tracer_create(intersector, &session.tracer);
  if (status == STATUS_LIMIT) (void)command_out_of_memory(command);
  else if (status == STATUS_OK && !request->scene.quiet) scene_file_warn_of_cuts(command, intersector);
  report.build = seconds_since(start);
  if (status == STATUS_OK) {
    start = seconds_now();
    session.scene = scene;
    const struct stream_reader reader = {take, answer, &session, request->binary ? RAY_VALUES * sizeof(double) : 0,
                                         request->rays};
    status = stream_read(command, &reader);
    report.render = seconds_since(start);
    report.counts = *tracer_counts(session.tracer);
  }
  if (status == STATUS_OK && request->stats != NULL)
    status = report_write(command, report_statistics(&report), request->stats);
  if (status == STATUS_OK && !request->scene.quiet && isatty(STDERR_FILENO) == 1) report_print(&report);
done:
  tracer_destroy(session.tracer);
  intersector_destroy(intersector);
  scene_destroy(scene);
  return status;
}

static const struct request DEFAULTS = {.scene = SCENE_REQUEST_DEFAULT};

static enum status run(const struct command *command, void *context, const struct command_line *line)
{
  struct request *request = context;
  static char buffer[OUTPUT_BUFFER];
  (void)setvbuf(stdout, buffer, _IOFBF, sizeof buffer);
  request->scene.path = line->positional[0];
  request->rays = line->positional_count == 1 ? NULL : line->positional[1];
  return trace(command, request);
}

const struct command command_trace = {
  .name = "trace",
  .arguments = "SCENE [FILE]",
  .summary = "Reads rays and prints where each hits the scene",
  .description =
    "FILE, or standard input, has one ray a line, 'ox oy oz dx dy dz', with blanks or commas between the numbers;\n"
    "the direction may have any length, and # begins a comment. Standard output has one line for each ray, in\n"
    "order: 'hit T U V PATCH NX NY NZ' or 'miss'. T is the distance from the origin in scene units, U and V are the\n"
    "parameters of the whole patch, PATCH is its number from 0, N the unit normal facing the origin. A bad line\n"
    "ends the run with its number, after the answers to the lines before it.\n"
    "\n"
    "--binary: a ray is six little-endian doubles, an answer seven, T U V PATCH NX NY NZ; a miss has T infinite,\n"
    "PATCH -1 and zeros.\n"
    "\n"
    "--certainty: each line ends with 'certain' if the answer is proven, or with 'grazing' if a change of the input\n"
    "within rounding could change it; a binary answer has an eighth number, 1 or 0.\n"
    "\n"
    "--all: all hits of a ray. A line 'N certain' or 'N grazing', then N lines 'hit ...' as above, in order of T.\n"
    "'certain' means that the number is proven: if it is odd the ray starts inside a closed surface. In binary, N\n"
    "and 1 or 0 as doubles, then N answers.\n"
    "\n"
    "--explain: for each ray the leaves on which it is tried, in order, each with its equations a and b, their\n"
    "resultant r in the format that 'pscn roots' reads (in powers of x = u/(1-u) if the basis is bernstein), the\n"
    "solver's roots, what became of each, and the nearest hit so far with its certificate; then the answer. To try\n"
    "another solver:\n"
    "pscn trace SCENE --explain <ray | sed -n 's/^  r: //p' | pscn roots --format table\n",
  COMMAND_RUNS(1, scene_request_take),
};

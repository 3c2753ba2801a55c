/* The peers of a chart: plain Newton, which is ours but guards nothing; Embree, by pscn-embree where it stands beside
 * pscn; and POV-Ray, where it is installed. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/number.h"
#include "base/sort.h"
#include "chart/exchange.h"
#include "chart/plain_newton.h"
#include "command/chart.h"
#include "command/interrupt.h"
#include "command/process.h"
#include "geometry/vector.h"

/* ---- plain Newton ---- */

static enum status ask_plain_newton(struct chart *chart)
{
  struct plain_newton *plain = plain_newton_create(chart->scene, chart->rays);
  struct answer *shadows = malloc((chart->rays[RAYS_SHADOW].count + 1) * sizeof *shadows);
  if (plain == NULL || shadows == NULL) {
    plain_newton_destroy(plain);
    free(shadows);
    return STATUS_LIMIT;
  }
  chart_tell(chart, "plain Newton");
  const struct runner runners[] = { pscn_runner_face(&chart->yardstick), plain_newton_face(plain) };
  const size_t counts[RAY_KINDS] = { chart->rays[RAYS_CAMERA].count, chart->rays[RAYS_SHADOW].count };
  struct timing time[2][RAY_KINDS];
  const enum status status = measure_rounds(runners, 2, counts, chart->rounds, &interrupt_signal, time);
  if (status == STATUS_OK) {
    struct chart_point *point = chart_add(chart, FAMILY_PLAIN_NEWTON);
    snprintf(point->name, sizeof point->name, "2-D Newton from the middle of %dx%d parts", PLAIN_NEWTON_SPLIT,
             PLAIN_NEWTON_SPLIT);
    memcpy(point->time, time[1], sizeof point->time);
    plain_newton_answers(plain, RAYS_SHADOW, shadows);
    for (size_t k = 0; k < counts[RAYS_SHADOW]; k++)
      chart->occluded[k] = isfinite(shadows[k].t);
    plain_newton_answers(plain, RAYS_CAMERA, chart->answers);
    point->has_shadow = true;
    chart_judge(chart, point);
  }
  plain_newton_destroy(plain);
  free(shadows);
  return status;
}

/* ---- Embree ---- */

/* The program beside ours, or nothing. */
static bool find_embree(char out[SCRATCH_PATH_SIZE])
{
  static const char NAME[] = "pscn-embree";
  const ssize_t length = readlink("/proc/self/exe", out, SCRATCH_PATH_SIZE - sizeof NAME - 1);
  if (length <= 0)
    return false;
  out[length] = '\0';
  char *slash = strrchr(out, '/');
  if (slash == NULL)
    return false;
  memcpy(slash + 1, NAME, sizeof NAME);
  return access(out, X_OK) == 0;
}

/* A mesh of more triangles is left out: it would take more than a gigabyte. */
#define MAX_TRIANGLES 8e6

static double triangles(const struct chart *chart, size_t side)
{
  return 2.0 * (double)(side * side) * (double)chart->scene->patch_count;
}

static bool write_question(const struct chart *chart, const struct scratch *folder)
{
  static const size_t SIDES[] = { 8, 16, 32, 64, 128, 256 }, QUICK_SIDES[] = { 8, 32, 128 };
  struct exchange_question question = { .patch_count = chart->scene->patch_count, .rounds = chart->rounds };
  memcpy(question.rays, chart->rays, sizeof question.rays);
  question.side_count = chart->quick ? sizeof QUICK_SIDES / sizeof QUICK_SIDES[0] : sizeof SIDES / sizeof SIDES[0];
  memcpy(question.sides, chart->quick ? QUICK_SIDES : SIDES, question.side_count * sizeof question.sides[0]);
  while (question.side_count > 1 && triangles(chart, question.sides[question.side_count - 1]) > MAX_TRIANGLES)
    question.side_count--;
  question.nets = calloc(question.patch_count + 1, sizeof *question.nets);
  FILE *file = question.nets == NULL ? NULL : scratch_open(folder, "question");
  bool good = file != NULL;
  for (size_t n = 0; good && n < question.patch_count; n++)
    memcpy(question.nets[n], chart->scene->patches[n].P, sizeof question.nets[n]);
  good = good && exchange_write_question(file, &question);
  if (file != NULL)
    good = scratch_close(file) == STATUS_OK && good;
  free(question.nets);
  return good;
}

static void read_embree(struct chart *chart, FILE *file)
{
  struct exchange_answer answer;
  while (exchange_read_answer(file, &answer, chart->rays[RAYS_CAMERA].count, chart->answers,
                              chart->rays[RAYS_SHADOW].count, chart->occluded)) {
    struct chart_point *point = chart_add(chart, FAMILY_EMBREE);
    snprintf(point->name, sizeof point->name, "Embree, %zux%zux2 triangles a patch, %s", answer.side, answer.side,
             answer.width == 1 ? "one by one" : "8 coherent");
    if (answer.width > 1)
      snprintf(point->label, sizeof point->label, "%zu", answer.side);
    memcpy(point->time, answer.time, sizeof point->time);
    point->has_shadow = true;
    chart_judge(chart, point);
  }
}

static enum status ask_embree(struct chart *chart)
{
  char program[SCRATCH_PATH_SIZE], question[SCRATCH_PATH_SIZE], answer[SCRATCH_PATH_SIZE], log[SCRATCH_PATH_SIZE];
  struct scratch folder;
  if (!find_embree(program)) {
    chart_note(chart, "Embree is left out: pscn-embree does not stand beside pscn (it is built where libembree-dev is "
                      "found).");
    return STATUS_OK;
  }
  chart_tell(chart, "Embree");
  if (scratch_create(&folder) != STATUS_OK) {
    chart_note(chart, "Embree is left out: no temporary folder could be made.");
    return STATUS_OK;
  }
  scratch_path(&folder, "question", question);
  scratch_path(&folder, "answer", answer);
  scratch_path(&folder, "log", log);
  const char *const arguments[] = { program, question, answer, NULL };
  const struct process_request request = { arguments, NULL, NULL, log };
  struct process_result result = { .exit_code = 1 };
  enum status status = STATUS_OK;
  if (write_question(chart, &folder))
    status = process_run(&request, &interrupt_signal, &result);
  FILE *file = status == STATUS_OK && result.exit_code == 0 ? fopen(answer, "rb") : NULL;
  if (file != NULL) {
    read_embree(chart, file);
    (void)fclose(file);
    chart_note(chart, "Embree runs in a program of its own, each mesh in turn with pscn's default solver, one thread; "
                      "its answers are those of rtcIntersect1 and rtcOccluded1.");
  } else if (status != STATUS_INTERRUPTED) {
    chart_note(chart, "Embree is left out: pscn-embree failed.");
  }
  scratch_remove(&folder);
  return status == STATUS_INTERRUPTED ? status : STATUS_OK;
}

/* ---- POV-Ray ---- */

/* "Trace Time: 0 hours 0 minutes 1 seconds (1.234 seconds)", and below it "using 1 thread(s) with 1.200 CPU-seconds
 * total". */
static double trace_seconds(const struct povray *povray)
{
  size_t length, used;
  char *log = scratch_read(&povray->folder, "povray.log", &length);
  const char *at = log == NULL ? NULL : strstr(log, "Trace Time:");
  double value = NAN;
  if (at != NULL)
    at = strstr(at, ") with ");
  if (at != NULL && number_read(at + 7, strlen(at + 7), &value, &used) != NUMBER_FINITE)
    value = NAN;
  free(log);
  return value;
}

/* The time of POV-Ray's pixels, without lights and textures, the yardstick after each. */
static enum status time_povray(struct chart *chart, struct povray *povray, struct timing *out)
{
  const size_t pixels = povray->width * povray->height, rounds = chart->quick ? 1 : 3;
  double seconds[3], ratio[3];
  unsigned char *mask = malloc(pixels);
  enum status status = mask == NULL ? STATUS_LIMIT : STATUS_OK;
  for (size_t k = 0; k < rounds && status == STATUS_OK; k++) {
    const struct runner runner = pscn_runner_face(&chart->yardstick);
    const size_t counts[RAY_KINDS] = { chart->rays[RAYS_CAMERA].count, 0 };
    struct timing yard[1][RAY_KINDS];
    status = povray_mask(povray, chart->scene, mask);
    seconds[k] = 1e9 * trace_seconds(povray) / (double)pixels;
    if (status == STATUS_OK)
      status = measure_rounds(&runner, 1, counts, chart->rounds, &interrupt_signal, yard);
    ratio[k] = seconds[k] / yard[0][RAYS_CAMERA].median;
  }
  free(mask);
  if (status != STATUS_OK)
    return status;
  sort_numbers(seconds, rounds);
  sort_numbers(ratio, rounds);
  const double middle = seconds[rounds / 2];
  *out = (struct timing){ seconds[0], (seconds[0] + middle) / 2, middle, (middle + seconds[rounds - 1]) / 2,
                          seconds[rounds - 1], ratio[rounds / 2] };
  return STATUS_OK;
}

static enum status ask_povray_once(struct chart *chart, struct povray *povray, int type, int steps)
{
  const struct ray_list *camera = &chart->rays[RAYS_CAMERA];
  for (size_t n = 0; n < chart->scene->patch_count; n++) {
    struct scene_patch *patch = &chart->scene->patches[n];
    patch->type = type, patch->u_steps = patch->v_steps = steps, patch->flatness = 0;
  }
  chart_tell(chart, "POV-Ray: type %d, u_steps %d", type, steps);
  double *distance = malloc((camera->count + 1) * sizeof *distance);
  struct timing time;
  enum status status = distance == NULL ? STATUS_LIMIT : STATUS_OK;
  if (status == STATUS_OK)
    status = povray_trace(povray, chart->scene, camera->count, camera->rays, distance);
  if (status == STATUS_OK)
    status = time_povray(chart, povray, &time);
  if (status == STATUS_OK) {
    struct chart_point *point = chart_add(chart, FAMILY_POVRAY);
    snprintf(point->name, sizeof point->name, "POV-Ray, type %d, u_steps %d, flatness 0", type, steps);
    if (type == 1)
      snprintf(point->label, sizeof point->label, "%d", steps);
    point->time[RAYS_CAMERA] = time;
    for (size_t k = 0; k < camera->count; k++)
      chart->answers[k] = (struct answer){ distance[k] / vector_length(camera->rays[k].direction),
                                           ANSWER_PATCH_UNKNOWN };
    chart_judge(chart, point);
  }
  free(distance);
  return status;
}

/* Whether the program can be found; povray_open's caller would otherwise be told an error. */
static bool can_run(const char *program)
{
  char path[SCRATCH_PATH_SIZE];
  if (strchr(program, '/') != NULL)
    return access(program, X_OK) == 0;
  const char *from = getenv("PATH");
  while (from != NULL && *from != '\0') {
    const size_t length = strcspn(from, ":");
    snprintf(path, sizeof path, "%.*s/%s", (int)length, from, program);
    if (access(path, X_OK) == 0)
      return true;
    from += length + (from[length] == ':');
  }
  return false;
}

static enum status ask_povray(struct chart *chart)
{
  struct povray povray = { .command = chart->command, .program = chart->program, .width = chart->scene_request.width,
                           .height = chart->scene_request.height, .scene_path = chart->scene_request.path };
  if (!can_run(chart->program)) {
    chart_note(chart, "POV-Ray is left out: there is no program '%s'.", chart->program);
    return STATUS_OK;
  }
  enum status status = povray_open(&povray);
  for (int type = chart->quick ? 1 : 0; type <= 1; type++) {
    for (int steps = 1; steps <= 7 && status == STATUS_OK; steps += chart->quick ? 3 : 1)
      status = ask_povray_once(chart, &povray, type, steps);
  }
  if (status == STATUS_OK)
    chart_note(chart, "POV-Ray %s: errors from its trace(); the time is the CPU time of its trace phase for all "
                      "%zux%zu pixels of the scene in white without lights, parsing apart.",
               povray.version, povray.width, povray.height);
  else if (status != STATUS_INTERRUPTED && status != STATUS_LIMIT)
    chart_note(chart, "POV-Ray failed, and what is missing of it is left out.");
  povray_close(&povray);
  return status == STATUS_INTERRUPTED || status == STATUS_LIMIT ? status : STATUS_OK;
}

enum status chart_peers(struct chart *chart)
{
  enum status status = ask_plain_newton(chart);
  if (!chart->peers) {
    chart_note(chart, "Embree and POV-Ray were not asked (--no-peers).");
    return status;
  }
  if (status == STATUS_OK)
    status = ask_embree(chart);
  if (status == STATUS_OK)
    status = ask_povray(chart);
  return status;
}

/* The peers of a chart: plain Newton, which is ours but guards nothing; Embree, by pscn-embree where it stands beside
 * pscn; and POV-Ray, where it is installed. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/sort.h"
#include "chart/exchange.h"
#include "chart/plain_newton.h"
#include "chart/work.h"
#include "check/povray.h"
#include "check/process.h"
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
  listener_tell(chart->listener, TOLD_PROGRESS, "plain Newton");
  const struct runner runners[] = { pscn_runner_face(&chart->yardstick), plain_newton_face(plain) };
  const size_t counts[RAY_KINDS] = { chart->rays[RAYS_CAMERA].count, chart->rays[RAYS_SHADOW].count };
  struct timing time[2][RAY_KINDS];
  const enum status status = measure_rounds(runners, 2, counts, chart->rounds, chart->listener->stop, time);
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
  const bool quick = chart->request->quick;
  question.side_count = quick ? sizeof QUICK_SIDES / sizeof QUICK_SIDES[0] : sizeof SIDES / sizeof SIDES[0];
  memcpy(question.sides, quick ? QUICK_SIDES : SIDES, question.side_count * sizeof question.sides[0]);
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
  if (chart->scene->patch_count == 0) {
    chart_note(chart, "Embree is left out: the scene has no patch that could be cut into triangles.");
    return STATUS_OK;
  }
  if (!find_embree(program)) {
    chart_note(chart, "Embree is left out: pscn-embree does not stand beside pscn (it is built where libembree-dev is "
                      "found).");
    return STATUS_OK;
  }
  listener_tell(chart->listener, TOLD_PROGRESS, "Embree");
  if (scratch_create(&folder) != STATUS_OK) {
    chart_note(chart, "Embree is left out: no temporary folder could be made.");
    return STATUS_OK;
  }
  scratch_path(&folder, "question", question);
  scratch_path(&folder, "answer", answer);
  scratch_path(&folder, "log", log);
  const char *const arguments[] = { program, question, answer, NULL };
  const struct process_request request = { .arguments = arguments, .output = log };
  struct process_result result = { .exit_code = 1 };
  enum status status = STATUS_OK;
  if (write_question(chart, &folder))
    status = process_run(&request, chart->listener->stop, &result);
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

/* The time of POV-Ray's pixels, without lights and textures, the yardstick after each. */
static enum status time_povray(struct chart *chart, struct povray *povray, struct timing *out)
{
  const double pixels = (double)povray->width * (double)povray->height;
  const size_t rounds = chart->request->quick ? 1 : 3;
  double time[3], ratio[3];
  for (size_t k = 0; k < rounds; k++) {
    const struct runner runner = pscn_runner_face(&chart->yardstick);
    const size_t counts[RAY_KINDS] = { chart->rays[RAYS_CAMERA].count, 0 };
    struct timing yard[1][RAY_KINDS];
    enum status status = povray_time(povray, chart->scene, &time[k]);
    if (status == STATUS_OK)
      status = measure_rounds(&runner, 1, counts, chart->rounds, chart->listener->stop, yard);
    if (status != STATUS_OK)
      return status;
    time[k] *= 1e9 / pixels;
    ratio[k] = time[k] / yard[0][RAYS_CAMERA].median;
  }
  sort_numbers(time, rounds);
  sort_numbers(ratio, rounds);
  const double middle = time[rounds / 2];
  *out = (struct timing){ time[0], (time[0] + middle) / 2, middle, (middle + time[rounds - 1]) / 2, time[rounds - 1],
                          ratio[rounds / 2] };
  return STATUS_OK;
}

static enum status ask_povray_once(struct chart *chart, struct povray *povray, int type, int steps)
{
  const struct ray_list *camera = &chart->rays[RAYS_CAMERA];
  for (size_t n = 0; n < chart->scene->patch_count; n++) {
    struct scene_patch *patch = &chart->scene->patches[n];
    patch->type = type, patch->u_steps = patch->v_steps = steps, patch->flatness = 0;
  }
  listener_tell(chart->listener, TOLD_PROGRESS, "POV-Ray: type %d, u_steps %d", type, steps);
  double *distance = malloc((camera->count + 1) * sizeof *distance);
  struct timing time;
  enum status status = distance == NULL ? STATUS_LIMIT : STATUS_OK;
  if (status == STATUS_OK)
    status = povray_ask(povray, chart->scene, camera->count, camera->rays, distance, NULL);
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

static enum status ask_povray(struct chart *chart)
{
  struct povray povray = { .listener = chart->listener, .program = chart->request->program,
                           .width = chart->request->width, .height = chart->request->height,
                           .timeout = chart->request->timeout, .optional = true };
  enum status status = povray_open(&povray);
  if (povray.missing)
    chart_note(chart, "POV-Ray is left out: there is no program '%s'.", chart->request->program);
  for (int type = chart->request->quick ? 1 : 0; type <= 1; type++) {
    for (int steps = 1; steps <= 7 && status == STATUS_OK; steps += chart->request->quick ? 3 : 1)
      status = ask_povray_once(chart, &povray, type, steps);
  }
  if (status == STATUS_OK)
    chart_note(chart, "POV-Ray %s: errors from its trace(); the time is the CPU time of its trace phase for all "
                      "%zux%zu pixels of the scene in white without lights, parsing apart.",
               povray.version, povray.width, povray.height);
  else if (status != STATUS_INTERRUPTED && !povray.missing)
    chart_note(chart, "POV-Ray failed, and what is missing of it is left out.");
  povray_close(&povray);
  return status == STATUS_INTERRUPTED ? status : STATUS_OK;
}

enum status chart_peers(struct chart *chart)
{
  enum status status = ask_plain_newton(chart);
  if (!chart->request->peers) {
    chart_note(chart, "Embree and POV-Ray were not asked (--no-peers).");
    return status;
  }
  if (status == STATUS_OK)
    status = ask_embree(chart);
  if (status == STATUS_OK)
    status = ask_povray(chart);
  return status;
}

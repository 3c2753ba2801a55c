/* pscn-embree QUESTION ANSWER: measures Embree on triangles for `pscn chart`, which runs it where it stands beside
 * pscn. The files are those of chart/exchange.h. Every round times pscn's default solver first, as the yardstick. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "chart/exchange.h"
#include "chart/embree_mesh.h"

static const unsigned WIDTHS[] = { 1, 8 };
enum { WIDTH_COUNT = sizeof WIDTHS / sizeof WIDTHS[0] };

struct embree_runner {
  const struct embree_mesh *mesh;
  struct embree_rays *const *rays; /* [RAY_KINDS] */
  unsigned width;
  volatile double sink;
};

static void run(void *context, enum ray_kind kind)
{
  struct embree_runner *runner = context;
  runner->sink = embree_trace(runner->mesh, runner->rays[kind], runner->width, kind == RAYS_SHADOW);
}

static bool write_answers(const struct exchange_question *question, const struct embree_runner *runner,
                          const struct timing time[RAY_KINDS], size_t side, FILE *file)
{
  const size_t camera = question->rays[RAYS_CAMERA].count, shadow = question->rays[RAYS_SHADOW].count;
  struct answer *answers = calloc(camera + 1, sizeof *answers);
  bool *occluded = calloc(shadow + 1, sizeof *occluded);
  struct exchange_answer answer = { .side = side, .width = runner->width };
  memcpy(answer.time, time, sizeof answer.time);
  bool good = answers != NULL && occluded != NULL;
  for (size_t k = 0; good && k < camera; k++)
    embree_answer(runner->mesh, runner->rays[RAYS_CAMERA], k, &answers[k].t, &answers[k].patch);
  for (size_t k = 0; good && k < shadow; k++)
    occluded[k] = embree_answer_any(runner->mesh, runner->rays[RAYS_SHADOW], k);
  good = good && exchange_write_answer(file, &answer, camera, answers, shadow, occluded);
  free(answers);
  free(occluded);
  return good;
}

static bool measure_side(const struct exchange_question *question, struct pscn_runner *yardstick,
                         struct embree_rays *const rays[RAY_KINDS], size_t side, FILE *file)
{
  struct embree_mesh *mesh = embree_mesh_create((const double(*)[4][4][3])question->nets, question->patch_count,
                                                (unsigned)side);
  if (mesh == NULL) return false;
  struct embree_runner embree[WIDTH_COUNT];
  struct runner runners[1 + WIDTH_COUNT] = { pscn_runner_face(yardstick) };
  struct timing time[1 + WIDTH_COUNT][RAY_KINDS];
  const size_t counts[RAY_KINDS] = { question->rays[RAYS_CAMERA].count, question->rays[RAYS_SHADOW].count };
  for (size_t w = 0; w < WIDTH_COUNT; w++) {
    embree[w] = (struct embree_runner){ .mesh = mesh, .rays = rays, .width = WIDTHS[w] };
    runners[1 + w] = (struct runner){ run, &embree[w], { counts[0] > 0, counts[1] > 0 } };
  }
  bool good = measure_rounds(runners, 1 + WIDTH_COUNT, counts, question->rounds, NULL, time) == STATUS_OK;
  for (size_t w = 0; good && w < WIDTH_COUNT; w++) good = write_answers(question, &embree[w], time[1 + w], side, file);
  embree_mesh_destroy(mesh);
  return good;
}

static bool answer_question(const struct exchange_question *question, struct arena *arena, FILE *file)
{
  struct scene_patch *patches = arena_alloc(arena, question->patch_count + 1, sizeof *patches);
  if (patches == NULL) return false;
  for (size_t n = 0; n < question->patch_count; n++) memcpy(patches[n].P, question->nets[n], sizeof patches[n].P);
  const struct scene scene = { .patches = patches, .patch_count = question->patch_count };
  struct method options;
  method_default(solver_at(0), &options);
  struct pscn_runner yardstick;
  struct embree_rays *rays[RAY_KINDS] = { NULL };
  bool good = pscn_runner_create(&scene, &options, question->rays, &yardstick) == STATUS_OK;
  for (int kind = 0; good && kind < RAY_KINDS; kind++) {
    if (question->rays[kind].count == 0) continue;
    rays[kind] = embree_rays_create(question->rays[kind].rays, question->rays[kind].count);
    good = rays[kind] != NULL;
  }
  for (size_t k = 0; good && k < question->side_count; k++)
    good = measure_side(question, &yardstick, rays, question->sides[k], file);
  for (int kind = 0; kind < RAY_KINDS; kind++) embree_rays_destroy(rays[kind]);
  pscn_runner_free(&yardstick);
  return good;
}

int main(int argc, char **argv)
{
  if (argc != 3) {
    fputs("usage: pscn-embree QUESTION ANSWER\nRun by 'pscn chart', which writes the question.\n", stderr);
    return STATUS_USAGE;
  }
  struct arena *arena = arena_create();
  FILE *in = fopen(argv[1], "rb"), *out = fopen(argv[2], "wb");
  struct exchange_question question;
  enum status status = STATUS_OK;
  if (arena == NULL || in == NULL || out == NULL) status = STATUS_FILE;
  else if (!exchange_read_question(in, arena, &question)) status = STATUS_INPUT;
  else if (!answer_question(&question, arena, out)) status = STATUS_LIMIT;
  if (in != NULL) (void)fclose(in);
  if (out != NULL && fclose(out) != 0) status = STATUS_FILE;
  arena_destroy(arena);
  if (status != STATUS_OK) fputs("pscn-embree: no answer: files, memory, or Embree itself\n", stderr);
  return (int)status;
}

/* Answers judged by the reference. */
#include "chart/judge.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/sort.h"

#if defined(PSCN_HAS_QUAD)
#include "reference/reference.h"

bool judge_available(void) { return true; }

static struct truth truth_of(const struct reference_answer *answer)
{
  const enum truth_kind kind = answer->verdict == REFERENCE_HIT    ? TRUTH_HIT
                               : answer->verdict == REFERENCE_MISS ? TRUTH_MISS
                                                                   : TRUTH_UNDECIDED;
  if (kind != TRUTH_HIT) return (struct truth){.kind = kind, .t = INFINITY, .patch = HIT_NONE};
  const double t = (double)answer->t;
  return (struct truth){kind, t, (double)(answer->t - t), answer->patch, answer->shared};
}

enum status judge_truths(const struct scene *scene, const struct ray_list *rays, const atomic_int *stop,
                         struct truth *out)
{
  double(*nets)[4][4][3] = calloc(scene->patch_count + 1, sizeof *nets);
  if (nets == NULL) return STATUS_LIMIT;
  for (size_t n = 0; n < scene->patch_count; n++) memcpy(nets[n], scene->patches[n].P, sizeof nets[n]);
  struct reference *reference = reference_create((const double(*)[4][4][3])nets, scene->patch_count);
  free(nets);
  if (reference == NULL) return STATUS_LIMIT;
  bool stopped = false;
  for (size_t k = 0; k < rays->count && !stopped; k++) {
    struct reference_answer answer;
    reference_closest(reference, rays->rays[k].origin, rays->rays[k].direction, &answer);
    out[k] = truth_of(&answer);
    stopped = stop != NULL && atomic_load(stop) != 0;
  }
  reference_destroy(reference);
  return stopped ? STATUS_INTERRUPTED : STATUS_OK;
}
#else
bool judge_available(void) { return false; }

enum status judge_truths(const struct scene *scene, const struct ray_list *rays, const atomic_int *stop,
                         struct truth *out)
{
  (void)scene, (void)rays, (void)stop, (void)out;
  return STATUS_LIMIT;
}
#endif

void judge_answers(size_t count, const struct truth *truths, const struct answer *answers, double *errors,
                   struct judgement *out)
{
  double *all = errors + count;
  size_t right = 0, asked = 0;
  *out = (struct judgement){.rays = count};
  for (size_t k = 0; k < count; k++) {
    const struct truth *truth = &truths[k];
    const bool hit = truth->kind == TRUTH_HIT, answered = isfinite(answers[k].t), both = hit && answered;
    if (truth->kind == TRUTH_UNDECIDED) {
      out->undecided++;
      continue;
    }
    if (!hit && !answered) continue;
    const double error = both ? fabs((answers[k].t - truth->t) - truth->t_rest) / truth->t : INFINITY;
    const bool wrong = !(error <= JUDGE_WRONG);
    const bool other_patch = answers[k].patch != ANSWER_PATCH_UNKNOWN && answers[k].patch != truth->patch;
    out->hits += hit;
    out->invented += !hit;
    out->lost += !answered;
    out->wrong += both && wrong;
    out->other_patch += !wrong && other_patch && !truth->shared;
    if (!wrong) errors[right++] = error;
    all[asked++] = wrong ? 1 : error;
  }
  sort_numbers(errors, right);
  sort_numbers(all, asked);
  out->median = right == 0 ? NAN : sorted_quantile(errors, right, 0.5);
  out->p99 = right == 0 ? NAN : sorted_quantile(errors, right, 0.99);
  out->max = right == 0 ? NAN : errors[right - 1];
  out->p99_of_all = out->hits == 0 ? NAN : sorted_quantile(all, asked, 0.99);
}

void judge_occluded(size_t count, const struct ray *rays, const struct truth *truths, const struct answer *answers,
                    struct judgement *out)
{
  *out = (struct judgement){.rays = count, .median = NAN, .p99 = NAN, .max = NAN, .p99_of_all = NAN};
  for (size_t k = 0; k < count; k++) {
    if (truths[k].kind == TRUTH_UNDECIDED) {
      out->undecided++;
      continue;
    }
    const bool hidden = truths[k].kind == TRUTH_HIT && truths[k].t < rays[k].t_max;
    const bool occluded = isfinite(answers[k].t);
    out->hits += hidden;
    out->lost += hidden && !occluded;
    out->invented += !hidden && occluded;
  }
}

/* Truths about rays from the reference, and answers judged by them.
 *
 * The reference (reference/reference.h) shares no code and no method with the renderer. Where the compiler has no
 * quadruple precision there is none, and judge_truths answers STATUS_LIMIT; judge_available asks.
 */
#ifndef PSCN_CHART_JUDGE_H
#define PSCN_CHART_JUDGE_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/status.h"
#include "chart/rays.h"
#include "scene/scene.h"

enum truth_kind { TRUTH_MISS, TRUTH_HIT, TRUTH_UNDECIDED };

struct truth {
  enum truth_kind kind;
  double t, t_rest; /* of a hit, in units of |direction|: t + t_rest, t being the nearest double */
  uint32_t patch;
  bool shared; /* the hit lies on an edge that another patch has too */
};

/* What somebody answers to a ray. */
enum { ANSWER_PATCH_UNKNOWN = UINT32_MAX - 1 };

struct answer {
  double t;       /* INFINITY: a miss */
  uint32_t patch; /* or ANSWER_PATCH_UNKNOWN */
};

/* Both hit, but so far apart, relative: another place of the surface. */
#define JUDGE_WRONG 1e-2

struct judgement {
  size_t rays, undecided, hits; /* hits: of the truth */
  size_t lost;                  /* a hit answered by a miss */
  size_t invented;              /* a miss answered by a hit */
  size_t wrong;                 /* a hit answered by one farther off than JUDGE_WRONG */
  size_t other_patch;           /* the right place, but said to be of a patch it is not of */
  /* relative errors of T of the rays that both hit; p99: of 99 % no more; NAN where there are none */
  double median, p99, max;
  /* the same, every answer that is lost, invented or wrong counting as an error of 1; NAN where nothing is to be hit */
  double p99_of_all;
};

bool judge_available(void);

/* STATUS_INTERRUPTED where *stop turns nonzero. */
enum status judge_truths(const struct scene *scene, const struct ray_list *rays, const atomic_int *stop,
                         struct truth *out) STATUS_MUST_CHECK;

/* `errors` is room for 2 * count numbers. */
void judge_answers(size_t count, const struct truth *truths, const struct answer *answers, double *errors,
                   struct judgement *out);

/* Whether anything is hit: only rays, undecided, hits (rays in shadow), lost and invented are set. A truth beyond t_max
 * is no hit. */
void judge_occluded(size_t count, const struct ray *rays, const struct truth *truths, const struct answer *answers,
                    struct judgement *out);

#endif

/* True answers to rays from the reference, and other answers judged by them.
 *
 * The reference (reference/reference.h) shares no code and no method with the renderer. If the compiler has no
 * quadruple precision, there is none: judge_available says so, and judge_truths returns STATUS_LIMIT.
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
  double t, t_rest; /* of a hit, in units of |direction|: t + t_rest, where t is the nearest double */
  uint32_t patch;
  bool shared; /* the hit is on an edge shared with another patch */
};

/* The answer of a solver or a peer to a ray. */
enum { ANSWER_PATCH_UNKNOWN = UINT32_MAX - 1 };

struct answer {
  double t;       /* INFINITY: a miss */
  uint32_t patch; /* or ANSWER_PATCH_UNKNOWN */
};

/* If both hit, but this far apart, relative, they are at different places of the surface. */
#define JUDGE_WRONG 1e-2

struct judgement {
  size_t rays, undecided, hits; /* hits: of the truth */
  size_t lost;                  /* a hit answered by a miss */
  size_t invented;              /* a miss answered by a hit */
  size_t wrong;                 /* a hit answered by one with a larger error than JUDGE_WRONG */
  size_t other_patch;           /* the right place, but on a wrong patch */
  /* relative errors of T of the right answers to rays that hit; p99: 99 % have at most this; NAN if there are none */
  double median, p99, max;
  /* the same with every lost, invented or wrong answer as an error of 1; NAN if there is nothing to hit */
  double p99_of_all;
};

bool judge_available(void);

/* STATUS_INTERRUPTED if *stop becomes nonzero. */
enum status judge_truths(const struct scene *scene, const struct ray_list *rays, const atomic_int *stop,
                         struct truth *out) STATUS_MUST_CHECK;

/* `errors` has room for 2 * count numbers. */
void judge_answers(size_t count, const struct truth *truths, const struct answer *answers, double *errors,
                   struct judgement *out);

/* Judges whether anything is hit. Sets only rays, undecided, hits (rays in shadow), lost and invented. A true hit
 * beyond t_max is none. */
void judge_occluded(size_t count, const struct ray *rays, const struct truth *truths, const struct answer *answers,
                    struct judgement *out);

#endif

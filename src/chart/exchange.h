/* What the chart and a peer's program tell each other: files of plain numbers as they stand in memory, for two programs
 * of one build on one machine.
 *
 * The question holds patches, rays and what is asked; the answer, for each thing asked, times and answers.
 */
#ifndef PSCN_CHART_EXCHANGE_H
#define PSCN_CHART_EXCHANGE_H

#include <stdio.h>

#include "base/arena.h"
#include "chart/measure.h"

enum { EXCHANGE_MAX_SIDES = 16 };

struct exchange_question {
  size_t patch_count, rounds, side_count;
  size_t sides[EXCHANGE_MAX_SIDES]; /* squares a side of a patch, each to be measured */
  double (*nets)[4][4][3];          /* [patch] */
  struct ray_list rays[RAY_KINDS];
};

/* One side, one width (rays at once, 1 or 8). The answers follow in the file. */
struct exchange_answer {
  size_t side, width;
  struct timing time[RAY_KINDS]; /* ratio: to pscn's default solver, measured in the same rounds */
};

/* False where the file cannot be written or read, or does not hold what it should. What is read lives in the arena. */
bool exchange_write_question(FILE *file, const struct exchange_question *question);
bool exchange_read_question(FILE *file, struct arena *arena, struct exchange_question *out);

/* answers[camera rays], occluded[shadow rays]. */
bool exchange_write_answer(FILE *file, const struct exchange_answer *answer, size_t camera,
                           const struct answer *answers, size_t shadow, const bool *occluded);
bool exchange_read_answer(FILE *file, struct exchange_answer *out, size_t camera, struct answer *answers, size_t shadow,
                          bool *occluded);

#endif

/* Frees roots that are stuck, in methods that move all roots at once. Internal to src/algebra.
 *
 * Symmetric starts (real values seeking a complex pair, pairs seeking two real roots) would never part by themselves.
 * So every TURN_PERIOD sweeps, a step that is no shorter than STUCK times the step at the last look is turned, by an
 * angle that no two roots share. A choice of speed only.
 */
#ifndef PSCN_ALGEBRA_TURN_H
#define PSCN_ALGEBRA_TURN_H

#include <stdbool.h>

#include "algebra/complex_number.h"

enum { TURN_PERIOD = 5 };
#define STUCK 0.9

/* Whether this sweep, counted from 1, looks for stuck roots. */
static inline bool turn_due(int sweep) { return sweep % TURN_PERIOD == 0; }

/* The step of root number `root`, with |step|^2 in u being `square`. It is turned where the step is no shorter than
 * STUCK times the one of `checked`, the square at the last look (infinite at first). */
static inline struct complex_number turn_if_stuck(int root, struct complex_number step, double square, double checked)
{
  if (!(square >= STUCK * STUCK * checked)) return step;
  const double angle = 0.3 + 0.37 * root;
  return complex_multiply(step, (struct complex_number){cos(angle), sin(angle)});
}

#endif

/* Where leaves are thicker than they are apart: the pages of a book, a roll of paper.
 *
 * Internal to src/intersect/prepare.
 */
#ifndef PSCN_INTERSECT_PREPARE_CROWD_H
#define PSCN_INTERSECT_PREPARE_CROWD_H

#include <stdbool.h>

#include "base/status.h"

struct making;

/* Cuts patches that stand in a crowd finer, as far as there may be more leaves, and says how many leaves each part of the patches
 * has now. The leaves, which are kept, and the hierarchy are there, and are those of before: *out, whether they are to be made
 * anew. STATUS_LIMIT where memory is short, or threads are. */
enum status crowd_cut_finer(struct making *m, bool *out) STATUS_MUST_CHECK;

#endif

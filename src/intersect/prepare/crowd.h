/* Where leaves are thicker than they are apart: the pages of a book, a roll of paper.
 *
 * Internal to src/intersect/prepare.
 */
#ifndef PSCN_INTERSECT_PREPARE_CROWD_H
#define PSCN_INTERSECT_PREPARE_CROWD_H

#include <stdbool.h>

#include "base/status.h"

struct making;

/* Cuts patches in a crowd finer, as far as there may be more leaves, and sets how many leaves each part of the patches
 * has then. The leaves, which are kept, and the hierarchy exist and are unchanged; *out: whether they must be made
 * anew. STATUS_LIMIT if memory or threads are short. */
enum status crowd_cut_finer(struct making *m, bool *out) STATUS_MUST_CHECK;

#endif

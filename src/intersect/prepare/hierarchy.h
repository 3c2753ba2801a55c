/* The leaves of a model's patches, and the hierarchy over their boxes and the copies'.
 *
 * Internal to src/intersect/prepare.
 */
#ifndef PSCN_INTERSECT_PREPARE_HIERARCHY_H
#define PSCN_INTERSECT_PREPARE_HIERARCHY_H

#include "intersect/model.h"

/* Fewer patches or leaves are done before another thread has begun: one takes a microsecond or two. */
enum { TEAM_LEAST = 1024 };

/* Cuts the patches that are not copied, makes their leaves, and builds model->tree, whose frame is set. Patches and
 * leaves are kept if `keep` and there are at most `keep_most` leaves; this makes rays a quarter faster, at 1.6 KB for a
 * patch of one leaf. STATUS_LIMIT if memory or threads are short; model_destroy then frees what there is. */
enum status hierarchy_make(struct model *model, const struct team *team, const struct cut_limit *limit, bool keep,
                           size_t keep_most) STATUS_MUST_CHECK;

#endif

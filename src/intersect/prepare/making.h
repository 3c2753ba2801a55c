/* Patches and their leaves while they are made.
 *
 * Internal to src/intersect/prepare.
 */
#ifndef PSCN_INTERSECT_PREPARE_MAKING_H
#define PSCN_INTERSECT_PREPARE_MAKING_H

#include <stdatomic.h>

#include "intersect/model.h"
#include "intersect/prepare/cut.h"
#include "intersect/prepare/hierarchy.h"

struct making {
  struct model *model;
  const struct team *team;
  struct cut_limit limit;
  bool keep;               /* whether patches and leaves are kept */
  struct arena **arenas;   /* one a thread, for what is kept: patches first, then leaves */
  size_t part, part_count; /* patches in a part; threads take whole parts */
  size_t *leaves;          /* in each part; later before it */
  struct cells cells;      /* while patches are cut */
  struct bvh_box *boxes;   /* if leaves are not kept, with room for boxes along them */
  atomic_size_t taken;     /* parts */
};

/* How many leaves a patch is cut into. */
static inline size_t cut_leaves(const struct model_cut *cut) { return (size_t)cut->split[0] * cut->split[1]; }

/* Takes a part that nobody has taken: its patches are [*begin, *end). False if there is none. */
static inline bool making_take_part(struct making *m, size_t *number, size_t *begin, size_t *end)
{
  *number = atomic_fetch_add(&m->taken, 1);
  const size_t count = m->model->scene->patch_count;
  *begin = *number * m->part, *end = count - *begin < m->part ? count : *begin + m->part;
  return *number < m->part_count;
}

/* Has all parts done, by the team if there are enough patches or leaves. */
static inline enum status making_do_parts(struct making *m, team_work *work, size_t count)
{
  atomic_store(&m->taken, 0);
  return team_run(count < TEAM_LEAST ? NULL : m->team, m->part_count, work, m);
}

#endif

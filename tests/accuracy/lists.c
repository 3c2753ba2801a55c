/* Lists of all hits against the exact roots of all patches; see lists.h. */
#include "accuracy/lists.h"

#include <math.h>

#include "accuracy/exact.h"
#include "accuracy/trial.h"
#include "base/wide.h"

const char *const list_finding_names[LIST_FINDINGS] = {"right",    "undecided",        "lost",
                                                       "invented", "lost on a border", "out of order"};

/* The allowed error of a hit's t, in floors. Next to a tangency floors are only of the first order; roots nearer to
 * each other than this are told apart by their order. */
#define SAME_FLOORS 16

/* The allowed error of U and V of a certain hit inside a patch, in floors. */
#define PLACE_FLOORS 16

/* The parameter is the nearest double to a root's. A root that 113 bits cannot tell from a border counts as a hit on
 * it, of the first of the patches that share it, although it may be in the other one. */
#define AT_BORDER 0x1p-90

static bool on_border(double parameter) { return parameter <= AT_BORDER || parameter >= 1; }

void list_truth_find(const struct scene *scene, const struct reference *reference, const struct ray *ray,
                     struct list_truth *out)
{
  out->count = 0, out->doubt = false;
  for (size_t n = 0; n < scene->patch_count; n++) {
    struct exact_roots roots;
    exact_patch_roots((const double(*)[4][3])scene->patches[n].P, ray->origin, ray->direction, ray->t_min, ray->t_max,
                      &roots);
    out->doubt |= roots.count == EXACT_MOST_ROOTS;
    for (size_t k = 0; k < roots.count; k++) {
      const struct exact_root *r = &roots.root[k];
      out->doubt |= !r->proven;
      if (!r->proven || out->count == LIST_MOST_ROOTS) continue;
      const bool border = on_border(r->u) || on_border(r->v);
      const struct facts_floor floor = trial_floor(reference, ray, (uint32_t)n, r->t, r->u, r->v);
      out->root[out->count++] = (struct list_root){(uint32_t)n, r->t, r->u, r->v, floor, border, false};
    }
  }
}

/* Whether a hit may be at the place of a root. Any place will do if the root is on a border, where others may be the
 * same point, or if the floors are NaN, because the patch is singular there. */
static bool place_good(const struct hit *hit, const struct list_root *root)
{
  return root->border || !(fabs(hit->u - root->u) > PLACE_FLOORS * (root->floor.u + DOUBLE_UNIT) ||
                           fabs(hit->v - root->v) > PLACE_FLOORS * (root->floor.v + DOUBLE_UNIT));
}

/* The root that a hit is: the nearest one not met yet, of the hit's patch, or on a border if the hit is. NULL if none
 * is near enough. */
static struct list_root *root_of(struct list_truth *truth, const struct hit *hit)
{
  struct list_root *best = NULL;
  double least = INFINITY;
  const bool border = on_border(hit->u) || on_border(hit->v);
  for (size_t k = 0; k < truth->count; k++) {
    struct list_root *r = &truth->root[k];
    const double off = fabs(r->t - hit->t) / r->floor.t;
    if (r->met || !(off <= SAME_FLOORS) || !(r->patch == hit->patch ? place_good(hit, r) : border && r->border))
      continue;
    /* Of two that t cannot tell apart, takes the one whose parameters are nearer. */
    const double aside = r->patch != hit->patch ? 1 : fmax(fabs(r->u - hit->u), fabs(r->v - hit->v));
    if (aside < least) best = r, least = aside;
  }
  return best;
}

enum list_finding list_judge(const struct hit_list *list, struct list_truth *truth)
{
  for (size_t k = 0; k < truth->count; k++) truth->root[k].met = false;
  for (size_t k = 0; k < list->count; k++) {
    const struct hit *hit = &list->hits[k];
    if (k > 0 && !(hit[-1].t <= hit->t)) return LIST_ORDER;
    if (hit->certainty != CERTAINTY_CERTAIN) continue;
    struct list_root *root = root_of(truth, hit);
    if (root) root->met = true;
    else if (!truth->doubt) return LIST_INVENTED;
  }
  if (list->certainty != CERTAINTY_CERTAIN) return LIST_RIGHT;
  for (size_t k = 0; k < truth->count; k++) {
    const struct list_root *r = &truth->root[k];
    bool met = r->met;
    for (size_t n = 0; n < list->count && r->border; n++)
      met |= fabs(list->hits[n].t - r->t) <= SAME_FLOORS * r->floor.t;
    if (!met) return r->border ? LIST_BORDER_LOST : LIST_LOST;
  }
  return truth->doubt ? LIST_UNDECIDED : LIST_RIGHT;
}

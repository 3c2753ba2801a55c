/* Pieces that cover a leaf. See cover.h.
 *
 * Compiled once per instruction set.
 */
#include "intersect/lanes/nearest.h"
#include "intersect/lanes/piece.h"

/* The most pieces halved on a leaf. A choice of speed, as COVER_HALVINGS. */
enum { COVER_SPLITS = 160 };

/* The most halvings of the leaf to show that the ray passes it by, for a method that seeks its roots afterwards. A choice
 * of speed. */
enum { MISS_HALVINGS = 3 };

/* Whether all pieces are done with. stack[0], the leaf, is set. Otherwise the middle of one that is not goes to left.
 * Sets the number of pieces halved. */
static bool cover(const struct piece_ray *ray, struct piece stack[COVER_HALVINGS + 2], int halvings, double left[2],
                  int *splits)
{
  *splits = 0;
  for (int top = 1; top > 0;) {
    struct piece *piece = &stack[--top];
    struct aimed aimed;
    if (piece_exclude(ray, piece, &aimed) || (piece_root(ray, piece) && piece_unique(&aimed))) continue;
    if (piece->halvings == halvings || *splits == COVER_SPLITS) {
      left[0] = piece->u + 0.5 * piece->size_u - 0.5, left[1] = piece->v + 0.5 * piece->size_v - 0.5;
      return false;
    }
    piece_halve(ray, piece, piece + 1);
    top += 2, ++*splits;
  }
  return true;
}

/* The leaf's first border (geometry/edges.h) that is a pole, or -1. */
static int leaf_pole(const struct model_patch *patch, const struct leaf *leaf)
{
  const uint16_t *split = patch->cut.split;
  const bool *pole = patch->pole;
  return pole[0] && leaf->column_u == 0              ? 0
         : pole[1] && leaf->column_u == split[0] - 1 ? 1
         : pole[2] && leaf->column_v == 0            ? 2
         : pole[3] && leaf->column_v == split[1] - 1 ? 3
                                                     : -1;
}

lane_mask cover_proves(struct packet *p, const struct candidate *it, int count, const struct known_root roots[],
                       int halvings, lane_mask open, lanes left[2])
{
  struct piece stack[COVER_HALVINGS + 2], *leaf = &stack[0];
  struct piece_ray ray = {.leaf = it->leaf, .count = count, .roots = roots};
  const int pole = leaf_pole(it->patch, it->leaf);
  lanes from, to, off;
  /* up to t_max and not the nearest hit so far, or answers would depend on the way through the hierarchy */
  ray_ends(p, it, p->t_max, &from, &to, &off);
  off += 2 * it->line->error;
  memcpy(&ray.depth, it->leaf->x[it->axis], sizeof ray.depth);
  for (unsigned bits = lanes_bits(open); bits; bits &= bits - 1) {
    const int lane = ray.lane = __builtin_ctz(bits);
    *leaf = (struct piece){.size_u = 1, .size_v = 1};
    for (int n = 0; n < 16; n++)
      leaf->f[0].c[n / 4][n % 4] = it->a[n][lane], leaf->f[1].c[n / 4][n % 4] = it->b[n][lane];
    for (int k = 0; k < 2; k++) ray.size[k] = net_size(&leaf->f[k]), ray.error[k] = it->line->error[lane];
    if (pole >= 0) piece_divide(&ray, pole, leaf);
    ray.from = from[lane] - off[lane], ray.to = to[lane] + off[lane];
    double middle[2];
    int splits;
    const bool covered = cover(&ray, stack, halvings, middle, &splits);
    p->postponed->left[lane] -= COST_BOX * (1 + 2 * splits);
    if (covered) continue;
    open &= ~lanes_mask(bits & -bits);
    if (left) left[0][lane] = middle[0], left[1][lane] = middle[1];
  }
  return open;
}

/* Offers the two roots, as far as they are proven and distinct, on the lanes of `open` where they are all, and returns
 * these. Lanes where neither is proven are not tried. */
static lane_mask cover_two(struct packet *p, const struct candidate *it, const struct leaf_root *first,
                           const struct leaf_root *second, lane_mask open)
{
  const struct newton_root *one = &first->at, *two = &second->at;
  const lane_mask same = one->exists & roots_meet(one, two);
  const struct known_root known[2] = {{one, open & one->exists}, {two, open & two->exists & ~same}};
  open &= known[0].proven | known[1].proven;
  if (!lanes_any(open)) return open;
  const int count = lanes_any(known[1].proven) ? 2 : 1;
  const lane_mask covered = cover_proves(p, it, count, known, COVER_HALVINGS, open, NULL);
  offer_root(p, it, first, covered & known[0].proven & inside(one));
  if (count > 1) offer_root(p, it, second, (p->any ? open : covered) & known[1].proven & inside(two));
  return covered;
}

lane_mask stage_cover(struct packet *p, struct candidate *it, lane_mask open)
{
  if (it->patch->lanes != SOLVER_LANES_SIGNS) return open & ~cover_proves(p, it, 0, NULL, MISS_HALVINGS, open, NULL);
  const struct newton_root *r = &it->first.at;
  const struct known_root known = {r, open & r->exists};
  lanes left[2] = {{0}, {0}};
  const lane_mask covered = cover_proves(p, it, 1, &known, COVER_EARLY, open, left);
  offer_root(p, it, &it->first, (p->any ? known.proven : covered & known.proven) & inside(r));
  open &= ~covered & p->live;
  if (!lanes_any(open)) return open;
  struct leaf_root second;
  newton_solve(p, it->leaf, it->axis, left, open, &second);
  const lane_mask more = second.at.exists;
  return lanes_any(more) ? open & ~cover_two(p, it, &it->first, &second, more) & p->live : open;
}

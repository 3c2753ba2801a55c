/* Boxes that cover a leaf. See cover.h.
 *
 * Compiled once per instruction set.
 */
#include "intersect/lanes/cover.h"

#include "intersect/lanes/cover_nets.h"
#include "intersect/lanes/nearest.h"

/* The most boxes split on a leaf. A choice of speed, as COVER_HALVINGS. */
enum { COVER_SPLITS = 160 };

/* What is known of one ray on the leaf. */
struct cover_ray {
  const struct leaf *leaf;
  int lane, count;
  const struct known_root *roots;
  double size, error;     /* of the coefficients of a and b: a bound, and their errors */
  struct cover_net depth; /* x_k of the leaf, k being the ray's axis */
  double from, to;        /* the ray seeks roots between these x_k, whatever it has hit: see ray_ends */
  int halvings, splits;   /* how often a box may be halved, and how many more boxes may be */
  double left[2];         /* out: the middle of a box that was not cleared */
};

struct cover_box {
  struct cover_net a, b;
  double u, v, size_u, size_v; /* in leaf parameters */
  int halvings;
};

/* Whether that root of the ray is proven and in the box. */
LANES_INLINE bool root_is_in(const struct cover_ray *ray, const struct cover_box *box, const struct known_root *root)
{
  if (!root->proven[ray->lane]) return false;
  const double u = root->at->u[ray->lane], radius_u = root->at->radius_u[ray->lane];
  const double v = root->at->v[ray->lane], radius_v = root->at->radius_v[ray->lane];
  return u - radius_u >= box->u && u + radius_u <= box->u + box->size_u && v - radius_v >= box->v &&
         v + radius_v <= box->v + box->size_v;
}

/* The weights of a cubic's coefficients. */
LANES_INLINE row weights_at(double t)
{
  const double s = 1 - t;
  return (row){s * s * s, 3 * (s * s * t), 3 * (s * t * t), t * t * t};
}

/* Whether the box may be where the ray seeks roots. */
LANES_INLINE bool box_is_seen(const struct cover_ray *ray, const struct cover_box *box)
{
  const double half_u = 0.5 * box->size_u, half_v = 0.5 * box->size_v, *first = ray->leaf->first;
  const row *x = ray->depth.c, u = weights_at(box->u + half_u), v = weights_at(box->v + half_v);
  const row sums = (u[0] * x[0] + u[1] * x[1] + (u[2] * x[2] + u[3] * x[3])) * v;
  const double middle = (sums[0] + sums[1]) + (sums[2] + sums[3]), reach = first[0] * half_u + first[1] * half_v;
  return middle + reach >= ray->from && middle - reach <= ray->to;
}

/* Whether the box is at the leaf's pole. */
LANES_INLINE bool box_at_pole(const struct leaf *leaf, const struct cover_box *box)
{
  switch (leaf->pole) {
  case 1: return box->u == 0;
  case 2: return box->u + box->size_u == 1;
  case 3: return box->v == 0;
  case 4: return box->v + box->size_v == 1;
  default: return false;
  }
}

/* Whether the box may have an unknown root. */
LANES_INLINE bool box_is_open(const struct cover_ray *ray, const struct cover_box *box)
{
  bool has_root = false;
  for (int k = 0; k < ray->count; k++) has_root |= root_is_in(ray, box, &ray->roots[k]);
  /* each halving adds three roundings, of values of the leaf's size */
  const double error = ray->error + box->halvings * 4 * UNIT_ROUNDOFF * ray->size;
  if (!nets_full(&box->a, &box->b, has_root, ray->size, error) || !box_is_seen(ray, box)) return false;
  return !box_at_pole(ray->leaf, box) ||
         nets_full_at_pole(&box->a, &box->b, ray->leaf->pole - 1, has_root, ray->size, error);
}

/* Halves the box across the parameter along which it is longer. *box becomes the lower half. */
LANES_INLINE void box_split(const struct leaf *leaf, struct cover_box *box, struct cover_box *high)
{
  const bool across_u = leaf->first[0] * box->size_u >= leaf->first[1] * box->size_v;
  if (across_u) box->size_u /= 2;
  else box->size_v /= 2;
  box->halvings++;
  high->u = across_u ? box->u + box->size_u : box->u, high->v = across_u ? box->v : box->v + box->size_v;
  high->size_u = box->size_u, high->size_v = box->size_v, high->halvings = box->halvings;
  net_halve(&box->a, across_u, &high->a);
  net_halve(&box->b, across_u, &high->b);
}

/* Whether all boxes are cleared. stack[0], the leaf, is set. Counts the splits. */
static bool cover(struct cover_ray *ray, struct cover_box stack[COVER_HALVINGS + 2])
{
  for (int top = 1; top > 0;) {
    struct cover_box *box = &stack[--top];
    if (!box_is_open(ray, box)) continue;
    if (box->halvings == ray->halvings || --ray->splits < 0) {
      ray->left[0] = box->u + 0.5 * box->size_u - 0.5, ray->left[1] = box->v + 0.5 * box->size_v - 0.5;
      return false;
    }
    box_split(ray->leaf, box, box + 1);
    top += 2;
  }
  return true;
}

lane_mask cover_proves(struct packet *p, const struct candidate *it, int count, const struct known_root roots[],
                       int halvings, lane_mask open, lanes left[2])
{
  struct cover_box stack[COVER_HALVINGS + 2];
  struct cover_box *leaf = &stack[0];
  struct cover_ray ray = {.leaf = it->leaf, .count = count, .roots = roots, .halvings = halvings};
  lanes from, to, off;
  /* up to t_max and not the nearest hit so far, or answers would depend on the way through the hierarchy */
  ray_ends(p, it, p->t_max, &from, &to, &off);
  off += 2 * it->line->error;
  memcpy(&ray.depth, it->leaf->x[it->axis], sizeof ray.depth);
  for (unsigned bits = lanes_bits(open); bits; bits &= bits - 1) {
    const int lane = ray.lane = __builtin_ctz(bits);
    for (int n = 0; n < 16; n++) leaf->a.c[n / 4][n % 4] = it->a[n][lane], leaf->b.c[n / 4][n % 4] = it->b[n][lane];
    leaf->u = leaf->v = 0, leaf->size_u = leaf->size_v = 1, leaf->halvings = 0;
    ray.size = real_max(net_size(&leaf->a), net_size(&leaf->b)), ray.error = it->line->error[lane];
    ray.from = from[lane] - off[lane], ray.to = to[lane] + off[lane];
    ray.splits = COVER_SPLITS;
    const bool covered = cover(&ray, stack);
    p->postponed->left[lane] -= COST_BOX * (1 + 2 * (COVER_SPLITS - ray.splits));
    if (covered) continue;
    open &= ~lanes_mask(bits & -bits);
    if (left) left[0][lane] = ray.left[0], left[1][lane] = ray.left[1];
  }
  return open;
}

lane_mask cover_two(struct packet *p, const struct candidate *it, const struct leaf_root *first,
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

/* Claims about one ray and one leaf hold: the error bound of the plane polynomials, and the Newton-Kantorovich test. */
#include <math.h>
#include <string.h>

#include "cmocka_test.h"
#include "geometry/edges.h"
#include "intersect/certificate.h"
#include "intersect/lanes/candidate.h"
#include "property/world.h"
#include "quad_root.h"
#include "worse.h"

enum { SEED = 20240513, CASES = 2400 };

/* The plane polynomials of the exact ray over the exact patch's part under the leaf, in quadruple precision, as a
 * moment and nets in the leaf's frame. */
struct truth {
  struct quad_net net[2];
  quad moment[2];
  struct quad_net x[3]; /* the leaf's own */
};

static void truth_make(const struct model *model, const struct leaf *leaf, const struct ray *ray, int k,
                       struct truth *out)
{
  const struct model_patch *patch = &model->patches[leaf->patch];
  double(*P)[4][3] = model->scene->patches[leaf->patch].P;
  struct quad_net *x = out->x;
  quad q[3];
  for (int c = 0; c < 3; c++) {
    struct quad_net whole;
    for (int n = 0; n < 16; n++) whole.c[n / 4][n % 4] = ((quad)P[n / 4][n % 4][c] - patch->center[c]) / patch->scale;
    const quad step[2] = {(quad)1 / patch->cut.split[0], (quad)1 / patch->cut.split[1]};
    quad_net_restrict(&whole, leaf->column_u * step[0], step[0], leaf->column_v * step[1], step[1], &x[c]);
    q[c] = ((quad)ray->origin[c] - patch->center[c]) / patch->scale;
  }
  for (int s = 0; s < 2; s++) {
    const int i = (k + 1 + s) % 3;
    const quad slope = (quad)ray->direction[i] / ray->direction[k];
    out->moment[s] = q[i] - slope * q[k];
    for (int n = 0; n < 16; n++)
      out->net[s].c[n / 4][n % 4] = x[i].c[n / 4][n % 4] - slope * x[k].c[n / 4][n % 4] - out->moment[s];
  }
}

struct subject {
  struct world world;
  const struct model *model;
  struct leaf *leaf;
  struct ray ray;
  struct packet packet;
  struct ready ready;
  int axis;
  struct truth truth;
};

/* Makes a border one point. */
static void collapse(world_net net, int border)
{
  for (int k = 1; k < 4; k++) {
    const int at = edge_at(border, k), from = edge_at(border, 0);
    memcpy(net[at / 4][at % 4], net[from / 4][from % 4], sizeof net[0][0]);
  }
}

/* Takes the ray, alike on all lanes, to the leaf. */
static void see(struct subject *s)
{
  struct ray rays[LANES];
  for (int l = 0; l < LANES; l++) rays[l] = s->ray, rays[l].t_min = -INFINITY;
  packet_begin(&s->packet, &s->ready, s->world.tracer, LANES, rays, false, s->world.tracer->budget);
  packet_set_patch(&s->packet, &s->model->patches[s->leaf->patch], s->leaf->patch);
  s->axis = packet_axis(&s->packet, 0);
  truth_make(s->model, s->leaf, &s->ray, s->axis, &s->truth);
}

/* Calls `body` for `cases` rays at leaves of scenes near and far, cut into split x split leaves (0: the default
 * cut), with directions of all sizes that the tracer passes on; `poles`: of patches with one pole each. */
static void on_leaves(uint64_t seed, int split, bool poles, int cases,
                      void (*body)(struct subject *s, struct random *random))
{
  struct method method;
  method_default(solver_at(0), &method);
  method.split = split;
  static const double offsets[] = {0, 0, 1e6, -3e7};
  struct random random = {seed};
  world_net nets[WORLD_MAX];
  for (int kind = 0; kind < 3; kind++) {
    for (int place = 0; place < 4; place++) {
      struct subject s;
      const size_t count = world_fill((enum world_kind)kind, &random, nets);
      for (size_t p = 0; p < count; p++) world_scale_net(nets[p], 1, offsets[place], nets[p]);
      for (size_t p = 0; p < count && poles; p++) collapse(nets[p], (int)(random_bits(&random) % 4));
      world_open(&s.world, nets, count, &method);
      s.model = s.world.tracer->model;
      for (int n = 0; n < cases / 12; n++) {
        s.ray = world_ray(&random, nets, count, n % RAY_KINDS);
        const int exponent = n % 3 == 0 ? 0 : n % 3 == 1 ? 199 : -199;
        for (int k = 0; k < 3; k++) s.ray.direction[k] = ldexp(s.ray.direction[k], exponent);
        if (n % 5 == 0) /* from far away */
          for (int k = 0; k < 3; k++) s.ray.origin[k] -= ldexp(s.ray.direction[k], 26 - exponent);
        s.leaf = &s.model->leaves[random_bits(&random) % s.model->leaf_count];
        see(&s);
        body(&s, &random);
      }
      world_close(&s.world);
    }
  }
}

static double worst_moment, worst_net, worst_t;

static void check_planes(struct subject *s, struct random *random)
{
  (void)random;
  const struct line *line = &s->packet.line[s->axis];
  const int k = s->axis;
  for (int p = 0; p < 2; p++) {
    const double off = (double)quad_abs((quad)line->moment[p][0] - s->truth.moment[p]);
    worst_moment = worse(worst_moment, off / (UNIT_ROUNDOFF * (double)(quad_abs(s->truth.moment[p]) + 0x1p-60)));
    for (int n = 0; n < 16; n++) {
      lanes net[2];
      plane_values(line, k, s->leaf->x, n, &net[0], &net[1]);
      worst_net = worse(worst_net,
                        (double)quad_abs((quad)net[p][0] - s->truth.net[p].c[n / 4][n % 4]) / line->error[0]);
    }
  }
  /* start and to_t give t of the local place 0. */
  const struct model_patch *patch = &s->model->patches[s->leaf->patch];
  const quad t = ((quad)patch->center[k] - s->ray.origin[k]) / s->packet.direction[k][0];
  const quad got = ((quad)line->start[0][0] + line->start[1][0]) * line->to_t[0];
  if (t != 0) worst_t = worse(worst_t, (double)(quad_abs(got - t) / quad_abs(t)) / UNIT_ROUNDOFF);
}

TEST(the_plane_polynomials_are_within_their_error)
{
  on_leaves(SEED, 0, false, CASES, check_planes);
  print_message("moments off by %.3g last places; coefficients %.3g of the bound; t of a place %.3g roundings\n",
                worst_moment, worst_net, worst_t);
  assert_true(worst_moment <= 4);
  assert_true(worst_net <= 1);
  assert_true(worst_net > 1e-3); /* not vacuous */
  assert_true(worst_t <= 2);
}

/* Counts of the claims on proven roots, and of those that fail. */
struct tally {
  int exist, alone, outside_radius, not_alone;
  double worst_radius;
};

/* Checks the claims of lane 0, and sets (u,v) to the exact root. Returns whether that exists. */
static bool check_root(const struct truth *truth, const struct newton_root *r, struct random *random,
                       struct tally *tally, quad *u, quad *v)
{
  if (!(lanes_bits(r->exists) & 1)) return false;
  tally->exist++;
  *u = r->u[0], *v = r->v[0];
  if (!quad_root(truth->net, u, v)) {
    tally->outside_radius++;
    return false;
  }
  const double du = (double)quad_abs(*u - r->u[0]), dv = (double)quad_abs(*v - r->v[0]);
  if (!(du <= r->radius_u[0] && dv <= r->radius_v[0])) tally->outside_radius++;
  tally->worst_radius = fmax(tally->worst_radius, fmax(du / r->radius_u[0], dv / r->radius_v[0]));
  if (!(lanes_bits(r->alone) & 1)) return true;
  tally->alone++;
  for (int n = 0; n < 9; n++) { /* no second root, wherever the search starts */
    quad x = (n % 3 + random_unit(random)) / 3, y = (n / 3 + random_unit(random)) / 3;
    if (!quad_root(truth->net, &x, &y)) continue;
    if (x < 0 || x > 1 || y < 0 || y > 1) continue;
    if (quad_abs(x - *u) > 1e-20 || quad_abs(y - *v) > 1e-20) tally->not_alone++;
  }
  return true;
}

/* Turns the ray to a point of the leaf, from some leaf sizes away. The smaller `slant` is, the flatter the ray, and
 * the more likely it meets the leaf twice. */
static void aim(struct subject *s, struct random *random, double slant)
{
  const struct model_patch *patch = &s->model->patches[s->leaf->patch];
  const quad u = random_unit(random), v = random_unit(random);
  struct quad_jet jet[3];
  double along[3], normal[3];
  for (int c = 0; c < 3; c++) jet[c] = quad_net_jet(&s->truth.x[c], u, v);
  for (int c = 0; c < 3; c++) {
    const int i = (c + 1) % 3, j = (c + 2) % 3;
    normal[c] = (double)(jet[i].du * jet[j].dv - jet[j].du * jet[i].dv);
  }
  const double turn = random_between(random, -1, 1), way = random_between(random, 2, 9);
  const double size = hypot(normal[0], hypot(normal[1], normal[2]));
  for (int c = 0; c < 3; c++) {
    along[c] = (double)(jet[c].du + turn * jet[c].dv) + (size > 0 ? slant * normal[c] / sqrt(size) : 0);
    s->ray.direction[c] = along[c];
    s->ray.origin[c] = patch->center[c] + patch->scale * ((double)jet[c].value - way * along[c]);
  }
}

/* The root at which the kernel's iteration from there ends, alike on all lanes. */
static void solve(struct subject *s, const double start[2], struct leaf_root *out)
{
  const lanes at[2] = {lanes_all(start[0]), lanes_all(start[1])};
  const lane_mask all = lanes_all(0) == lanes_all(0);
  see(s);
  newton_solve(&s->packet, s->leaf, s->axis, at, all, out);
}

static struct tally refined;
static double worst_inside; /* the point, in units of leaf_parts.error and a rounding */

static void check_refine(struct subject *s, struct random *random)
{
  static const double slants[] = {0.5, 0.2, 0.1, 0.05};
  if (random_bits(random) % 2) aim(s, random, slants[random_bits(random) % 4]);
  for (int n = 0; n < 4; n++) {
    const double start[2] = {random_between(random, -0.6, 0.6), random_between(random, -0.6, 0.6)};
    struct leaf_root root;
    quad u, v;
    solve(s, start, &root);
    if (!check_root(&s->truth, &root.at, random, &refined, &u, &v)) continue;
    for (int c = 0; c < 3; c++) {
      const quad x = quad_net_jet(&s->truth.x[c], root.at.u[0], root.at.v[0]).value;
      const double off = (double)quad_abs(root.point[c][0] - x);
      worst_inside = worse(worst_inside, off / (s->leaf->parts.error + UNIT_ROUNDOFF));
    }
  }
}

/* However bent the leaves are, and whether or not they are cut exactly. */
TEST(proven_roots_are_where_they_are_said_to_be)
{
  static const int splits[] = {0, 1, 2, 3, 7, 32};
  int alone = 0;
  for (size_t k = 0; k < sizeof splits / sizeof *splits; k++) {
    refined = (struct tally){0}, worst_inside = 0;
    on_leaves(SEED + 1 + k, splits[k], false, CASES / 6, check_refine);
    print_message(
      "split %d: %d proven, %d of them alone; at most %.3g of the radius away, points %.3g of their error\n", splits[k],
      refined.exist, refined.alone, refined.worst_radius, worst_inside);
    assert_true(refined.exist > 100);
    alone += refined.alone;
    assert_int_equal(refined.outside_radius, 0);
    assert_int_equal(refined.not_alone, 0);
    assert_true(worst_inside <= 1);
  }
  assert_true(alone > 50);
}

static struct tally fan_roots;

static void check_fan(struct subject *s, struct random *random)
{
  static const double slants[] = {2, 0.5, 0.2, 0.1};
  int pole = 0;
  while (pole < 4 && !leaf_border_is_point(&s->model->patches[s->leaf->patch], s->leaf, pole)) pole++;
  if (pole == 4) return;
  if (random_bits(random) % 4) aim(s, random, slants[random_bits(random) % 4]);
  const double start[2] = {random_between(random, -0.6, 0.6), random_between(random, -0.6, 0.6)};
  struct leaf_root root;
  quad u, v;
  solve(s, start, &root);
  (void)check_root(&s->truth, &root.at, random, &fan_roots, &u, &v);
}

/* The Jacobian is singular along the pole. */
TEST(roots_next_to_poles_are_alone_where_they_are_said_to_be)
{
  static const int splits[] = {3, 8, 32};
  for (size_t k = 0; k < sizeof splits / sizeof *splits; k++) {
    fan_roots = (struct tally){0};
    on_leaves(SEED + 40 + k, splits[k], true, splits[k] * CASES / 8, check_fan);
    assert_int_equal(fan_roots.outside_radius, 0);
    assert_int_equal(fan_roots.not_alone, 0);
  }
}

static struct tally leaf_roots;
static double worst_residual, worst_place, worst_point, worst_tangent;

/* The lengths of the rows of the inverse Jacobian there, as covectors of space. */
static void row_lengths(const struct subject *s, quad u, quad v, double out[2])
{
  const struct quad_jet a = quad_net_jet(&s->truth.net[0], u, v), b = quad_net_jet(&s->truth.net[1], u, v);
  const lanes *line = s->packet.line[s->axis].slope;
  const double slope[2] = {line[0][0], line[1][0]}, inverse = (double)(1 / (a.du * b.dv - a.dv * b.du));
  const double rows[2][2] = {{(double)b.dv, -(double)a.dv}, {-(double)b.du, (double)a.du}};
  for (int k = 0; k < 2; k++) {
    const double p = rows[k][0] * inverse, q = rows[k][1] * inverse, r = p * slope[0] + q * slope[1];
    out[k] = sqrt(p * p + q * q + r * r);
  }
}

static void check_leaf_root(struct subject *s, struct random *random)
{
  static const double slants[] = {0.5, 0.2, 0.1, 0.05}, middle[2] = {0, 0};
  struct leaf_root root;
  aim(s, random, slants[random_bits(random) % 4]);
  solve(s, middle, &root);
  const int k = s->axis;
  quad u, v;
  if (!check_root(&s->truth, &root.at, random, &leaf_roots, &u, &v) || !s->leaf->parts.final) return;
  double size[2];
  row_lengths(s, u, v, size);
  /* Distance from the ray: one rounding of a coordinate of the patch, of size 1; of the surface's way under the
   * rounding of u and v; and of the bend's. */
  const quad at_u = root.at.u[0], at_v = root.at.v[0];
  for (int n = 0; n < 2; n++) {
    const quad off = quad_net_jet(&s->truth.net[n], at_u, at_v).value;
    worst_residual = worse(worst_residual, (double)quad_abs(off) / UNIT_ROUNDOFF);
  }
  const struct model_patch *patch = &s->model->patches[s->leaf->patch];
  const quad start = ((quad)patch->center[k] - s->ray.origin[k]) / patch->scale;
  const struct quad_jet exact = quad_net_jet(&s->truth.x[k], u, v);
  const double place = (double)quad_abs((quad)root.t[0] * s->ray.direction[k] / patch->scale - (exact.value + start));
  worst_place = worse(worst_place,
                      place / (UNIT_ROUNDOFF * (fmax(size[0], size[1]) + (double)quad_abs(exact.value + start))));
  for (int c = 0; c < 3 && at_u >= 0 && at_u <= 1 && at_v >= 0 && at_v <= 1; c++) {
    const struct quad_jet jet = quad_net_jet(&s->truth.x[c], at_u, at_v);
    const double reach = s->leaf->first[0] + s->leaf->first[1];
    worst_point = worse(worst_point, (double)quad_abs(root.point[c][0] - jet.value) / UNIT_ROUNDOFF);
    worst_tangent = worse(worst_tangent, (double)quad_abs(root.su[c][0] - jet.du) / (UNIT_ROUNDOFF * (reach + 1)));
    worst_tangent = worse(worst_tangent, (double)quad_abs(root.sv[c][0] - jet.dv) / (UNIT_ROUNDOFF * (reach + 1)));
  }
}

TEST(roots_of_leaves_that_bend_little_are_right_to_the_last_places)
{
  on_leaves(SEED + 2, 0, false, CASES, check_leaf_root);
  on_leaves(SEED + 3, 32, false, CASES / 4, check_leaf_root); /* as many leaves as are cut exactly */
  print_message("%d proven, %d of them alone; at most %.3g of the radius away\n", leaf_roots.exist, leaf_roots.alone,
                leaf_roots.worst_radius);
  print_message("in roundings: off the ray %.3g, places %.3g, points %.3g, derivatives %.3g\n", worst_residual,
                worst_place, worst_point, worst_tangent);
  assert_true(leaf_roots.exist > 100 && leaf_roots.alone > 50);
  assert_int_equal(leaf_roots.outside_radius, 0);
  assert_int_equal(leaf_roots.not_alone, 0);
  assert_true(worst_residual <= 0.5 && worst_place <= 0.5 && worst_point <= 0.5 && worst_tangent <= 0.5);
}

/* A leaf, and a packet of rays aimed at it lane by lane, for tests of one instruction set (lanes_main.h). */
#ifndef PSCN_TESTS_UNIT_LANE_SUBJECT_H
#define PSCN_TESTS_UNIT_LANE_SUBJECT_H

#include <math.h>
#include <string.h>

#include "geometry/patch.h"
#include "intersect/lanes/candidate.h"
#include "intersect/prepare/leaf.h"
#include "random.h"

struct subject {
  double rest[3][4][4];
  struct method method;
  struct model_patch patch;
  struct leaf leaf;
  struct packet packet;
  bool over_a_plane; /* x is linear in u, y in v */
};

/* Makes a leaf of any shape, or flat within `rough`, or slender; its patch is cut into up to 2^most_halvings a side. */
static inline void subject_make(struct random *random, unsigned most_halvings, double rough, struct subject *s)
{
  const int kind = (int)(random_bits(random) % 3);
  const uint16_t side = (uint16_t)(1 << random_bits(random) % (most_halvings + 1));
  s->over_a_plane = kind == 1;
  method_default(solver_at(0), &s->method);
  s->patch = (struct model_patch){
    .scale = exp2(rint(random_between(random, -30, 30))), .cut = {.split = {side, side}}, .method = &s->method};
  s->patch.rest = (const double(*)[4][4])s->rest;
  for (int k = 0; k < 3; k++) {
    s->patch.center[k] = s->patch.scale * rint(random_between(random, -4, 4));
    for (int n = 0; n < 16; n++) {
      double x = random_between(random, -1, 1);
      if (kind == 1) x = k == 0 ? n / 4 / 4.0 : k == 1 ? n % 4 / 4.0 : (n / 4 - n % 4) / 8.0 + rough * x;
      if (kind == 2) x = (k == 0 ? n / 4 / 2.0 - 0.75 : 0) + x * 0x1p-7;
      s->patch.x[k][n / 4][n % 4] = x;
    }
  }
  leaf_make(&s->patch, 0, (uint32_t)(random_bits(random) % (uint64_t)(side * side)), &s->leaf);
}

/* A point of the leaf, in the frame of its patch. */
static inline void subject_point(const struct subject *s, double u, double v, double out[3])
{
  for (int k = 0; k < 3; k++) {
    double net[4][4];
    memcpy(net, s->leaf.x[k], sizeof net);
    out[k] = patch_evaluate(net, u, v).value;
  }
}

/* Prepares the packet's rays, whose origins, directions and ends are set, for the patch, whose points are off by up
 * to `error`. */
static inline void subject_look(struct subject *s, double error)
{
  struct packet *p = &s->packet;
  p->live = (lane_mask){0} == 0, p->t_far = p->t_max, p->net_error = error;
  packet_untried(p);
  packet_set_patch(p, &s->patch, 0);
}

#endif

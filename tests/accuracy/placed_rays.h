/* Packets of rays at closed models, each model as it is made and moved, by every method: for tests of whether the models
 * are closed. */
#ifndef TESTS_ACCURACY_PLACED_RAYS_H
#define TESTS_ACCURACY_PLACED_RAYS_H

#include "accuracy/models.h"
#include "accuracy/trial.h"

/* Where on a patch rays are aimed: exactly at a feature, next to it, or anywhere; poles are rows u = 0. */
enum aim {
  AIM_EDGE,
  AIM_CORNER,
  AIM_POLE,
  AIM_EIGHTH, /* a line of constant u or v where leaves of the patch meet */
  AIM_ANYWHERE,
  AIM_NEAR_EDGE,
  AIM_NEAR_POLE,
  AIM_TANGENT, /* anywhere, along the surface */
  AIMS
};
extern const char *const aim_names[AIMS];

/* Moves (u,v) to such a place. `bits` choose which border, and which end of it. */
void aim_at(enum aim aim, uint64_t bits, struct random *random, double *u, double *v);

/* How the rays are shared out: equally among models, by shares among aims, and equally among placements except the first.
 * There a model is not moved, so rays meet edges and poles exactly and are left to the intersector's slowest stage. The
 * others turn it; one makes it 1e6 times as large, and one as small; the last one shifts it. */
struct placed_shares {
  void (*const *models)(struct closed_model *out);
  int model_count;
  double aims[AIMS]; /* sum 1 */
  double exact;      /* the first placement's share, relative to each other one's */
  double shift;      /* of the last placement */
  double others;     /* the share of each method but the default, relative to that one's */
};

/* Makes `count` rays with this aim at the model, at most PACKET_SIZE, and examines their answers. */
typedef void placed_packet(void *context, struct trial *trial, const struct placed_model *at, enum aim aim,
                           size_t count, struct random *random);

/* Makes about `wanted` rays for the default method, and its share for each other one: every solver, and other numbers of
 * leaves than the default's. */
void placed_rays(const struct placed_shares *shares, size_t wanted, uint64_t seed, placed_packet *packet,
                 void *context);

#endif

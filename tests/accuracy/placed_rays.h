/* Packets of rays at closed models, each model as it is made and moved, for tests of whether the models are closed. */
#ifndef TESTS_ACCURACY_PLACED_RAYS_H
#define TESTS_ACCURACY_PLACED_RAYS_H

#include "accuracy/models.h"
#include "accuracy/trial.h"

/* How the rays are shared out: equally among models, by shares among kinds of aim, and equally among placements except
 * the first. There a model is not moved, so rays meet edges and poles exactly and are left to the intersector's slowest
 * stage. The others turn it; one makes it 1e6 times as large, and one as small; the last one shifts it. */
struct placed_shares {
  void (*const *models)(struct model *out);
  int model_count, kind_count;
  const double *kinds; /* sum 1; NULL: equal ones */
  double exact;        /* the first placement's share, relative to each other one's */
  double shift;        /* of the last placement */
};

/* Makes `count` rays of the kind at the model, at most PACKET_SIZE, and examines their answers. */
typedef void placed_packet(void *context, struct trial *trial, const struct placed_model *at, int kind, size_t count,
                           struct random *random);

/* Makes about `wanted` rays, answered by the method `options`. */
void placed_rays(const struct placed_shares *shares, const struct method *options, size_t wanted, struct random *random,
                 placed_packet *packet, void *context);

#endif

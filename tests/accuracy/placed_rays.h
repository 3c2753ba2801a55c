/* Packets of rays at closed models, each where it is made and moved, for tests of whether the models are closed.
 */
#ifndef TESTS_ACCURACY_PLACED_RAYS_H
#define TESTS_ACCURACY_PLACED_RAYS_H

#include "accuracy/models.h"
#include "accuracy/trial.h"

/* How the rays are shared out: among models alike, among kinds of aim by their shares, and among placements alike but for
 * the first one. There a model is not moved, so that rays meet edges and poles exactly and are left to the slowest stage
 * of the intersector. The others turn it; one makes it 1e6 times as large, and one as small; the last one shifts it. */
struct placed_shares {
  void (*const *models)(struct model *out);
  int model_count, kind_count;
  const double *kinds; /* sum 1; NULL: all alike */
  double exact;        /* of the first placement, beside each other one's */
  double shift;        /* of the last placement */
};

/* Makes `count` rays of that kind at the model, no more than PACKET_SIZE, and looks at their answers. */
typedef void placed_packet(void *context, struct trial *trial, const struct placed_model *at, int kind, size_t count,
                           struct random *random);

/* Some `wanted` rays, answered as `options` says. */
void placed_rays(const struct placed_shares *shares, const struct method *options, size_t wanted, struct random *random,
                 placed_packet *packet, void *context);

#endif

/* Packets of rays at closed models. See placed_rays.h. */
#include "accuracy/placed_rays.h"

enum { PLACEMENTS = 5 };

/* All rays of one kind. */
static void rays_of_kind(struct trial *trial, const struct placed_model *at, int kind, size_t count,
                         struct random *random, placed_packet *packet, void *context)
{
  for (size_t first = 0; first < count; first += PACKET_SIZE)
    packet(context, trial, at, kind, count - first < PACKET_SIZE ? count - first : PACKET_SIZE, random);
}

void placed_rays(const struct placed_shares *shares, const struct method *options, size_t wanted, struct random *random,
                 placed_packet *packet, void *context)
{
  const double scales[PLACEMENTS] = {1, 1, 1e6, 1e-6, 1}, shifts[PLACEMENTS] = {0, 1, 1e6, 1e-6, shares->shift};
  const double each = (double)wanted / (shares->model_count * (PLACEMENTS - 1 + shares->exact));
  for (int which = 0; which < shares->model_count; which++) {
    for (int place = 0; place < PLACEMENTS; place++) {
      struct placed_model at;
      struct trial trial;
      model_placed(shares->models[which], random, scales[place], shifts[place], place > 0, &at);
      trial_create(&trial, (const double(*)[4][4][3])at.placed.P, at.placed.count, options);
      for (int kind = 0; kind < shares->kind_count; kind++) {
        const double share = shares->kinds ? shares->kinds[kind] : 1.0 / shares->kind_count;
        const size_t count = (size_t)((place > 0 ? 1 : shares->exact) * share * each) + 1;
        rays_of_kind(&trial, &at, kind, count, random, packet, context);
      }
      trial_destroy(&trial);
    }
  }
}

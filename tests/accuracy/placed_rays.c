/* Packets of rays at closed models. See placed_rays.h. */
#include "accuracy/placed_rays.h"

#include <math.h>

enum { PLACEMENTS = 5 };

const char *const aim_names[AIMS] = {"edge",     "corner",    "pole",      "eighth",
                                     "anywhere", "near edge", "near pole", "tangent"};

void aim_at(enum aim aim, uint64_t bits, struct random *random, double *u, double *v)
{
  const double tiny = ldexp(1, -(int)(random_bits(random) % 56) - 4), end = (double)(bits >> 8 & 1);
  double *fixed = bits >> 9 & 1 ? u : v;
  if (aim == AIM_EDGE) *fixed = end;
  if (aim == AIM_CORNER) *u = end, *v = (double)(bits >> 10 & 1);
  if (aim == AIM_POLE) *u = 0;
  if (aim == AIM_EIGHTH) *fixed = (double)(bits >> 10 & 7) / 8;
  if (aim == AIM_NEAR_EDGE) *fixed = end > 0 ? 1 - tiny : tiny;
  if (aim == AIM_NEAR_POLE) *u = tiny;
}

static void by_method(const struct placed_shares *shares, const char *method, double wanted, struct random *random,
                      placed_packet *packet, void *context)
{
  const double scales[PLACEMENTS] = {1, 1, 1e6, 1e-6, 1}, shifts[PLACEMENTS] = {0, 1, 1e6, 1e-6, shares->shift};
  const double each = wanted / (shares->model_count * (PLACEMENTS - 1 + shares->exact));
  for (int n = 0; n < shares->model_count * PLACEMENTS; n++) {
    const int place = n % PLACEMENTS;
    struct placed_model at;
    struct trial trial;
    model_placed(shares->models[n / PLACEMENTS], random, scales[place], shifts[place], place > 0, &at);
    trial_create(&trial, (const double(*)[4][4][3])at.placed.P, at.placed.count, method);
    for (enum aim aim = 0; aim < AIMS; aim++) {
      if (shares->aims[aim] == 0) continue;
      for (size_t left = (size_t)((place > 0 ? 1 : shares->exact) * shares->aims[aim] * each) + 1, size; left > 0;
           left -= size) {
        size = left < PACKET_SIZE ? left : PACKET_SIZE;
        packet(context, &trial, &at, aim, size, random);
      }
    }
    trial_destroy(&trial);
  }
}

void placed_rays(const struct placed_shares *shares, size_t wanted, uint64_t seed, placed_packet *packet, void *context)
{
  static const char *const methods[] = {"bernstein",
                                        "newton",
                                        "laguerre",
                                        "aberth",
                                        "durand_kerner",
                                        "bernstein { split 1 }",
                                        "bernstein { split 2 }",
                                        "bernstein { split 3 }",
                                        "bernstein { split 16 }"};
  struct random random = {.state = seed};
  for (size_t n = 0; n < sizeof methods / sizeof methods[0]; n++)
    by_method(shares, methods[n], (double)wanted * (n == 0 ? 1 : shares->others), &random, packet, context);
}

/* Seeded random numbers for tests: SplitMix64 (S. Steele, D. Lea, C. Flood, 2014). The same everywhere. */
#ifndef TESTS_RANDOM_H
#define TESTS_RANDOM_H

#include <stddef.h>
#include <stdint.h>

struct random {
  uint64_t state;
};

static inline uint64_t random_bits(struct random *random)
{
  uint64_t z = (random->state += 0x9e3779b97f4a7c15u);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

/* Uniform in [0,1), a multiple of 2^-53. */
static inline double random_unit(struct random *random) { return (double)(random_bits(random) >> 11) * 0x1p-53; }

/* Uniform in [low, high). */
static inline double random_between(struct random *random, double low, double high)
{
  return low + (high - low) * random_unit(random);
}

/* Makes every order equally likely (R. Durstenfeld, Algorithm 235, 1964). */
static inline void random_shuffle(struct random *random, size_t count, size_t order[])
{
  for (size_t n = count; n-- > 1;) {
    const size_t other = random_bits(random) % (n + 1), swap = order[n];
    order[n] = order[other], order[other] = swap;
  }
}

#endif

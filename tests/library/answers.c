/* answers SCENE...: nearest hits of some hundred rays in each scene, with all digits: arm64.sh compares them with those
 * of another processor. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>

#include "library/pscn.h"

enum { RAYS = 300 };

/* Knuth's generator (MMIX); from -1 to 1. */
static double next(uint64_t *state)
{
  *state = *state * 6364136223846793005U + 1442695040888963407U;
  return (double)(int64_t)*state / 9223372036854775808.0;
}

static int answer(const char *path)
{
  static struct pscn_ray rays[RAYS];
  static struct pscn_hit hits[RAYS];
  struct pscn_scene *scene;
  uint64_t state = 1;
  if (pscn_scene_from_file(path, NULL, &scene) != PSCN_OK) return 1;
  for (int k = 0; k < RAYS; k++) {
    rays[k] = (struct pscn_ray){.t_max = INFINITY};
    for (int c = 0; c < 3; c++) {
      rays[k].origin[c] = 5 * next(&state);
      rays[k].direction[c] = next(&state) - rays[k].origin[c];
    }
  }
  if (pscn_nearest(scene, RAYS, rays, sizeof *rays, hits, sizeof *hits) != PSCN_OK) return 1;
  for (int k = 0; k < RAYS; k++) {
    const struct pscn_hit *hit = &hits[k];
    printf("%d %d", hit->verdict, hit->certain);
    if (hit->verdict == PSCN_HIT)
      printf(" %.17g %.17g %.17g %u %.17g %.17g %.17g", hit->t, hit->u, hit->v, hit->patch, hit->normal[0],
             hit->normal[1], hit->normal[2]);
    printf("\n");
  }
  pscn_scene_free(scene);
  return 0;
}

int main(int argc, char *argv[])
{
  int failed = argc < 2;
  for (int k = 1; k < argc && !failed; k++) failed = answer(argv[k]);
  return failed;
}

/* How much of space a closed model fills: a grid of N x N lines goes through it. A point of a line is inside if the
 * line has met the surface an odd number of times before it. The sum of the lengths inside, times the area that each
 * line stands for, is the volume. No line may meet the surface an odd number of times altogether.
 *
 *     cc inside.c $(pkg-config --cflags --libs pscn) -lm -o inside
 *     ./inside 100                  a ball of eight patches, made here of control points
 *     ./inside 100 model.pscn       a model of yours, closed, all patches of the file
 *
 * Writes the number of lines, of those that meet the model, and of those whose number of hits is not proven, and the
 * volume. The exit code is 1 if a line with a proven number of hits got in and not out.
 */
#include <math.h>
#include <pscn.h>
#include <stdio.h>
#include <stdlib.h>

/* The eighth of a ball of radius 1 between three half axes, from the pole (u = 0) to the equator (u = 1), as near as
 * cubic curves come to a circle; and its mirror images. */
static enum pscn_status make_ball(struct pscn_scene **out)
{
  const double k = 0.5522847498, c = k * k;
  const double eighth[4][4][3] = {{{0, 1, 0}, {0, 1, 0}, {0, 1, 0}, {0, 1, 0}},
                                  {{k, 1, 0}, {k, 1, c}, {c, 1, k}, {0, 1, k}},
                                  {{1, k, 0}, {1, k, k}, {k, k, 1}, {0, k, 1}},
                                  {{1, 0, 0}, {1, 0, k}, {k, 0, 1}, {0, 0, 1}}};
  double points[8][4][4][3];
  for (int patch = 0; patch < 8; patch++) {
    for (int n = 0; n < 48; n++) {
      const double x = eighth[n / 12][n / 3 % 4][n % 3];
      points[patch][n / 12][n / 3 % 4][n % 3] = patch >> n % 3 & 1 ? -x : x;
    }
  }
  return pscn_scene_from_points(&points[0][0][0][0], 8, sizeof points[0], sizeof points[0][0][0], NULL, out);
}

/* A box around all control points, and therefore around all patches. */
static void find_box(const struct pscn_scene *scene, double low[3], double high[3])
{
  for (int k = 0; k < 3; k++) low[k] = INFINITY, high[k] = -INFINITY;
  for (size_t patch = 0; patch < pscn_patch_count(scene); patch++) {
    double P[4][4][3];
    if (pscn_patch(scene, patch, P) != PSCN_OK) continue;
    for (int n = 0; n < 48; n++) {
      const double x = P[n / 12][n / 3 % 4][n % 3];
      low[n % 3] = fmin(low[n % 3], x);
      high[n % 3] = fmax(high[n % 3], x);
    }
  }
}

/* Lines along z through the middles of row `row` of an n x n grid over the box. */
static void make_lines(const double low[3], const double high[3], size_t row, size_t n, struct pscn_ray rays[])
{
  for (size_t k = 0; k < n; k++) {
    rays[k] = (struct pscn_ray){.direction = {0, 0, 1}, .t_max = INFINITY};
    rays[k].origin[0] = low[0] + (high[0] - low[0]) * ((double)k + 0.5) / (double)n;
    rays[k].origin[1] = low[1] + (high[1] - low[1]) * ((double)row + 0.5) / (double)n;
    rays[k].origin[2] = low[2] - (high[2] - low[2]);
  }
}

struct sums {
  size_t met, unproven, leaks;
  double length;
};

enum { MOST = 64 }; /* hits of a line that are used; more are only counted */

static void add_line(const struct pscn_hits *count, const struct pscn_hit hits[MOST], struct sums *sums)
{
  sums->met += count->count > 0;
  sums->unproven += !count->certain;
  sums->leaks += count->certain && count->count % 2 == 1;
  /* Every second stretch between two hits is inside. The direction has length 1. */
  for (size_t k = 1; k < count->count && k < MOST; k += 2) sums->length += hits[k].t - hits[k - 1].t;
}

int main(int argc, char **argv)
{
  const size_t n = argc > 1 ? strtoul(argv[1], NULL, 10) : 100;
  if (n < 1 || n > 10000) {
    fprintf(stderr, "usage: inside [N [SCENE]], N from 1 to 10000\n");
    return 2;
  }
  struct pscn_scene *scene;
  const enum pscn_status status = argc > 2 ? pscn_scene_from_file(argv[2], NULL, &scene) : make_ball(&scene);
  fputs(pscn_scene_messages(scene), stderr);
  struct pscn_ray *rays = calloc(n, sizeof *rays);
  struct pscn_hits *counts = calloc(n, sizeof *counts);
  struct pscn_hit(*hits)[MOST] = calloc(n, sizeof *hits);
  struct sums sums = {0, 0, 0, 0};
  int code = (int)status;
  if (status == PSCN_OK && (rays == NULL || counts == NULL || hits == NULL)) code = PSCN_LIMIT;
  if (code != PSCN_OK) goto done;

  double low[3], high[3];
  find_box(scene, low, high);
  for (size_t row = 0; row < n; row++) {
    make_lines(low, high, row, n, rays);
    code = (int)pscn_all(scene, n, rays, sizeof *rays, counts, sizeof *counts, *hits, sizeof *hits, MOST);
    if (code != PSCN_OK) goto done;
    for (size_t k = 0; k < n; k++) add_line(&counts[k], hits[k], &sums);
  }
  printf("%zu lines, %zu meet the model, %zu have no proven number of hits\n", n * n, sums.met, sums.unproven);
  printf("%zu got in and not out\n", sums.leaks);
  printf("volume %.6g\n", sums.length * (high[0] - low[0]) * (high[1] - low[1]) / (double)(n * n));
  code = sums.leaks > 0;
done:
  if (code > 1) fprintf(stderr, "inside: %s\n", pscn_status_text((enum pscn_status)code));
  free(hits);
  free(counts);
  free(rays);
  pscn_scene_free(scene);
  return code;
}

/* Primary rays of a scene by pscn, and by Embree on triangles, in one process and taking turns.
 *
 *   primary_rays SCENE [RUNS [SIDE [SOLVER...]]]
 *
 * All 800x600 camera rays in the renderer's order: pscn's packets by the scene's own solvers, then by each SOLVER
 * ("aberth { split 1 }"; "all" or "all SOLVER": all hits of each ray instead of the nearest), beside Embree's rtcIntersect1 and coherent rtcIntersect8 on SIDE x SIDE x 2 triangles a patch
 * (128). CPU time of the thread. A line a contestant, tabs between: name, ns a ray (median over runs, smallest,
 * largest), and the medians of the ratios to rtcIntersect1, to rtcIntersect8 and to pscn in the same run.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/sort.h"
#include "chart/rays.h"
#include "language/language.h"
#include "chart/embree_mesh.h"

enum { WIDTH = 800, HEIGHT = 600, MAX_CONTESTANTS = 16, MAX_RUNS = 1000, FIRST_PSCN = 2 };

struct contestant {
  const char *name;
  unsigned embree_width; /* 0: pscn */
  bool all;              /* hits of a ray */
  struct scene *scene;
  struct intersector *intersector;
  struct tracer *tracer;
  double seconds[MAX_RUNS];
};

static void tell(void *context, const char *text, size_t length)
{
  (void)context;
  (void)fwrite(text, 1, length, stderr);
}

static void fail(const char *what)
{
  fprintf(stderr, "primary_rays: %s\n", what);
  exit(EXIT_FAILURE);
}

static void contestant_load(struct contestant *c, const char *path, const char *solver)
{
  struct diagnostics diagnostics = {.tell = tell};
  c->name = solver == NULL ? "pscn" : solver;
  c->all = solver != NULL && strncmp(solver, "all", 3) == 0 && (solver[3] == ' ' || solver[3] == '\0');
  if (c->all) solver = solver[3] == ' ' ? solver + 4 : NULL;
  const struct language_settings settings = {
    .image_width = WIDTH, .image_height = HEIGHT, .solver_text = solver, .tolerance = NAN};
  if (language_load(path, &settings, &diagnostics, &c->scene) != STATUS_OK) exit(EXIT_FAILURE);
  if (intersector_create(c->scene, &c->intersector) != STATUS_OK) fail("out of memory");
  if (tracer_create(c->intersector, &c->tracer) != STATUS_OK) fail("out of memory");
}

static void trace(struct tracer *tracer, bool all, const struct ray_list *list)
{
  struct hit hits[PACKET_SIZE];
  struct hit_list lists[PACKET_SIZE];
  for (size_t k = 0; k < list->packet_count; k++) {
    const struct ray_packet *packet = &list->packets[k];
    if (packet->new_run) tracer_forget(tracer);
    const struct ray *rays = &list->rays[packet->first];
    if (!all) tracer_closest(tracer, packet->count, rays, hits);
    else if (tracer_all(tracer, packet->count, rays, lists) != STATUS_OK) fail("out of memory");
  }
}

/* Sorts the values. */
static double median(double *values, size_t count)
{
  sort_numbers(values, count);
  return sorted_quantile(values, count, 0.5);
}

static double median_ratio(const struct contestant *a, const struct contestant *b, size_t runs)
{
  double ratio[MAX_RUNS];
  for (size_t r = 0; r < runs; r++) ratio[r] = a->seconds[r] / b->seconds[r];
  return median(ratio, runs);
}

static void report(struct contestant *list, size_t count, size_t runs, size_t rays)
{
  double ratio[MAX_CONTESTANTS][FIRST_PSCN + 1];
  for (size_t c = 0; c < count; c++)
    for (size_t to = 0; to <= FIRST_PSCN; to++) ratio[c][to] = median_ratio(&list[c], &list[to], runs);
  printf("name\tns a ray\tsmallest\tlargest\tto rtcIntersect1\tto rtcIntersect8\tto pscn\n");
  for (size_t c = 0; c < count; c++) {
    const double unit = 1e9 / (double)rays, middle = median(list[c].seconds, runs) * unit;
    printf("%s\t%.1f\t%.1f\t%.1f\t%.3f\t%.3f\t%.3f\n", list[c].name, middle, list[c].seconds[0] * unit,
           list[c].seconds[runs - 1] * unit, ratio[c][0], ratio[c][1], ratio[c][2]);
  }
}

int main(int argc, char **argv)
{
  static struct contestant list[MAX_CONTESTANTS];
  size_t count = FIRST_PSCN + 1;
  if (argc < 2) fail("which scene?");
  const size_t runs = argc > 2 ? strtoul(argv[2], NULL, 10) : 9;
  const unsigned side = argc > 3 ? (unsigned)strtoul(argv[3], NULL, 10) : 128;
  if (runs == 0 || runs > MAX_RUNS || side == 0) fail("bad numbers");
  list[0] = (struct contestant){.name = "Embree rtcIntersect1", .embree_width = 1};
  list[1] = (struct contestant){.name = "Embree rtcIntersect8, coherent", .embree_width = 8};
  contestant_load(&list[FIRST_PSCN], argv[1], NULL);
  for (int k = 4; k < argc && count < MAX_CONTESTANTS; k++) contestant_load(&list[count++], argv[1], argv[k]);

  const struct scene *scene = list[FIRST_PSCN].scene;
  struct arena *arena = arena_create();
  struct ray_list rays;
  double(*P)[4][4][3] = arena == NULL ? NULL : arena_alloc(arena, scene->patch_count, sizeof *P);
  if (P == NULL || rays_of_camera(scene, WIDTH, HEIGHT, WIDTH * HEIGHT, arena, &rays) != STATUS_OK)
    fail("out of memory");
  for (size_t n = 0; n < scene->patch_count; n++)
    for (int k = 0; k < 48; k++) P[n][k / 12][k / 3 % 4][k % 3] = scene->patches[n].P[k / 12][k / 3 % 4][k % 3];
  struct embree_mesh *mesh = pscn_embree_peer.mesh_create((const double(*)[4][4][3])P, scene->patch_count, side);
  struct embree_rays *embree = pscn_embree_peer.rays_create(rays.rays, rays.count);
  if (mesh == NULL || embree == NULL) fail("Embree failed");

  double sum = 0;
  for (size_t r = 0; r < runs; r++) {
    for (size_t c = 0; c < count; c++) {
      const double start = clock_seconds(CLOCK_THREAD_CPUTIME_ID);
      if (list[c].embree_width == 0) trace(list[c].tracer, list[c].all, &rays);
      else sum += pscn_embree_peer.trace(mesh, embree, list[c].embree_width, false);
      list[c].seconds[r] = clock_seconds(CLOCK_THREAD_CPUTIME_ID) - start;
    }
  }
  fprintf(stderr, "%s, %zu camera rays, %zu triangles, %zu runs (Embree's distances add up to %.6g)\n", argv[1],
          rays.count, scene->patch_count * side * side * 2, runs, sum);
  report(list, count, runs, rays.count);
  pscn_embree_peer.rays_destroy(embree);
  pscn_embree_peer.mesh_destroy(mesh);
  arena_destroy(arena);
  for (size_t c = FIRST_PSCN; c < count; c++) {
    tracer_destroy(list[c].tracer);
    intersector_destroy(list[c].intersector);
    scene_destroy(list[c].scene);
  }
  return 0;
}

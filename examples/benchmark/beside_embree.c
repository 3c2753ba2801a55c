/* Rays of a scene by pscn, and by Embree on triangles, in one process and taking turns.
 *
 *   beside_embree KIND SCENE [RUNS [SIDE [SOLVER...]]]
 *
 * KIND is one of
 *   camera      all 800x600 camera rays, in the renderer's order
 *   shadow      the shadow rays that their hits send: whether anything is hit
 *   scattered   as many rays from random points of the box of the hits, in random directions, in no order
 *
 * pscn answers by the scene's own solvers, in packets and, "one by one", each ray alone; then by each SOLVER ("aberth {
 * split 1 }"; "all" or "all SOLVER": all hits of each ray instead of the nearest). Embree has SIDE x SIDE x 2 triangles
 * a patch (64), and answers by rtcIntersect1 and by packets of 8 and, where the processor has the instructions, 16,
 * which are told whether the rays are coherent; or by rtcOccluded.
 *
 * Prints a line for each contestant, tabs between: its name; ns a ray, in CPU time of the thread (median over runs,
 * smallest, largest); the medians of the ratios in the same run to Embree's rays one by one, to its fastest packets and
 * to pscn's packets. Then the work before the first ray, in CPU seconds of one thread: pscn's preparing of the patches;
 * Embree's triangles and their hierarchy, of its default quality and of the best, with which its rays are traced.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/real.h"
#include "base/sort.h"
#include "chart/embree_mesh.h"
#include "chart/rays.h"
#include "language/language.h"

enum { WIDTH = 800, HEIGHT = 600, MAX_CONTESTANTS = 16, MAX_RUNS = 1000 };

enum kind { CAMERA, SHADOW, SCATTERED, KINDS };

static const char *const KIND_NAMES[KINDS] = {"camera", "shadow", "scattered"};

struct contestant {
  const char *name;
  unsigned width; /* rays at once */
  bool embree;
  bool all; /* hits of a ray */
  struct scene *scene;
  struct intersector *intersector;
  struct tracer *tracer;
  double seconds[MAX_RUNS];
  double preparing; /* seconds */
};

static void tell(void *context, const char *text, size_t length)
{
  (void)context;
  (void)fwrite(text, 1, length, stderr);
}

static void fail(const char *what)
{
  fprintf(stderr, "beside_embree: %s\n", what);
  exit(EXIT_FAILURE);
}

static void contestant_load(struct contestant *c, const char *path, const char *solver)
{
  struct diagnostics diagnostics = {.tell = tell};
  c->name = solver == NULL ? "pscn" : solver;
  c->width = PACKET_SIZE;
  c->all = solver != NULL && strncmp(solver, "all", 3) == 0 && (solver[3] == ' ' || solver[3] == '\0');
  if (c->all) solver = solver[3] == ' ' ? solver + 4 : NULL;
  const struct language_settings settings = {
    .image_width = WIDTH, .image_height = HEIGHT, .solver_text = solver, .tolerance = NAN};
  if (language_load(path, &settings, &diagnostics, &c->scene) != STATUS_OK) exit(EXIT_FAILURE);
  const double start = clock_seconds(CLOCK_THREAD_CPUTIME_ID);
  if (intersector_create(c->scene, &c->intersector) != STATUS_OK) fail("out of memory");
  c->preparing = clock_seconds(CLOCK_THREAD_CPUTIME_ID) - start;
  if (tracer_create(c->intersector, &c->tracer) != STATUS_OK) fail("out of memory");
}

/* ---- the rays ---- */

static void find_hits(struct tracer *tracer, const struct ray_list *list, struct hit hits[])
{
  for (size_t k = 0; k < list->packet_count; k++) {
    const struct ray_packet *packet = &list->packets[k];
    tracer_closest(tracer, packet->count, &list->rays[packet->first], &hits[packet->first]);
  }
}

/* In [0,1), by a generator with the constants of Knuth's MMIX. */
static double random_number(uint64_t *state)
{
  *state = *state * 6364136223846793005u + 1442695040888963407u;
  return (double)(*state >> 11) * 0x1p-53;
}

/* Replaces the rays; full packets stay full. */
static void scatter(const struct hit *hits, struct ray_list *list)
{
  double lo[3] = {INFINITY, INFINITY, INFINITY}, hi[3] = {-INFINITY, -INFINITY, -INFINITY};
  uint64_t state = 1;
  for (size_t k = 0; k < list->count; k++) {
    if (hits[k].patch == HIT_NONE) continue;
    for (int c = 0; c < 3; c++) lo[c] = real_min(lo[c], hits[k].point[c]), hi[c] = real_max(hi[c], hits[k].point[c]);
  }
  if (!(lo[0] <= hi[0])) fail("no camera ray hits anything");
  for (size_t k = 0; k < list->count; k++) {
    struct ray *ray = &list->rays[k];
    const double z = 2 * random_number(&state) - 1, angle = 8 * atan(1) * random_number(&state);
    const double direction[3] = {sqrt(1 - z * z) * cos(angle), sqrt(1 - z * z) * sin(angle), z};
    for (int c = 0; c < 3; c++) ray->origin[c] = lo[c] + random_number(&state) * (hi[c] - lo[c]);
    memcpy(ray->direction, direction, sizeof direction);
    ray->t_min = 0, ray->t_max = INFINITY;
  }
}

static struct ray_list make_rays(enum kind kind, const struct contestant *pscn, struct arena *arena)
{
  struct ray_list camera, shadows;
  if (rays_of_camera(pscn->scene, WIDTH, HEIGHT, WIDTH * HEIGHT, arena, &camera) != STATUS_OK) fail("out of memory");
  if (kind == CAMERA) return camera;
  struct hit *hits = arena_alloc(arena, camera.count, sizeof *hits);
  if (hits == NULL) fail("out of memory");
  find_hits(pscn->tracer, &camera, hits);
  if (kind == SHADOW) {
    if (rays_of_shadows(pscn->scene, pscn->tracer, &camera, hits, arena, &shadows) != STATUS_OK) fail("out of memory");
    if (shadows.count == 0) fail("there are no shadow rays");
    return shadows;
  }
  scatter(hits, &camera);
  return camera;
}

/* ---- the contest ---- */

static void trace(const struct contestant *c, const struct ray_list *list, bool any)
{
  struct hit hits[PACKET_SIZE];
  struct hit_list lists[PACKET_SIZE];
  bool occluded[PACKET_SIZE];
  for (size_t k = 0; k < list->packet_count; k++) {
    const struct ray_packet *packet = &list->packets[k];
    if (packet->new_run) tracer_forget(c->tracer);
    for (size_t first = 0; first < packet->count; first += c->width) {
      const size_t left = packet->count - first, count = left < c->width ? left : c->width;
      const struct ray *rays = &list->rays[packet->first + first];
      if (any) tracer_occluded(c->tracer, count, rays, occluded);
      else if (!c->all) tracer_closest(c->tracer, count, rays, hits);
      else if (tracer_all(c->tracer, count, rays, lists) != STATUS_OK) fail("out of memory");
    }
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

/* Which of Embree's packets were faster. */
static size_t fastest_packets(const struct contestant *list, size_t count, size_t runs)
{
  size_t best = 1;
  for (size_t c = 2; c < count && list[c].embree; c++)
    if (median_ratio(&list[c], &list[best], runs) < 1) best = c;
  return best;
}

static void report(struct contestant *list, size_t count, size_t pscn, size_t runs, size_t rays)
{
  const size_t to[3] = {0, fastest_packets(list, count, runs), pscn};
  double ratio[MAX_CONTESTANTS][3];
  for (size_t c = 0; c < count; c++)
    for (size_t k = 0; k < 3; k++) ratio[c][k] = median_ratio(&list[c], &list[to[k]], runs);
  printf("name\tns a ray\tsmallest\tlargest\tto Embree one by one\tto Embree's packets\tto pscn\n");
  for (size_t c = 0; c < count; c++) {
    const double unit = 1e9 / (double)rays, middle = median(list[c].seconds, runs) * unit;
    printf("%s\t%.1f\t%.1f\t%.1f\t%.3f\t%.3f\t%.3f\n", list[c].name, middle, list[c].seconds[0] * unit,
           list[c].seconds[runs - 1] * unit, ratio[c][0], ratio[c][1], ratio[c][2]);
  }
}

static const double (*nets_of(const struct scene *scene, struct arena *arena))[4][4][3]
{
  double(*P)[4][4][3] = arena_alloc(arena, scene->patch_count, sizeof *P);
  if (P == NULL) fail("out of memory");
  for (size_t n = 0; n < scene->patch_count; n++) memcpy(P[n], scene->patches[n].P, sizeof P[n]);
  return (const double(*)[4][4][3])P;
}

/* Embree's triangles; *seconds: the time of making them. */
static struct embree_mesh *make_mesh(const double (*P)[4][4][3], size_t patch_count, unsigned side, bool best,
                                     double *seconds)
{
  const double start = clock_seconds(CLOCK_THREAD_CPUTIME_ID);
  struct embree_mesh *mesh = pscn_embree_peer.mesh_create(P, patch_count, side, best);
  *seconds = clock_seconds(CLOCK_THREAD_CPUTIME_ID) - start;
  if (mesh == NULL) fail("Embree failed");
  return mesh;
}

int main(int argc, char **argv)
{
  static struct contestant list[MAX_CONTESTANTS];
  static const char *const names[2][3] = {{"rtcIntersect1", "rtcIntersect8", "rtcIntersect16"},
                                          {"rtcOccluded1", "rtcOccluded8", "rtcOccluded16"}};
  enum kind kind = CAMERA;
  while (argc > 1 && kind < KINDS && strcmp(argv[1], KIND_NAMES[kind]) != 0) kind++;
  if (argc < 3 || kind == KINDS) fail("which rays of which scene?");
  const size_t runs = argc > 3 ? strtoul(argv[3], NULL, 10) : 9;
  const unsigned side = argc > 4 ? (unsigned)strtoul(argv[4], NULL, 10) : 64;
  if (runs == 0 || runs > MAX_RUNS || side == 0) fail("bad numbers");
  const bool any = kind == SHADOW;

  struct contestant own = {0};
  contestant_load(&own, argv[2], NULL);
  struct arena *arena = arena_create();
  if (arena == NULL) fail("out of memory");
  const struct ray_list rays = make_rays(kind, &own, arena);
  const double(*nets)[4][4][3] = nets_of(own.scene, arena);
  const size_t patches = own.scene->patch_count;
  double default_seconds, best_seconds;
  pscn_embree_peer.mesh_destroy(make_mesh(nets, patches, side, false, &default_seconds));
  struct embree_mesh *mesh = make_mesh(nets, patches, side, true, &best_seconds);
  struct embree_rays *embree = pscn_embree_peer.rays_create(rays.rays, rays.count);
  if (embree == NULL) fail("out of memory");

  size_t count = 0;
  for (unsigned k = 0, width = 1; k < 3 && width <= pscn_embree_peer.widest(mesh); k++, width = 4u << k)
    list[count++] = (struct contestant){.name = names[any][k], .width = width, .embree = true};
  const size_t pscn = count;
  list[count++] = own;
  list[count] = own, list[count].name = "pscn, one by one", list[count++].width = 1;
  for (int k = 5; k < argc && count < MAX_CONTESTANTS; k++) contestant_load(&list[count++], argv[2], argv[k]);

  double sum = 0;
  for (size_t r = 0; r < runs; r++) {
    for (size_t c = 0; c < count; c++) {
      const double start = clock_seconds(CLOCK_THREAD_CPUTIME_ID);
      if (list[c].embree) sum += pscn_embree_peer.trace(mesh, embree, list[c].width, kind != SCATTERED, any);
      else trace(&list[c], &rays, any);
      list[c].seconds[r] = clock_seconds(CLOCK_THREAD_CPUTIME_ID) - start;
    }
  }
  fprintf(stderr, "%s, %zu %s rays, %zu triangles, %zu runs (Embree's answers add up to %.6g)\n", argv[2], rays.count,
          KIND_NAMES[kind], own.scene->patch_count * side * side * 2, runs, sum);
  report(list, count, pscn, runs, rays.count);
  printf("preparing, pscn\t%.4f\npreparing, Embree\t%.4f\t%.4f\n", own.preparing, default_seconds, best_seconds);
  pscn_embree_peer.rays_destroy(embree);
  pscn_embree_peer.mesh_destroy(mesh);
  arena_destroy(arena);
  for (size_t c = pscn; c < count; c++) {
    if (c == pscn + 1) continue; /* the same again */
    tracer_destroy(list[c].tracer);
    intersector_destroy(list[c].intersector);
    scene_destroy(list[c].scene);
  }
  return 0;
}

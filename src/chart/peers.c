/* The peers of a chart: rival methods, which are ours but prove nothing; Embree, by a module if that was built; and
 * POV-Ray, if installed. */
#include <dlfcn.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/module.h"
#include "base/sort.h"
#include "chart/embree_mesh.h"
#include "chart/rivals.h"
#include "chart/work.h"
#include "geometry/vector.h"

/* ---- rivals ---- */

static enum status ask_rivals(struct chart *chart)
{
  struct {
    const char *name, *label;
    rival_seek *seek;
  } ways[] = {{"Newton from the middle", "Newton", rival_newton},
              {"Bezier clipping", "clipping", rival_clipping},
              {"interval Newton with Krawczyk's test", "Krawczyk", rival_krawczyk},
              {"subdivision", "subdivision", rival_subdivision},
              {"companion matrix by dhseqr", "companion", NULL},
              {"Bezout's pencil by dggev", "pencil", NULL}};
  enum { WAYS = sizeof ways / sizeof ways[0], EIGEN = 4 };
  void *handle = module_open(RIVAL_MODULE_FILE, RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
  for (int k = EIGEN; handle != NULL && k < WAYS; k++)
    *(void **)&ways[k].seek = dlsym(handle, k == EIGEN ? RIVAL_COMPANION : RIVAL_PENCIL);
  if (handle == NULL)
    chart_note(chart, "Eigenvalues are left out: there is no %s, which is built if LAPACK is found.",
               RIVAL_MODULE_FILE);
  struct rivals *rivals = rivals_create(chart->scene, chart->rays);
  if (rivals == NULL) return STATUS_LIMIT;
  enum status status = STATUS_OK;
  for (int k = 0; k < WAYS && status == STATUS_OK; k++) {
    if (ways[k].seek == NULL) continue;
    listener_tell(chart->listener, TOLD_PROGRESS, "%s", ways[k].name);
    const struct runner runner = rivals_face(rivals, ways[k].seek);
    struct chart_point said = {.family = FAMILY_RIVAL};
    snprintf(said.name, sizeof said.name, "%s", ways[k].name);
    snprintf(said.label, sizeof said.label, "%s", ways[k].label);
    status = chart_measure(chart, 1, &runner, &said, NULL);
  }
  rivals_destroy(rivals);
  return status;
}

/* ---- Embree ---- */

static const unsigned WIDTHS[] = {1, 8, 16}; /* rays at once; the last if the processor has it */
enum { WIDTH_COUNT = sizeof WIDTHS / sizeof WIDTHS[0] };

struct embree {
  const struct embree_peer *peer;
  const struct ray_list *lists;
  struct embree_rays *rays[RAY_KINDS]; /* NULL if there are none of the kind */
};

struct embree_runner {
  const struct embree *embree;
  const struct embree_mesh *mesh;
  unsigned width;
  volatile double sink;
};

/* The answers are those to single rays. */
static void run_embree(void *context, enum ray_kind kind, struct answer *answers)
{
  struct embree_runner *runner = context;
  const struct embree *embree = runner->embree;
  const bool any = kind == RAYS_SHADOW;
  if (answers == NULL) runner->sink = embree->peer->trace(runner->mesh, embree->rays[kind], runner->width, true, any);
  for (size_t k = 0; answers != NULL && k < embree->lists[kind].count; k++)
    embree->peer->answer(runner->mesh, embree->rays[kind], k, any, &answers[k].t, &answers[k].patch);
}

/* Measures each mesh in turn with the yardstick. STATUS_FILE if Embree makes no mesh. */
static enum status measure_side(struct chart *chart, const struct embree *embree, const double (*nets)[4][4][3],
                                size_t side)
{
  struct embree_mesh *mesh = embree->peer->mesh_create(nets, chart->scene->patch_count, (unsigned)side, true);
  if (mesh == NULL) return STATUS_FILE;
  struct embree_runner own[WIDTH_COUNT];
  struct runner runners[WIDTH_COUNT];
  struct chart_point said[WIDTH_COUNT];
  const size_t widths = embree->peer->widest(mesh) == WIDTHS[WIDTH_COUNT - 1] ? WIDTH_COUNT : WIDTH_COUNT - 1;
  for (size_t w = 0; w < widths; w++) {
    char how[32] = "one by one";
    if (WIDTHS[w] > 1) snprintf(how, sizeof how, "%u coherent", WIDTHS[w]);
    own[w] = (struct embree_runner){.embree = embree, .mesh = mesh, .width = WIDTHS[w]};
    runners[w] = (struct runner){run_embree, &own[w]};
    said[w] = (struct chart_point){.family = FAMILY_EMBREE};
    snprintf(said[w].name, sizeof said[w].name, "Embree, %zux%zux2 triangles a patch, %s", side, side, how);
    if (WIDTHS[w] == 8) snprintf(said[w].label, sizeof said[w].label, "%zu", side);
  }
  const enum status status = chart_measure(chart, widths, runners, said, NULL);
  embree->peer->mesh_destroy(mesh);
  return status;
}

/* A mesh of more triangles is left out, because it would take more than a gigabyte. */
#define MAX_TRIANGLES 8e6

static double triangles(const struct chart *chart, size_t side)
{
  return 2.0 * (double)(side * side) * (double)chart->scene->patch_count;
}

static enum status measure_embree(struct chart *chart, const struct embree_peer *peer)
{
  static const size_t SIDES[] = {8, 16, 32, 64, 128, 256};
  enum { SIDE_COUNT = sizeof SIDES / sizeof SIDES[0] };
  struct embree embree = {.peer = peer, .lists = chart->rays};
  double(*nets)[4][4][3] = calloc(chart->scene->patch_count, sizeof *nets);
  enum status status = nets == NULL ? STATUS_LIMIT : STATUS_OK;
  for (size_t n = 0; status == STATUS_OK && n < chart->scene->patch_count; n++)
    memcpy(nets[n], chart->scene->patches[n].P, sizeof nets[n]);
  for (int kind = 0; status == STATUS_OK && kind < RAY_KINDS; kind++) {
    const struct ray_list *list = &chart->rays[kind];
    embree.rays[kind] = list->count == 0 ? NULL : peer->rays_create(list->rays, list->count);
    status = list->count > 0 && embree.rays[kind] == NULL ? STATUS_LIMIT : STATUS_OK;
  }
  for (size_t k = 0; status == STATUS_OK && k < SIDE_COUNT; k += chart->request->quick ? 2 : 1)
    if (k == 0 || triangles(chart, SIDES[k]) <= MAX_TRIANGLES)
      status = measure_side(chart, &embree, (const double(*)[4][4][3])nets, SIDES[k]);
  for (int kind = 0; kind < RAY_KINDS; kind++) peer->rays_destroy(embree.rays[kind]);
  free(nets);
  return status;
}

static enum status ask_embree(struct chart *chart)
{
  if (chart->scene->patch_count == 0) {
    chart_note(chart, "Embree is left out: the scene has no patch that could be cut into triangles.");
    return STATUS_OK;
  }
  /* It stays loaded, because Embree keeps threads of its own. */
  void *handle = module_open(EMBREE_MODULE_FILE, RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
  const struct embree_peer *peer = handle == NULL ? NULL : dlsym(handle, EMBREE_MODULE_SYMBOL);
  if (peer == NULL) {
    chart_note(chart, "Embree is left out: there is no %s, which is built if libembree-dev is found.",
               EMBREE_MODULE_FILE);
    return STATUS_OK;
  }
  listener_tell(chart->listener, TOLD_PROGRESS, "Embree");
  const enum status status = measure_embree(chart, peer);
  if (status == STATUS_OK)
    chart_note(chart, "Embree: each mesh in turn with pscn's default solver, one thread; its answers are those of "
                      "rtcIntersect1 and rtcOccluded1.");
  else if (status == STATUS_FILE) chart_note(chart, "Embree failed, and its missing points are left out.");
  return status == STATUS_FILE ? STATUS_OK : status;
}

/* ---- POV-Ray ---- */

/* The time of POV-Ray's pixels, without lights and textures, and of the yardstick after each run. */
static enum status time_povray(struct chart *chart, struct povray *povray, struct timing *out)
{
  const double pixels = (double)povray->width * (double)povray->height;
  const size_t rounds = chart->request->quick ? 1 : 3;
  double time[3], ratio[3];
  for (size_t k = 0; k < rounds; k++) {
    const struct runner runner = pscn_runner_face(&chart->yardstick);
    const size_t counts[RAY_KINDS] = {chart->rays[RAYS_CAMERA].count, 0};
    struct timing yard[1][RAY_KINDS];
    enum status status = povray_time(povray, chart->scene, &time[k]);
    if (status == STATUS_OK) status = measure_rounds(&runner, 1, counts, chart->rounds, chart->listener->stop, yard);
    if (status != STATUS_OK) return status;
    time[k] *= 1e9 / pixels;
    ratio[k] = time[k] / yard[0][RAYS_CAMERA].median;
  }
  sort_numbers(time, rounds);
  sort_numbers(ratio, rounds);
  const double middle = time[rounds / 2];
  *out = (struct timing){time[0],          (time[0] + middle) / 2, middle, (middle + time[rounds - 1]) / 2,
                         time[rounds - 1], ratio[rounds / 2]};
  return STATUS_OK;
}

static enum status ask_povray_once(struct chart *chart, struct povray *povray, int type, int steps)
{
  const struct ray_list *camera = &chart->rays[RAYS_CAMERA];
  for (size_t n = 0; n < chart->scene->patch_count; n++) {
    struct scene_patch *patch = &chart->scene->patches[n];
    patch->type = type, patch->u_steps = patch->v_steps = steps, patch->flatness = 0;
  }
  listener_tell(chart->listener, TOLD_PROGRESS, "POV-Ray: type %d, u_steps %d", type, steps);
  double *distance = malloc((camera->count + 1) * sizeof *distance);
  const struct timing unknown = {NAN, NAN, NAN, NAN, NAN, NAN};
  struct timing time[RAY_KINDS] = {unknown, unknown};
  enum status status = distance == NULL ? STATUS_LIMIT : STATUS_OK;
  if (status == STATUS_OK) status = povray_ask(povray, chart->scene, camera->count, camera->rays, distance, NULL);
  if (status == STATUS_OK) status = time_povray(chart, povray, &time[RAYS_CAMERA]);
  if (status == STATUS_OK) {
    struct chart_point said = {.family = FAMILY_POVRAY};
    snprintf(said.name, sizeof said.name, "POV-Ray, type %d, u_steps %d, flatness 0", type, steps);
    if (type == 1) snprintf(said.label, sizeof said.label, "%d", steps);
    for (size_t k = 0; k < camera->count; k++)
      chart->answers[k] = (struct answer){distance[k] / vector_length(camera->rays[k].direction), ANSWER_PATCH_UNKNOWN};
    (void)chart_add(chart, &said, time);
  }
  free(distance);
  return status;
}

static enum status ask_povray(struct chart *chart)
{
  struct povray povray = chart->request->povray;
  povray.listener = chart->listener;
  povray.width = chart->request->width;
  povray.height = chart->request->height;
  povray.optional = true;
  enum status status = povray_open(&povray);
  if (povray.missing)
    chart_note(chart, "POV-Ray is left out: there is no program '%s'.", chart->request->povray.program);
  for (int type = chart->request->quick ? 1 : 0; type <= 1; type++)
    for (int steps = 1; steps <= 7 && status == STATUS_OK; steps += chart->request->quick ? 3 : 1)
      status = ask_povray_once(chart, &povray, type, steps);
  if (status == STATUS_OK)
    chart_note(chart,
               "POV-Ray %s: errors from its trace(); the time is the CPU time of its trace phase for all "
               "%zux%zu pixels of the scene in white without lights, parsing apart.",
               povray.version, povray.width, povray.height);
  else if (status != STATUS_INTERRUPTED && !povray.missing)
    chart_note(chart, "POV-Ray failed, and its missing points are left out.");
  povray_close(&povray);
  return status == STATUS_INTERRUPTED ? status : STATUS_OK;
}

enum status chart_peers(struct chart *chart)
{
  enum status status = ask_rivals(chart);
  if (!chart->request->peers) {
    chart_note(chart, "Embree and POV-Ray are left out (--no-peers).");
    return status;
  }
  if (status == STATUS_OK) status = ask_embree(chart);
  if (status == STATUS_OK) status = ask_povray(chart);
  return status;
}

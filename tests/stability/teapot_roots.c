/* Aberth's method on ray-patch pairs of the teapot (whole patches), against all roots of the reference: how many of the
 * true (u,v) in [0,1]^2 it finds to 1e-11 with `polish off`, in Bernstein form; and that with `polish on` the nearest
 * hit is always right. The paper's own form is measured too, and printed. */
#include <limits.h>
#include <math.h>
#include <string.h>

#include "cmocka_test.h"
#include "effort.h"
#include "intersect/method.h"
#include "method_of.h"
#include "property/world.h"
#include "random.h"
#include "reference/reference.h"
#include "teapot.h"

enum { PAIRS = 100000, LEAST_PAIRS = 8000 };

/* Both parameters of a found root must be this near to the true one, absolute. */
#define FOUND_WITHIN 1e-11

/* The share of the true roots that must be found without polish. */
#define SHARE_UNPOLISHED 0.9998

/* Relative error of T with polish. */
#define POLISHED_WITHIN 1e-9

static const char plain_way[] = "aberth { polish off split 1 }", polished_way[] = "aberth { split 1 }",
                  paper_way[] = "aberth { form paper tolerance 1e-10 }";

static void open_patch(struct world *world, double P[4][4][3], const char *way)
{
  const struct method method = method_of(way);
  world_open(world, (world_net *)P, 1, &method);
}

/* The nets of the ray's planes for a net x in the patch's frame. */
static void ray_planes(const struct model_patch *patch, const struct ray *ray, const double x[3][16], double a[16],
                       double b[16])
{
  const double *d = ray->direction;
  const int k = dominant_axis(d);
  for (int s = 0; s < 2; s++) {
    const int i = (k + 1 + s) % 3;
    const quad slope = (quad)d[i] / d[k];
    const quad moment = ((quad)ray->origin[i] - patch->center[i] - slope * ((quad)ray->origin[k] - patch->center[k])) /
                        patch->scale;
    for (int c = 0; c < 16; c++) (s ? b : a)[c] = (double)(x[i][c] - moment - slope * x[k][c]);
  }
}

/* The roots that the patch's own method finds on the whole patch. */
static void find_roots(struct world *target, const struct ray *ray, struct method_roots *out)
{
  const struct model *model = target->tracer->model;
  const struct leaf *leaf = &model->leaves[0];
  struct leaf_form form;
  leaf_form_make(&model->patches[0], leaf, &form);
  struct method_planes planes = {.form = &form};
  ray_planes(&model->patches[0], ray, form.own ? leaf->x : form.x, planes.a, planes.b);
  method_find(model->patches[0].method, &planes, INT_MAX, NULL, out, NULL);
}

static bool among(const struct method_roots *found, const struct search_root *root)
{
  for (int k = 0; k < found->count; k++)
    if (fabs(found->u[k] - (double)root->u) <= FOUND_WITHIN && fabs(found->v[k] - (double)root->v) <= FOUND_WITHIN)
      return true;
  return false;
}

/* A ray from a point around the teapot through the box of the patch's control points. */
static void random_ray(struct random *random, const double P[4][4][3], struct ray *out)
{
  *out = (struct ray){.t_min = 0.0, .t_max = INFINITY};
  for (int k = 0; k < 3; k++) {
    double low = INFINITY, high = -INFINITY;
    for (int i = 0; i < 16; i++) {
      low = fmin(low, P[i / 4][i % 4][k]);
      high = fmax(high, P[i / 4][i % 4][k]);
    }
    out->origin[k] = random_between(random, -8.0, 8.0);
    out->direction[k] = random_between(random, low, high) - out->origin[k];
  }
}

static bool inside(const struct search_root *root)
{
  return root->u >= 0 && root->u <= 1 && root->v >= 0 && root->v <= 1;
}

TEST(roots_of_the_teapot)
{
  static double teapot[TEAPOT_PATCHES][4][4][3];
  const size_t pairs = effort_count(PAIRS, LEAST_PAIRS);
  struct random random = {3};
  size_t roots = 0, undecided = 0, found = 0, found_by_paper = 0, hits = 0, right = 0;
  teapot_read(teapot);
  for (int patch = 0; patch < TEAPOT_PATCHES; patch++) {
    struct world plain, paper, polished;
    open_patch(&plain, teapot[patch], plain_way), open_patch(&paper, teapot[patch], paper_way);
    open_patch(&polished, teapot[patch], polished_way);
    for (size_t pair = (size_t)patch; pair < pairs; pair += TEAPOT_PATCHES) {
      struct ray ray;
      random_ray(&random, teapot[patch], &ray);
      struct search_result exact;
      search_patch(teapot[patch], ray.origin, ray.direction, INFINITY, &exact);
      if (exact.undecided) {
        undecided++;
        continue;
      }
      struct method_roots candidates, paper_candidates;
      find_roots(&plain, &ray, &candidates);
      find_roots(&paper, &ray, &paper_candidates);
      double nearest = INFINITY;
      for (int k = 0; k < exact.count; k++) {
        if (inside(&exact.root[k])) {
          roots++;
          found += among(&candidates, &exact.root[k]);
          found_by_paper += among(&paper_candidates, &exact.root[k]);
          nearest = exact.root[k].t > 0 ? fmin(nearest, (double)exact.root[k].t) : nearest;
        }
      }
      struct hit hit;
      tracer_closest(polished.tracer, 1, &ray, &hit);
      if (nearest < INFINITY) {
        hits++;
        right += hit.patch == 0 && fabs(hit.t - nearest) <= POLISHED_WITHIN * nearest;
      } else {
        right += hit.patch != HIT_NONE && hit.certainty == CERTAINTY_CERTAIN ? (size_t)-1 : 0; /* invented */
      }
    }
    world_close(&plain), world_close(&paper), world_close(&polished);
  }
  print_message("%zu pairs (%zu undecided), %zu roots; to 1e-11: aberth unpolished %.5f %%, the paper's form %.3f %%; "
                "polished: %zu of %zu nearest hits\n",
                pairs, undecided, roots, 100.0 * (double)found / (double)roots,
                100.0 * (double)found_by_paper / (double)roots, right, hits);
  assert_true(roots > pairs / 10);
  assert_true((double)found >= SHARE_UNPOLISHED * (double)roots);
  assert_int_equal(right, hits);
}

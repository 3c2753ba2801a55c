/* Why the paper's methods lose hits: every hit that Newton's, Laguerre's or Aberth's method loses in the paper's form
 * gets one cause, on rays of several classes, with the patches as they are and with u and v exchanged. Prints CSV.
 *
 * The truth is the default's answer where it is certain. What is lost is put down to the first of these that holds:
 *
 * lower      r's degree is less than 18: its leading coefficients are roundings
 * far        the same method finds the hit if far roots no longer spoil near ones: `deflation composite`, or `radii
 *            polygon`, which starts at the small roots
 * tangent    another root of r is near in u, and its point is near in v, too: a true tangency
 * projected  another root of r is near in u, but that of a point with another v, often outside the patch
 * rounding   the method finds the hit if r is written in Bernstein form, where its coefficients have smaller errors
 * euclid     the method finds the hit if v is the null vector's
 * loose      the method finds the hit with eps = 1e-12
 * other
 *
 * `causes projected` prints only where the hits lost in the paper's pictures lie: at a
 * tangency, or where only the projection onto u makes a double root, whatever else spoils them. `causes conditions`
 * prints, hit by hit, condition numbers and errors of u (conditions_of). */
#include <complex.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "accuracy/generate.h"
#include "base/diagnostics.h"
#include "effort.h"
#include "geometry/patch.h"
#include "geometry/vector.h"
#include "intersect/local_ray.h"
#include "intersect/method.h"
#include "language/language.h"
#include "method_of.h"
#include "property/world.h"
#include "reference/quad.h"
#include "render/camera.h"

#define BEZOUT_REAL quad
#define BEZOUT_NAME(name) bezout_quad_##name
#include "algebra/bezout.h"

enum { DEGREE = 18, FULL_NETS = 50, LEAST_NETS = 2, METHODS = 3, WAYS = 6 };

/* Roots nearer than this in u are near: of 18 roots evenly in [0,1], each is 0.06 from the next. */
#define NEAR_U 0.03
#define NEAR_V 0.1

/* A hit farther off than this, relative, is lost (as in src/chart/judge.h). */
#define WRONG 1e-2

static const char *const METHOD[METHODS] = {"newton", "laguerre", "aberth"};
static const char *const WAY[WAYS] = {
  "", "deflation composite", "radii polygon", "basis bernstein", "back_substitution null_vector", "tolerance 1e-12"};

enum { RAYS = 32 }; /* at a patch */

typedef double net4[4][4][3];

/* ---- classes of patches, and of rays at them, as pictures have them ---- */

static void aim(struct random *random, net4 P, struct ray *out)
{
  double net[3][4][4], from[3], to[3];
  const double u = random_unit(random), v = random_unit(random);
  for (int n = 0; n < 48; n++) net[n % 3][n / 12][n / 3 % 4] = P[n / 12][n / 3 % 4][n % 3];
  for (int k = 0; k < 3; k++) to[k] = patch_evaluate(net[k], u, v).value, from[k] = random_between(random, -6, 6);
  ray_between(from, to, out);
}

/* Within 7 degrees of the axis of a height field. */
static void field(struct random *random, net4 P, struct ray rays[RAYS])
{
  for (int n = 0; n < 16; n++) {
    const double at[3] = {n / 4, n % 4, random_between(random, -1, 1)};
    memcpy(P[n / 4][n % 4], at, sizeof at);
  }
  for (int n = 0; n < RAYS; n++) {
    double from[3] = {0, 0, -8}, to[3] = {random_between(random, 0, 3), random_between(random, 0, 3), 0};
    for (int k = 0; k < 2; k++) from[k] = to[k] + random_between(random, -0.7, 0.7);
    ray_between(from, to, &rays[n]);
  }
}

/* A profile turned a quarter of a circle about the z axis. */
static void revolution(struct random *random, net4 P, struct ray rays[RAYS])
{
  static const double turn[4][2] = {{1, 0}, {1, 0.5522847498307936}, {0.5522847498307936, 1}, {0, 1}};
  for (int i = 0; i < 4; i++) {
    const double radius = random_between(random, 0.3, 2), z = i - 1.5 + random_between(random, -0.4, 0.4);
    for (int j = 0; j < 4; j++) P[i][j][0] = radius * turn[j][0], P[i][j][1] = radius * turn[j][1], P[i][j][2] = z;
  }
  for (int n = 0; n < RAYS; n++) aim(random, P, &rays[n]);
}

/* A skin as modellers make it: a section that is moved, turned and scaled along a path. */
static void skin(struct random *random, net4 P, struct ray rays[RAYS])
{
  double section[4][2];
  for (int j = 0; j < 4; j++) section[j][0] = j - 1.5, section[j][1] = random_between(random, -0.6, 0.6);
  for (int i = 0; i < 4; i++) {
    const double angle = random_between(random, -0.3, 0.3), size = random_between(random, 0.7, 1.3);
    for (int j = 0; j < 4; j++) {
      P[i][j][0] = size * (cos(angle) * section[j][0] - sin(angle) * section[j][1]);
      P[i][j][1] = i - 1.5;
      P[i][j][2] = size * (sin(angle) * section[j][0] + cos(angle) * section[j][1]) + random_between(random, -0.1, 0.1);
    }
  }
  for (int n = 0; n < RAYS; n++) aim(random, P, &rays[n]);
}

static void wild(struct random *random, net4 P, struct ray rays[RAYS])
{
  for (int n = 0; n < 48; n++) P[n / 12][n / 3 % 4][n % 3] = random_between(random, -2, 2);
  for (int n = 0; n < RAYS; n++) aim(random, P, &rays[n]);
}

/* Row 0 is one point. */
static void collapsed(struct random *random, net4 P, struct ray rays[RAYS])
{
  wild(random, P, rays);
  for (int j = 1; j < 4; j++) memcpy(P[0][j], P[0][0], sizeof P[0][0]);
  for (int n = 0; n < RAYS; n++) aim(random, P, &rays[n]);
}

/* In the tangent plane of a wild patch at a point, but for 1 to 10^-4. */
static void tangential(struct random *random, net4 P, struct ray rays[RAYS])
{
  wild(random, P, rays);
  double net[3][4][4];
  for (int n = 0; n < 48; n++) net[n % 3][n / 12][n / 3 % 4] = P[n / 12][n / 3 % 4][n % 3];
  for (int n = 0; n < RAYS; n++) {
    const double u = random_unit(random), v = random_unit(random), a = random_between(random, -1, 1),
                 b = random_between(random, -1, 1), off = pow(10, random_between(random, -4, 0));
    double to[3], from[3];
    for (int k = 0; k < 3; k++) {
      const struct patch_jet at = patch_evaluate(net[k], u, v);
      to[k] = at.value;
      from[k] = at.value + a * at.du + b * at.dv + off * random_between(random, -1, 1);
    }
    ray_between(from, to, &rays[n]);
  }
}

static const struct net_class {
  const char *name;
  void (*make)(struct random *random, net4 P, struct ray rays[RAYS]);
} CLASSES[] = {
  {"height field near its axis", field}, {"surface of revolution", revolution}, {"skin", skin}, {"random", wild},
  {"collapsed edge", collapsed},         {"near tangent", tangential}};

enum { NET_FIELD = 0, NET_RANDOM = 3, NETS = sizeof CLASSES / sizeof CLASSES[0] };

enum cause { LOWER, FAR, TANGENT, PROJECTED, ROUNDING, EUCLID, LOOSE, OTHER, CAUSES };

/* ---- the truth ---- */

/* The kept parameter and the other one of a hit, and r in powers of the kept one, in quadruple precision. */
struct algebra {
  quad kept, other, c[DEGREE + 1];
  quad a[16], b[16]; /* Bernstein nets, a[4 * i + j] with i of the kept parameter */
};

static void quad_to_power(quad *b, int stride)
{
  const quad b0 = b[0], b1 = b[stride], b2 = b[2 * stride], b3 = b[3 * stride];
  b[stride] = 3 * (b1 - b0), b[2 * stride] = 3 * (b2 - 2 * b1 + b0), b[3 * stride] = b3 - 3 * (b2 - b1) - b0;
}

static void algebra_of(net4 P, const struct ray *ray, bool v_kept, double u, double v, struct algebra *out)
{
  const double *d = ray->direction;
  const int axis = fabs(d[0]) < fabs(d[1]) ? (fabs(d[0]) < fabs(d[2]) ? 0 : 2) : fabs(d[1]) < fabs(d[2]) ? 1 : 2;
  double e[3] = {0}, first[3], second[3];
  e[axis] = 1;
  vector_cross(d, e, first), vector_cross(d, first, second);
  struct quad_net nets[2];
  for (int n = 0; n < 16; n++) {
    const int i = n / 4, j = n % 4;
    quad a = 0, b = 0;
    for (int k = 0; k < 3; k++) {
      const quad from = (quad)P[i][j][k] - ray->origin[k];
      a += from * first[k], b += from * second[k];
    }
    const int at = v_kept ? 4 * j + i : n;
    out->a[at] = a, out->b[at] = b;
    nets[0].c[at / 4][at % 4] = a, nets[1].c[at / 4][at % 4] = b;
  }
  out->kept = v_kept ? v : u, out->other = v_kept ? u : v;
  for (int step = 0; step < 3; step++) { /* a hit's double values, to all digits */
    const struct quad_jet f = quad_net_jet(&nets[0], out->kept, out->other),
                          g = quad_net_jet(&nets[1], out->kept, out->other);
    const quad det = f.du * g.dv - f.dv * g.du;
    if (det == 0) break;
    out->kept -= (f.value * g.dv - g.value * f.dv) / det, out->other -= (g.value * f.du - f.value * g.du) / det;
  }
  quad A[16], B[16];
  memcpy(A, out->a, sizeof A), memcpy(B, out->b, sizeof B);
  for (int i = 0; i < 4; i++) quad_to_power(A + 4 * i, 1), quad_to_power(B + 4 * i, 1);
  for (int j = 0; j < 4; j++) quad_to_power(A + j, 4), quad_to_power(B + j, 4);
  bezout_quad_determinant(3, 3, A, B, out->c);
}

/* Taylor coefficients of r at the hit, scaled to a largest coefficient of r of 1. */
static void taylor_at(const struct algebra *algebra, double out[DEGREE + 1])
{
  quad q[DEGREE + 1], largest = 0;
  for (int k = 0; k <= DEGREE; k++) q[k] = algebra->c[k], largest = quad_max(largest, quad_abs(q[k]));
  for (int j = 0; j <= DEGREE; j++)
    for (int k = DEGREE - 1; k >= j; k--) q[k] += q[k + 1] * algebra->kept;
  for (int k = 0; k <= DEGREE; k++) out[k] = largest > 0 ? (double)(q[k] / largest) : 0;
}

/* The root of r nearest to the hit's, as its distance: from the smaller root of the quadratic part on. */
static double complex nearest_other(const double q[DEGREE + 1])
{
  const double complex root = csqrt(q[2] * q[2] - 4 * q[1] * q[3]);
  const double complex sum = cabs(-q[2] + root) > cabs(-q[2] - root) ? -q[2] + root : -q[2] - root;
  double complex x = 2 * q[1] / sum;
  for (int step = 0; step < 20; step++) {
    double complex value = 0, slope = 0;
    for (int k = DEGREE; k >= 1; k--) slope = slope * x + value, value = value * x + q[k];
    if (value == 0) break;
    x -= value / slope;
  }
  return x;
}

static double other_at(const struct algebra *algebra, double kept)
{
  quad p[4] = {0}, q[4] = {0}, num[2], den[2], better;
  const quad t = kept, s = 1 - t, w[4] = {s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t};
  for (int n = 0; n < 16; n++) p[n % 4] += w[n / 4] * algebra->a[n], q[n % 4] += w[n / 4] * algebra->b[n];
  bezout_quad_null_vector(3, p, q, num, den, &better);
  return (double)(better > 0 ? num[0] / den[0] : num[1] / den[1]);
}

/* A coefficient below this part of the largest is none. */
#define NO_COEFFICIENT 0x1p-40

static enum cause geometric(const struct algebra *algebra)
{
  quad largest = 0;
  double q[DEGREE + 1];
  for (int k = 0; k <= DEGREE; k++) largest = quad_max(largest, quad_abs(algebra->c[k]));
  if (quad_abs(algebra->c[DEGREE]) <= NO_COEFFICIENT * largest) return LOWER;
  taylor_at(algebra, q);
  const double complex gap = nearest_other(q);
  if (!(cabs(gap) <= NEAR_U)) return OTHER;
  const double kept = (double)algebra->kept + creal(gap);
  return fabs(other_at(algebra, kept) - (double)algebra->other) <= NEAR_V ? TANGENT : PROJECTED;
}

/* ---- counts ---- */

struct counts {
  size_t rays, hits, lost, invented, cause[CAUSES], geometry[CAUSES];
};

static bool finds(struct world *target, const struct ray *ray, const struct hit *truth)
{
  struct hit hit;
  tracer_closest(target->tracer, 1, ray, &hit);
  return hit.patch != HIT_NONE && (truth->patch == HIT_NONE || fabs(hit.t - truth->t) <= WRONG * truth->t);
}

/* The rays against the patch, by the first `ways` ways of all methods, in their order (with `start previous` that
 * matters). */
static void count_rays(net4 P, size_t count, const struct ray rays[], const char *items, int ways,
                       struct counts out[METHODS])
{
  static struct world truth, target[METHODS][WAYS];
  world_open(&truth, (world_net *)P, 1, NULL);
  for (int m = 0; m < METHODS; m++)
    for (int w = 0; w < ways; w++) {
      char text[200];
      snprintf(text, sizeof text, "%s { form paper max_iterations 500 %s %s }", METHOD[m], items, WAY[w]);
      const struct method method = method_of(text);
      world_open(&target[m][w], (world_net *)P, 1, &method);
    }
  for (size_t n = 0; n < count; n++) {
    struct hit hit;
    tracer_closest(truth.tracer, 1, &rays[n], &hit);
    const bool certain = hit.certainty == CERTAINTY_CERTAIN;
    struct algebra algebra;
    enum cause geometry = CAUSES;
    for (int m = 0; m < METHODS; m++) {
      bool found[WAYS] = {false};
      for (int w = 0; w < ways; w++) found[w] = finds(&target[m][w], &rays[n], &hit);
      if (!certain) continue;
      out[m].rays++, out[m].hits += hit.patch != HIT_NONE;
      if (hit.patch == HIT_NONE) out[m].invented += found[0];
      if (hit.patch == HIT_NONE || found[0]) continue;
      out[m].lost++;
      if (geometry == CAUSES) {
        const struct model *model = target[m][0].tracer->model;
        struct leaf_form form;
        leaf_form_make(&model->patches[0], &model->leaves[0], &form);
        algebra_of(P, &rays[n], form.v_kept, hit.u, hit.v, &algebra);
        geometry = geometric(&algebra);
      }
      const enum cause cause = geometry == LOWER                 ? LOWER
                               : m < 2 && (found[1] || found[2]) ? FAR
                               : geometry != OTHER               ? geometry
                               : found[3]                        ? ROUNDING
                               : found[4]                        ? EUCLID
                               : found[5]                        ? LOOSE
                                                                 : OTHER;
      out[m].cause[cause]++, out[m].geometry[geometry]++;
    }
  }
  world_close(&truth);
  for (int m = 0; m < METHODS; m++)
    for (int w = 0; w < ways; w++) world_close(&target[m][w]);
}

/* Wilson's interval of 95 % for a share. */
static void interval(size_t part, size_t whole, double out[2])
{
  const double z = 1.96, n = (double)whole, p = (double)part / n,
               half = z * sqrt(p * (1 - p) / n + z * z / (4 * n * n));
  for (int k = 0; k < 2; k++) out[k] = (p + z * z / (2 * n) + (k ? half : -half)) / (1 + z * z / n);
}

static void print_counts(const char *name, bool exchanged, const struct counts counts[METHODS])
{
  for (int m = 0; m < METHODS; m++) {
    const struct counts *c = &counts[m];
    double range[2];
    interval(c->lost, c->hits > 0 ? c->hits : 1, range);
    printf("%s,%s,%s,%zu,%zu,%zu,%zu,%.3g,%.3g", name, exchanged ? "exchanged" : "plain", METHOD[m], c->rays, c->hits,
           c->invented, c->lost, fmax(range[0], 0), range[1]);
    for (int k = 0; k < CAUSES; k++) printf(",%zu", c->cause[k]);
    printf("\n");
  }
}

static void print_geometry(const char *name, const struct counts counts[METHODS])
{
  for (int m = 0; m < METHODS; m++)
    printf("%s,%s,%zu,%zu,%zu\n", name, METHOD[m], counts[m].lost, counts[m].geometry[TANGENT],
           counts[m].geometry[PROJECTED]);
}

/* ---- the paper's pictures ---- */

/* The camera rays of a scene of one patch, line by line; all causes, or only where lost hits lie. */
static bool count_picture(const char *name, const char *file, const char *items, bool exchanged, bool causes)
{
  enum { WIDTH = 320, HEIGHT = 240 };
  const int side = !causes || effort_fraction() >= 0.5 ? 1 : 8;
  static struct ray rays[WIDTH * HEIGHT];
  char path[400];
  snprintf(path, sizeof path, "%s/scenes/%s", PSCN_SOURCE_DIR, file);
  const struct language_settings settings = {.image_width = WIDTH, .image_height = HEIGHT, .tolerance = NAN};
  struct diagnostics diagnostics = {0};
  struct scene *scene = NULL;
  if (language_load(path, &settings, &diagnostics, &scene) != STATUS_OK) return false;
  const size_t width = (size_t)(WIDTH / side), count = width * (size_t)(HEIGHT / side);
  for (size_t p = 0; p < count; p++)
    camera_ray(&scene->camera, ((double)(p % width) + 0.5) / (double)width,
               ((double)(p / width) + 0.5) / (double)(HEIGHT / side), &rays[p]);
  struct counts counts[METHODS] = {0};
  net4 P;
  memcpy(P, scene->patches[0].P, sizeof P);
  if (exchanged) transpose(P);
  count_rays(P, count, rays, items, causes ? WAYS : 1, counts);
  if (causes) print_counts(name, exchanged, counts);
  else print_geometry(name, counts);
  /* What the page says of Fig 17, with the parameters in either order: Newton's method loses many hits, nearly all to
   * far roots, and Aberth's next to none. */
  const bool facts = !causes || strcmp(name, "Fig 17") != 0 ||
                     (counts[2].lost * 20 < counts[0].lost && counts[0].lost > 0 &&
                      counts[0].cause[FAR] * 10 > counts[0].lost * 9);
  scene_destroy(scene);
  return facts;
}

/* ---- condition numbers ---- */

/* For a hit: by how much relative errors of 2^-53 in the coefficients move u, as a root of r in powers (the sum of
 * |c_k u^k| over |r'|), as a root of r in Bernstein form (the same with its terms), and as a common root of a and b; and
 * the errors of u by Aberth's method in the paper's form, by the same in Bernstein form, and with polish. */
static void conditions_of(net4 P, const struct ray *ray, struct world target[3])
{
  struct hit hit[3];
  for (int k = 0; k < 3; k++) tracer_closest(target[k].tracer, 1, ray, &hit[k]);
  if (hit[2].patch == HIT_NONE || hit[2].certainty != CERTAINTY_CERTAIN) return;
  for (int k = 0; k < 2; k++)
    if (hit[k].patch == HIT_NONE || fabs(hit[k].t - hit[2].t) > WRONG * hit[2].t) return;
  const struct model *model = target[0].tracer->model;
  struct leaf_form form;
  leaf_form_make(&model->patches[0], &model->leaves[0], &form);
  struct algebra algebra;
  algebra_of(P, ray, form.v_kept, hit[2].u, hit[2].v, &algebra);
  quad scaled[16], other[16], c[DEGREE + 1], sum[2] = {0}, slope = 0, power = 1;
  for (int n = 0; n < 16; n++) {
    const double choose = bezout_quad_binomial(3, n / 4) * bezout_quad_binomial(3, n % 4);
    scaled[n] = choose * algebra.a[n], other[n] = choose * algebra.b[n];
  }
  bezout_quad_determinant(3, 3, scaled, other, c);
  const quad u = algebra.kept;
  for (int k = 0; k <= DEGREE; k++) {
    quad term = quad_abs(c[k]);
    for (int i = 0; i < DEGREE; i++) term *= i < k ? u : 1 - u;
    sum[0] += quad_abs(algebra.c[k]) * power, sum[1] += quad_abs(term), power *= quad_abs(u);
  }
  for (int k = DEGREE; k >= 1; k--) slope = slope * u + k * algebra.c[k];
  struct quad_net nets[2];
  for (int n = 0; n < 16; n++) nets[0].c[n / 4][n % 4] = algebra.a[n], nets[1].c[n / 4][n % 4] = algebra.b[n];
  const struct quad_jet f = quad_net_jet(&nets[0], u, algebra.other), g = quad_net_jet(&nets[1], u, algebra.other);
  const quad det = f.du * g.dv - f.dv * g.du;
  const quad both = (quad_net_magnitude(&nets[0]) * quad_abs(g.dv) + quad_net_magnitude(&nets[1]) * quad_abs(f.dv)) /
                    det;
  printf("%.3g,%.3g,%.3g", (double)(sum[0] / quad_abs(slope)), (double)(sum[1] / quad_abs(slope)),
         (double)quad_abs(both));
  for (int k = 0; k < 3; k++) printf(",%.3g", (double)quad_abs((form.v_kept ? hit[k].v : hit[k].u) - u));
  printf("\n");
}

static void conditions(void)
{
  static const char *const ways[3] = {"aberth { form paper tolerance 1e-12 max_iterations 500 }",
                                      "aberth { polish off split 1 tolerance 1e-15 }", "bernstein { split 1 }"};
  struct random random = {.state = 41};
  printf("power,bernstein,both,paper error,bernstein error,polished error\n");
  for (int index = 0; index < 20; index++) {
    net4 P;
    struct ray rays[RAYS];
    static struct world target[3];
    CLASSES[NET_RANDOM].make(&random, P, rays);
    for (int k = 0; k < 3; k++) {
      const struct method method = method_of(ways[k]);
      world_open(&target[k], (world_net *)P, 1, &method);
    }
    for (int n = 0; n < RAYS; n++) conditions_of(P, &rays[n], target);
    for (int k = 0; k < 3; k++) world_close(&target[k]);
  }
}

static bool pictures(bool exchanged, bool causes)
{
  return count_picture("Fig 16", "paper.pscn", "start previous tolerance 1e-2", exchanged, causes) &
         count_picture("Fig 17", "paper_magnified.pscn", "start previous tolerance 1e-10", exchanged, causes);
}

int main(int argc, char **argv)
{
  if (argc > 1 && strcmp(argv[1], "conditions") == 0) return conditions(), EXIT_SUCCESS;
  if (argc > 1 && strcmp(argv[1], "projected") == 0) {
    printf("class,method,lost,tangent,projected\n");
    return pictures(false, false) ? EXIT_SUCCESS : EXIT_FAILURE;
  }
  bool good = true;
  printf("class,parameters,method,rays,hits,invented,lost,low,high,lower,far,tangent,projected,rounding,euclid,loose,"
         "other\n");
  for (int exchanged = 0; exchanged < 2; exchanged++) good &= pictures(exchanged, true);
  const size_t nets = effort_count(FULL_NETS, LEAST_NETS);
  for (size_t k = 0; k < NETS; k++)
    for (int exchanged = 0; exchanged < 2; exchanged++) {
      struct random random = {.state = 7 + k};
      struct counts counts[METHODS] = {0};
      for (size_t index = 0; index < nets; index++) {
        net4 P;
        struct ray rays[RAYS];
        CLASSES[k].make(&random, P, rays);
        if (exchanged) transpose(P);
        count_rays(P, RAYS, rays, "tolerance 1e-10", WAYS, counts);
      }
      print_counts(CLASSES[k].name, exchanged, counts);
      /* Along the axis of a height field r has degree 12, and the roots of its other coefficients' roundings come
       * first: Laguerre's method finds nothing. */
      if (k == NET_FIELD) good &= counts[1].lost * 10 > counts[1].hits * 9 && counts[2].lost * 20 < counts[2].hits;
    }
  return good ? EXIT_SUCCESS : EXIT_FAILURE;
}

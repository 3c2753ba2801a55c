/* The price of a certificate: time a ray and error against the distance to the nearest tangency. CSV on standard
 * output.
 *
 *     tangency SCENE
 *
 * Rays through the middle part of the scene's first patch, each moved along the normal from where it touches, by 1 down
 * to 1e-15 scene units, to the side where it meets the patch twice nearby. For every solver with and without polish:
 * CPU time a ray, the median of rounds in which all take turns; the relative error of T, against the reference
 * (quadruple precision, proven), of the answers that are the reference's hit; the shares of its hits that are lost
 * (missed, or taken for another), and of the answers called grazing. Rays that the reference leaves open are left out.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/clock.h"
#include "geometry/vector.h"
#include "intersect/intersect.h"
#include "language/language.h"
#include "measure.h"
#include "reference/reference.h"

enum { RAYS = 400, ROUNDS = 3, LAST_DIGIT = 15, MOST_WAYS = 16 };

/* Two distances nearer than this, relative, are one hit: rounding the input moves a tangent ray's hits by
 * sqrt(1e-16). */
#define SAME_HIT 1e-6

/* How far before the tangency rays start. */
#define START 10.0

/* If the surface bends less than this along the ray, 1/radius, it is hardly tangent in one point. */
#define LEAST_BEND 0.1

/* A solver, with or without polish. */
struct way {
  const char *name;
  struct scene *scene;
  struct intersector *intersector;
  struct tracer *tracer;
  bool polish;
  double seconds[ROUNDS];
};

static void tell(void *context, const char *text, size_t length)
{
  (void)context;
  fwrite(text, 1, length, stderr);
}

static bool way_create(const char *scene, const struct solver *solver, bool polish, struct way *out)
{
  struct diagnostics diagnostics = {.tell = tell};
  *out = (struct way){.name = solver->name, .polish = polish};
  char text[64];
  snprintf(text, sizeof text, "%s { polish %s }", solver->name, polish ? "on" : "off");
  const struct language_settings settings = {
    .image_width = 100, .image_height = 100, .solver_text = text, .tolerance = NAN};
  return language_load(scene, &settings, &diagnostics, &out->scene) == STATUS_OK &&
         intersector_create(out->scene, &out->intersector) == STATUS_OK &&
         tracer_create(out->intersector, &out->tracer) == STATUS_OK;
}

/* Point and derivatives of a bicubic patch: [0] S, [1] Su, [2] Sv, [3] Suu, [4] Suv, [5] Svv. */
static void patch_jet(const double P[4][4][3], double u, double v, double out[6][3])
{
  double w[2][3][4];
  for (int k = 0; k < 2; k++) {
    const double t = k == 0 ? u : v, s = 1 - t;
    const double value[4] = {s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t};
    const double first[4] = {-3 * s * s, 3 * s * (s - 2 * t), 3 * t * (2 * s - t), 3 * t * t};
    const double second[4] = {6 * s, 6 * (t - 2 * s), 6 * (s - 2 * t), 6 * t};
    for (int n = 0; n < 4; n++) w[k][0][n] = value[n], w[k][1][n] = first[n], w[k][2][n] = second[n];
  }
  static const int orders[6][2] = {{0, 0}, {1, 0}, {0, 1}, {2, 0}, {1, 1}, {0, 2}};
  for (int d = 0; d < 6; d++)
    for (int c = 0; c < 3; c++) {
      out[d][c] = 0;
      for (int n = 0; n < 16; n++)
        out[d][c] += w[0][orders[d][0]][n / 4] * w[1][orders[d][1]][n % 4] * P[n / 4][n % 4][c];
    }
}

/* A ray that passes a tangency at `distance`. */
static void draw_ray(uint64_t *seed, const double P[4][4][3], double distance, struct ray *out)
{
  for (;;) {
    double jet[6][3], along[3], normal[3], bend[3];
    patch_jet(P, 0.2 + 0.6 * measure_random(seed), 0.2 + 0.6 * measure_random(seed), jet);
    const double angle = 2 * acos(-1.0) * measure_random(seed), du = cos(angle), dv = sin(angle);
    for (int c = 0; c < 3; c++) {
      along[c] = du * jet[1][c] + dv * jet[2][c];
      bend[c] = du * du * jet[3][c] + 2 * du * dv * jet[4][c] + dv * dv * jet[5][c];
    }
    vector_cross(jet[1], jet[2], normal);
    vector_scale(1 / vector_length(normal), normal, normal);
    const double curve = vector_dot(bend, normal) / vector_dot(along, along);
    if (!(fabs(curve) > LEAST_BEND)) continue;
    vector_scale(1 / vector_length(along), along, along);
    vector_add_scaled(jet[0], copysign(distance, curve), normal, out->origin);
    vector_add_scaled(out->origin, -START, along, out->origin);
    for (int c = 0; c < 3; c++) out->direction[c] = along[c];
    out->t_min = 0, out->t_max = INFINITY;
    return;
  }
}

static void trace_all(struct way *way, const struct ray rays[RAYS], struct hit out[RAYS])
{
  for (size_t k = 0; k < RAYS; k += PACKET_SIZE)
    tracer_closest(way->tracer, RAYS - k < PACKET_SIZE ? RAYS - k : PACKET_SIZE, rays + k, out + k);
}

/* A row for a way. */
static void print_row(int digits, struct way *way, const struct hit hits[RAYS],
                      const struct reference_answer right[RAYS])
{
  double error[RAYS], last = 0;
  size_t same = 0, proven = 0, lost = 0, grazing = 0;
  for (size_t k = 0; k < RAYS; k++) {
    grazing += hits[k].certainty == CERTAINTY_GRAZING;
    if (right[k].verdict != REFERENCE_HIT) continue;
    const double t = (double)right[k].t, off = hits[k].patch == HIT_NONE ? INFINITY : fabs(hits[k].t - t) / t;
    proven++, lost += !(off <= SAME_HIT);
    if (off <= SAME_HIT) error[same++] = off, last = fmax(last, off);
  }
  const double all = (double)(proven > 0 ? proven : 1);
  printf("1e-%d,%s,%s,%.3f,%.2g,%.2g,%.4f,%.4f,%zu\n", digits, way->name, way->polish ? "on" : "off",
         measure_median(ROUNDS, way->seconds) * 1e6, same > 0 ? measure_median(same, error) : 0, last,
         (double)lost / all, (double)grazing / RAYS, proven);
}

int main(int argc, char **argv)
{
  static struct way ways[MOST_WAYS];
  static struct ray rays[RAYS];
  static struct hit hits[RAYS];
  static struct reference_answer right[RAYS];
  size_t count = 0;
  if (argc != 2) {
    fputs("usage: tangency SCENE\n", stderr);
    return 2;
  }
  for (size_t s = 0; s < solver_count() && count + 2 <= MOST_WAYS; s++)
    for (int polish = 1; polish >= 0; polish--)
      if (!way_create(argv[1], solver_at(s), polish != 0, &ways[count++])) return 3;
  const struct scene_patch *patch = &ways[0].scene->patches[0];
  struct reference *reference = reference_create(&patch->P, 1);
  if (reference == NULL) return 5;
  printf("distance,method,polish,us_ray,error,largest,lost,grazing,hits\n");
  for (int digits = 0; digits <= LAST_DIGIT; digits++) {
    uint64_t seed = 17;
    for (size_t k = 0; k < RAYS; k++) {
      draw_ray(&seed, patch->P, pow(10, -digits), &rays[k]);
      reference_closest(reference, rays[k].origin, rays[k].direction, &right[k]);
    }
    for (int round = 0; round < ROUNDS; round++)
      for (size_t w = 0; w < count; w++) {
        const double start = clock_seconds(CLOCK_THREAD_CPUTIME_ID);
        trace_all(&ways[w], rays, hits);
        ways[w].seconds[round] = (clock_seconds(CLOCK_THREAD_CPUTIME_ID) - start) / RAYS;
      }
    for (size_t w = 0; w < count; w++) {
      trace_all(&ways[w], rays, hits);
      print_row(digits, &ways[w], hits, right);
    }
  }
  reference_destroy(reference);
  for (size_t w = 0; w < count; w++) {
    tracer_destroy(ways[w].tracer);
    intersector_destroy(ways[w].intersector);
    scene_destroy(ways[w].scene);
  }
  return 0;
}

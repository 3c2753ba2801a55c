/* Classes of patches and rays. See net_classes.h. */
#include "stability/net_classes.h"

#include <math.h>
#include <string.h>

#include "accuracy/generate.h"
#include "geometry/patch.h"

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

static const struct net_class CLASSES[] = {
  {"height field near its axis", field}, {"surface of revolution", revolution}, {"skin", skin}, {"random", wild},
  {"collapsed edge", collapsed},         {"near tangent", tangential}};

size_t net_class_count(void) { return sizeof CLASSES / sizeof CLASSES[0]; }

const struct net_class *net_class_at(size_t index) { return &CLASSES[index]; }

/* Light and closed convex rooms: a light outside reaches no point that a camera inside sees, and a light inside reaches
 * every point. The rooms are prisms with creases of all angles, down to a millionth of a degree; cameras look exactly
 * into creases and corners, in picture sizes for which a row or a column of pixels lies on them. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cmocka_test.h"
#include "effort.h"
#include "geometry/vector.h"
#include "property/world.h"
#include "render/camera.h"
#include "render/shade.h"

enum { CORNERS_MAX = 4 };

/* A prism: a convex polygon, from z = -depth to depth. */
struct room {
  size_t corners;
  double corner[CORNERS_MAX][2], depth;
};

/* The same room somewhere else. */
struct place {
  double axes[3][3], shift[3];
};

static void placed(const struct place *place, double x, double y, double z, double out[3])
{
  for (int k = 0; k < 3; k++)
    out[k] = place->shift[k] + (x * place->axes[0][k] + y * place->axes[1][k] + z * place->axes[2][k]);
}

/* p and q at k = 0 and 3. The order of the two makes no difference, so patches share their edges exactly. */
static double between(double p, double q, int k) { return k == 0 ? p : k == 3 ? q : ((3 - k) * p + k * q) / 3; }

static void flat_net(const double at[4][3], world_net net)
{
  for (int n = 0; n < 48; n++) {
    const int i = n / 12, j = n / 3 % 4, c = n % 3;
    net[i][j][c] = between(between(at[0][c], at[1][c], j), between(at[2][c], at[3][c], j), i);
  }
}

static size_t room_nets(const struct room *room, const struct place *place, world_net nets[])
{
  double at[CORNERS_MAX + 2][2][3];
  for (size_t n = 0; n < CORNERS_MAX; n++) {
    const double *corner = room->corner[n < room->corners ? n : room->corners - 1];
    for (int side = 0; side < 2; side++)
      placed(place, corner[0], corner[1], side ? room->depth : -room->depth, at[n][side]);
  }
  size_t count = 0;
  for (size_t n = 0; n < room->corners; n++) {
    double four[4][3];
    const size_t next = (n + 1) % room->corners;
    memcpy(four[0], at[n], sizeof at[n]), memcpy(four[2], at[next], sizeof at[n]);
    flat_net((const double(*)[3])four, nets[count++]);
  }
  for (int side = 0; side < 2; side++) {
    double four[4][3];
    static const size_t order[4] = {0, 1, 3, 2};
    for (size_t k = 0; k < 4; k++) memcpy(four[k], at[order[k]][side], sizeof four[k]);
    flat_net((const double(*)[3])four, nets[count++]);
  }
  return count;
}

/* Counts the points of a picture that the light reaches. All points are seen. */
static size_t lit_points(const struct world *world, const struct scene_camera *camera, const double light_at[3],
                         size_t width, size_t height)
{
  struct scene_light light = {.color = {1, 1, 1}};
  size_t lit = 0;
  memcpy(light.position, light_at, sizeof light.position);
  for (size_t n = 0; n < width * height; n += PACKET_SIZE) {
    struct ray rays[PACKET_SIZE];
    struct hit hits[PACKET_SIZE];
    bool reached[PACKET_SIZE];
    const size_t left = width * height - n, count = left < PACKET_SIZE ? left : PACKET_SIZE;
    for (size_t k = 0; k < count; k++)
      camera_ray(camera, ((double)((n + k) % width) + 0.5) / (double)width,
                 ((double)((n + k) / width) + 0.5) / (double)height, &rays[k]);
    tracer_closest(world->tracer, count, rays, hits);
    shade_lit(&light, world->tracer, count, rays, hits, reached);
    for (size_t k = 0; k < count; k++) {
      assert_int_not_equal(hits[k].patch, HIT_NONE);
      lit += reached[k];
    }
  }
  return lit;
}

/* A camera at a point inside that looks exactly at a corner of the polygon, at height z. */
static struct scene_camera look_at_corner(const struct room *room, const struct place *place, const double eye[3],
                                          size_t corner, double z, double width)
{
  const double *to = room->corner[corner], way[3] = {to[0] - eye[0], to[1] - eye[1], z - eye[2]};
  const double far = hypot(way[0], way[1]);
  struct place turned = *place;
  struct scene_camera camera;
  memset(turned.shift, 0, sizeof turned.shift);
  placed(place, eye[0], eye[1], eye[2], camera.location);
  placed(&turned, way[0], way[1], way[2], camera.direction);
  placed(&turned, 0, 0, width * far, camera.right);
  placed(&turned, -width * way[1], width * way[0], 0, camera.up);
  return camera;
}

enum { SHAPES = 4, PLACES = 6, EYES = 4, SIDE = 21 };

/* Two triangles, a rhombus and a rectangle, each with this angle at a corner. */
static struct room make_room(int shape, double angle)
{
  const double c = 6 * cos(angle), s = 6 * sin(angle);
  const double corner[SHAPES][CORNERS_MAX][2] = {
    {{0, 0}, {6, 0}, {c, s}},
    {{0, 0}, {c, 0}, {c, s}},
    {{0, 0}, {6, 0}, {6 + c, s}, {c, s}},
    {{0, 0}, {6, 0}, {6, s}, {0, s}},
  };
  struct room room = {.corners = shape < 2 ? 3 : 4, .depth = 3};
  memcpy(room.corner, corner[shape], sizeof room.corner);
  return room;
}

/* As it is, turned, a million times as large and as small, moved by a thousand rooms, turned and moved by a million. */
static struct place make_place(int number, struct random *random)
{
  const double a = random_between(random, 0, 6), b = random_between(random, 0, 6);
  const double size = number == 2 ? 1e6 : number == 3 ? 1e-6 : 1, away = number == 4 ? 1e3 : number == 5 ? 1e6 : 0;
  struct place place = {{{size, 0, 0}, {0, size, 0}, {0, 0, size}}, {1.37 * away, 2.37 * away, 3.37 * away}};
  const double turned[3][3] = {
    {cos(a), sin(a), 0}, {-sin(a) * cos(b), cos(a) * cos(b), sin(b)}, {sin(a) * sin(b), -cos(a) * sin(b), cos(b)}};
  if (number % 4 == 1) memcpy(place.axes, turned, sizeof turned);
  return place;
}

/* Looks at every corner and every crease from a point inside. Returns how many points have light that should not, or
 * do not have what they should. */
static size_t wrong_points(const struct world *world, const struct room *room, const struct place *place, int eye_kind,
                           struct random *random)
{
  static const double outside[6][3] = {{0.5, 10, 0},    {0.5, -10, 0}, {15, 0.1, 0.1},
                                       {-15, 0.1, 0.2}, {3, 0.1, 9},   {3, 0, -9}}; /* the last one in a wall's plane */
  double eye[3] = {0, 0, eye_kind == 2 ? 0.3 : 0}, inside[3] = {0}, weight[CORNERS_MAX], sum = 0;
  size_t wrong = 0;
  for (size_t n = 0; n < room->corners; n++) sum += weight[n] = eye_kind == 0 ? 1 : random_between(random, 0.01, 1);
  for (size_t n = 0; n < room->corners; n++) {
    for (int k = 0; k < 2; k++) {
      eye[k] += weight[n] / sum * room->corner[n][k];
      inside[k] += room->corner[n][k] * ((n == 0 ? 0.25 : 0) + 0.75 / (double)room->corners);
    }
  }
  for (size_t corner = 0; corner < room->corners; corner++) {
    const struct scene_camera camera = look_at_corner(room, place, eye, corner, eye_kind == 3 ? room->depth : 0,
                                                      eye_kind == 1 ? 0.01 : 2);
    double at[3];
    for (int n = 0; n < 6; n++) {
      placed(place, outside[n][0], outside[n][1], outside[n][2], at);
      wrong += lit_points(world, &camera, at, SIDE, SIDE);
    }
    placed(place, inside[0], inside[1], inside[2], at);
    wrong += SIDE * SIDE - lit_points(world, &camera, at, SIDE, SIDE);
    wrong += SIDE * SIDE - lit_points(world, &camera, camera.location, SIDE, SIDE);
  }
  return wrong;
}

/* Where a room is moved, its least angle is such that the rounding of its corners is small beside its width. */
TEST(rooms_of_every_angle)
{
  static const double degrees[] = {1e-6, 1e-5, 1e-4, 1e-3, 0.005, 0.01, 0.1, 0.5, 1, 2, 5, 10, 14, 30, 45, 60, 80};
  static const double least[PLACES] = {0, 0, 0, 0, 1e-5, 5e-3};
  const size_t step = effort_fraction() >= 0.01 ? 1 : 8;
  struct random random = {.state = effort_seed(4)};
  for (size_t n = random_bits(&random) % step; n < sizeof degrees / sizeof *degrees; n += step) {
    for (int k = 0; k < SHAPES * PLACES * EYES; k++) {
      const int shape = k % SHAPES, number = k / SHAPES % PLACES, eye = k / SHAPES / PLACES;
      if (degrees[n] < least[number]) continue;
      const struct room room = make_room(shape, degrees[n] * 3.141592653589793 / 180);
      const struct place place = make_place(number, &random);
      world_net nets[CORNERS_MAX + 2];
      struct world world;
      world_open(&world, nets, room_nets(&room, &place, nets), NULL);
      const size_t wrong = wrong_points(&world, &room, &place, eye, &random);
      world_close(&world);
      if (wrong > 0) print_error("%g degrees, shape %d, place %d, eye %d\n", degrees[n], shape, number, eye);
      assert_int_equal(wrong, 0);
    }
  }
}

/* A wedge of 14 degrees and a cube, in pictures of many sizes. */
TEST(rooms_of_every_size)
{
  const struct room rooms[2] = {{3, {{0, 0}, {6, 0}, {6, 1.5}}, 3}, {4, {{-3, -3}, {3, -3}, {3, 3}, {-3, 3}}, 3}};
  const struct scene_camera cameras[2] = {
    {.location = {3, 0.25, 0}, .direction = {-3, -0.25, 0}, .right = {0, 0, 2}, .up = {0, 2, 0}},
    {.location = {0, 0, 0}, .direction = {0, 0, 1}, .right = {4, 0, 0}, .up = {0, 4, 0}}};
  const double light[2][3] = {{0.5, 10, 0}, {10, 20, 5}};
  const size_t sizes = effort_count(100, 3);
  for (size_t n = 0; n < 2 * sizes; n++) {
    const int room = n % 2;
    const struct place place = make_place(0, &(struct random){1});
    const size_t side = 101 + 300 * (n / 2) / sizes;
    world_net nets[CORNERS_MAX + 2];
    struct world world;
    world_open(&world, nets, room_nets(&rooms[room], &place, nets), NULL);
    assert_int_equal(lit_points(&world, &cameras[room], light[room], side, room ? side : side * 3 / 4), 0);
    world_close(&world);
  }
}

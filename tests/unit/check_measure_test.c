/* The measurements of check: our own picture, and one of POV-Ray's rows beside it. POV-Ray's answers are made up here. */
#include "check/measure.h"

#include <math.h>
#include <string.h>

#include "cmocka_test.h"

enum { MOST_PIXELS = 1200 };

/* POV-Ray's answers, and the last question to it. */
static float their_picture[3 * MOST_PIXELS];
static double their_distance[MOST_PIXELS];
static unsigned char their_mask[MOST_PIXELS];
static struct ray asked[MOST_PIXELS];
static size_t asked_count;

enum status __wrap_povray_render(struct povray *povray, const struct scene *scene, struct povray_picture *out);
enum status __wrap_povray_render(struct povray *povray, const struct scene *scene, struct povray_picture *out)
{
  (void)scene;
  *out = (struct povray_picture){.time = {1, 1}};
  assert_int_equal(image_create(povray->width, povray->height, 3, &out->image), STATUS_OK);
  memcpy(out->image.value, their_picture, 3 * povray->width * povray->height * sizeof *their_picture);
  return STATUS_OK;
}

enum status __wrap_povray_ask(struct povray *povray, const struct scene *scene, size_t count, const struct ray rays[],
                              double out_distance[], unsigned char *out_mask);
enum status __wrap_povray_ask(struct povray *povray, const struct scene *scene, size_t count, const struct ray rays[],
                              double out_distance[], unsigned char *out_mask)
{
  (void)scene;
  asked_count = count;
  memcpy(asked, rays, count * sizeof *rays);
  memcpy(out_distance, their_distance, count * sizeof *out_distance);
  if (out_mask != NULL) memcpy(out_mask, their_mask, povray->width * povray->height);
  return STATUS_OK;
}

/* The scene's file gives a different picture. */
enum status __wrap_povray_render_file(struct povray *povray, const char *path, const char *const *folders,
                                      char out_word[POVRAY_WORD_SIZE], struct povray_picture *out);
enum status __wrap_povray_render_file(struct povray *povray, const char *path, const char *const *folders,
                                      char out_word[POVRAY_WORD_SIZE], struct povray_picture *out)
{
  (void)folders;
  strcpy(out_word, path);
  if (out_word[0] != '\0') return STATUS_OK;
  const enum status status = __wrap_povray_render(povray, NULL, out);
  image_pixel(&out->image, 0, 0)[0] = 1;
  return status;
}

static struct scene scene = {.gamma = 1, .camera = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}}};
static int warned;
static void hear(void *context, enum told what, const char *text)
{
  (void)context, (void)text;
  warned += what == TOLD_WARNING;
}
static const struct listener nobody = {.hear = hear};
static struct check_request request;
static struct check_pixel pixels[MOST_PIXELS];

/* A check of a black picture of this size. Every pixel is hit at distance 1, by both programs. */
static struct check check_of(size_t width, size_t height, size_t grid)
{
  request = (struct check_request){
    .dumped = "", .width = width, .height = height, .grid = grid, .fail = {.each = 4.0 / 255}};
  struct check check = {.request = &request,
                        .listener = &nobody,
                        .scene = &scene,
                        .povray = {.width = width, .height = height},
                        .ours = {.pixel = pixels}};
  assert_true(width * height <= MOST_PIXELS);
  assert_int_equal(image_create(width, height, 3, &check.ours.picture), STATUS_OK);
  memset(their_picture, 0, sizeof their_picture);
  for (size_t k = 0; k < width * height; k++) {
    pixels[k] = (struct check_pixel){.distance = 1};
    their_distance[k] = 1;
    their_mask[k] = 1;
  }
  return check;
}

static void free_check(struct check *check)
{
  for (size_t k = 0; k < check->row_count; k++) image_destroy(&check->row[k].picture.image);
  image_destroy(&check->ours.picture);
}

static struct check_row *measure_row(struct check *check)
{
  assert_int_equal(check_measure_row(check, 1), STATUS_OK);
  return &check->row[check->row_count - 1];
}

/* Whether this is the ray through the middle of the pixel. */
static bool is_ray_of(const struct check *check, const struct ray *ray, size_t x, size_t y)
{
  const double along = ((double)x + 0.5) / (double)check->request->width - 0.5,
               up = 0.5 - ((double)y + 0.5) / (double)check->request->height;
  return fabs(ray->direction[0] - along) < 1e-12 && fabs(ray->direction[1] - up) < 1e-12;
}

/* A difference counts if it exceeds a limit, not if it equals it; it counts for what its pixel lies on. */
TEST(differences_are_counted)
{
  static const int codes[] = {0, 1, 2, 4, 5, 16, 17, 255};
  static const enum check_edge edges[] = {CHECK_EDGE_NONE,   CHECK_EDGE_NONE,   CHECK_EDGE_NONE, CHECK_EDGE_CREASE,
                                          CHECK_EDGE_CREASE, CHECK_EDGE_SHADOW, CHECK_EDGE_NONE, CHECK_EDGE_SILHOUETTE};
  struct check check = check_of(8, 1, 0);
  for (int k = 0; k < 8; k++) {
    their_picture[3 * k + k % 3] = (float)codes[k] / 255;
    pixels[k].edge = edges[k];
  }
  const struct check_row *row = measure_row(&check);
  assert_true(row->over[0] == 6 && row->over[1] == 4 && row->over[2] == 2 && row->over_limit == 4);
  for (int edge = 0; edge < CHECK_EDGES; edge++) assert_int_equal(row->over_limit_on[edge], 1);
  assert_true(row->result.max == 1 && row->result.worst_x == 7);
  free_check(&check);
}

TEST(hits_of_one_alone_are_counted)
{
  struct check check = check_of(5, 2, 0);
  pixels[0].distance = pixels[1].distance = INFINITY;
  their_mask[1] = 0; /* both miss */
  for (int k = 5; k < 8; k++) their_mask[k] = 0;
  const struct check_row *row = measure_row(&check);
  assert_true(row->mask_theirs == 1 && row->mask_ours == 3);
  assert_int_equal(asked_count, 0);
  free_check(&check);
}

/* POV-Ray reads the scene's file first, unless that is refused or the file could use others; then the dump. */
TEST(the_first_row_is_as_written)
{
  static const struct {
    const char *dumped, *word, *why;
  } cases[] = {{NULL, "", ""},
               {"it is a pipe", "", "it is a pipe"},
               {NULL, "#read in 'a'", "#read in 'a' could read or write files"}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    struct check check = check_of(3, 2, 0);
    request.dumped = cases[k].dumped, request.path = cases[k].word;
    for (size_t steps = 0; steps < 3; steps++) {
      assert_int_equal(check_measure_row(&check, steps), STATUS_OK);
      assert_true(check.row[steps].result.max == (k == 0 && steps == 0));
    }
    assert_string_equal(check.dumped, cases[k].why);
    assert_int_equal(warned, k == 2);
    /* a picture is kept until the next row */
    assert_true(check.row[1].picture.image.value == NULL && check.row[2].picture.image.value != NULL);
    free_check(&check);
  }
}

/* They are asked at every second pixel of every second row, from the second on; if the grid is larger than the picture,
 * at one. */
TEST(distances_are_those_of_a_grid)
{
  struct check check = check_of(7, 5, 2);
  pixels[1 * 7 + 1].distance = 4, their_distance[0] = 5;
  pixels[1 * 7 + 3].distance = INFINITY;
  their_distance[2] = INFINITY;
  pixels[3 * 7 + 1].distance = 8, their_distance[3] = 7;
  pixels[3 * 7 + 3].distance = their_distance[4] = INFINITY;
  const struct check_row *row = measure_row(&check);
  const struct check_distances *found = &row->distances;
  assert_int_equal(asked_count, 6);
  for (size_t k = 0; k < 6; k++) assert_true(is_ray_of(&check, &asked[k], 1 + 2 * (k % 3), 1 + 2 * (k / 3)));
  assert_true(found->rays == 6 && found->only_ours == 1 && found->only_theirs == 1 && found->both == 3);
  assert_true(found->median == 0.125 && found->max == 0.25 && found->p99 == 0.25);
  free_check(&check);

  check = check_of(6, 5, 100);
  pixels[0].distance = INFINITY;
  row = measure_row(&check);
  assert_int_equal(asked_count, 1);
  assert_true(is_ray_of(&check, &asked[0], 0, 0));
  assert_true(row->distances.both == 0 && isnan(row->distances.median) && isnan(row->distances.max));
  free_check(&check);
}

/* The rectangle x0 <= x <= x1, |y| <= y1 at depth z. */
static struct scene_patch rectangle(double x0, double x1, double y1, double z)
{
  struct scene_patch patch = {0};
  for (int i = 0; i < 4; i++) {
    for (int j = 0; j < 4; j++) {
      const double point[3] = {x0 + (x1 - x0) * j / 3, y1 * (2 * i / 3.0 - 1), z};
      memcpy(patch.P[i][j], point, sizeof point);
    }
  }
  return patch;
}

/* The left half of the picture shows a rectangle in front of a longer, lower one. The first light is behind both; of
 * the nearer one, which it would reach in part, it lights nothing. The shadow of the second light's nearer rectangle
 * ends on the farther one. The last light is shadowless. */
TEST(our_pixels_are_known)
{
  enum { WIDTH = 20, HEIGHT = 8, CODE = 124, LIT = 15 }; /* CODE: of 0.2; LIT: the first column past the shadow */
  struct method solver;
  struct scene_patch patches[] = {rectangle(-2, 0, 2, 2), rectangle(-4, 4, 1, 4)};
  struct scene_light lights[] = {
    {.position = {0, 3, 10}}, {.position = {-0.5, 0, 1}}, {.position = {-0.7, 0, 1}, .shadowless = true}};
  struct scene_texture texture = {
    .pigment = {0.2, 0.2, 0.2}, .finish = {.ambient = {1, 1, 1}, .brilliance = 1, .phong_size = 40, .roughness = 0.05}};
  struct scene seen = {.gamma = 1,
                       .camera = scene.camera,
                       .ambient_light = {1, 1, 1},
                       .lights = lights,
                       .light_count = 3,
                       .patches = patches,
                       .patch_count = 2,
                       .textures = &texture,
                       .texture_count = 1,
                       .solvers = &solver,
                       .solver_count = 1};
  method_default(solver_at(0), &solver);
  request = (struct check_request){.width = WIDTH, .height = HEIGHT, .parse = {1000, 2000}};
  struct check check = {.request = &request, .listener = &nobody, .scene = &seen};
  assert_int_equal(check_measure_ours(&check), STATUS_OK);
  for (size_t k = 0; k < WIDTH * HEIGHT; k++) {
    const size_t x = k % WIDTH, y = k / WIDTH;
    const bool left = x < WIDTH / 2, hit = left || (y >= 2 && y <= 5);
    const bool silhouette = x == 9 || x == 10 || (x > 10 && y >= 1 && y <= 6 && y != 3 && y != 4);
    const bool shadow = (y == 3 || y == 4) && (x == LIT - 1 || x == LIT);
    const double z = left ? 2 : 4, along = ((double)x + 0.5) / WIDTH - 0.5, up = 0.5 - ((double)y + 0.5) / HEIGHT;
    const struct check_pixel *pixel = &check.ours.pixel[k];
    assert_int_equal(pixel->edge, silhouette ? CHECK_EDGE_SILHOUETTE : shadow ? CHECK_EDGE_SHADOW : CHECK_EDGE_NONE);
    if (hit) assert_true(fabs(pixel->distance / (z * sqrt(1 + along * along + up * up)) - 1) < 1e-12);
    else assert_true(isinf(pixel->distance));
    for (int c = 0; c < 3; c++) assert_true(image_pixel(&check.ours.picture, x, y)[c] == (hit ? (float)CODE / 255 : 0));
  }
  assert_true(check.ours.time.wall >= 1000 && check.ours.time.wall < 1500);
  assert_true(check.ours.time.cpu >= 2000 && check.ours.time.cpu < 2500);
  check_ours_free(&check.ours);
}

/* A check: its measurements, and their order. */
#include "check/measure.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/sort.h"
#include "geometry/vector.h"
#include "base/srgb.h"
#include "render/camera.h"
#include "render/render.h"
#include "render/shade.h"

static const int CODE[CHECK_CODES] = {1, 4, 16};

/* Values are multiples of 1/255 rounded to float: with this margin only values beyond k exceed a limit of k/255. */
static const double CODE_ROUNDING = 1e-6;

static const size_t RGB[3] = {0, 1, 2};

/* ---- ours ---- */

static struct ray pixel_ray(const struct check *check, size_t x, size_t y)
{
  struct ray ray;
  camera_ray(&check->scene->camera, ((double)x + 0.5) / (double)check->request->width,
             ((double)y + 0.5) / (double)check->request->height, &ray);
  return ray;
}

/* Converts linear light to the codes of an 8-bit PNG. */
static void encode(struct image *image)
{
  struct srgb_table table;
  srgb_table_fill(&table);
  const size_t count = image->width * image->height * image->channel_count;
  for (size_t k = 0; k < count; k++) image->value[k] = (float)srgb_encode8(&table, image->value[k]) / 255;
}

static void look_at_row(struct check *check, struct tracer *tracer, size_t y, struct check_sight *out)
{
  const size_t lights = check->scene->light_count < CHECK_LIGHTS ? check->scene->light_count : CHECK_LIGHTS;
  for (size_t x = 0; x < check->request->width; x += PACKET_SIZE) {
    struct check_pixel *pixels = &check->ours.pixel[y * check->request->width + x];
    const size_t left = check->request->width - x, count = left < PACKET_SIZE ? left : PACKET_SIZE;
    struct ray rays[PACKET_SIZE];
    struct hit hits[PACKET_SIZE];
    for (size_t k = 0; k < count; k++) rays[k] = pixel_ray(check, x + k, y);
    tracer_closest(tracer, count, rays, hits);
    for (size_t k = 0; k < count; k++) {
      const struct hit *hit = &hits[k];
      const double distance = hit->patch == HIT_NONE ? INFINITY : hit->t * vector_length(rays[k].direction);
      out[x + k] = (struct check_sight){.hit = *hit, .distance = distance};
      pixels[k].distance = distance;
    }
    for (size_t light = 0; light < lights; light++) {
      bool lit[PACKET_SIZE];
      shade_lit(&check->scene->lights[light], tracer, count, rays, hits, lit);
      for (size_t k = 0; k < count; k++) out[x + k].lights |= (uint64_t)lit[k] << light;
    }
  }
}

/* A row's edges are known when the row below it is. */
static void look_at_pixels(struct check *check, struct tracer *tracer, struct check_sight *window)
{
  const size_t width = check->request->width, height = check->request->height;
  for (size_t y = 0; y <= height && !listener_stopped(check->listener); y++) {
    if (y < height) look_at_row(check, tracer, y, &window[y % 3 * width]);
    if (y > 0) check_find_edges(check, window, y - 1);
  }
}

enum status check_measure_ours(struct check *check)
{
  struct check_ours *ours = &check->ours;
  struct intersector *intersector = NULL;
  struct tracer *tracer = NULL;
  struct check_sight *window = NULL;
  const size_t width = check->request->width, height = check->request->height;
  const struct render_options options = {.width = width,
                                         .height = height,
                                         .samples = 1,
                                         .crop = {.width = width, .height = height},
                                         .threads = 1,
                                         .channels = {.count = 1, .width = 3, .kind = {CHANNEL_RGB}}};
  const struct render_watch watch = {.stop = check->listener->stop};
  struct render_stats stats;
  const struct seconds start = seconds_now();
  enum status status = image_create(width, height, 3, &ours->picture);
  if (status == STATUS_OK) status = intersector_create(check->scene, &intersector);
  if (status == STATUS_OK)
    status = render_scene(check->scene, intersector, &options, &watch, ours->picture.value, &stats);
  if (status == STATUS_OK) {
    encode(&ours->picture);
    const struct seconds taken = seconds_since(start), *parse = &check->request->parse;
    ours->time = (struct seconds){taken.wall + parse->wall, taken.cpu + parse->cpu};
    for (int k = 0; k < 3; k++) snprintf(ours->picture.channel[k].name, IMAGE_NAME_SIZE, "%c", "RGB"[k]);
    ours->pixel = calloc(width * height, sizeof *ours->pixel);
    window = calloc(3 * width, sizeof *window);
    status = ours->pixel == NULL || window == NULL ? STATUS_LIMIT : tracer_create(intersector, &tracer);
  }
  if (status == STATUS_OK) {
    look_at_pixels(check, tracer, window);
    if (listener_stopped(check->listener)) status = STATUS_INTERRUPTED;
  }
  free(window);
  tracer_destroy(tracer);
  intersector_destroy(intersector);
  return status == STATUS_LIMIT ? listener_out_of_memory(check->listener) : status;
}

void check_ours_free(struct check_ours *ours)
{
  image_destroy(&ours->picture);
  free(ours->pixel);
}

/* ---- pictures ---- */

static struct compare_pair pair_of(const struct check *check, const struct check_row *row)
{
  return (struct compare_pair){.first = &check->ours.picture,
                               .second = &row->picture.image,
                               .channel_count = 3,
                               .first_channel = RGB,
                               .second_channel = RGB};
}

static double pixel_difference(const struct check *check, const struct check_row *row, size_t x, size_t y)
{
  const float *a = image_pixel(&check->ours.picture, x, y), *b = image_pixel(&row->picture.image, x, y);
  double most = 0;
  for (int k = 0; k < 3; k++) most = fmax(most, fabs((double)a[k] - (double)b[k]));
  return most;
}

static void compare_row(const struct check *check, const unsigned char *mask, struct check_row *row)
{
  const struct compare_pair pair = pair_of(check, row);
  const double limit = check->request->fail.each + CODE_ROUNDING;
  compare_images(&pair, &row->result, NULL, 1);
  for (int k = 0; k < CHECK_CODES; k++) row->over[k] = compare_count_over(&pair, CODE[k] / 255.0 + CODE_ROUNDING);
  row->over_limit = compare_count_over(&pair, limit);
  for (size_t y = 0; y < check->request->height; y++) {
    for (size_t x = 0; x < check->request->width; x++) {
      const size_t index = y * check->request->width + x;
      const bool hit = isfinite(check->ours.pixel[index].distance);
      row->over_limit_on[check->ours.pixel[index].edge] += pixel_difference(check, row, x, y) > limit;
      row->mask_ours += hit && !mask[index];
      row->mask_theirs += !hit && mask[index];
    }
  }
}

/* ---- distances ---- */

/* Compares both distances on the same rays; `ours` is overwritten. */
static void compare_distances(size_t count, double ours[], const double theirs[], struct check_distances *out)
{
  *out = (struct check_distances){.rays = count};
  for (size_t k = 0; k < count; k++) {
    const bool hit = isfinite(ours[k]), theirs_hit = isfinite(theirs[k]);
    out->only_ours += hit && !theirs_hit;
    out->only_theirs += !hit && theirs_hit;
    if (hit && theirs_hit) ours[out->both++] = fabs(theirs[k] - ours[k]) / ours[k];
  }
  out->median = out->p99 = out->max = NAN;
  if (out->both == 0) return;
  sort_numbers(ours, out->both);
  out->median = sorted_quantile(ours, out->both, 0.5);
  out->p99 = sorted_quantile(ours, out->both, 0.99);
  out->max = ours[out->both - 1];
}

/* Asks which pixels POV-Ray hits, and for the distances on the grid. */
static enum status ask(struct check *check, unsigned char *mask, struct check_row *row)
{
  const struct check_request *request = check->request;
  const size_t width = request->width, height = request->height, step = request->grid;
  const size_t x0 = step / 2 < width ? step / 2 : 0, y0 = step / 2 < height ? step / 2 : 0;
  const size_t columns = step == 0 ? 0 : (width - 1 - x0) / step + 1;
  const size_t count = step == 0 ? 0 : columns * ((height - 1 - y0) / step + 1);
  struct ray *rays = calloc(count + 1, sizeof *rays);
  double *ours = calloc(count + 1, sizeof *ours), *theirs = calloc(count + 1, sizeof *theirs);
  enum status status = STATUS_LIMIT;
  if (rays == NULL || ours == NULL || theirs == NULL) {
    (void)listener_out_of_memory(check->listener);
    goto done;
  }
  for (size_t k = 0; k < count; k++) {
    const size_t x = x0 + k % columns * step, y = y0 + k / columns * step;
    rays[k] = pixel_ray(check, x, y);
    ours[k] = check->ours.pixel[y * width + x].distance;
  }
  status = povray_ask(&check->povray, check->scene, count, rays, theirs, mask);
  if (status == STATUS_OK) compare_distances(count, ours, theirs, &row->distances);

done:
  free(rays);
  free(ours);
  free(theirs);
  return status;
}

/* ---- rows ---- */

/* Renders the file as written, or if that must not be the dump. */
static enum status render_first(struct check *check, struct povray_picture *out)
{
  const struct check_request *request = check->request;
  char word[POVRAY_WORD_SIZE] = "";
  if (request->dumped != NULL) {
    snprintf(check->dumped, sizeof check->dumped, "%s", request->dumped);
  } else {
    const enum status status = povray_render_file(&check->povray, request->path, request->folders, word, out);
    if (status == STATUS_INPUT && check->povray.refused)
      listener_tell(check->listener, TOLD_DETAIL, "With --dump POV-Ray reads the dump of the scene.");
    if (status != STATUS_OK || word[0] == '\0') return status;
    snprintf(check->dumped, sizeof check->dumped, "%s could read or write files", word);
    listener_tell(check->listener, TOLD_WARNING, "POV-Ray reads the dump of the scene, not its file: %s",
                  check->dumped);
  }
  return povray_render(&check->povray, check->scene, out);
}

enum status check_measure_row(struct check *check, size_t steps)
{
  struct check_row *row = &check->row[check->row_count];
  if (check->row_count > 0) image_destroy(&row[-1].picture.image);
  *row = (struct check_row){.steps = steps};
  const struct check_request *request = check->request;
  enum status status = steps == 0 ? render_first(check, &row->picture)
                                  : povray_render(&check->povray, check->scene, &row->picture);
  if (status != STATUS_OK) return status;
  check->row_count++;
  unsigned char *mask = calloc(request->width * request->height, 1); /* [height][width]: POV-Ray hits */
  status = mask == NULL ? listener_out_of_memory(check->listener) : ask(check, mask, row);
  if (status == STATUS_OK) compare_row(check, mask, row);
  free(mask);
  return status;
}

enum status check_difference(const struct check *check, const struct check_row *row, double scale, struct image *out)
{
  const enum status status = image_create(check->request->width, check->request->height, 3, out);
  if (status != STATUS_OK) return status;
  const struct compare_pair pair = pair_of(check, row);
  struct compare_result ignored;
  compare_images(&pair, &ignored, out, scale);
  for (int k = 0; k < 3; k++) out->channel[k] = check->ours.picture.channel[k];
  return STATUS_OK;
}

/* ---- limits ---- */

bool check_within_limits(const struct check *check, char *out, size_t size)
{
  const struct check_request *request = check->request;
  const struct check_row *row = &check->row[check->row_count - 1];
  const double pixels = (double)row->result.pixels;
  const double mask = 100 * (double)(row->mask_ours + row->mask_theirs) / pixels;
  if (compare_limit_passed(&request->fail, &row->result, row->over_limit))
    snprintf(out, size, "%.4g %% of the pixels differ by more than %.4g of 255, the most by %.4g",
             100 * (double)row->over_limit / pixels, 255 * request->fail.each, 255 * row->result.max);
  else if (row->result.psnr < request->fail_psnr)
    snprintf(out, size, "the PSNR is %.4g dB, less than %.4g dB", row->result.psnr, request->fail_psnr);
  else if (mask > request->fail_mask)
    snprintf(out, size, "%.4g %% of the pixels are hit by one of both only, more than %.4g %%", mask,
             request->fail_mask);
  else return true;
  return false;
}

/* ---- the order of the work ---- */

/* Measures a row, and makes its files before the next row takes its picture's place. */
static enum status measure_row(struct check *check, size_t steps)
{
  const enum status status = check_measure_row(check, steps);
  return status == STATUS_OK ? check_make_pictures(check) : status;
}

static enum status measure_series(struct check *check)
{
  enum status status = STATUS_OK;
  for (size_t steps = 1; steps <= check->request->steps && status == STATUS_OK; steps++) {
    listener_tell(check->listener, TOLD_PROGRESS, "POV-Ray: u_steps %zu", steps);
    for (size_t k = 0; k < check->scene->patch_count; k++) {
      struct scene_patch *patch = &check->scene->patches[k];
      patch->u_steps = patch->v_steps = (int)steps;
      patch->flatness = 0;
    }
    status = measure_row(check, steps);
  }
  return status;
}

static enum status measure(struct check *check)
{
  enum status status = povray_open(&check->povray);
  if (status == STATUS_OK) {
    listener_tell(check->listener, TOLD_PROGRESS, "pscn");
    status = check_measure_ours(check);
  }
  if (status == STATUS_OK) {
    listener_tell(check->listener, TOLD_PROGRESS, "POV-Ray: as written");
    status = measure_row(check, 0);
  }
  return status == STATUS_OK ? measure_series(check) : status;
}

static enum status judge(struct check *check, struct text_buffer *out_text)
{
  char beyond[256], verdict[512];
  const bool within = check_within_limits(check, beyond, sizeof beyond);
  const struct check_row *last = &check->row[check->row_count - 1];
  if (within)
    snprintf(verdict, sizeof verdict,
             "Within the limits: %.4g %% of the pixels differ by more than %.4g of 255, PSNR %.4g dB.",
             100 * (double)last->over_limit / (double)last->result.pixels, 255 * check->request->fail.each,
             last->result.psnr);
  else snprintf(verdict, sizeof verdict, "Beyond the limits: %s.", beyond);
  const enum status status = check_write(check, verdict, out_text);
  return status != STATUS_OK || within ? status : listener_fail(check->listener, STATUS_DIFFERENT, "%s", beyond);
}

enum status check_scene(const struct check_request *request, struct scene *scene, const struct listener *listener,
                        struct text_buffer *out_text)
{
  *out_text = (struct text_buffer){0};
  struct check *check = calloc(1, sizeof *check);
  if (check == NULL) return listener_out_of_memory(listener);
  *check = (struct check){.request = request, .listener = listener, .scene = scene, .povray = request->povray};
  check->povray.listener = listener;
  check->povray.width = request->width;
  check->povray.height = request->height;
  enum status status = measure(check);
  if (status == STATUS_OK) status = judge(check, out_text);
  povray_close(&check->povray);
  for (size_t k = 0; k < check->row_count; k++) image_destroy(&check->row[k].picture.image);
  for (size_t k = 0; k < CHECK_FILES; k++) text_buffer_free(&check->file[k]);
  check_ours_free(&check->ours);
  free(check);
  return status;
}

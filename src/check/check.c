/* The order of a check's work. */
#include "check/check.h"

#include <stdio.h>
#include <stdlib.h>

#include "check/measure.h"

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

/* From a scene to the picture's file. See rendering.h. */
#include "command/rendering.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/memory.h"
#include "command/interrupt.h"
#include "command/output.h"
#include "command/piece.h"
#include "command/progress.h"
#include "command/report.h"
#include "image/image_loading.h"
#include "render/threads.h"

enum status rendering_check_outputs(const struct command *command, const struct rendering_request *request,
                                    const struct scene *scene)
{
  enum status status = output_spare(command, request->stats, request->output);
  if (status == STATUS_OK) status = output_spare(command, request->stats, request->part);
  if (status == STATUS_OK) status = output_spare(command, request->output, request->part); /* a link to the part */
  if (status == STATUS_OK) status = scene_file_spare(command, request->scene, scene, request->part);
  if (status == STATUS_OK) status = scene_file_spare(command, request->scene, scene, request->output);
  return status == STATUS_OK ? scene_file_spare(command, request->scene, scene, request->stats) : status;
}

/* ---- what is done so far ---- */

/* Loading what writes the part takes some tenths of a second, for which a signal does not wait. So it is loaded after
 * so many seconds, and until then nothing is kept. */
#define LOADS_AFTER 1.0

/* A rendering in progress. */
struct rendering {
  const struct command *command;
  const struct rendering_request *request;
  struct report *report;
  struct piece piece;
  struct progress progress;
  struct seconds writing; /* when that began */
  double kept;            /* when the part was last kept, in seconds since the rendering began */
  bool has_part;          /* there is a file of what is done */
  bool has_old;           /* an earlier run's file, from which we do not continue */
  size_t left;            /* pixels of this picture in the earlier run's file, from which we do not continue */
  bool warned;            /* of a scene of which nothing will be visible */
  /* for the picture, or if that is a PNG for the part, once the rendering takes LOADS_AFTER */
  struct image_loading *loading;
  bool loads_part;
};

/* Writes what is done into its file. Returns whether that worked; prints the error if not. */
static bool keep(struct rendering *rendering)
{
  char message[IMAGE_MESSAGE_SIZE] = "out of memory";
  unsigned char *bytes = NULL;
  size_t size;
  int reason = 0;
  enum status status = STATUS_LIMIT;
  if (report_describe(rendering->report, &rendering->piece.image))
    status = piece_encode(&rendering->piece, &bytes, &size, message);
  if (status == STATUS_OK) {
    const struct atomic_file file = {rendering->request->part, bytes, size};
    status = atomic_file_put(&file, &reason);
    snprintf(message, sizeof message, "%s", strerror(reason));
  }
  free(bytes);
  if (status == STATUS_OK) rendering->has_part = true;
  else
    command_error(rendering->command, "cannot keep the finished part in '%s': %s", rendering->request->part, message);
  return status == STATUS_OK;
}

/* Whether an earlier run's file has more than is done now. A user who forgot --resume, and interrupts for that reason,
 * must not lose it. */
static bool has_less(const struct rendering *rendering)
{
  return !rendering->has_part && tile_list_pixels(&rendering->piece.tiles, true) < rendering->left &&
         access(rendering->request->part, F_OK) == 0;
}

/* About ten times a second. */
static void look(void *context, const struct render_progress *progress)
{
  struct rendering *rendering = context;
  const struct rendering_request *request = rendering->request;
  if (!request->scene->quiet)
    progress_tell(&rendering->progress, progress->seconds, (double)progress->pixels / (double)progress->pixels_total,
                  progress->rays);
  if (request->format == IMAGE_PNG && request->part != NULL && !rendering->loads_part &&
      progress->seconds > LOADS_AFTER) {
    rendering->loads_part = true;
    image_loading_begin(rendering->loading, true);
  }
  if (request->part == NULL || !(request->checkpoint > 0) ||
      progress->seconds - rendering->kept < request->checkpoint ||
      tile_list_pixels(&rendering->piece.tiles, true) == 0 || has_less(rendering))
    return;
  const struct seconds start = seconds_now();
  (void)keep(rendering);
  rendering->kept = progress->seconds + seconds_since(start).wall;
}

/* Whether a part can be written without waiting for a library. */
static bool can_keep(const struct rendering *rendering)
{
  if (rendering->has_part || rendering->has_old) return true; /* one was written or read already */
  return (rendering->loads_part || rendering->request->format != IMAGE_PNG) && image_loading_done(rendering->loading);
}

/* Keeps what is done when a signal ends the rendering, or when its results cannot be written. */
static void keep_rest(struct rendering *rendering, bool interrupted)
{
  const size_t done = tile_list_pixels(&rendering->piece.tiles, true),
               all = tile_list_pixels(&rendering->piece.tiles, false);
  if (rendering->request->part == NULL) return;
  const bool less = has_less(rendering);
  if (!(less || (done > 0 && keep(rendering))) || rendering->request->scene->quiet) return;
  fprintf(stderr, "pscn %s: %s%.0f %% of the picture%s in '", rendering->command->name,
          interrupted ? "interrupted; " : "", floor(100 * (double)(less ? rendering->left : done) / (double)all),
          less ? ", rendered by an earlier run, stays" : " is kept");
  command_print(stderr, rendering->request->part);
  fputs("'; --resume continues from there\n", stderr);
}

/* Whether the part of an earlier run belongs to this picture and piece. If not, the message says how they differ. */
static bool is_part(const struct piece *piece, const struct piece *part, char *message, size_t size)
{
  if (part->number != piece->number || part->count != piece->count) {
    snprintf(message, size, "its piece: %zu/%zu, not %zu/%zu", part->number, part->count, piece->number, piece->count);
    return false;
  }
  return piece_belongs(&part->image, &piece->image, message, size);
}

/* Whether a part is of this scene, the one with this text or this name. If not, the message says so. */
static bool is_of_scene(const struct report *report, const struct image *part, char *message, size_t size)
{
  const char *path = image_text(part, "pscn:scene");
  snprintf(message, size, "it is of the scene '%s'", path);
  return (strcmp(path, report->scene_path) == 0 && !output_is_standard(path)) ||
         strcmp(image_text(part, "pscn:text"), report->scene->text_hash) == 0;
}

/* Takes the tiles of a part. Returns false if it is of another picture, or lacks a channel. */
static bool take_part(struct rendering *rendering, const struct piece *part, char *message, size_t size)
{
  struct piece *piece = &rendering->piece;
  if (!is_part(piece, part, message, size)) return false;
  snprintf(message, size, "it lacks a channel");
  if (!piece_copy(part, &piece->image)) return false;
  for (size_t k = 0; k < part->tiles.count; k++) atomic_store(&piece->tiles.rows[k], atomic_load(&part->tiles.rows[k]));
  return true;
}

/* Continues from a part. `status` is that of its reading. */
static enum status continue_from(struct rendering *rendering, const struct piece *part, enum status status,
                                 char *message, size_t size)
{
  const char *path = rendering->request->part;
  if (status != STATUS_OK) {
    command_error(rendering->command, "cannot continue from '%s'%s: %s", path,
                  status == STATUS_LIMIT ? "" : " (without --resume rendering starts anew)", message);
    return status;
  }
  rendering->has_part = take_part(rendering, part, message, size);
  if (rendering->has_part) return STATUS_OK;
  command_error(rendering->command, "'%s' belongs to another picture; %s. Without --resume rendering starts anew", path,
                message);
  return STATUS_INPUT;
}

/* Continues from what an earlier run has left, or warns that it is there. Refuses a file of the part's name that is no
 * part of this scene: what is done would replace it, and the picture remove it. All of the file is read to know whether
 * it is damaged, and need not be spared at the cost of what is done now; if memory is too short for that, it may be
 * whole. */
static enum status resume(struct rendering *rendering)
{
  const struct command *command = rendering->command;
  const char *path = rendering->request->part;
  struct piece head, part;
  char message[IMAGE_MESSAGE_SIZE];
  if (path == NULL || access(path, F_OK) != 0) return STATUS_OK;
  enum status status = piece_read(path, false, &head, message);
  if (status == STATUS_OK && !is_of_scene(rendering->report, &head.image, message, sizeof message))
    status = STATUS_INPUT;
  if (status != STATUS_OK) {
    command_error(command,
                  "'%s', in which the finished part would be kept, is not a part of this scene: %s; remove it, or "
                  "choose another name for the picture",
                  path, message);
    piece_destroy(&head);
    return status == STATUS_LIMIT ? status : STATUS_FILE;
  }
  status = piece_read(path, true, &part, message);
  if (rendering->request->resume) {
    status = continue_from(rendering, &part, status, message, sizeof message);
  } else {
    const bool useless = status != STATUS_OK && status != STATUS_LIMIT;
    if (!useless && is_part(&rendering->piece, &head, message, sizeof message))
      rendering->left = tile_list_pixels(&head.tiles, true);
    rendering->has_old = true;
    if (!rendering->request->scene->quiet)
      command_warning(command, "'%s' is left by an earlier run%s", path,
                      rendering->left > 0 ? "; --resume continues from there"
                      : useless           ? ", cannot be continued, and is replaced"
                                          : ", belongs to another picture, and is replaced");
    status = STATUS_OK;
  }
  piece_destroy(&head);
  piece_destroy(&part);
  return status;
}

/* Creates the picture, and fills in what an earlier run has done. */
static enum status begin(struct rendering *rendering)
{
  const struct rendering_request *request = rendering->request;
  const size_t piece = request->pieces == 0 ? 1 : request->piece, pieces = request->pieces == 0 ? 1 : request->pieces;
  const enum status status = piece_create(&request->options, piece, pieces, &rendering->piece);
  if (status != STATUS_OK || !report_describe(rendering->report, &rendering->piece.image))
    return command_out_of_memory(rendering->command);
  return resume(rendering);
}

/* ---- the picture ---- */

/* The time now, and since `start`, without the CPU time of loading in parallel. The thread's clock is read before the
 * process's, because the latter counts other threads only up to the last reading of their clocks. */
static struct seconds now(const struct image_loading *loading)
{
  const double beside = image_loading_seconds(loading);
  struct seconds now = seconds_now();
  now.cpu -= beside;
  return now;
}

static struct seconds since(struct seconds start, const struct image_loading *loading)
{
  struct seconds taken = seconds_between(start, now(loading));
  taken.cpu = fmax(taken.cpu, 0); /* the two clocks are not read at the same time */
  return taken;
}

/* Waits until pictures can be written. Prints the error if they cannot. */
static enum status loaded(const struct rendering *rendering, struct image_loading *loading)
{
  const char *message;
  const enum status status = image_loading_end(loading, &message);
  if (rendering->request->format == IMAGE_PNG || status == STATUS_OK) return STATUS_OK;
  command_error(rendering->command, "cannot write pictures: %s", message);
  return status;
}

/* Warns of a picture without anything to be seen. Of a continued one, and of a piece, that is not known. */
static void warn_of_nothing(const struct rendering *rendering, const struct render_stats *stats)
{
  if (rendering->request->scene->quiet || rendering->warned || rendering->request->resume ||
      rendering->request->pieces != 0)
    return;
  if (!stats->seen)
    command_warning(rendering->command,
                    "no ray hits a patch: the camera points elsewhere, or the patches are too small");
  else if (!stats->lit)
    command_warning(rendering->command, "all patches are black: no light reaches them, or they have no pigment");
}

/* Renders the tiles that are not done. Stops early if the picture could not be written. */
static enum status make_picture(struct rendering *rendering, struct image_loading *loading)
{
  struct report *report = rendering->report;
  struct intersector *intersector = NULL;
  struct render_options options = rendering->request->options;
  const struct render_watch watch = {.progress = look,
                                     .context = rendering,
                                     .stop = &interrupt_signal,
                                     .failed = rendering->request->format == IMAGE_PNG ? NULL : &loading->failed};
  struct render_stats stats = {0};
  struct seconds start = now(loading);
  options.tiles = &rendering->piece.tiles;
  rendering->progress = progress_start();
  const struct team team = threads_team(options.threads);
  enum status status = intersector_create_by(report->scene, &team, &intersector);
  report->build = since(start, loading);
  if (status == STATUS_OK && !rendering->request->scene->quiet)
    scene_file_warn_of_cuts(rendering->command, intersector);
  if (status == STATUS_OK) {
    interrupt_defer();
    start = now(loading);
    status = render_scene(report->scene, intersector, &options, &watch, rendering->piece.image.value, &stats);
    report->render = since(start, loading);
    progress_end(&rendering->progress);
    if (atomic_load(&interrupt_signal) != 0) status = STATUS_INTERRUPTED;
    report->counts = stats.counts;
    report->threads = stats.threads;
    if (status == STATUS_OK) warn_of_nothing(rendering, &stats);
  }
  if (status == STATUS_LIMIT && memory_limit_reached()) (void)command_out_of_memory(rendering->command);
  else if (status == STATUS_LIMIT) command_error(rendering->command, "out of memory or threads");
  else if (atomic_load(&interrupt_signal) == 0) status = loaded(rendering, loading);
  report->loading = image_loading_seconds(loading);
  intersector_destroy(intersector);
  return status;
}

/* Called while the file is encoded. */
static bool go_on_writing(void *context, double part)
{
  struct rendering *rendering = context;
  if (!rendering->request->scene->quiet)
    progress_write(&rendering->progress, seconds_since(rendering->writing).wall, part);
  return atomic_load(&interrupt_signal) == 0;
}

static enum status encode(struct rendering *rendering, unsigned char **out_bytes, size_t *out_size, char *message)
{
  const struct rendering_request *request = rendering->request;
  if (atomic_load(&interrupt_signal) != 0) return STATUS_INTERRUPTED;
  snprintf(message, IMAGE_MESSAGE_SIZE, "out of memory");
  if (!report_describe(rendering->report, &rendering->piece.image)) return STATUS_LIMIT;
  if (request->pieces != 0) return piece_encode(&rendering->piece, out_bytes, out_size, message);
  rendering->progress = progress_start();
  const struct image_encoding encoding = {
    .format = request->format, .bits = (int)request->bits, .progress = go_on_writing, .context = rendering};
  const enum status status = image_encode(&rendering->piece.image, &encoding, out_bytes, out_size, message);
  progress_end(&rendering->progress);
  return status;
}

/* Writes the picture, and the statistics if requested, and removes the part. */
static enum status write_results(struct rendering *rendering)
{
  const struct command *command = rendering->command;
  const struct rendering_request *request = rendering->request;
  rendering->writing = seconds_now();
  unsigned char *bytes;
  char *statistics = NULL;
  size_t size;
  char message[IMAGE_MESSAGE_SIZE];
  enum status status = encode(rendering, &bytes, &size, message);
  if (status != STATUS_OK) {
    if (status != STATUS_INTERRUPTED) command_error(command, "cannot create '%s': %s", request->output, message);
    return status;
  }
  rendering->report->write = seconds_since(rendering->writing);
  if (request->stats != NULL) status = report_text(command, report_statistics(rendering->report), &statistics);
  const size_t length = statistics == NULL ? 0 : strlen(statistics);
  const struct atomic_file files[] = {{request->output, bytes, size},
                                      {request->stats, statistics, length},
                                      {rendering->has_part || rendering->has_old ? request->part : NULL, NULL, 0}};
  if (status == STATUS_OK) status = output_write(command, files, 3);
  free(statistics);
  free(bytes);
  return status;
}

static enum status render(const struct command *command, const struct rendering_request *request,
                          struct image_loading *loading)
{
  struct scene *scene = NULL;
  const struct seconds start = now(loading);
  enum status status = scene_file_load(command, request->scene, &scene);
  const bool warned = status == STATUS_OK && !request->scene->quiet && scene_file_warn(command, scene);
  struct report report = {.scene_path = request->scene->path,
                          .picture_path = request->output,
                          .scene = scene,
                          .width = request->options.width,
                          .height = request->options.height,
                          .crop = request->options.crop,
                          .channels = request->channels,
                          .options = request->how,
                          .samples = request->options.samples,
                          .parse = since(start, loading)};
  struct rendering rendering = {
    .command = command, .request = request, .report = &report, .warned = warned, .loading = loading};
  if (status == STATUS_OK) status = rendering_check_outputs(command, request, scene);
  if (status == STATUS_OK) status = begin(&rendering);
  if (status == STATUS_OK) status = make_picture(&rendering, loading);
  const bool made = status == STATUS_OK;
  if (made) status = write_results(&rendering);
  const bool interrupted = status == STATUS_INTERRUPTED;
  if (made ? status != STATUS_OK : interrupted && can_keep(&rendering)) keep_rest(&rendering, interrupted);
  if (status == STATUS_OK && !request->scene->quiet) report_print(&report);
  piece_destroy(&rendering.piece);
  scene_destroy(scene);
  return status;
}

enum status rendering_make(const struct command *command, const struct rendering_request *request)
{
  struct image_loading loading;
  const char *unused;
  image_loading_begin(&loading, request->format != IMAGE_PNG);
  const enum status status = render(command, request, &loading);
  if (status == STATUS_INTERRUPTED && !image_loading_done(&loading)) interrupt_end();
  (void)!image_loading_end(&loading, &unused);
  return status;
}

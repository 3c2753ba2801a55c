/* pscn merge PIECE...: makes a picture from its pieces. */
#include <stdlib.h>
#include <string.h>

#include "base/text_buffer.h"
#include "command/command.h"
#include "command/output.h"
#include "command/piece.h"
#include "command/report.h"
#include "command/values.h"
#include "library/pscn.h"

struct request {
  const char *output;
  size_t bits; /* 0: not given */
  bool quiet;
  enum image_format format;
};

static const char SECONDS[] = "pscn:render_seconds";

static const struct command_option OPTIONS[] = {
  COMMAND_HELP_OPTION,       COMMAND_TEXT("output", 'o', output, "the picture, .png or .exr", "FILE"),
  COMMAND_BITS_OPTION(bits), COMMAND_TRUE("quiet", 'q', quiet, "print nothing unless something is wrong"),
  COMMAND_OPTIONS_END,
};

/* One of the files. */
struct file {
  const char *path;
  struct piece piece; /* without pixels */
  bool good;          /* a valid piece of the picture, as far as is known */
  size_t members;     /* of the first file of a picture: how many files belong to that */
};

/* The state of the merge. */
struct merge {
  const struct command *command;
  const struct request *request;
  struct file *file;
  size_t count;
  const struct file *first; /* the first file of the picture that most files belong to; NULL: no file is a piece */
  struct piece picture;     /* piece 1 of 1; done: the tiles found in a file */
  double seconds;           /* rendering time of the pieces */
  bool strange;             /* a file is wrong; the error has been printed */
};

/* Excludes the file, and prints the reason. */
static void refuse(struct merge *merge, struct file *file, const char *before, const char *why)
{
  command_error(merge->command, "'%s': %s%s", file->path, before, why);
  file->good = false;
  merge->strange = true;
}

/* ---- which picture, and which files are of it ---- */

static enum status read_headers(struct merge *merge)
{
  char message[IMAGE_MESSAGE_SIZE];
  for (size_t k = 0; k < merge->count; k++) {
    struct file *file = &merge->file[k];
    const enum status status = piece_read(file->path, false, &file->piece, message);
    file->good = status == STATUS_OK;
    if (!file->good) refuse(merge, file, "", message);
    if (status == STATUS_LIMIT) return status;
  }
  return STATUS_OK;
}

/* Whether both files are of one picture, cut in the same way. If not, `out` says how they differ. */
static bool belong(const struct file *a, const struct file *b, char *out, size_t size)
{
  if (!piece_belongs(&a->piece.image, &b->piece.image, out, size)) return false;
  snprintf(out, size, "its number of pieces: %zu, not %zu", a->piece.count, b->piece.count);
  return a->piece.count == b->piece.count;
}

/* Chooses the picture that most files belong to; in a tie, that of the first file. */
static void choose_picture(struct merge *merge)
{
  char message[IMAGE_MESSAGE_SIZE];
  for (size_t k = 0; k < merge->count; k++) {
    size_t first = 0; /* file of its picture */
    if (!merge->file[k].good) continue;
    while (first < k &&
           (merge->file[first].members == 0 || !belong(&merge->file[k], &merge->file[first], message, sizeof message)))
      first++;
    merge->file[first].members++;
  }
  for (size_t k = 0; k < merge->count; k++)
    if (merge->file[k].members > (merge->first == NULL ? 0 : merge->first->members)) merge->first = &merge->file[k];
}

/* Creates the picture, still black. */
static enum status create_picture(struct merge *merge)
{
  const struct file *first = merge->first;
  if (merge->request->format == IMAGE_PNG && !channel_list_is_rgb(&first->piece.channels))
    return command_usage(merge->command, "a PNG holds only the channel rgb, and '%s' has others: use .exr",
                         first->path);
  const enum status status = piece_create_like(&first->piece, 1, 1, &merge->picture);
  return status == STATUS_OK ? status : command_out_of_memory(merge->command);
}

/* The place of a piece's tile in the list of the whole picture (render/tile.h). */
static size_t place_of(const struct piece *piece, size_t tile) { return tile * piece->count + piece->number - 1; }

/* Whether one of the piece's tiles is done already. */
static bool has_twice(const struct merge *merge, const struct piece *piece)
{
  bool twice = false;
  for (size_t t = 0; t < piece->tiles.count; t++)
    twice |= tile_is_done(&piece->tiles, t) && tile_is_done(&merge->picture.tiles, place_of(piece, t));
  return twice;
}

static void count_tiles(const struct merge *merge, const struct piece *piece)
{
  for (size_t t = 0; t < piece->tiles.count; t++)
    if (tile_is_done(&piece->tiles, t)) atomic_store(&merge->picture.tiles.rows[place_of(piece, t)], TILE_ROWS);
}

/* ---- pixels ---- */

/* Whether a piece still is what its header said: it may have been overwritten meanwhile. */
static bool is_same(const struct piece *header, const struct piece *whole)
{
  char message[IMAGE_MESSAGE_SIZE];
  return strcmp(image_text(&header->image, "pscn:sum"), image_text(&whole->image, "pscn:sum")) == 0 &&
         piece_belongs(&whole->image, &header->image, message, sizeof message);
}

/* A file's tiles count only after its pixels have been read, so that a damaged file does not exclude another one. */
static enum status read_files(struct merge *merge)
{
  char message[IMAGE_MESSAGE_SIZE];
  for (size_t k = 0; k < merge->count; k++) {
    struct file *file = &merge->file[k];
    struct piece whole;
    if (file->good && !belong(file, merge->first, message, sizeof message))
      refuse(merge, file, "is a piece of another picture; ", message);
    if (file->good && has_twice(merge, &file->piece)) refuse(merge, file, "", "its tiles are in an earlier file, too");
    if (!file->good) continue;
    const enum status status = piece_read(file->path, true, &whole, message);
    if (status != STATUS_OK) refuse(merge, file, "", message);
    else if (!is_same(&file->piece, &whole)) refuse(merge, file, "", "it changed while it was being read");
    else if (!piece_copy(&whole, &merge->picture.image)) refuse(merge, file, "", "it lacks a channel");
    else count_tiles(merge, &whole);
    merge->seconds += atof(image_text(&whole.image, SECONDS));
    piece_destroy(&whole);
    if (status == STATUS_LIMIT) return status;
  }
  return STATUS_OK;
}

static bool is_missing(const struct merge *merge, size_t number)
{
  const struct tile_list *tiles = &merge->picture.tiles;
  for (size_t k = number - 1; k < tiles->count; k += merge->first->piece.count)
    if (!tile_is_done(tiles, k)) return true;
  return false;
}

/* Prints the numbers of the pieces that are missing, if any, as Slurm's sbatch --array takes them: "2,5-7". Says so in
 * words, too. */
static enum status print_missing(const struct merge *merge, bool *out_any)
{
  struct text_buffer text = {0};
  for (size_t k = 1, count = merge->first->piece.count; k <= count; k++) {
    const size_t begin = k;
    while (k <= count && is_missing(merge, k)) k++;
    if (k > begin) text_buffer_format(&text, text.length > 0 ? ",%zu" : "%zu", begin);
    if (k > begin + 1) text_buffer_format(&text, "-%zu", k - 1);
  }
  *out_any = text.length > 0;
  const enum status status = text.failed ? command_out_of_memory(merge->command) : STATUS_OK;
  if (status == STATUS_OK && *out_any) {
    puts(text.text);
    command_error(merge->command, "of %zu pieces these are missing or incomplete: %s; no picture is written",
                  merge->first->piece.count, text.text);
  }
  text_buffer_free(&text);
  return status;
}

/* ---- the picture ---- */

/* The picture's metadata are those of the pieces, but for the date and the time that rendering took. */
static bool describe(const struct merge *merge, struct image *picture)
{
  const struct image *piece = &merge->first->piece.image;
  bool enough = report_sign(picture);
  for (const char *name = NULL; enough && (name = piece_next_text(piece, name)) != NULL;)
    if (strcmp(name, SECONDS) == 0) enough = image_add_text(picture, name, "%.3f", merge->seconds);
    else enough = image_add_text(picture, name, "%s", name + strlen(name) + 1);
  return enough;
}

static enum status write_picture(struct merge *merge)
{
  const struct request *request = merge->request;
  const struct image_encoding encoding = {.format = request->format, .bits = (int)request->bits};
  if (!describe(merge, &merge->picture.image)) return command_out_of_memory(merge->command);
  return output_picture(merge->command, &merge->picture.image, &encoding, request->output);
}

static enum status put_together(struct merge *merge)
{
  enum status status = read_headers(merge);
  if (status == STATUS_OK) choose_picture(merge);
  if (status == STATUS_OK && merge->first == NULL) return STATUS_FILE;
  if (status == STATUS_OK) status = create_picture(merge);
  if (status == STATUS_OK) status = read_files(merge);
  if (status != STATUS_OK) return status;
  bool missing;
  status = print_missing(merge, &missing);
  if (status != STATUS_OK) return status;
  if (missing || merge->strange) {
    if (!missing) command_error(merge->command, "no picture is written");
    status = command_finish_output(merge->command);
    return status == STATUS_OK ? STATUS_DIFFERENT : status;
  }
  status = write_picture(merge);
  if (status != STATUS_OK || merge->request->quiet) return status;
  command_print(stderr, merge->request->output);
  fprintf(stderr, ": %zu piece%s\n", merge->count, merge->count == 1 ? "" : "s");
  return status;
}

/* ---- the command ---- */

static enum status check(const struct command *command, struct request *request, const struct command_line *line)
{
  if (request->output == NULL) return command_usage(command, "name the picture with -o FILE");
  enum status status = output_format(command, request->output, &request->format);
  if (status != STATUS_OK) return status;
  if (request->bits == 0) request->bits = (size_t)image_format_default_bits(request->format);
  if (!image_format_has_bits(request->format, (int)request->bits))
    return command_usage(command, "'%s' cannot have %zu bits a value", request->output, request->bits);
  for (size_t k = 0; k < line->positional_count && status == STATUS_OK; k++)
    status = output_spare_input(command, request->output, line->positional[k]);
  return status == STATUS_OK ? output_probe(command, request->output) : status;
}

static const struct request DEFAULTS = {.output = NULL};

static enum status run(const struct command *command, void *context, const struct command_line *line)
{
  struct request *request = context;
  enum status status = check(command, request, line);
  if (status != STATUS_OK) return status;
  struct merge merge = {.command = command, .request = request, .count = line->positional_count};
  merge.file = calloc(merge.count, sizeof *merge.file);
  if (merge.file == NULL) return command_out_of_memory(command);
  for (size_t k = 0; k < merge.count; k++) merge.file[k].path = line->positional[k];
  status = put_together(&merge);
  for (size_t k = 0; k < merge.count; k++) piece_destroy(&merge.file[k].piece);
  piece_destroy(&merge.picture);
  free(merge.file);
  return status;
}

const struct command command_merge = {
  .name = "merge",
  .arguments = "PIECE...",
  .summary = "Puts the pieces of a picture together",
  .description =
    "Pieces are the files of 'pscn render --tile K/N', K = 1 to N, rendered on any machines and in any order, and\n"
    "what an interrupted rendering has kept (*.part.exr). The picture is, bit by bit, that of a single rendering\n"
    "without --tile.\n"
    "\n"
    "Each piece records its picture: the text of the scene and of all its includes, the options, the version and\n"
    "the kind of processor. If a piece is missing, cannot be read, belongs to another picture than most or has\n"
    "tiles of another piece, no picture is written and the exit code is 1. Standard output then has the numbers of\n"
    "the pieces that are still to be rendered, such as 2,5-7, in the form of sbatch --array.\n",
  COMMAND_RUNS(1, NULL),
};

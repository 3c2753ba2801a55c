/* Where results go, how they are written, and which files they must not overwrite. */
#ifndef PSCN_COMMAND_OUTPUT_H
#define PSCN_COMMAND_OUTPUT_H

#include <stdbool.h>

#include "base/atomic_file.h"
#include "base/clock.h"
#include "base/listener.h"
#include "base/text_buffer.h"
#include "command/command.h"
#include "command/scene_file.h"
#include "image/image_file.h"

/* Whether the path is "-": standard output, or as a scene's path standard input. */
bool output_is_standard(const char *path);

/* output_probe asks before the work whether a file can be written. output_write writes the files of a result, at most
 * OUTPUT_MOST, all or none (atomic_file.h). A NULL path is skipped. "-" is standard output, which cannot be undone and
 * therefore comes first. Errors are printed. A signal in the meantime, or a standard output without a reader where
 * files are to follow, leaves the old files as they were: STATUS_INTERRUPTED. */
enum { OUTPUT_MOST = 3 };
enum status output_probe(const struct command *command, const char *path) STATUS_MUST_CHECK;
enum status output_write(const struct command *command, const struct atomic_file outputs[],
                         size_t count) STATUS_MUST_CHECK;

/* Encodes a picture and writes it. Prints the error if it cannot be encoded. */
enum status output_picture(const struct command *command, const struct image *image,
                           const struct image_encoding *encoding, const char *path) STATUS_MUST_CHECK;

/* The text for an errno value about a file to be written. */
const char *output_reason(const char *path, int reason);

/* The row of the option --bits, stored in a field of the file's own struct request; 0: not given. */
#define COMMAND_BITS_OPTION(field) \
  COMMAND_INTEGER("bits", field, 8, 32, "number of bits", "bits of a colour value: 8 or 16 (PNG), 16 or 32 (EXR)", "N")

/* The format of a picture, by its suffix. Returns STATUS_USAGE, after printing the error, if the suffix is not
 * known. */
enum status output_format(const struct command *command, const char *path, enum image_format *out) STATUS_MUST_CHECK;

/* Returns STATUS_USAGE, after printing the error, if writing `path` would overwrite `other`, an input or another
 * output: the same file under any name. "-" stands for the file that standard output goes to. NULLs and devices
 * overwrite nothing. */
enum status output_spare(const struct command *command, const char *path, const char *other) STATUS_MUST_CHECK;

/* The same for `path` and for standard output, where `input` is a file to be read; as an input, "-" is a file name. */
enum status output_spare_input(const struct command *command, const char *path, const char *input) STATUS_MUST_CHECK;

/* The scene's name with its suffix replaced by `suffix`, in the scene's folder: "scenes/teapot.pscn" gives
 * "scenes/teapot.png". "-" stays "-". The caller frees it; NULL if memory is short. */
char *output_name(const char *scene, const char *suffix);

/* A folder of results. If `path` is NULL, it is named after the scene, with `suffix`, and is in the current folder,
 * because the scene's folder may belong to somebody else. */
struct output_folder {
  const char *path, *suffix;
  const char *const *files; /* file_count of them; the last one is the page that presents the others */
  size_t file_count;
};

/* What is to be done with a scene: its results go to the folder, and a text for standard output to out_text. */
struct output_job {
  const char *folder;
  struct scene *scene;
  struct seconds parse; /* the time of reading the scene */
  const struct listener *listener;
  struct text_buffer *out_text;
};

/* Makes the folder if needed, reads the scene, checks that the files can be written, and has `work` write them, with
 * signals deferred. Prints the text unless the request is quiet. Removes a folder that it made if `work` fails. Returns
 * the status of `work`. */
enum status output_folder_fill(const struct command *command, const struct output_folder *folder,
                               const struct scene_request *request,
                               enum status work(void *context, const struct output_job *job),
                               void *context) STATUS_MUST_CHECK;

#endif

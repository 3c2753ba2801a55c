/* Where results go, how they get there, and what they must not overwrite. */
#ifndef PSCN_COMMAND_OUTPUT_H
#define PSCN_COMMAND_OUTPUT_H

#include <stdbool.h>

#include "base/atomic_file.h"
#include "base/text_buffer.h"
#include "command/command.h"
#include "image/image_file.h"

/* The name that means standard output, or as a scene's standard input. */
bool output_is_standard(const char *path);

/* Asks before the work whether a file can be written, and after it writes the files of a result, OUTPUT_MOST of them at
 * most: all together or none (atomic_file.h). A NULL path is nowhere, "-" standard output, which cannot be taken back
 * and comes first. Errors are told. A signal that comes meanwhile leaves what was there: STATUS_INTERRUPTED, and so does
 * a standard output that nobody reads any more, where files are to follow. */
enum { OUTPUT_MOST = 3 };
enum status output_probe(const struct command *command, const char *path) STATUS_MUST_CHECK;
enum status output_write(const struct command *command, const struct atomic_file outputs[],
                         size_t count) STATUS_MUST_CHECK;

/* Encodes a picture and writes it; told where it cannot be made. */
enum status output_picture(const struct command *command, const struct image *image,
                           const struct image_encoding *encoding, const char *path) STATUS_MUST_CHECK;

/* What an errno value says of a file that is to be written. */
const char *output_reason(const char *path, int reason);

/* The format of a picture, by its suffix; STATUS_USAGE, told, where it has none that is known. */
enum status output_format(const struct command *command, const char *path, enum image_format *out) STATUS_MUST_CHECK;

/* STATUS_USAGE, told, where `path` would overwrite `other`, an input or another output: the same file, by whatever name.
 * "-" is the file that standard output goes to. NULLs and devices overwrite nothing. */
enum status output_spare(const struct command *command, const char *path, const char *other) STATUS_MUST_CHECK;

/* The same of `path` and of standard output, where `input` is a file that is read: "-" is the name of one. */
enum status output_spare_input(const struct command *command, const char *path, const char *input) STATUS_MUST_CHECK;

/* The scene's name with `suffix` instead of its own: "scenes/teapot.pscn" gives "scenes/teapot.png", beside the scene,
 * and "-" stays what it is. To be freed; NULL where memory is short. */
char *output_name(const char *scene, const char *suffix);

/* A folder of results. Without a path it is named as the scene with `suffix`, and stands here, for the scene's folder
 * need not be ours. */
struct output_folder {
  const char *path, *scene, *suffix;
  const char *page; /* the file in it that shows the rest */
};

/* Makes the folder where there is none, has `work` fill it, signals being deferred, and unless `quiet` tells its text on
 * standard output; takes a folder it has made away where the work fails. Answers the status of the work. */
typedef enum status output_folder_work(void *context, const char *folder, struct text_buffer *out_text);
enum status output_folder_fill(const struct command *command, const struct output_folder *folder, bool quiet,
                               output_folder_work *work, void *context) STATUS_MUST_CHECK;

#endif

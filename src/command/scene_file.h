/* Reads a scene from a file; errors are printed to stderr. */
#ifndef PSCN_COMMAND_SCENE_FILE_H
#define PSCN_COMMAND_SCENE_FILE_H

#include <math.h>
#include <stddef.h>

#include "base/diagnostics.h"
#include "base/status.h"
#include "command/command.h"
#include "intersect/intersect.h"
#include "language/language.h"
#include "scene/scene.h"

/* What a command line says about a scene. */
enum { SCENE_MOST_FOLDERS = 32, SCENE_MOST_NUMBERS = 64 };

struct scene_request {
  const char *path;
  size_t width, height;                    /* of the picture: image_width and image_height */
  const char *solver_text;                 /* or NULL */
  double tolerance;                        /* or NAN */
  size_t max_memory;                       /* bytes, or 0: the default */
  const char *folders[SCENE_MOST_FOLDERS]; /* of -I */
  size_t folder_count;
  struct language_number numbers[SCENE_MOST_NUMBERS]; /* of --declare */
  size_t number_count;
  double clock;
  int frame, first_frame, last_frame; /* of an animation, or 0 */
  bool lenient;
  bool quiet; /* no warnings */
  bool untrusted;
};

/* The largest width or height of a picture. */
enum { MAX_SIDE = 1000000 };

/* The values where options are not given. */
#define SCENE_REQUEST_DEFAULT                                          \
  {                                                                    \
    .width = DEFAULT_WIDTH, .height = DEFAULT_HEIGHT, .tolerance = NAN \
  }

/* The options of a scene_request that is the member `scene` of the file's struct request: rows of the table of options,
 * and the handler for those that are not stored directly, whose vals are the same in all commands. `text` says what the
 * size belongs to, or what the solver and the tolerance are. */
enum { OPTION_SIZE = OPTION_HELP + 1, OPTION_MAX_MEMORY, OPTION_INCLUDE, OPTION_DECLARE };
#define SCENE_SIZE_OPTION(text) COMMAND_OPTION("size", 0, OPTION_SIZE, text, "WxH")
#define SCENE_SOLVER_OPTION(text) COMMAND_TEXT("solver", 0, scene.solver_text, text, "TEXT")
#define SCENE_TOLERANCE_OPTION(text) COMMAND_POSITIVE("tolerance", scene.tolerance, "tolerance", text, "E")
#define SCENE_READING_OPTIONS                                                                                      \
  COMMAND_OPTION("max-memory", 0, OPTION_MAX_MEMORY, "memory for the scene; default a quarter of all, at most 8G", \
                 "SIZE"),                                                                                          \
    COMMAND_OPTION("include", 'I', OPTION_INCLUDE, "folder in which included files are sought; may be repeated",   \
                   "DIR"),                                                                                         \
    COMMAND_TRUE("lenient", 0, scene.lenient, "leave out unsupported words, with warnings"),                       \
    COMMAND_NUMBER("clock", scene.clock, "the value of clock in the scene", "X"),                                  \
    COMMAND_OPTION("declare", 0, OPTION_DECLARE, "declare a number before the scene is read; may be repeated",     \
                   "NAME=X"),                                                                                      \
    COMMAND_TRUE("untrusted", 0, scene.untrusted, "for a stranger's scene: limits of files, memory, size, time")
#define SCENE_OPTIONS                                                 \
  SCENE_SOLVER_OPTION("replaces all solver statements of the scene"), \
    SCENE_TOLERANCE_OPTION("replaces the tolerance of all solvers"), SCENE_READING_OPTIONS
enum status scene_request_take(const struct command *command, void *scene_request, int val,
                               const char *argument) STATUS_MUST_CHECK;

/* The most bytes that the scene may take: as on the command line, or a share of the machine's memory, or what a stranger
 * gets. */
size_t scene_request_memory(const struct scene_request *request);

/* The folders in which included files are looked for: those of -I, those of PSCN_INCLUDE, POV-Ray's own, then NULL. The
 * caller frees the result by one free; NULL if memory is short. */
const char **scene_request_folders(const struct scene_request *request);

/* Warns if there was too little memory to cut patches as finely as they ask. */
void scene_file_warn_of_cuts(const struct command *command, const struct intersector *intersector);

/* Reads the scene, from standard input if its path is "-"; the caller destroys it. From now on
 * this thread's memory is limited to what the request allows. On failure the errors have been
 * printed and *out is NULL. It fails if standard output goes to one of the scene's files. */
enum status scene_file_load(const struct command *command, const struct scene_request *request,
                            struct scene **out) STATUS_MUST_CHECK;

/* The options on how a scene is read, without those on where it is found, as on a command line. The caller frees it;
 * NULL if memory is short. */
char *scene_request_text(const struct scene_request *request);

/* Warns if nothing of the scene will be visible: it lacks patches, lights or a camera. Returns whether it does. Warns, as
 * POV-Ray does, if the version that decides what its colours mean is missing. */
bool scene_file_warn(const struct command *command, const struct scene *scene);

/* Returns STATUS_USAGE, after printing the error, if `output` (NULL: nowhere) would overwrite a file of the scene, or is
 * in a stranger's folder, where names may be traps. Ask
 * before reading, with NULL for the scene, and again when its included files are known. */
enum status scene_file_spare(const struct command *command, const struct scene_request *request,
                             const struct scene *scene, const char *output) STATUS_MUST_CHECK;

/* Diagnostics that are printed to stderr. */
struct diagnostics stderr_diagnostics(const struct command *command);

#endif

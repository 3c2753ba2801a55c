/* Where results go unless the command line says it, and the folders they go to. */
#ifndef PSCN_COMMAND_OUTPUT_H
#define PSCN_COMMAND_OUTPUT_H

#include <stdbool.h>

#include "command/command.h"

/* The scene's name with `suffix` instead of its own: "scenes/teapot.pscn" gives "scenes/teapot.png", beside the scene;
 * of a folder "teapot-check", here, for the scene's folder need not be ours. To be freed; NULL where memory is
 * short. */
char *output_name(const char *scene, const char *suffix);
char *output_folder_name(const char *scene, const char *suffix);

/* Makes the folder where there is none, which *out_made tells. STATUS_FILE after telling the error. */
enum status output_folder_make(const struct command *command, const char *folder, bool *out_made) STATUS_MUST_CHECK;

#endif

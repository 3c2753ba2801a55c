/* pscn dump SCENE: the scene as canonical text. */
#include "command/command.h"
#include "command/scene_file.h"
#include "scene/scene.h"

struct request {
  struct scene_request scene; /* first: passed to scene_request_take */
};

static const struct command_option OPTIONS[] = {
  COMMAND_HELP_OPTION,
  SCENE_SIZE_OPTION("values of image_width and image_height; default 800x600"),
  SCENE_OPTIONS,
  COMMAND_TRUE("quiet", 'q', scene.quiet, "print nothing unless something is wrong"), /* no warnings */
  COMMAND_OPTIONS_END,
};

static const struct request DEFAULTS = {.scene = SCENE_REQUEST_DEFAULT};

static enum status run(const struct command *command, void *context, const struct command_line *line)
{
  struct request *request = context;
  struct scene *scene = NULL;
  request->scene.path = line->positional[0];
  enum status status = scene_file_load(command, &request->scene, &scene);
  if (status == STATUS_OK) {
    (void)!scene_dump(scene, stdout); /* if something was not written, the next line tells the reason */
    status = command_finish_output(command);
  }
  scene_destroy(scene);
  return status;
}

const struct command command_dump = {
  .name = "dump",
  .arguments = "SCENE",
  .summary = "Writes a scene as canonical text, which pscn and POV-Ray read",
  .description =
    "Names, includes, arithmetic and transforms are resolved; the text goes to standard output. The dump of a dump\n"
    "is the same text.\n",
  COMMAND_RUNS(1, scene_request_take),
};

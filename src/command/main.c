/* pscn: a table of subcommands. */
#include <fcntl.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "command/command.h"
#include "command/interrupt.h"
#include "intersect/intersect.h"
#include "library/pscn.h"
#include "render/threads.h"

/* Gives each closed standard stream a descriptor that refuses use; otherwise a file of ours could be opened in its
 * place and receive the stream's output. */
static void hold_streams(void)
{
  for (int stream = 0; stream <= 2; stream++)
    if (fcntl(stream, F_GETFD) == -1) (void)open("/dev/null", stream == 0 ? O_WRONLY : O_RDONLY);
}

/* "pscn scene.pscn" renders it; no command has such a name. */
static bool is_scene(const char *name)
{
  return strpbrk(name, "./") != NULL || strcmp(name, "-") == 0 || access(name, F_OK) == 0;
}

/* "pscn -o picture.png scene.pscn" as well, and "pscn +W320 +Iscene.pov" for a better message, but not "pscn -q dump
 * scene.pscn". */
static bool is_rendering(int argc, char **argv)
{
  bool scene = is_scene(argv[1]) || argv[1][0] == '+';
  for (int k = 2; k < argc && argv[1][0] == '-'; k++) {
    if (command_find(argv[k]) != NULL) return false;
    scene |= is_scene(argv[k]);
  }
  return scene;
}

struct call {
  const struct command *command;
  int argc;
  const char **argv;
  bool ran;
};

static enum status run_call(void *context, size_t worker)
{
  struct call *call = context;
  (void)worker;
  call->ran = true;
  return command_run(call->command, call->argc, call->argv);
}

int main(int argc, char **argv)
{
  hold_streams();
  interrupt_install();
  if (argc < 2) {
    command_print_overview(stderr);
    return STATUS_USAGE;
  }
  const char *name = argv[1];
  if (strcmp(name, "--version") == 0 || strcmp(name, "-V") == 0 || strcmp(name, "-v") == 0) {
    if (argc > 2) return (int)command_usage(NULL, "one argument too many: '%s'", argv[2]);
    printf("pscn %s\n", PSCN_VERSION);
    return (int)command_finish_output(NULL);
  }
  if (strcmp(name, "--help") == 0 || strcmp(name, "-h") == 0) name = command_help.name;
  const struct command *command = command_find(name);
  int words = 1; /* words before the command's own */
  if (command == NULL && is_rendering(argc, argv)) {
    command = &command_render;
    words = 0;
  }
  if (command == NULL) return (int)command_unknown(name);
  if (!intersector_kernel_here())
    return (int)command_usage(NULL, "PSCN_KERNEL='%s' is not an instruction set of this processor",
                              getenv("PSCN_KERNEL"));
  struct call call = {command, argc - words, (const char **)argv + words, false};
  const int code = (int)threads_run_deep(run_call, &call);
  if (!call.ran) return (int)command_out_of_memory(command); /* there was no memory for the thread */
  return code == STATUS_INTERRUPTED ? interrupt_exit_code() : code;
}

/* A child process: started, watched, reaped. */
#include "command/process.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/clock.h"

enum {
  EXIT_SIGNAL = 128,
  POLL_NANOSECONDS = 2000000, /* between looks at the child: far below what a rendering takes */
  GRACE_LOOKS = 500           /* looks at a child that was asked to end before it is made to: one second */
};

/* CPU time of the children waited for so far. */
static double children_seconds(void)
{
  struct rusage usage;
  if (getrusage(RUSAGE_CHILDREN, &usage) != 0)
    return 0;
  return (double)(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
         1e-6 * (double)(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
}

/* Turns the child's outputs and input to where they belong. */
static bool redirect(const char *output)
{
  const int in = open("/dev/null", O_RDONLY);
  const int out = open(output, O_WRONLY | O_CREAT | O_TRUNC, 0600);
  return in >= 0 && out >= 0 && dup2(in, STDIN_FILENO) >= 0 && dup2(out, STDOUT_FILENO) >= 0 &&
         dup2(out, STDERR_FILENO) >= 0;
}

/* In the child: becomes the program, or tells why not through the pipe, which a started program closes. */
static void become(const struct process_request *request, int report)
{
  static const int OURS[] = { SIGINT, SIGTERM, SIGHUP, SIGXFSZ };
  (void)setpgid(0, 0);
  for (size_t k = 0; k < sizeof OURS / sizeof OURS[0]; k++)
    (void)signal(OURS[k], SIG_DFL);
  bool ready = redirect(request->output) && (request->folder == NULL || chdir(request->folder) == 0);
  for (const char *const *pair = request->environment; ready && pair != NULL && *pair != NULL; pair += 2)
    ready = (pair[1] == NULL ? unsetenv(pair[0]) : setenv(pair[0], pair[1], 1)) == 0;
  if (ready)
    execvp(request->arguments[0], (char *const *)request->arguments);
  const int reason = errno;
  (void)!write(report, &reason, sizeof reason);
  _exit(EXIT_SIGNAL - 1);
}

/* Waits for the end of the child, or of the time it is given where `looks` is not negative. */
static bool wait_child(pid_t child, const atomic_int *stop, int looks, int *out_state)
{
  const struct timespec pause = { .tv_nsec = POLL_NANOSECONDS };
  for (;;) {
    const pid_t ended = waitpid(child, out_state, WNOHANG);
    if (ended == child || (ended < 0 && errno != EINTR))
      return true;
    if ((stop != NULL && atomic_load(stop) != 0) || looks-- == 0)
      return false;
    (void)nanosleep(&pause, NULL);
  }
}

static void end_child(pid_t child)
{
  int state;
  (void)kill(-child, SIGTERM);
  if (!wait_child(child, NULL, GRACE_LOOKS, &state)) {
    (void)kill(-child, SIGKILL);
    (void)wait_child(child, NULL, -1, &state);
  } else {
    (void)kill(-child, SIGKILL); /* whoever else is left of its group */
  }
}

enum status process_run(const struct process_request *request, const atomic_int *stop, struct process_result *out)
{
  *out = (struct process_result){ 0 };
  int report[2];
  if (pipe(report) != 0) {
    out->reason = errno;
    return STATUS_FILE;
  }
  (void)fcntl(report[0], F_SETFD, FD_CLOEXEC);
  (void)fcntl(report[1], F_SETFD, FD_CLOEXEC);
  const double start = clock_seconds(CLOCK_MONOTONIC), cpu_start = children_seconds();
  const pid_t child = fork();
  if (child == 0)
    become(request, report[1]);
  const int fork_reason = errno;
  (void)close(report[1]);
  if (child < 0) {
    (void)close(report[0]);
    out->reason = fork_reason;
    return STATUS_FILE;
  }
  (void)setpgid(child, child); /* both sides do it: whichever comes first */
  ssize_t told;
  do
    told = read(report[0], &out->reason, sizeof out->reason);
  while (told < 0 && errno == EINTR);
  (void)close(report[0]);
  int state = 0;
  if (!wait_child(child, stop, -1, &state)) {
    end_child(child);
    return STATUS_INTERRUPTED;
  }
  if (told == (ssize_t)sizeof out->reason) {
    out->missing = out->reason == ENOENT || out->reason == EACCES || out->reason == ENOTDIR;
    return STATUS_FILE;
  }
  out->reason = 0;
  out->wall = clock_seconds(CLOCK_MONOTONIC) - start;
  out->cpu = children_seconds() - cpu_start;
  out->exit_code = WIFSIGNALED(state) ? EXIT_SIGNAL + WTERMSIG(state) : WEXITSTATUS(state);
  return STATUS_OK;
}

/* A child process: started, confined, watched, reaped. Landlock: Linux's Documentation/userspace-api/landlock.rst. */
#define _GNU_SOURCE /* for syscall */
#include "page/process.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <signal.h>
#include <stdint.h>
#include <stdlib.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#if __has_include(<linux/landlock.h>)
#include <linux/landlock.h>
#endif

enum {
  EXIT_SIGNAL = 128,
  WRITTEN_EVERY = 32,        /* such looks: how often its files are measured */
  POLL_NANOSECONDS = 2000000 /* between two looks at the child: far less than a rendering takes */
};

#define GRACE 1.0 /* seconds from asking a child to end to forcing it */

/* CPU time of the children waited for so far. */
static double children_seconds(void)
{
  struct rusage usage;
  if (getrusage(RUSAGE_CHILDREN, &usage) != 0) return 0;
  return (double)(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
         1e-6 * (double)(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
}

/* Redirects the child's input and outputs. */
static bool redirect(const char *output)
{
  const int in = open("/dev/null", O_RDONLY | O_CLOEXEC);
  const int out = open(output, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  return in >= 0 && out >= 0 && dup2(in, STDIN_FILENO) >= 0 && dup2(out, STDOUT_FILENO) >= 0 &&
         dup2(out, STDERR_FILENO) >= 0;
}

/* ---- what a program may do ---- */

#if defined(LANDLOCK_CREATE_RULESET_VERSION)
bool process_can_confine(void)
{
  return syscall(SYS_landlock_create_ruleset, NULL, 0, LANDLOCK_CREATE_RULESET_VERSION) > 0;
}

/* Lets this process, and the program it becomes, write only in the current folder. */
static bool confine(void)
{
  static const uint64_t WRITING = LANDLOCK_ACCESS_FS_WRITE_FILE | LANDLOCK_ACCESS_FS_REMOVE_DIR |
                                  LANDLOCK_ACCESS_FS_REMOVE_FILE | LANDLOCK_ACCESS_FS_MAKE_CHAR |
                                  LANDLOCK_ACCESS_FS_MAKE_DIR | LANDLOCK_ACCESS_FS_MAKE_REG |
                                  LANDLOCK_ACCESS_FS_MAKE_SOCK | LANDLOCK_ACCESS_FS_MAKE_FIFO |
                                  LANDLOCK_ACCESS_FS_MAKE_BLOCK | LANDLOCK_ACCESS_FS_MAKE_SYM;
  const struct landlock_ruleset_attr rules = {.handled_access_fs = WRITING};
  const struct landlock_path_beneath_attr here = {.allowed_access = WRITING,
                                                  .parent_fd = open(".", O_RDONLY | O_CLOEXEC)};
  const int set = (int)syscall(SYS_landlock_create_ruleset, &rules, sizeof rules, 0);
  return set >= 0 && here.parent_fd >= 0 &&
         syscall(SYS_landlock_add_rule, set, LANDLOCK_RULE_PATH_BENEATH, &here, 0) == 0 &&
         prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 && syscall(SYS_landlock_restrict_self, set, 0) == 0;
}
#else
bool process_can_confine(void) { return false; }

static bool confine(void) { return true; }
#endif

/* Lowers a limit; never raises it. */
static const struct rlimit *lower(struct rlimit *limit, size_t most)
{
  if (limit->rlim_cur > most) limit->rlim_cur = limit->rlim_max = most;
  return limit;
}

static bool limit_resources(size_t memory)
{
  struct rlimit now;
  return getrlimit(RLIMIT_CORE, &now) == 0 && setrlimit(RLIMIT_CORE, lower(&now, 0)) == 0 &&
         (memory == 0 || (getrlimit(RLIMIT_AS, &now) == 0 && setrlimit(RLIMIT_AS, lower(&now, memory)) == 0 &&
                          getrlimit(RLIMIT_FSIZE, &now) == 0 && setrlimit(RLIMIT_FSIZE, lower(&now, memory)) == 0));
}

static bool restrict_program(const struct process_request *request, pid_t parent)
{
  /* the parent may have ended before that call */
  return prctl(PR_SET_PDEATHSIG, SIGKILL) == 0 && getppid() == parent && limit_resources(request->memory) &&
         (!request->confined || !process_can_confine() || confine());
}

/* In the child: becomes the program, or sends the reason why not through the pipe, which exec closes. */
static void become(const struct process_request *request, int report, pid_t parent)
{
  static const int OURS[] = {SIGINT, SIGTERM, SIGHUP, SIGXCPU, SIGXFSZ};
  (void)setpgid(0, 0);
  for (size_t k = 0; k < sizeof OURS / sizeof OURS[0]; k++) (void)signal(OURS[k], SIG_DFL);
  bool ready = redirect(request->output) && (request->folder == NULL || chdir(request->folder) == 0);
  for (const char *const *pair = request->environment; ready && pair != NULL && *pair != NULL; pair += 2)
    ready = (pair[1] == NULL ? unsetenv(pair[0]) : setenv(pair[0], pair[1], 1)) == 0;
  if (ready && restrict_program(request, parent)) execvp(request->arguments[0], (char *const *)request->arguments);
  const int reason = errno;
  (void)!write(report, &reason, sizeof reason);
  _exit(EXIT_SIGNAL - 1);
}

/* The bytes in the files of a folder. */
static size_t folder_bytes(const char *folder)
{
  size_t bytes = 0;
  struct stat info;
  DIR *list = opendir(folder == NULL ? "." : folder);
  for (struct dirent *entry; list != NULL && (entry = readdir(list)) != NULL;)
    if (fstatat(dirfd(list), entry->d_name, &info, AT_SYMLINK_NOFOLLOW) == 0 && S_ISREG(info.st_mode))
      bytes += (size_t)info.st_size;
  if (list != NULL) (void)closedir(list);
  return bytes;
}

/* What ends a child: a flag that is set, a time, files that grow beyond `most` bytes. */
struct bounds {
  const atomic_int *stop;
  double end;
  const char *folder;
  size_t most;
};

static bool is_overfull(const struct bounds *bounds)
{
  return bounds->most != 0 && folder_bytes(bounds->folder) > bounds->most;
}

/* Waits for the child to end. Returns STATUS_INTERRUPTED if the flag came first, STATUS_LIMIT if another bound did. */
static enum status wait_child(pid_t child, const struct bounds *bounds, int *out_state)
{
  const struct timespec pause = {.tv_nsec = POLL_NANOSECONDS};
  for (unsigned looks = 1;; looks++) {
    const pid_t ended = waitpid(child, out_state, WNOHANG);
    if (ended == child || (ended < 0 && errno != EINTR)) return STATUS_OK;
    if (bounds->stop != NULL && atomic_load(bounds->stop) != 0) return STATUS_INTERRUPTED;
    if (clock_seconds(CLOCK_MONOTONIC) > bounds->end) return STATUS_LIMIT;
    if (looks % WRITTEN_EVERY == 0 && is_overfull(bounds)) return STATUS_LIMIT;
    (void)nanosleep(&pause, NULL);
  }
}

static void end_child(pid_t child)
{
  int state;
  (void)kill(-child, SIGTERM);
  const struct bounds soon = {.end = clock_seconds(CLOCK_MONOTONIC) + GRACE}, never = {.end = INFINITY};
  const enum status ended = wait_child(child, &soon, &state);
  (void)kill(-child, SIGKILL); /* and the rest of its group */
  if (ended != STATUS_OK) (void)wait_child(child, &never, &state);
}

enum status process_run(const struct process_request *request, const atomic_int *stop, struct process_result *out)
{
  *out = (struct process_result){0};
  int report[2];
  if (pipe(report) != 0) {
    out->reason = errno;
    return STATUS_FILE;
  }
  (void)fcntl(report[0], F_SETFD, FD_CLOEXEC);
  (void)fcntl(report[1], F_SETFD, FD_CLOEXEC);
  const double start = clock_seconds(CLOCK_MONOTONIC), cpu_start = children_seconds();
  const struct bounds bounds = {.stop = stop,
                                .end = request->timeout > 0 ? start + request->timeout : INFINITY,
                                .folder = request->folder,
                                .most = request->written == 0 ? 0 : request->written + folder_bytes(request->folder)};
  const pid_t us = getpid(), child = fork();
  if (child == 0) become(request, report[1], us);
  const int fork_reason = errno;
  (void)close(report[1]);
  if (child < 0) {
    (void)close(report[0]);
    out->reason = fork_reason;
    return STATUS_FILE;
  }
  (void)setpgid(child, child); /* both sides call it, because either may run first */
  ssize_t told;
  do told = read(report[0], &out->reason, sizeof out->reason);
  while (told < 0 && errno == EINTR);
  (void)close(report[0]);
  int state = 0;
  const enum status status = wait_child(child, &bounds, &state);
  if (status != STATUS_OK) {
    end_child(child);
    out->overfull = status == STATUS_LIMIT && is_overfull(&bounds);
    return status;
  }
  if (told == (ssize_t)sizeof out->reason) {
    out->missing = out->reason == ENOENT || out->reason == EACCES || out->reason == ENOTDIR;
    return STATUS_FILE;
  }
  out->time = (struct seconds){clock_seconds(CLOCK_MONOTONIC) - start, children_seconds() - cpu_start};
  out->exit_code = WIFSIGNALED(state) ? EXIT_SIGNAL + WTERMSIG(state) : WEXITSTATUS(state);
  return STATUS_OK;
}

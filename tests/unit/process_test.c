/* Other programs: their surroundings, how they end, and that they do. */
#include "page/process.h"

#include <errno.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cmocka_test.h"
#include "files.h"

static const char *const OUTPUT = "output";

/* Set by SIGUSR1, with which a program says that it is ready to be stopped. */
static atomic_int stop;
static void on_ready(int signal) { atomic_store(&stop, signal); }

/* Runs this program of a shell, otherwise as the request says. */
static enum status run(struct process_request request, const char *program, struct process_result *out)
{
  const char *const arguments[] = {"sh", "-c", program, NULL};
  request.arguments = arguments, request.output = OUTPUT;
  atomic_store(&stop, 0);
  return process_run(&request, &stop, out);
}

IN_FOLDER(output_is_new_and_input_is_empty)
{
  struct process_result result;
  int ours[2];
  const int saved = dup(STDIN_FILENO);
  assert_true(saved >= 0 && pipe(ours) == 0 && write(ours[1], "ours\n", 5) == 5 && close(ours[1]) == 0);
  assert_true(dup2(ours[0], STDIN_FILENO) >= 0 && close(ours[0]) == 0);
  const enum status first = run((struct process_request){0}, "echo a longer text", &result);
  const enum status second = run((struct process_request){0}, "cat; echo out; echo error >&2; exit 3", &result);
  assert_true(dup2(saved, STDIN_FILENO) >= 0 && close(saved) == 0);
  assert_true(first == STATUS_OK && second == STATUS_OK && result.exit_code == 3);
  expect_file(OUTPUT, "out\nerror\n");
}

IN_FOLDER(the_environment_is_changed)
{
  struct process_result result;
  const char *const pairs[] = {"PSCN_TEST_A", NULL, "PSCN_TEST_B", "new", NULL};
  assert_int_equal(mkdir("inside", 0777), 0);
  assert_true(setenv("PSCN_TEST_A", "old", 1) == 0 && setenv("PSCN_TEST_B", "old", 1) == 0);
  assert_int_equal(run((struct process_request){.environment = pairs, .folder = "inside"},
                       "echo ${PSCN_TEST_A-unset} $PSCN_TEST_B ${PWD##*/}", &result),
                   STATUS_OK);
  expect_file(OUTPUT, "unset new inside\n");
}

/* The program obeys these signals even if we ignore them. */
IN_FOLDER(signals_end_it)
{
  const int signals[] = {SIGINT, SIGTERM, SIGHUP, SIGXCPU, SIGXFSZ};
  for (size_t k = 0; k < sizeof signals / sizeof *signals; k++) {
    char program[50];
    struct process_result result;
    snprintf(program, sizeof program, "kill -%d $$; exit 0", signals[k]);
    void (*const before)(int) = signal(signals[k], SIG_IGN);
    const enum status status = run((struct process_request){0}, program, &result);
    (void)signal(signals[k], before);
    assert_int_equal(status, STATUS_OK);
    assert_int_equal(result.exit_code, 128 + signals[k]);
  }
}

/* Soft and hard limits. A shell counts addresses in units of 1024 bytes, files in units of 512. */
IN_FOLDER(limits_are_kept)
{
  struct process_result result;
  struct rlimit core, file;
  assert_true(getrlimit(RLIMIT_CORE, &core) == 0 && getrlimit(RLIMIT_FSIZE, &file) == 0);
  assert_int_equal(setrlimit(RLIMIT_CORE, &(struct rlimit){core.rlim_max, core.rlim_max}), 0);
  assert_int_equal(run((struct process_request){.memory = (size_t)1 << 30},
                       "ulimit -c; ulimit -v; ulimit -f; ulimit -H -v; ulimit -H -f", &result),
                   STATUS_OK);
  expect_file(OUTPUT, "0\n1048576\n2097152\n1048576\n2097152\n");
  /* A limit that is lower already is kept. */
  assert_int_equal(setrlimit(RLIMIT_FSIZE, &(struct rlimit){1 << 20, file.rlim_max}), 0);
  assert_int_equal(run((struct process_request){.memory = (size_t)1 << 30}, "ulimit -f", &result), STATUS_OK);
  expect_file(OUTPUT, "2048\n");
  assert_true(setrlimit(RLIMIT_CORE, &core) == 0 && setrlimit(RLIMIT_FSIZE, &file) == 0);
}

IN_FOLDER(it_writes_in_its_folder_only)
{
  struct process_result result;
  if (!process_can_confine()) skip();
  assert_int_equal(mkdir("inside", 0777), 0);
  assert_int_equal(run((struct process_request){.folder = "inside", .confined = true},
                       "echo text >file; exec 2>&-; (echo text >../outside) || echo not outside", &result),
                   STATUS_OK);
  expect_file(OUTPUT, "not outside\n");
  assert_int_equal(access("inside/file", R_OK), 0);
}

IN_FOLDER(what_cannot_be_run_is_missing)
{
  const struct {
    const char *program;
    int reason;
  } cases[] = {
    {"pscn-no-such-program", ENOENT}, {"inside/file", EACCES}, {"inside/file/x", ENOTDIR}, {"./inside", EACCES}};
  assert_int_equal(mkdir("inside", 0777), 0);
  put_text("inside/file", "");
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    struct process_result result;
    const char *const arguments[] = {cases[k].program, NULL};
    const struct process_request request = {.arguments = arguments, .output = OUTPUT};
    assert_int_equal(process_run(&request, NULL, &result), STATUS_FILE);
    assert_true(result.missing);
    assert_int_equal(result.reason, cases[k].reason);
  }
}

/* Its time excludes that of the programs before it. */
IN_FOLDER(time_is_its_own)
{
  struct process_result busy, idle;
  assert_int_equal(run((struct process_request){0}, "k=0; while [ $k -lt 100000 ]; do k=$((k + 1)); done", &busy),
                   STATUS_OK);
  assert_int_equal(run((struct process_request){0}, "sleep 0.01", &idle), STATUS_OK);
  assert_true(busy.time.cpu > idle.time.cpu && idle.time.wall >= 0.01);
}

/* The whole group is asked to end, and has some time for it. Here not the program does so, but one that it started. */
IN_FOLDER(it_is_asked_to_end)
{
  struct process_result result;
  assert_int_equal(run((struct process_request){0},
                       "us=$PPID; trap : TERM; (trap 'echo ended; exit' TERM; kill -USR1 $us; while :; do :; done) & "
                       "wait; wait",
                       &result),
                   STATUS_INTERRUPTED);
  expect_file(OUTPUT, "ended\n");
}

/* A program that does not listen is killed: nobody holds the pipe any more. */
IN_FOLDER(it_is_made_to_end)
{
  struct process_result result;
  int held[2];
  char byte;
  assert_int_equal(pipe(held), 0);
  assert_int_equal(
    run((struct process_request){0}, "us=$PPID; (trap '' TERM; kill -USR1 $us; exec sleep 1000) & wait", &result),
    STATUS_INTERRUPTED);
  assert_int_equal(close(held[1]), 0);
  struct pollfd end = {.fd = held[0], .events = POLLIN};
  assert_int_equal(poll(&end, 1, 100000), 1);
  assert_int_equal(read(held[0], &byte, 1), 0);
  assert_int_equal(close(held[0]), 0);
}

int main(void)
{
  const struct sigaction ready = {.sa_handler = on_ready};
  if (sigaction(SIGUSR1, &ready, NULL) != 0) return 1;
  return test_run();
}

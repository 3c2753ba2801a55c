/* Signals that end the process. */
#include "command/interrupt.h"

#include <signal.h>
#include <stdbool.h>
#include <stddef.h>
#include <unistd.h>

enum { EXIT_SIGNAL = 128 };

atomic_int interrupt_signal;
static atomic_bool deferred;

/* The other signals may come in a row by themselves: SIGXCPU each second, SIGHUP from the shell and the terminal. */
static bool is_said_again(int number)
{
  return atomic_load(&interrupt_signal) != 0 && (number == SIGINT || number == SIGTERM);
}

static void handle(int number)
{
  if (!atomic_load(&deferred) || is_said_again(number)) _exit(EXIT_SIGNAL + number);
  atomic_store(&interrupt_signal, number);
}

void interrupt_install(void)
{
  struct sigaction action = {.sa_handler = handle};
  sigemptyset(&action.sa_mask);
  (void)sigaction(SIGINT, &action, NULL);
  (void)sigaction(SIGTERM, &action, NULL);
  (void)sigaction(SIGXCPU, &action, NULL); /* the soft limit: some time remains to save what is done */
  (void)signal(SIGXFSZ, SIG_IGN);          /* writing past the limit on file sizes is then an error of write */
  (void)signal(SIGCHLD, SIG_DFL);          /* if our parent ignores it, we could not learn how a child ended */
  struct sigaction hangup;
  if (sigaction(SIGHUP, NULL, &hangup) == 0 && hangup.sa_handler != SIG_IGN) /* nohup(1) stays effective */
    (void)sigaction(SIGHUP, &action, NULL);
}

/* Sets the action of SIGPIPE, unless it was ignored when we were started. */
static void on_broken_pipe(void (*action)(int))
{
  struct sigaction now;
  if (sigaction(SIGPIPE, NULL, &now) != 0 || now.sa_handler == SIG_IGN) return;
  now = (struct sigaction){.sa_handler = action};
  sigemptyset(&now.sa_mask);
  (void)sigaction(SIGPIPE, &now, NULL);
}

void interrupt_defer(void)
{
  atomic_store(&deferred, true);
  on_broken_pipe(handle);
}

void interrupt_resume(void)
{
  atomic_store(&deferred, false);
  on_broken_pipe(SIG_DFL);
}

void interrupt_end(void) { _exit(interrupt_exit_code()); }

int interrupt_exit_code(void) { return EXIT_SIGNAL + atomic_load(&interrupt_signal); }

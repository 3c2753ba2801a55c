/* Signals that end the process. */
#include "command/interrupt.h"

#include <signal.h>
#include <stdbool.h>
#include <stddef.h>
#include <unistd.h>

enum { EXIT_SIGNAL = 128 };

atomic_int interrupt_signal;
static atomic_bool deferred;

static void handle(int number)
{
  if (!atomic_load(&deferred))
    _exit(EXIT_SIGNAL + number);
  atomic_store(&interrupt_signal, number);
}

void interrupt_install(void)
{
  struct sigaction action = { .sa_handler = handle };
  sigemptyset(&action.sa_mask);
  (void)sigaction(SIGINT, &action, NULL);
  (void)sigaction(SIGTERM, &action, NULL);
  (void)signal(SIGXFSZ, SIG_IGN); /* a file that may grow no further is an error of write, told as such */
  struct sigaction hangup;
  if (sigaction(SIGHUP, NULL, &hangup) == 0 && hangup.sa_handler != SIG_IGN) /* nohup(1) stays in force */
    (void)sigaction(SIGHUP, &action, NULL);
}

void interrupt_defer(void)
{
  atomic_store(&deferred, true);
}

void interrupt_resume(void)
{
  atomic_store(&deferred, false);
}

int interrupt_exit_code(void)
{
  return EXIT_SIGNAL + atomic_load(&interrupt_signal);
}

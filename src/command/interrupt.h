/* SIGINT, SIGTERM, SIGHUP and SIGXCPU: the process ends with 128 + the signal's number (130, 143, 129, 152) and leaves
 * nothing behind.
 *
 * A signal ends the process at once. Between interrupt_defer and interrupt_resume it only raises the flag, for whoever
 * has something to put away first, and watches it; the command then answers STATUS_INTERRUPTED, of which main makes
 * interrupt_exit_code(). So does a reader that goes away: SIGPIPE, which otherwise keeps its default. A SIGHUP that is
 * ignored when we start, as under nohup, stays ignored; SIGXFSZ is, so that a file that may grow no further is an error
 * of writing it.
 */
#ifndef PSCN_COMMAND_INTERRUPT_H
#define PSCN_COMMAND_INTERRUPT_H

#include <stdatomic.h>

/* The number of the signal that came, or 0. */
extern atomic_int interrupt_signal;

/* Called by main once, before any thread starts. */
void interrupt_install(void);
void interrupt_defer(void);
void interrupt_resume(void);

/* 128 + the signal that came; 128 where none has. */
int interrupt_exit_code(void);

#endif

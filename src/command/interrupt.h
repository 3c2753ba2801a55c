/* SIGINT, SIGTERM, SIGHUP and SIGXCPU end the process with exit code 128 + the signal's number (130, 143, 129, 152) and
 * leave nothing behind.
 *
 * A signal ends the process at once. Between interrupt_defer and interrupt_resume the first one only sets the flag
 * interrupt_signal, for code that has something to save first; the command then returns STATUS_INTERRUPTED, which main
 * turns into interrupt_exit_code(). A second SIGINT or SIGTERM ends the process at once even there. SIGPIPE (the reader
 * has gone) is treated there as the first one; elsewhere it keeps its default. A SIGHUP that is ignored at the start, as
 * under nohup, stays ignored. SIGXFSZ is ignored, so that a file that may grow no further is an error of writing.
 */
#ifndef PSCN_COMMAND_INTERRUPT_H
#define PSCN_COMMAND_INTERRUPT_H

#include <stdatomic.h>

/* The number of the signal that came, or 0. */
extern atomic_int interrupt_signal;

/* main calls this once, before any thread starts. */
void interrupt_install(void);
void interrupt_defer(void);
void interrupt_resume(void);

/* Ends the process now, without waiting for other threads. */
void interrupt_end(void) __attribute__((noreturn));

/* 128 + the number of the signal that came; 128 if none has. */
int interrupt_exit_code(void);

#endif

/* One status enum for the whole library.
 *
 * A function that can fail for a reason outside the program returns it and is marked STATUS_MUST_CHECK. A miss, "no
 * real root" or "grazing" is a result, never a status. The values are the exit codes of the command (fixed contract).
 */
#ifndef PSCN_BASE_STATUS_H
#define PSCN_BASE_STATUS_H

enum status {
  STATUS_OK = 0,
  STATUS_DIFFERENT = 1,    /* a comparison failed its limits */
  STATUS_USAGE = 2,        /* the command line is wrong */
  STATUS_INPUT = 3,        /* a scene or an input line is wrong; diagnostics say where */
  STATUS_FILE = 4,         /* a file cannot be opened, read, written or renamed */
  STATUS_LIMIT = 5,        /* out of memory, or a stated limit was passed */
  STATUS_INTERRUPTED = 130 /* SIGINT; for SIGTERM the command answers 143 */
};

#define STATUS_MUST_CHECK __attribute__((warn_unused_result))

#endif

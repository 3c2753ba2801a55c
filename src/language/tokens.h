/* The stream of tokens that the grammar reads, after conditions; and recovery from syntax errors. */
#ifndef PSCN_LANGUAGE_TOKENS_H
#define PSCN_LANGUAGE_TOKENS_H

#include "language/sources.h"

/* The last token given to the parser, and what is needed to give it again. */
struct delivered {
  int token;
  struct span place;
  int depth;  /* braces open before it */
  bool again; /* it is also the next token */
};

/* Where in a solver statement the next token is. All words are plain there, except in a number's parentheses. */
enum solver_part { SOLVER_OUTSIDE, SOLVER_NAME, SOLVER_BEHIND_NAME, SOLVER_BLOCK };

/* Zeroed: no token given yet. */
struct tokens {
  bool solver_only; /* the text is that which follows `solver` */
  int made_up;      /* tokens given before those of the text */
  enum solver_part solver_part;
  int parentheses; /* open in the solver's block */
  int depth;       /* braces open */
  struct span braces[MAX_NESTING];
  struct delivered last;
  struct span previous;        /* that of the token before the last */
  int skipping;                /* in tokens_recover: 1 plus the braces open where it began */
  struct span recovered, told; /* where the last recovery began; what the last syntax error was about */
};

/* The next token of the grammar, described by tokens->last. 0 at the end, and where reading must end early. */
int tokens_next(struct language *language);

/* After a syntax error, skips to the next item of the block in which the error is, counting braces, or to the block's
 * closing brace. The token of the error counts too. False if the text has ended. */
bool tokens_recover(struct language *language);

#endif

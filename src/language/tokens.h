/* The stream of tokens the grammar reads: what conditions leave over of the sources; recovery from syntax errors. */
#ifndef PSCN_LANGUAGE_TOKENS_H
#define PSCN_LANGUAGE_TOKENS_H

#include "language/sources.h"

/* The last token handed to the parser, and what it takes to hand it out again. */
struct delivered {
  int token;
  struct span place;
  int depth;  /* of braces, before it */
  bool again; /* it comes next once more */
};

/* Where in a solver statement the next token stands: there all words are plain, but in the parentheses of a number. */
enum solver_part { SOLVER_OUTSIDE, SOLVER_NAME, SOLVER_BEHIND_NAME, SOLVER_BLOCK };

/* Zeroed: nothing handed out. */
struct tokens {
  bool solver_only; /* the text is what follows `solver` */
  int made_up;      /* tokens handed out before those of the text */
  enum solver_part solver_part;
  int parentheses; /* open in its block */
  int depth;       /* braces open */
  struct span braces[MAX_NESTING];
  struct delivered last;
  struct span previous;        /* of the token before the last */
  int skipping;                /* in tokens_recover: 1 and the braces open where it began */
  struct span recovered, told; /* where the last recovery began, what the last syntax error was about */
};

/* The next token of the grammar, which tokens->last tells of. 0 also where reading must end early. */
int tokens_next(struct language *language);

/* After a syntax error: skips to where the next item of the block begins in which the error stands, counting braces,
 * or to its closing brace. The token at which the error was found is taken into account. False where the text has
 * ended. */
bool tokens_recover(struct language *language);

#endif

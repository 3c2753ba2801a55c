/* The stream of tokens that the grammar reads, after conditions; recovery from syntax errors; and directives. */
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

/* A directive that a parser of its own reads, and what was there before it. */
struct own {
  int token;
  const struct declaration *outer;
  size_t declared;
  struct declaration declaration; /* its own, while it is open */
};

/* Zeroed: no token given yet. */
struct tokens {
  bool solver_only; /* the text is that which follows `solver` */
  int start[2];     /* tokens to be given before those of the text, the last one first; 0: none */
  int nested;       /* parsers within each other */
  struct own *own;  /* the directive being read, or NULL */
  bool naming;      /* the next word is not that of a macro to be called */
  enum solver_part solver_part;
  int parentheses; /* open in the solver's block */
  int depth;       /* braces open */
  struct span braces[MAX_NESTING];
  struct delivered last;
  struct span previous;        /* that of the token before the last */
  struct span word;            /* that of the last word that stands for something */
  int skipping;                /* in tokens_recover: 1 plus the braces open where it began */
  struct span recovered, told; /* where the last recovery began; what the last syntax error was about */
};

/* The next token of the grammar, described by tokens->last. 0 at the end, and after too many errors. */
int tokens_next(struct language *language);

/* Parses what `start` begins with another parser, from the next token on, and gives its values as a list, which the
 * caller frees also after an error. An error has been reported; the text is then read from behind its parentheses on. */
bool tokens_parse(struct language *language, int start, struct value **out);

/* After a syntax error, skips to the next item of the block in which the error is, counting braces, or to the block's
 * closing brace. The token of the error counts too. False if the text has ended. */
bool tokens_recover(struct language *language);

/* Skips what belongs to the word just read, in the same way. */
void tokens_pass(struct language *language);

/* Skips a block in braces, which must follow. Returns its closing brace, or after an error where that is. */
struct span tokens_pass_block(struct language *language);

/* ---- directives, and all other tokens of the scanner that are not the grammar's ---- */

/* Handles the scanner's last token if it is not the grammar's. Returns whether it did and the next one is wanted. */
bool directives_pass(struct language *language, int token);

/* The next token of the source being read, whatever it is; counts those that loops and macros read again. */
int directives_scan(struct language *language);

/* Reads the name behind a directive, which is not a word of the language or of POV-Ray's. False, after an error, if
 * there is none. */
bool directives_name(struct language *language, const char *directive, struct name *out);

/* Reports the comment or the quote that the source does not close. */
void directives_tell_open(struct language *language, int token);

/* At #debug, #warning or #error: reads the string behind it and prints it. */
void message_pass(struct language *language, int directive);

/* At the end, prints what #debug said without ending its line. */
void messages_end(struct language *language);

/* ---- conditions, loops and #switch; a loop's text is read again from its place in the source ---- */

/* If the scanner's last token is a directive of these, or an #end, handles it. Returns whether it did. */
bool control_pass(struct language *language, int token);

/* Skips to behind the matching #end; false if there is none. */
bool control_skip_to_end(struct language *language);

/* At the end of a source, reports what is open in it. */
void control_end(struct language *language);

/* Goes back to the includer or to the call. */
void control_leave(struct language *language);

/* ---- macros ---- */

/* At #macro: declares a macro, and passes over its text. */
void macro_declare(struct language *language);

/* If the word just read names a macro, reads its arguments and begins to read its text. Returns whether it did. */
bool macro_called(struct language *language);

#endif

/* The stream of tokens the grammar reads: scanners over sources, includes and conditions.
 *
 * Internal to src/language and grammar/.
 */
#ifndef PSCN_LANGUAGE_TOKENS_H
#define PSCN_LANGUAGE_TOKENS_H

#include <setjmp.h>
#include <stdbool.h>
#include <stddef.h>

#include "language/build.h"
#include "pscn.tab.h"

/* What the scanner finds besides the grammar's tokens; tokens_next never hands these on. */
enum {
  TOKEN_FIRST_PRIVATE = 1000,
  TOKEN_OPEN_COMMENT,
  TOKEN_OPEN_STRING,
  TOKEN_BAD_CHARACTER,
  TOKEN_TOO_LARGE,
  TOKEN_NO_MEMORY,
  TOKEN_INCLUDE,
  TOKEN_IFDEF,
  TOKEN_IFNDEF,
  TOKEN_ELSE,
  TOKEN_ENDIF,
  TOKEN_FOREIGN_DIRECTIVE, /* a directive of POV-Ray's that is not in the language */
  TOKEN_FOREIGN            /* a word of POV-Ray's that is not in the language */
};

/* One scanner over one text. */
struct scan {
  void *scanner;
  size_t begin, end; /* bytes of the last token */
  size_t comment_begin;
  int comment_depth;
  double number[3]; /* of PSCN_TOKEN_NUMBER ([0]) and PSCN_TOKEN_POINT */
  jmp_buf broken;
};

/* Scans text[0 .. length-1], behind which stand two NULs; the text is written to while scanning and must outlive the scanner.
 * False where memory is short. */
bool pscn_scan_open(struct scan *scan, char *text, size_t length);

/* The next token: a grammar token, 0 at the end, or one of the above. */
int pscn_scan_next(struct scan *scan);
void pscn_scan_close(struct scan *scan);

/* What token a word, or a directive with its #, is. */
int tokens_word(const char *text, size_t length);
int tokens_directive(const char *text, size_t length);

/* The next token for the grammar. */
int tokens_next(struct language *language, struct token *out_token, struct place *out_place);

/* Begins to read from a source, which the stream takes over (also on failure). False where memory is short. */
bool tokens_open(struct language *language, struct source *source);

/* Closes all scanners and frees all sources. */
void tokens_close(struct language *language);

#endif

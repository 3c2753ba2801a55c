/* The stream of tokens the grammar reads: scanners over sources, includes, conditions, and recovery from syntax errors.
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
  TOKEN_NO_MEMORY,
  TOKEN_INCLUDE,
  TOKEN_IFDEF,
  TOKEN_IFNDEF,
  TOKEN_ELSE,
  TOKEN_ENDIF,
  TOKEN_FOREIGN_OPENER,    /* a directive of POV-Ray's that is not in the language and has an #end: #if, #macro ... */
  TOKEN_FOREIGN_DIRECTIVE, /* one that has none */
  TOKEN_UNKNOWN_DIRECTIVE
};

/* ---- the scanner, grammar/pscn.l ---- */

/* One scanner over one text. */
struct scan {
  void *scanner;
  size_t begin, end; /* bytes of the last token */
  size_t comment_begin;
  int comment_depth;
  double number[3]; /* of PSCN_TOKEN_NUMBER ([0]) and PSCN_TOKEN_POINT */
  bool too_large;   /* one of them is too large for a double: which bytes */
  size_t too_large_begin, too_large_end;
  jmp_buf broken;
  _Alignas(max_align_t) char pool[512]; /* the scanner's memory */
  size_t pool_used;
};

/* Scans text[0 .. length-1], behind which stand two NULs. The text must outlive the scanner; it is written to during
 * pscn_scan_next, and is what it was afterwards. False where it cannot be scanned. */
bool pscn_scan_open(struct scan *scan, char *text, size_t length);

/* The next token: a grammar token, 0 at the end, or one of the above. */
int pscn_scan_next(struct scan *scan);
void pscn_scan_close(struct scan *scan);

/* ---- sources.c ---- */

struct condition {
  struct place place; /* of the #ifdef */
  bool seen_else;
};

enum { MAX_CONDITIONS = 200 }; /* open in one source */

/* A source being read. */
struct frame {
  struct frame *outer;
  const struct source *source;
  struct scan scan;
  struct condition condition[MAX_CONDITIONS];
  int conditions;
};

/* Begins to read a source, which is taken over even on failure: false where memory is short. */
bool sources_open(struct language *language, struct source *source);

/* Tells the scene which files were read; false where memory is short. */
bool sources_list(const struct language *language, struct scene *scene);

/* Reads the file name behind #include and begins to read that file, or tells an error. */
void sources_include(struct language *language);

/* Goes back to the includer. */
void sources_leave(struct language *language);
void sources_close(struct language *language);

/* The bytes of the last token of the source being read. */
struct place sources_here(const struct language *language);

/* ---- keywords.c ---- */

/* What token a word, or a directive with its #, is. */
int keyword_token(const char *text, size_t length);
int keyword_directive(const char *text, size_t length);

/* Offers all words of the language, or all its directives, to a search for the nearest (words.h). */
void keywords_consider(const char *word, size_t length, const char **best, size_t *best_length, size_t *distance);
void keywords_consider_directives(const char *word, size_t length, const char **best, size_t *best_length,
                                  size_t *distance);

/* ---- tokens.c ---- */

/* The next token of the grammar. 0 also where reading must end early. */
int tokens_next(struct language *language, struct token *out_token, struct place *out_place);

/* After a syntax error: skips to where the next item of the block begins in which the error stands, counting braces,
 * or to its closing brace. The token at which the error was found is taken into account. False where the text has
 * ended. */
bool tokens_recover(struct language *language);

#endif

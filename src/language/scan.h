/* The scanner, grammar/pscn.l: from text to tokens. */
#ifndef PSCN_LANGUAGE_SCAN_H
#define PSCN_LANGUAGE_SCAN_H

#include <setjmp.h>
#include <stdbool.h>
#include <stddef.h>

#include "pscn.tab.h"

/* What the scanner finds besides the grammar's tokens; tokens_next never hands these on. */
enum {
  TOKEN_FIRST_PRIVATE = 1000,
  TOKEN_OPEN_COMMENT,
  TOKEN_OPEN_STRING,
  TOKEN_BAD_CHARACTER,
  TOKEN_INCLUDE,
  TOKEN_IFDEF,
  TOKEN_IFNDEF,
  TOKEN_ELSE,
  TOKEN_ELSEIF, /* POV-Ray's */
  TOKEN_ENDIF,
  TOKEN_MACRO,
  TOKEN_UNDEF,
  TOKEN_FOREIGN_OPENER,    /* a directive of POV-Ray's that is not in the language and has an #end: #if, #while ... */
  TOKEN_FOR,               /* #for, which declares its variable besides */
  TOKEN_FOREIGN_DIRECTIVE, /* one that has none */
  TOKEN_FILE,              /* #fopen, which declares a name, or #fclose, which forgets it */
  TOKEN_READ,              /* #read, which gives values to several */
  TOKEN_UNKNOWN_DIRECTIVE,
  TOKEN_SECOND_POINT, /* a number with a point too many, and what follows it; scan->number[0] is 1 */
  TOKEN_OPEN_EXPONENT /* a number with an exponent that has no digits, and the word that begins there; likewise */
};

/* One scanner over one text. */
struct scan {
  void *scanner;
  size_t begin, end; /* bytes of the last token */
  size_t length;     /* of the text */
  bool hash;         /* a # and comments stand before the word that comes next */
  size_t comment_begin;
  int comment_depth;
  size_t bad_end;   /* behind the last characters that mean nothing */
  double number[3]; /* of PSCN_TOKEN_NUMBER ([0]) and PSCN_TOKEN_POINT */
  bool too_large;   /* one of them is too large for a double: which bytes */
  size_t too_large_begin, too_large_end;
  jmp_buf *broken;
  _Alignas(max_align_t) char pool[512]; /* the scanner's memory */
  size_t pool_used;
};

/* Scans text[0 .. length-1], behind which stand two NULs. The text must outlive the scanner; it is written to during
 * pscn_scan_next, and is what it was afterwards. Should the scanner ever break, *broken is jumped to, which must be set.
 * False where the text cannot be scanned. */
bool pscn_scan_open(struct scan *scan, char *text, size_t length, jmp_buf *broken);

/* The next token: a grammar token, 0 at the end, or one of the above. */
int pscn_scan_next(struct scan *scan);
void pscn_scan_close(struct scan *scan);

/* The number that a digit by itself is, as many are. */
void scan_digit(struct scan *scan, char digit);

/* Reads `count` numbers out of the last token's text into scan->number. One that is too large becomes the whole token. */
void scan_numbers(struct scan *scan, const char *text, size_t length, int count);

/* Whether text[0 .. length-1], what stands behind a #, is comments and then a word, as POV-Ray allows. */
bool scan_comments_lead_to_word(const char *text, size_t length);

/* Whether a token is a word, be it a name or one of the language's or of POV-Ray's. */
bool scan_is_word(int token);

#endif

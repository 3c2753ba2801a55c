/* The scanner, grammar/pscn.l: from text to tokens. */
#ifndef PSCN_LANGUAGE_SCAN_H
#define PSCN_LANGUAGE_SCAN_H

#include <setjmp.h>
#include <stdbool.h>
#include <stddef.h>

#include "pscn.tab.h"

/* The scanner's tokens that are not the grammar's; tokens_next never returns them. */
enum {
  TOKEN_FIRST_PRIVATE = 1000,
  TOKEN_OPEN_COMMENT,
  TOKEN_OPEN_STRING,
  TOKEN_BAD_CHARACTER,
  TOKEN_BAD_NUMBER, /* one with a second point, or an exponent without digits */
  TOKEN_FIRST_DIRECTIVE,
  TOKEN_INCLUDE,
  TOKEN_IFDEF,
  TOKEN_IFNDEF,
  TOKEN_IF,
  TOKEN_ELSEIF,
  TOKEN_ELSE,
  TOKEN_END,
  TOKEN_WHILE,
  TOKEN_FOR,
  TOKEN_SWITCH,
  TOKEN_CASE,
  TOKEN_RANGE,
  TOKEN_BREAK,
  TOKEN_MACRO,
  TOKEN_UNDEF,
  TOKEN_DEBUG, /* also #render and #statistics, as in POV-Ray */
  TOKEN_WARNING,
  TOKEN_ERROR,
  TOKEN_FOREIGN_DIRECTIVE, /* of files */
  TOKEN_UNKNOWN_DIRECTIVE
};

/* One scanner over one text. */
struct scan {
  void *scanner;
  size_t begin, end; /* bytes of the last token: [begin, end) */
  size_t length;     /* of the text */
  size_t comment_begin;
  int comment_depth;
  double number[3]; /* values of PSCN_TOKEN_NUMBER ([0]) and PSCN_TOKEN_POINT */
  bool too_large;   /* one of them is too large: at these bytes */
  size_t too_large_begin, too_large_end;
  jmp_buf *broken;
  _Alignas(max_align_t) char pool[512]; /* the scanner's memory */
  size_t pool_used;
};

/* Begins to scan text[0 .. length-1], which two NULs must follow. The text must outlive the scanner. pscn_scan_next
 * writes to it, but restores it before it returns. If the scanner breaks, it jumps to *broken, which must be set. */
void pscn_scan_open(struct scan *scan, char *text, size_t length, jmp_buf *broken);

/* The next token: a grammar token, 0 at the end, or one of the above. */
int pscn_scan_next(struct scan *scan);

/* Goes on with the token that begins at that byte, outside of comments. */
void pscn_scan_seek(struct scan *scan, size_t at);
void pscn_scan_close(struct scan *scan);

#endif

/* The contents of tokens. */
#include "language/scan.h"

#include "base/number.h"

void scan_digit(struct scan *scan, char digit)
{
  scan->too_large = false;
  scan->number[0] = digit - '0';
}

void scan_numbers(struct scan *scan, const char *text, size_t length, int count)
{
  size_t at = 0;
  scan->too_large = false;
  for (int k = 0; k < count; k++) {
    size_t used = 0;
    while (text[at] == '<' || text[at] == ',' || (text[at] <= ' ' && text[at] > 0)) at++;
    const enum number_kind kind = number_read(text + at, length - at, &scan->number[k], &used);
    if ((kind == NUMBER_OVERFLOW || fabs(scan->number[k]) > NUMBER_LARGEST) && !scan->too_large) {
      scan->too_large = true;
      scan->too_large_begin = scan->begin + at;
      scan->too_large_end = scan->too_large_begin + used;
    }
    at += used;
  }
}

bool scan_is_word(int token)
{
  return token > 255 && token < TOKEN_FIRST_PRIVATE && token != PSCN_TOKEN_NUMBER && token != PSCN_TOKEN_POINT &&
         token != PSCN_TOKEN_STRING && token != PSCN_TOKEN_VERSION && token != PSCN_TOKEN_DECLARE &&
         token != PSCN_TOKEN_LOCAL && token != PSCN_TOKEN_DEFAULT && token != PSCN_TOKEN_COMPARISON;
}

/* Reads the arguments of options. See values.h. */
#include "command/values.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

#include "base/number.h"

/* Reads decimal digits at *text, whose value is at most `maximum`, and advances it. */
static bool read_digits(const char **text, size_t maximum, size_t *out)
{
  size_t value = 0;
  const char *from = *text;
  for (; *from >= '0' && *from <= '9'; from++) {
    const size_t digit = (size_t)(*from - '0');
    if (digit > maximum || value > (maximum - digit) / 10) return false;
    value = 10 * value + digit;
  }
  if (from == *text) return false;
  *text = from;
  *out = value;
  return true;
}

bool value_integer(const char *text, size_t minimum, size_t maximum, size_t *out)
{
  size_t value;
  if (!read_digits(&text, maximum, &value) || *text != '\0' || value < minimum) return false;
  *out = value;
  return true;
}

/* A finite number >= 0 at the beginning of text; *out_used is its length. */
static bool read_number(const char *text, double *out, size_t *out_used)
{
  return number_read(text, strlen(text), out, out_used) == NUMBER_FINITE && *out >= 0;
}

bool value_number(const char *text, double *out)
{
  double value, divisor = 1;
  size_t used;
  if (!read_number(text, &value, &used)) return false;
  text += used;
  if (*text == '/') {
    if (!read_number(++text, &divisor, &used)) return false;
    text += used;
  }
  if (*text != '\0' || divisor == 0 || !isfinite(value / divisor)) return false;
  *out = value / divisor;
  return true;
}

bool value_bytes(const char *text, size_t *out)
{
  static const char units[] = "KMGT";
  size_t value;
  if (!read_digits(&text, SIZE_MAX, &value) || value == 0) return false;
  const char *unit = *text != '\0' ? strchr(units, *text) : NULL;
  const int shift = unit != NULL ? 10 * (int)(unit - units + 1) : 0;
  if (*(text + (unit != NULL)) != '\0' || value > SIZE_MAX >> shift) return false;
  *out = value << shift;
  return true;
}

bool value_size(const char *text, size_t maximum, size_t *out_width, size_t *out_height)
{
  size_t width, height;
  if (!read_digits(&text, maximum, &width) || (*text != 'x' && *text != 'X')) return false;
  if (!value_integer(text + 1, 1, maximum, &height) || width == 0) return false;
  *out_width = width;
  *out_height = height;
  return true;
}

bool value_range(const char *text, char sign, size_t maximum, size_t *out_first, size_t *out_last)
{
  size_t first, last;
  if (!read_digits(&text, maximum, &first) || *text != sign) return false;
  if (first == 0 || !value_integer(text + 1, first, maximum, &last)) return false;
  *out_first = first;
  *out_last = last;
  return true;
}

bool value_rectangle(const char *text, struct rectangle *out)
{
  struct rectangle r;
  size_t *const part[4] = {&r.x, &r.y, &r.width, &r.height};
  const size_t maximum = (size_t)-1 / 2; /* a sum of two of them does not overflow */
  for (int k = 0; k < 4; k++)
    if ((k > 0 && *text++ != ',') || !read_digits(&text, maximum, part[k])) return false;
  if (*text != '\0' || r.width == 0 || r.height == 0) return false;
  *out = r;
  return true;
}

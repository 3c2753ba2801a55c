/* Reads the arguments of options. See values.h. */
#include "command/values.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

#include "base/number.h"

bool value_digits(const char **text, const char *end, size_t maximum, size_t *out)
{
  size_t value = 0;
  const char *from = *text;
  for (; from < end && *from >= '0' && *from <= '9'; from++) {
    const size_t digit = (size_t)(*from - '0');
    if (digit > maximum || value > (maximum - digit) / 10) return false;
    value = 10 * value + digit;
  }
  if (from == *text) return false;
  *text = from;
  *out = value;
  return true;
}

bool value_sign(const char **text, const char *end, char sign)
{
  if (*text == end || **text != sign) return false;
  ++*text;
  return true;
}

bool value_integer(const char *text, size_t minimum, size_t maximum, size_t *out)
{
  const char *const end = text + strlen(text);
  size_t value;
  if (!value_digits(&text, end, maximum, &value) || text != end || value < minimum) return false;
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
  if (!value_digits(&text, text + strlen(text), SIZE_MAX, &value) || value == 0) return false;
  const char *unit = *text != '\0' ? strchr(units, *text) : NULL;
  const int shift = unit != NULL ? 10 * (int)(unit - units + 1) : 0;
  if (*(text + (unit != NULL)) != '\0' || value > SIZE_MAX >> shift) return false;
  *out = value << shift;
  return true;
}

bool value_size(const char *text, size_t maximum, size_t *out_width, size_t *out_height)
{
  const char *const end = text + strlen(text);
  size_t width, height;
  if (!value_digits(&text, end, maximum, &width) || !(value_sign(&text, end, 'x') || value_sign(&text, end, 'X')) ||
      !value_digits(&text, end, maximum, &height) || text != end || width == 0 || height == 0)
    return false;
  *out_width = width;
  *out_height = height;
  return true;
}

bool value_rectangle(const char *text, struct rectangle *out)
{
  const char *const end = text + strlen(text);
  struct rectangle r;
  size_t *const part[4] = {&r.x, &r.y, &r.width, &r.height};
  const size_t maximum = (size_t)-1 / 2; /* a sum of two of them does not overflow */
  for (int k = 0; k < 4; k++)
    if ((k > 0 && !value_sign(&text, end, ',')) || !value_digits(&text, end, maximum, part[k])) return false;
  if (text != end || r.width == 0 || r.height == 0) return false;
  *out = r;
  return true;
}

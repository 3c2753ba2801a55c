/* The fraction of heavy tests that is done; see effort.h. */
#include "effort.h"

#include <stdlib.h>
#include <string.h>

/* Parses digits with a decimal point, whatever the locale; returns 0 if the text is no such number. */
static double parse_decimal(const char *text)
{
  double value = 0, scale = 1;
  int point_seen = 0;
  for (; *text; text++) {
    if (*text == '.' && !point_seen) {
      point_seen = 1;
    } else if (*text >= '0' && *text <= '9') {
      value = value * 10 + (*text - '0');
      scale *= point_seen ? 10 : 1;
    } else {
      return 0;
    }
  }
  return value / scale;
}

double effort_fraction(void)
{
  const char *text = getenv("PSCN_EFFORT");
  if (!text) return EFFORT_DEFAULT;
  if (!strcmp(text, "full")) return 1;
  double value = parse_decimal(text);
  return value > 0 && value <= 1 ? value : EFFORT_DEFAULT;
}

size_t effort_count(size_t full, size_t least)
{
  size_t count = (size_t)((double)full * effort_fraction());
  if (count < least) count = least;
  return count < full ? count : full;
}

uint64_t effort_seed(uint64_t seed)
{
  const char *text = getenv("PSCN_SEED");
  return text ? seed + 1000000 * (uint64_t)parse_decimal(text) : seed;
}

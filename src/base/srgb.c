/* The sRGB transfer function, IEC 61966-2-1. */
#include "base/srgb.h"

#include <math.h>

/* The standard's constants. */
static const double LINEAR_LIMIT = 0.0031308; /* of linear light, below which the curve is a line */
static const double ENCODED_LIMIT = 0.04045;  /* the same point, encoded */
static const double SLOPE = 12.92;            /* of that line */
static const double OFFSET = 0.055;
static const double EXPONENT = 2.4;

/* NaN compares false and gives 0. */
static double clip(double value) { return value > 0 ? value < 1 ? value : 1 : 0; }

double srgb_encode(double linear)
{
  return linear <= LINEAR_LIMIT ? SLOPE * linear : (1 + OFFSET) * pow(linear, 1 / EXPONENT) - OFFSET;
}

double srgb_decode(double encoded)
{
  return encoded <= ENCODED_LIMIT ? encoded / SLOPE : pow((encoded + OFFSET) / (1 + OFFSET), EXPONENT);
}

void srgb_table_fill(struct srgb_table *out)
{
  for (int k = 1; k <= 255; k++) out->bound[k - 1] = (float)srgb_decode((k - 0.5) / 255);
}

uint8_t srgb_encode8(const struct srgb_table *table, float linear)
{
  /* The number of bounds that are not above the value: a binary search over 255 = 2^8 - 1 bounds. */
  unsigned code = 0;
  for (unsigned step = 128; step != 0; step /= 2)
    if (linear >= table->bound[code + step - 1]) code += step;
  return (uint8_t)code;
}

uint16_t srgb_encode16(float linear) { return (uint16_t)(srgb_encode(clip((double)linear)) * 65535 + 0.5); }

uint8_t srgb_code8(float encoded) { return (uint8_t)(clip((double)encoded) * 255 + 0.5); }

uint16_t srgb_code16(float encoded) { return (uint16_t)(clip((double)encoded) * 65535 + 0.5); }

/* The sRGB transfer function, IEC 61966-2-1: linear light to display code, rounded once.
 *
 * Codes are clipped to their range; NaN counts as 0.
 */
#ifndef PSCN_BASE_SRGB_H
#define PSCN_BASE_SRGB_H

#include <stdint.h>

/* Linear [0,1] to encoded [0,1], and the inverse; the curves go on beyond. */
double srgb_encode(double linear);
double srgb_decode(double encoded);

/* The linear values at which the 8-bit codes 1 to 255 start: code k at bound[k - 1]. So a decoded code that lies half
 * way between two 8-bit ones, as 0.5 does, becomes the upper one, as in POV-Ray. */
struct srgb_table {
  float bound[255];
};
void srgb_table_fill(struct srgb_table *out);

/* The nearest code of a linear value. */
uint8_t srgb_encode8(const struct srgb_table *table, float linear);
uint16_t srgb_encode16(float linear);

/* The nearest code of an encoded value. */
uint8_t srgb_code8(float encoded);
uint16_t srgb_code16(float encoded);

#endif

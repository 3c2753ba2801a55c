/* Numbers as text, the same in every locale.
 *
 * Safe on any thread; nothing allocates.
 */
#ifndef PSCN_BASE_NUMBER_H
#define PSCN_BASE_NUMBER_H

#include <math.h>
#include <stdbool.h>
#include <stddef.h>

/* Room for any number written here, with its NUL. */
enum { NUMBER_TEXT_SIZE = 32 };

enum number_kind {
  NUMBER_NONE,    /* no number at the beginning */
  NUMBER_FINITE,  /* the nearest double, ties to even; a number too small for a double is 0 or subnormal */
  NUMBER_OVERFLOW /* a number too large for a double */
};

/* Reads [+-] digits [. digits] [e|E [+-] digits] at the beginning of text[0 .. length-1], with digits on at least one
 * side of the point. *out_used is how many bytes belong to it. Both results are written unless the answer is
 * NUMBER_NONE. No blanks are skipped; inf, nan and hexadecimal are no numbers. */
enum number_kind number_read(const char *text, size_t length, double *out_value, size_t *out_used);

/* The numbers of scenes and rays. Larger ones are errors; smaller ones count as 0 where they are a coordinate or the
 * result of arithmetic. So no product of three overflows or vanishes. */
#define NUMBER_LARGEST 1e100
#define NUMBER_LEAST 1e-100

/* Whether a scene or a ray may have this number, which becomes 0 if it is too small. */
static inline bool number_in_range(double *x)
{
  if (fabs(*x) < NUMBER_LEAST) *x = 0;
  return fabs(*x) <= NUMBER_LARGEST;
}

/* Writes the fewest correctly rounded digits that read back as the same finite double; `out` holds NUMBER_TEXT_SIZE
 * bytes. Returns the length. Not finite: "inf", "-inf", "nan". */
size_t number_write(double value, char *out);

/* Writes with 17 significant digits, trailing zeros dropped (the same value as %.17g prints). Not finite: as above. */
size_t number_write_17(double value, char *out);

#endif

/* Exact conversion between doubles and decimal digits, for numbers of everyday size.
 *
 * Both directions work in integers. With 5^n for n <= 54 in 128 bits, a double times a power of ten is an integer times
 * a power of two, so rounding is one exact comparison (ties to even, as IEEE arithmetic and printf round). For numbers
 * outside the range the functions return false, and the caller has a slower way. Safe on any thread.
 */
#ifndef PSCN_BASE_DECIMAL_H
#define PSCN_BASE_DECIMAL_H

#include <stdbool.h>
#include <stdint.h>

/* The nearest decimal number of `count` digits, 1 <= count <= 17: digits x 10^exponent, 10^(count-1) <= digits <
 * 10^count. Always true for count 17 and 1e-30 <= value <= 1e15. Other numbers may give false, and nothing is
 * written. */
bool decimal_from_double(double value, int count, uint64_t *out_digits, int *out_exponent);

/* The double nearest to digits x 10^exponent, digits > 0. Always true for exponents from -27 to 27; otherwise false,
 * and nothing is written. */
bool decimal_to_double(uint64_t digits, int exponent, double *out_value);

#endif

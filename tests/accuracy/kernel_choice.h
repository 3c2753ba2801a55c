/* Which instruction set a tracer uses: for tests that compare them.
 */
#ifndef TESTS_ACCURACY_KERNEL_CHOICE_H
#define TESTS_ACCURACY_KERNEL_CHOICE_H

#include <stddef.h>

#include "intersect/intersect.h"

/* How many this processor can run; the last is the plainest. */
size_t kernel_choices(void);

/* From now on the tracer uses number `index`, whose name is returned. */
const char *kernel_choose(struct tracer *tracer, size_t index);

#endif

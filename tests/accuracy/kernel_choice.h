/* Chooses the instruction set that a tracer uses, for tests that compare them. */
#ifndef TESTS_ACCURACY_KERNEL_CHOICE_H
#define TESTS_ACCURACY_KERNEL_CHOICE_H

#include <stddef.h>

#include "intersect/intersect.h"

/* How many sets this processor can run; the last is the plainest. */
size_t kernel_choices(void);

/* Makes the tracer use number `index`; returns its name. */
const char *kernel_choose(struct tracer *tracer, size_t index);

#endif

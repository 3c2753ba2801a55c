/* See kernel_choice.h. */
#include "accuracy/kernel_choice.h"

#include "intersect/tracer.h"

size_t kernel_choices(void)
{
  const struct kernel *kernels[KERNELS_MAX];
  return kernels_here(kernels);
}

const char *kernel_choose(struct tracer *tracer, size_t index)
{
  const struct kernel *kernels[KERNELS_MAX];
  kernels_here(kernels);
  tracer->kernel = kernels[index];
  return kernels[index]->name;
}

/* The space of a scene's colours. */
#include "scene/gamma.h"

#include <float.h>
#include <math.h>

#include "base/srgb.h"

double gamma_to_light(double gamma, double part)
{
  const double size = fabs(part), light = gamma == GAMMA_SRGB ? srgb_decode(size) : pow(size, gamma);
  return copysign(fmin(light, FLT_MAX), part);
}

double gamma_of_srgb(double gamma, double code)
{
  return gamma == GAMMA_SRGB ? code : pow(srgb_decode(code), 1 / gamma);
}

/* The space in which a scene's colours are given and light is added up: POV-Ray's assumed_gamma.
 *
 * A part of a colour to the power of gamma is linear light. GAMMA_SRGB stands for the curve of sRGB instead.
 */
#ifndef PSCN_SCENE_GAMMA_H
#define PSCN_SCENE_GAMMA_H

#define GAMMA_SRGB 0.0

/* Linear light of a part of a colour; finite as a float. Negative parts give negative light. */
double gamma_to_light(double gamma, double part);

/* The part of a colour that is as light as an sRGB code, which is at least 0 and need not end at 1. */
double gamma_of_srgb(double gamma, double code);

#endif

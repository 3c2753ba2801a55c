/* Colours of a packet of rays: local shading and shadows, with the formulas and the behaviour of POV-Ray 3.7.
 *
 *   ambient   ambient x ambient_light x pigment
 *   and for each point light on the viewer's side of the surface that is not hidden:
 *   diffuse   diffuse x (N.L)^brilliance x pigment x light
 *   phong     phong x (R.L)^phong_size x light           R: the viewing ray reflected at N
 *   specular  specular x (N.H)^(1/roughness) x light     H: half way between L and the direction to the viewer
 *
 * N is the unit normal facing the viewer, L the unit vector to the light. A `shadowless` light passes through
 * everything and, as in POV-Ray, gives no phong and no specular highlight. A miss gets the background's colour. All
 * this is added up in the space of the scene's colours (scene/scene.h).
 */
#ifndef PSCN_RENDER_SHADE_H
#define PSCN_RENDER_SHADE_H

#include <stdbool.h>
#include <stddef.h>

#include "intersect/intersect.h"
#include "scene/scene.h"

/* The shadow rays of `count` <= PACKET_SIZE hits on whose viewer's side the light is; out_sent says which these are.
 * Returns their number; `out` has room for `count`. Each starts on its ray before the hit (tracer_leave), and ends 2^-26
 * of the way before the light, so that a surface on which the light lies does not hide it. */
size_t shade_shadow_rays(const struct scene_light *light, struct tracer *tracer, size_t count, const struct ray rays[],
                         const struct hit hits[], struct ray out[], bool out_sent[]);

/* Which of `count` <= PACKET_SIZE hits the light reaches: it is on the viewer's side, and nothing hides it. */
void shade_lit(const struct scene_light *light, struct tracer *tracer, size_t count, const struct ray rays[],
               const struct hit hits[], bool out_lit[]);

/* The colours, as linear light, of `count` <= PACKET_SIZE rays with their closest hits; shadow rays go through the tracer. */
void shade_packet(const struct scene *scene, struct tracer *tracer, size_t count, const struct ray rays[],
                  const struct hit hits[], double out_rgb[][3]);

#endif

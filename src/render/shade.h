/* Colours of a packet of rays: local shading and shadows, with the formulas and the behaviour of POV-Ray 3.7.
 *
 *   ambient   ambient x ambient_light x pigment
 *   and of each point light that is on the viewer's side of the surface and is not hidden:
 *   diffuse   diffuse x (N.L)^brilliance x pigment x light
 *   phong     phong x (R.L)^phong_size x light           R: the viewing ray reflected at N
 *   specular  specular x (N.H)^(1/roughness) x light     H: half way between L and the direction to the viewer
 *
 * N is the unit normal facing the viewer, L the unit vector to the light. A `shadowless` light passes through
 * everything and, as POV-Ray's, gives no phong and no specular highlight. A miss has the background's colour.
 */
#ifndef PSCN_RENDER_SHADE_H
#define PSCN_RENDER_SHADE_H

#include <stdbool.h>
#include <stddef.h>

#include "intersect/intersect.h"
#include "scene/scene.h"

/* The ray that asks whether `light` is hidden from `hit`: from beside the surface (hit_leave) to just before the
 * light, so that a surface on which the light lies does not hide it. False where the light is not on the viewer's
 * side; then nothing is written. */
bool shade_shadow_ray(const struct scene_light *light, const struct hit *hit, struct ray *out);

/* Which of `count` <= PACKET_SIZE hits the light reaches: it is on the viewer's side, and nothing hides it. */
void shade_lit(const struct scene_light *light, struct tracer *tracer, size_t count, const struct hit hits[],
               bool out_lit[]);

/* The linear colours of `count` <= PACKET_SIZE rays with their closest hits; shadow rays go through the tracer. */
void shade_packet(const struct scene *scene, struct tracer *tracer, size_t count, const struct ray rays[],
                  const struct hit hits[], double out_rgb[][3]);

#endif

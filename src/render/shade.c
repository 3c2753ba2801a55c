/* Local shading and shadows. Lambert's law; B. T. Phong, "Illumination for computer generated pictures", CACM 18, 1975;
 * J. F. Blinn, "Models of light reflection for computer synthesized pictures", SIGGRAPH 1977 (the half vector). */
#include "render/shade.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "geometry/vector.h"
#include "intersect/intersect.h"
#include "scene/scene.h"

/* The end of shadow rays, as a fraction of the way to the light. Where a ray meets a surface under an angle of sine s
 * is known to about eps / s of the way, eps = 2^-52. This end is therefore before a surface that holds the light for
 * all s > 2^-26. */
static const double SHADOW_END = 1 - 0x1p-26;

/* A lit point seen along a ray. */
struct view {
  const struct scene_texture *texture;
  const double *normal;
  double toward[3]; /* unit direction of the viewing ray */
};

static const struct scene_texture *texture_of(const struct scene *scene, const struct hit *hit)
{
  return &scene->textures[scene->patches[hit->patch].texture];
}

/* A cosine, above 1 at most by rounding, to a power as large or as negative as a float. At most FLT_MAX, so that its
 * product with colours, which are also floats, is finite. */
static double power(double cosine, double exponent) { return fmin(pow(fmin(cosine, 1), exponent), FLT_MAX); }

static double phong(const struct view *view, const double to_light[3])
{
  double reflected[3];
  vector_add_scaled(view->toward, -2 * vector_dot(view->toward, view->normal), view->normal, reflected);
  const double cosine = vector_dot(reflected, to_light);
  const struct scene_finish *finish = &view->texture->finish;
  return cosine > 0 ? finish->phong * power(cosine, finish->phong_size) : 0;
}

static double specular(const struct view *view, const double to_light[3])
{
  double half[3];
  vector_subtract(to_light, view->toward, half);
  const double length = vector_length(half);
  const double cosine = length > 0 ? vector_dot(half, view->normal) / length : 0;
  const struct scene_finish *finish = &view->texture->finish;
  return cosine > 0 ? finish->specular * power(cosine, 1 / finish->roughness) : 0;
}

/* Adds a visible light's contribution; to_light is the unit vector L, cosine = N.L > 0. */
static void add_light(const struct view *view, const struct scene_light *light, const double to_light[3], double cosine,
                      double rgb[3])
{
  const struct scene_finish *finish = &view->texture->finish;
  const double part = finish->brilliance == 1 ? cosine : power(cosine, finish->brilliance);
  const double diffuse = finish->diffuse > 0 ? finish->diffuse * part : 0; /* like the highlights, it never darkens */
  double highlight = 0;
  if (!light->shadowless) {
    highlight += finish->phong > 0 ? phong(view, to_light) : 0;
    highlight += finish->specular > 0 ? specular(view, to_light) : 0;
  }
  for (int k = 0; k < 3; k++) rgb[k] += light->color[k] * (diffuse * view->texture->pigment[k] + highlight);
}

size_t shade_shadow_rays(const struct scene_light *light, struct tracer *tracer, size_t count, const struct ray rays[],
                         const struct hit hits[], struct ray out[], bool out_sent[])
{
  const unsigned facing = tracer_leave_for(tracer, count, rays, hits, light->position, SHADOW_END, out);
  size_t sent = 0;
  for (size_t k = 0; k < count; k++) {
    out_sent[k] = facing >> k & 1;
    if (out_sent[k] && sent < k) out[sent] = out[k];
    sent += out_sent[k];
  }
  return sent;
}

void shade_lit(const struct scene_light *light, struct tracer *tracer, size_t count, const struct ray rays[],
               const struct hit hits[], bool out_lit[])
{
  struct ray shadow[PACKET_SIZE];
  bool hidden[PACKET_SIZE] = {false};
  const size_t sent = shade_shadow_rays(light, tracer, count, rays, hits, shadow, out_lit);
  if (sent > 0 && !light->shadowless) tracer_occluded(tracer, sent, shadow, hidden);
  for (size_t k = 0, ray = 0; k < count; k++)
    if (out_lit[k]) out_lit[k] = !hidden[ray++];
}

/* Adds one light to the hits of a packet. */
static void light_packet(const struct scene_light *light, struct tracer *tracer, size_t count, const struct ray rays[],
                         const struct view views[], const struct hit hits[], double out_rgb[][3])
{
  bool lit[PACKET_SIZE];
  shade_lit(light, tracer, count, rays, hits, lit);
  for (size_t k = 0; k < count; k++) {
    double way[3], to_light[3];
    if (!lit[k]) continue;
    vector_subtract(light->position, hits[k].point, way);
    const double length = vector_length(way);
    vector_scale(1 / length, way, to_light);
    add_light(&views[k], light, to_light, vector_dot(way, views[k].normal) / length, out_rgb[k]);
  }
}

void shade_packet(const struct scene *scene, struct tracer *tracer, size_t count, const struct ray rays[],
                  const struct hit hits[], double out_rgb[][3])
{
  struct view views[PACKET_SIZE];
  for (size_t k = 0; k < count; k++) {
    if (hits[k].patch == HIT_NONE) {
      for (int c = 0; c < 3; c++) out_rgb[k][c] = scene->background[c];
      continue;
    }
    const struct scene_texture *texture = texture_of(scene, &hits[k]);
    views[k].texture = texture;
    views[k].normal = hits[k].normal;
    vector_scale(1 / vector_length(rays[k].direction), rays[k].direction, views[k].toward);
    for (int c = 0; c < 3; c++)
      out_rgb[k][c] = texture->finish.ambient[c] * scene->ambient_light[c] * texture->pigment[c];
  }
  for (size_t k = 0; k < scene->light_count; k++)
    light_packet(&scene->lights[k], tracer, count, rays, views, hits, out_rgb);
  if (scene->gamma == 1) return;
  for (size_t k = 0; k < count; k++)
    for (int c = 0; c < 3; c++) out_rgb[k][c] = gamma_to_light(scene->gamma, out_rgb[k][c]);
}

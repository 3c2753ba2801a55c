/* POV-Ray's words that pscn does not have, and the distance between words (Damerau-Levenshtein, neighbours swapped once). */
#include "language/words.h"

#include <stdlib.h>
#include <string.h>

/* Sorted for bsearch. */
static const char *const foreign[] = {
    "aa_level", "aa_threshold", "abs", "absorption", "accuracy", "acos", "acosh", "adaptive", "adc_bailout", "agate",
    "agate_turb", "all", "all_intersections", "alpha", "altitude", "always_sample", "ambient_light_source", "aperture",
    "arc_angle", "area_illumination", "area_light", "array", "asc", "ascii", "asin", "asinh", "atan", "atan2", "atanh",
    "autostop", "average", "b_spline", "bezier_spline", "black_hole", "blob", "blur_samples", "bounded_by", "box",
    "boxed", "bozo", "brick", "brick_size", "brightness", "bump_map", "bump_size", "bumps", "caustics", "ceil", "cells",
    "charset", "checker", "chr", "circular", "clipped_by", "clock", "clock_delta", "clock_on", "collect", "color_map",
    "colour_map", "component", "composite", "concat", "cone", "confidence", "conic_sweep", "conserve_energy",
    "contained_by", "control0", "control1", "coords", "cos", "cosh", "count", "crackle", "crand", "cube", "cubic",
    "cubic_spline", "cubic_wave", "cutaway_textures", "cylinder", "cylindrical", "deferred", "defined", "degrees",
    "density", "density_file", "density_map", "dents", "df3", "difference", "dimension_size", "dimensions", "disc",
    "dispersion", "dispersion_samples", "dist_exp", "distance", "div", "double_illuminate", "eccentricity", "emission",
    "error_bound", "evaluate", "exp", "expand_thresholds", "exponent", "exterior", "extinction", "face_indices", "facets",
    "fade_color", "fade_colour", "fade_distance", "fade_power", "falloff", "falloff_angle", "false", "file_exists",
    "filter", "final_clock", "final_frame", "fisheye", "flip", "floor", "focal_point", "fog", "fog_alt", "fog_offset",
    "fog_type", "form", "frame_number", "frequency", "fresnel", "function", "gather", "gif", "global_lights", "gradient",
    "granite", "gray", "gray_threshold", "grey", "hdr", "height_field", "hexagon", "hf_gray_16", "hierarchy", "hollow",
    "hypercomplex", "iff", "image_map", "image_pattern", "increment", "inital_clock", "initial_frame", "inside",
    "inside_vector", "int", "interior", "interior_texture", "internal", "interpolate", "intersection", "inverse", "ior",
    "irid", "irid_wavelength", "isosurface", "jitter", "jpeg", "julia", "julia_fractal", "lambda", "lathe", "leopard",
    "light_group", "linear_spline", "linear_sweep", "ln", "load_file", "log", "look_at_distance", "looks_like",
    "low_error_factor", "magnet", "major_radius", "mandel", "map_type", "marble", "material", "material_map", "max",
    "max_extent", "max_gradient", "max_intersections", "max_iteration", "max_sample", "media", "media_attenuation",
    "media_interaction", "merge", "mesh", "mesh2", "metallic", "method", "metric", "min", "min_extent", "minimum_reuse",
    "mm_per_unit", "mod", "mortar", "natural_spline", "nearest_count", "no", "no_bump_scale", "no_image",
    "no_radiosity", "no_reflection", "no_shadow", "noise_generator", "normal", "normal_indices", "normal_map",
    "normal_vectors", "now", "number_of_waves", "off", "offset", "omega", "omnimax", "on", "once", "onion", "open",
    "orient", "orientation", "orthographic", "ovus", "panoramic", "parallel", "parametric", "pass_through", "pattern",
    "perturb", "pgm", "phase", "photons", "pigment_map", "pigment_pattern", "planar", "plane", "png", "point_at", "poly",
    "poly_wave", "polygon", "polynomial", "pot", "pow", "ppm", "precision", "precompute", "pretrace_end",
    "pretrace_start", "prism", "prod", "projected_through", "pwr", "quadratic_spline", "quadric", "quartic", "quaternion",
    "quick_color", "quick_colour", "quilted", "radial", "radians", "radiosity", "radius", "rainbow", "ramp_wave", "rand",
    "ratio", "reciprocal", "recursion_limit", "reflection", "reflection_exponent", "refraction", "rgbf", "rgbft",
    "rgbt", "ripples", "save_file", "scallop_wave", "scattering", "seed", "select", "sin", "sine_wave", "sinh", "size",
    "sky_sphere", "slice", "slope", "slope_map", "smooth", "smooth_triangle", "solid", "sor", "spacing", "sphere",
    "sphere_sweep", "spherical", "spiral1", "spiral2", "spline", "split_union", "spotlight", "spotted", "sqr", "sqrt",
    "srgb", "srgbf", "srgbft", "srgbt", "statistics", "str", "strcmp", "strength", "strlen", "strlwr", "strupr",
    "sturm", "substr", "subsurface", "sum", "superellipsoid", "sys", "t", "tan", "tanh", "target", "text", "texture_list",
    "texture_map", "tga", "thickness", "threshold", "tiff", "tightness", "tile2", "tiles", "tolerance", "toroidal",
    "torus", "trace", "transform", "translucency", "transmit", "triangle", "triangle_wave", "true", "ttf", "turb_depth",
    "turbulence", "turbulence_vector", "u", "ultra_wide_angle", "use_alpha", "use_color", "use_colour", "use_index",
    "utf8", "uv_indices", "uv_mapping", "uv_vectors", "v", "val", "variance", "vaxis_rotate", "vcross", "vdot",
    "vertex_vectors", "vlength", "vnormalize", "vrotate", "vstr", "vturbulence", "warp", "warp_type", "water_level",
    "waves", "while", "width", "wood", "wrinkles", "yes"};

static const char *const shapes[] = {"blob",   "box",     "cone",       "cubic",   "cylinder", "difference",   "disc",
                                     "height_field", "intersection", "isosurface", "julia_fractal", "lathe", "merge",
                                     "mesh", "mesh2", "ovus", "parametric", "plane", "poly", "polygon", "polynomial",
                                     "prism", "quadric", "quartic", "smooth_triangle", "sor", "sphere",
                                     "sphere_sweep", "superellipsoid", "text", "torus", "triangle"};

struct word {
  const char *text;
  size_t length;
};

static int compare(const void *key, const void *element)
{
  const struct word *word = key;
  const char *other = *(const char *const *)element;
  const int order = strncmp(word->text, other, word->length);
  return order ? order : other[word->length] ? -1 : 0;
}

static bool listed(const char *word, size_t length, const char *const *list, size_t count)
{
  const struct word key = {word, length};
  return bsearch(&key, list, count, sizeof *list, compare) != NULL;
}

bool words_foreign(const char *word, size_t length)
{
  return listed(word, length, foreign, sizeof foreign / sizeof *foreign);
}

bool words_foreign_shape(const char *word, size_t length)
{
  return listed(word, length, shapes, sizeof shapes / sizeof *shapes);
}

size_t words_reach(size_t length) { return length < 6 ? 1 : length / 3; }

enum { LONGEST_COMPARED = 40 };

static size_t smallest(size_t a, size_t b, size_t c)
{
  const size_t least = a < b ? a : b;
  return least < c ? least : c;
}

static size_t distance_between(const char *a, size_t m, const char *b, size_t n)
{
  size_t row[LONGEST_COMPARED + 1][LONGEST_COMPARED + 1];
  for (size_t i = 0; i <= m; i++) row[i][0] = i;
  for (size_t j = 0; j <= n; j++) row[0][j] = j;
  for (size_t i = 1; i <= m; i++) {
    for (size_t j = 1; j <= n; j++) {
      const size_t replaced = row[i - 1][j - 1] + (a[i - 1] != b[j - 1]);
      row[i][j] = smallest(row[i - 1][j] + 1, row[i][j - 1] + 1, replaced);
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[i][j] = smallest(row[i][j], row[i - 2][j - 2] + 1, row[i][j]);
    }
  }
  return row[m][n];
}

void words_consider(const char *word, size_t length, const char *candidate, const char **best, size_t *distance)
{
  const size_t other = strlen(candidate);
  if (length > LONGEST_COMPARED || other > LONGEST_COMPARED) return;
  const size_t d = distance_between(word, length, candidate, other);
  if (d > *distance || (*best && d == *distance)) return;
  *best = candidate;
  *distance = d;
}

/* POV-Ray's words that pscn does not have, and the distance between words (Damerau-Levenshtein, neighbours swapped
 * once). */
#include "language/words.h"

#include <string.h>

/* Sorted. */
static const char *const FOREIGN[] = {
    "aa_level", "aa_threshold", "abs", "absorption", "accuracy", "acos", "acosh", "adaptive", "adc_bailout", "agate",
    "agate_turb", "albedo", "all", "all_intersections", "alpha", "altitude", "always_sample", "anisotropy", "aoi",
    "aperture", "append", "arc_angle", "area_illumination", "area_light", "array", "asc", "ascii", "asin", "asinh",
    "atan", "atan2", "atanh", "autostop", "average", "b_spline", "bezier_spline", "bitwise_and", "bitwise_or",
    "bitwise_xor", "black_hole", "blob", "blur_samples", "bokeh", "bounded_by", "box", "boxed", "bozo", "brick",
    "brick_size", "brightness", "bump_map", "bump_size", "bumps", "caustics", "ceil", "cells", "charset", "checker",
    "chr", "circular", "clipped_by", "clock", "clock_on", "collect", "color_map", "colour_map", "component",
    "composite", "concat", "cone", "confidence", "conic_sweep", "conserve_energy", "contained_by", "control0",
    "control1", "coords", "cos", "cosh", "count", "crackle", "crand", "cube", "cubic", "cubic_spline", "cubic_wave",
    "cutaway_textures", "cylinder", "cylindrical", "datetime", "defined", "degrees", "density", "density_file",
    "density_map", "dents", "df3", "difference", "dimension_size", "dimensions", "disc", "dispersion",
    "dispersion_samples", "dist_exp", "distance", "div", "double_illuminate", "dtag", "eccentricity", "emission",
    "error_bound", "evaluate", "exp", "expand_thresholds", "exponent", "exr", "exterior", "extinction",
    "face_indices", "facets", "fade_color", "fade_colour", "fade_distance", "fade_power", "falloff", "falloff_angle",
    "false", "file_exists", "filter", "fisheye", "flip", "floor", "focal_point", "fog", "fog_alt", "fog_offset",
    "fog_type", "form", "frequency", "fresnel", "function", "gather", "gif", "global_lights", "gradient", "granite",
    "gray", "gray_threshold", "hdr", "height_field", "hexagon", "hf_gray_16", "hierarchy", "hollow", "hypercomplex",
    "iff", "image_map", "image_pattern", "importance", "inside", "inside_vector", "int", "interior",
    "interior_texture", "internal", "interpolate", "intersection", "intervals", "inverse", "ior", "irid",
    "irid_wavelength", "isosurface", "jitter", "jpeg", "julia", "julia_fractal", "lambda", "lathe", "leopard",
    "light_group", "linear_spline", "linear_sweep", "ln", "load_file", "log", "looks_like", "low_error_factor",
    "magnet", "major_radius", "mandel", "map_type", "marble", "material", "material_map", "max", "max_extent",
    "max_gradient", "max_intersections", "max_iteration", "max_sample", "max_trace", "maximum_reuse", "media",
    "media_attenuation", "media_interaction", "merge", "mesh", "mesh2", "mesh_camera", "metallic", "method", "min",
    "min_extent", "minimum_reuse", "mm_per_unit", "mod", "mortar", "natural_spline", "nearest_count", "no",
    "no_bump_scale", "no_image", "no_radiosity", "no_reflection", "no_shadow", "noise_generator", "normal",
    "normal_indices", "normal_map", "normal_vectors", "now", "number_of_waves", "octaves", "off", "offset", "omega",
    "omnimax", "on", "once", "onion", "open", "orient", "orientation", "orthographic", "ovus", "panoramic",
    "parallel", "parametric", "pass_through", "pattern", "pgm", "phase", "photons", "pigment_map", "pigment_pattern",
    "planar", "plane", "png", "point_at", "poly", "poly_wave", "polygon", "polynomial", "pot", "pow", "ppm",
    "precision", "precompute", "premultiplied", "pretrace_end", "pretrace_start", "prism", "prod",
    "projected_through", "pwr", "quadratic_spline", "quadric", "quartic", "quaternion", "quick_color", "quick_colour",
    "quilted", "radial", "radians", "radiosity", "radius", "rainbow", "ramp_wave", "rand", "ratio", "reciprocal",
    "recursion_limit", "reflection", "reflection_exponent", "refraction", "rgbf", "rgbft", "rgbt", "ripples",
    "save_file", "scallop_wave", "scattering", "seed", "select", "sin", "sine_wave", "sinh", "size", "sky_sphere",
    "slice", "slope", "slope_map", "smooth", "smooth_triangle", "solid", "sor", "spacing", "sphere", "sphere_sweep",
    "spherical", "spiral1", "spiral2", "spline", "split_union", "spotlight", "spotted", "sqr", "sqrt", "square",
    "srgb", "srgbf", "srgbft", "srgbt", "statistics", "str", "strcmp", "strength", "strlen", "strlwr", "strupr",
    "sturm", "substr", "subsurface", "sum", "superellipsoid", "sys", "t", "tan", "tanh", "target", "text",
    "texture_list", "texture_map", "tga", "thickness", "threshold", "tiff", "tightness", "tile2", "tiles", "tiling",
    "tolerance", "toroidal", "torus", "trace", "transform", "translucency", "transmit", "triangle", "triangle_wave",
    "triangular", "true", "ttf", "turb_depth", "turbulence", "u", "ultra_wide_angle", "use_alpha", "use_color",
    "use_colour", "use_index", "utf8", "uv_indices", "uv_mapping", "uv_vectors", "v", "val", "variance",
    "vaxis_rotate", "vcross", "vdot", "vertex_vectors", "vlength", "vnormalize", "vrotate", "vstr", "vturbulence",
    "warp", "water_level", "waves", "while", "width", "wood", "wrinkles", "yes"};

static const char *const SHAPES[] = {
    "blob", "box", "cone", "cubic", "cylinder", "difference", "disc", "height_field", "intersection", "isosurface",
    "julia_fractal", "lathe", "merge", "mesh", "mesh2", "ovus", "parametric", "plane", "poly", "polygon",
    "polynomial", "prism", "quadric", "quartic", "smooth_triangle", "sor", "sphere", "sphere_sweep", "superellipsoid",
    "text", "torus", "triangle"};

int words_compare(const char *word, size_t length, const char *name)
{
  const int order = strncmp(word, name, length);
  return order ? order : name[length] ? -1 : 0;
}

static bool listed(const char *word, size_t length, const char *const *list, size_t count)
{
  size_t low = 0, high = count;
  while (low < high) {
    const size_t middle = (low + high) / 2;
    const int order = words_compare(word, length, list[middle]);
    if (order == 0) return true;
    if (order < 0) high = middle;
    else low = middle + 1;
  }
  return false;
}

bool words_foreign(const char *word, size_t length)
{
  return listed(word, length, FOREIGN, sizeof FOREIGN / sizeof *FOREIGN);
}

bool words_foreign_shape(const char *word, size_t length)
{
  return listed(word, length, SHAPES, sizeof SHAPES / sizeof *SHAPES);
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
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        row[i][j] = smallest(row[i][j], row[i - 2][j - 2] + 1, row[i][j]);
      }
    }
  }
  return row[m][n];
}

void words_consider(const char *word, size_t length, const char *candidate, size_t candidate_length, const char **best,
                    size_t *best_length, size_t *distance)
{
  if (length > LONGEST_COMPARED || candidate_length > LONGEST_COMPARED) return;
  if (length > candidate_length + *distance || candidate_length > length + *distance) return;
  const size_t d = distance_between(word, length, candidate, candidate_length);
  /* A word all of whose letters are wrong is no misspelling. */
  if (d >= length || d > *distance || (*best && d == *distance)) return;
  *best = candidate;
  *best_length = candidate_length;
  *distance = d;
}

/* The words of the language, POV-Ray's other words, and the distance between words (Damerau-Levenshtein, neighbours
 * swapped once). */
#include "language/words.h"

#include <stdio.h>
#include <string.h>

#include "language/scan.h"

struct keyword {
  const char *name;
  int token;
};

/* Sorted. */
static const struct keyword KEYWORDS[] = {{"ambient", PSCN_TOKEN_AMBIENT},
                                          {"ambient_light", PSCN_TOKEN_AMBIENT_LIGHT},
                                          {"angle", PSCN_TOKEN_ANGLE},
                                          {"assumed_gamma", PSCN_TOKEN_ASSUMED_GAMMA},
                                          {"background", PSCN_TOKEN_BACKGROUND},
                                          {"bicubic_patch", PSCN_TOKEN_BICUBIC_PATCH},
                                          {"blue", PSCN_TOKEN_BLUE},
                                          {"brilliance", PSCN_TOKEN_BRILLIANCE},
                                          {"camera", PSCN_TOKEN_CAMERA},
                                          {"color", PSCN_TOKEN_COLOR},
                                          {"colour", PSCN_TOKEN_COLOR},
                                          {"diffuse", PSCN_TOKEN_DIFFUSE},
                                          {"direction", PSCN_TOKEN_DIRECTION},
                                          {"filter", PSCN_TOKEN_FILTER},
                                          {"finish", PSCN_TOKEN_FINISH},
                                          {"flatness", PSCN_TOKEN_FLATNESS},
                                          {"global_settings", PSCN_TOKEN_GLOBAL_SETTINGS},
                                          {"green", PSCN_TOKEN_GREEN},
                                          {"image_height", PSCN_TOKEN_IMAGE_HEIGHT},
                                          {"image_width", PSCN_TOKEN_IMAGE_WIDTH},
                                          {"light_source", PSCN_TOKEN_LIGHT_SOURCE},
                                          {"location", PSCN_TOKEN_LOCATION},
                                          {"look_at", PSCN_TOKEN_LOOK_AT},
                                          {"matrix", PSCN_TOKEN_MATRIX},
                                          {"max_trace_level", PSCN_TOKEN_MAX_TRACE_LEVEL},
                                          {"object", PSCN_TOKEN_OBJECT},
                                          {"perspective", PSCN_TOKEN_PERSPECTIVE},
                                          {"phong", PSCN_TOKEN_PHONG},
                                          {"phong_size", PSCN_TOKEN_PHONG_SIZE},
                                          {"pi", PSCN_TOKEN_PI},
                                          {"pigment", PSCN_TOKEN_PIGMENT},
                                          {"red", PSCN_TOKEN_RED},
                                          {"rgb", PSCN_TOKEN_RGB},
                                          {"rgbf", PSCN_TOKEN_RGBF},
                                          {"rgbft", PSCN_TOKEN_RGBFT},
                                          {"rgbt", PSCN_TOKEN_RGBF},
                                          {"right", PSCN_TOKEN_RIGHT},
                                          {"rotate", PSCN_TOKEN_ROTATE},
                                          {"roughness", PSCN_TOKEN_ROUGHNESS},
                                          {"scale", PSCN_TOKEN_SCALE},
                                          {"shadowless", PSCN_TOKEN_SHADOWLESS},
                                          {"sky", PSCN_TOKEN_SKY},
                                          {"solver", PSCN_TOKEN_SOLVER},
                                          {"specular", PSCN_TOKEN_SPECULAR},
                                          {"texture", PSCN_TOKEN_TEXTURE},
                                          {"translate", PSCN_TOKEN_TRANSLATE},
                                          {"transmit", PSCN_TOKEN_FILTER},
                                          {"type", PSCN_TOKEN_TYPE},
                                          {"u_steps", PSCN_TOKEN_U_STEPS},
                                          {"union", PSCN_TOKEN_UNION},
                                          {"up", PSCN_TOKEN_UP},
                                          {"v_steps", PSCN_TOKEN_V_STEPS},
                                          {"version", PSCN_TOKEN_VERSION_WORD},
                                          {"x", PSCN_TOKEN_X},
                                          {"y", PSCN_TOKEN_Y},
                                          {"z", PSCN_TOKEN_Z}};

static const struct keyword DIRECTIVES[] = {{"declare", PSCN_TOKEN_DECLARE},
                                            {"default", PSCN_TOKEN_DEFAULT},
                                            {"else", TOKEN_ELSE},
                                            {"end", TOKEN_ENDIF},
                                            {"ifdef", TOKEN_IFDEF},
                                            {"ifndef", TOKEN_IFNDEF},
                                            {"include", TOKEN_INCLUDE},
                                            {"local", PSCN_TOKEN_LOCAL},
                                            {"version", PSCN_TOKEN_VERSION}};

/* POV-Ray 3.7's other directives. */
static const struct keyword FOREIGN_DIRECTIVES[] = {
  {"break", TOKEN_FOREIGN_DIRECTIVE},   {"case", TOKEN_FOREIGN_DIRECTIVE},
  {"debug", TOKEN_FOREIGN_DIRECTIVE},   {"elseif", TOKEN_FOREIGN_DIRECTIVE},
  {"error", TOKEN_FOREIGN_DIRECTIVE},   {"fclose", TOKEN_FOREIGN_DIRECTIVE},
  {"fopen", TOKEN_FOREIGN_DIRECTIVE},   {"for", TOKEN_FOREIGN_OPENER},
  {"if", TOKEN_FOREIGN_OPENER},         {"macro", TOKEN_MACRO},
  {"range", TOKEN_FOREIGN_DIRECTIVE},   {"read", TOKEN_FOREIGN_DIRECTIVE},
  {"render", TOKEN_FOREIGN_DIRECTIVE},  {"statistics", TOKEN_FOREIGN_DIRECTIVE},
  {"switch", TOKEN_FOREIGN_OPENER},     {"undef", TOKEN_FOREIGN_DIRECTIVE},
  {"warning", TOKEN_FOREIGN_DIRECTIVE}, {"while", TOKEN_FOREIGN_OPENER},
  {"write", TOKEN_FOREIGN_DIRECTIVE}};

/* Sorted: what else POV-Ray 3.7 reserves, and which of that are shapes. */
static const char *const FOREIGN[] = {"aa_level",
                                      "aa_threshold",
                                      "abs",
                                      "absorption",
                                      "accuracy",
                                      "acos",
                                      "acosh",
                                      "adaptive",
                                      "adc_bailout",
                                      "agate",
                                      "agate_turb",
                                      "albedo",
                                      "all",
                                      "all_intersections",
                                      "alpha",
                                      "altitude",
                                      "always_sample",
                                      "anisotropy",
                                      "aoi",
                                      "aperture",
                                      "append",
                                      "arc_angle",
                                      "area_illumination",
                                      "area_light",
                                      "array",
                                      "asc",
                                      "ascii",
                                      "asin",
                                      "asinh",
                                      "atan",
                                      "atan2",
                                      "atanh",
                                      "autostop",
                                      "average",
                                      "b_spline",
                                      "bezier_spline",
                                      "bitwise_and",
                                      "bitwise_or",
                                      "bitwise_xor",
                                      "black_hole",
                                      "blob",
                                      "blur_samples",
                                      "bokeh",
                                      "bounded_by",
                                      "box",
                                      "boxed",
                                      "bozo",
                                      "brick",
                                      "brick_size",
                                      "brightness",
                                      "bump_map",
                                      "bump_size",
                                      "bumps",
                                      "caustics",
                                      "ceil",
                                      "cells",
                                      "charset",
                                      "checker",
                                      "chr",
                                      "circular",
                                      "clipped_by",
                                      "clock",
                                      "clock_on",
                                      "collect",
                                      "color_map",
                                      "colour_map",
                                      "component",
                                      "composite",
                                      "concat",
                                      "cone",
                                      "confidence",
                                      "conic_sweep",
                                      "conserve_energy",
                                      "contained_by",
                                      "control0",
                                      "control1",
                                      "coords",
                                      "cos",
                                      "cosh",
                                      "count",
                                      "crackle",
                                      "crand",
                                      "cube",
                                      "cubic",
                                      "cubic_spline",
                                      "cubic_wave",
                                      "cutaway_textures",
                                      "cylinder",
                                      "cylindrical",
                                      "datetime",
                                      "defined",
                                      "degrees",
                                      "density",
                                      "density_file",
                                      "density_map",
                                      "dents",
                                      "df3",
                                      "difference",
                                      "dimension_size",
                                      "dimensions",
                                      "disc",
                                      "dispersion",
                                      "dispersion_samples",
                                      "dist_exp",
                                      "distance",
                                      "div",
                                      "double_illuminate",
                                      "dtag",
                                      "eccentricity",
                                      "emission",
                                      "error_bound",
                                      "evaluate",
                                      "exp",
                                      "expand_thresholds",
                                      "exponent",
                                      "exr",
                                      "exterior",
                                      "extinction",
                                      "face_indices",
                                      "facets",
                                      "fade_color",
                                      "fade_colour",
                                      "fade_distance",
                                      "fade_power",
                                      "falloff",
                                      "falloff_angle",
                                      "false",
                                      "file_exists",
                                      "fisheye",
                                      "flip",
                                      "floor",
                                      "focal_point",
                                      "fog",
                                      "fog_alt",
                                      "fog_offset",
                                      "fog_type",
                                      "form",
                                      "frequency",
                                      "fresnel",
                                      "function",
                                      "gather",
                                      "gif",
                                      "global_lights",
                                      "gradient",
                                      "granite",
                                      "gray",
                                      "gray_threshold",
                                      "hdr",
                                      "height_field",
                                      "hexagon",
                                      "hf_gray_16",
                                      "hierarchy",
                                      "hollow",
                                      "hypercomplex",
                                      "iff",
                                      "image_map",
                                      "image_pattern",
                                      "importance",
                                      "inside",
                                      "inside_vector",
                                      "int",
                                      "interior",
                                      "interior_texture",
                                      "internal",
                                      "interpolate",
                                      "intersection",
                                      "intervals",
                                      "inverse",
                                      "ior",
                                      "irid",
                                      "irid_wavelength",
                                      "isosurface",
                                      "jitter",
                                      "jpeg",
                                      "julia",
                                      "julia_fractal",
                                      "lambda",
                                      "lathe",
                                      "leopard",
                                      "light_group",
                                      "linear_spline",
                                      "linear_sweep",
                                      "ln",
                                      "load_file",
                                      "log",
                                      "looks_like",
                                      "low_error_factor",
                                      "magnet",
                                      "major_radius",
                                      "mandel",
                                      "map_type",
                                      "marble",
                                      "material",
                                      "material_map",
                                      "max",
                                      "max_extent",
                                      "max_gradient",
                                      "max_intersections",
                                      "max_iteration",
                                      "max_sample",
                                      "max_trace",
                                      "maximum_reuse",
                                      "media",
                                      "media_attenuation",
                                      "media_interaction",
                                      "merge",
                                      "mesh",
                                      "mesh2",
                                      "mesh_camera",
                                      "metallic",
                                      "method",
                                      "min",
                                      "min_extent",
                                      "minimum_reuse",
                                      "mm_per_unit",
                                      "mod",
                                      "mortar",
                                      "natural_spline",
                                      "nearest_count",
                                      "no",
                                      "no_bump_scale",
                                      "no_image",
                                      "no_radiosity",
                                      "no_reflection",
                                      "no_shadow",
                                      "noise_generator",
                                      "normal",
                                      "normal_indices",
                                      "normal_map",
                                      "normal_vectors",
                                      "now",
                                      "number_of_waves",
                                      "octaves",
                                      "off",
                                      "offset",
                                      "omega",
                                      "omnimax",
                                      "on",
                                      "once",
                                      "onion",
                                      "open",
                                      "orient",
                                      "orientation",
                                      "orthographic",
                                      "ovus",
                                      "panoramic",
                                      "parallel",
                                      "parametric",
                                      "pass_through",
                                      "pattern",
                                      "pgm",
                                      "phase",
                                      "photons",
                                      "pigment_map",
                                      "pigment_pattern",
                                      "planar",
                                      "plane",
                                      "png",
                                      "point_at",
                                      "poly",
                                      "poly_wave",
                                      "polygon",
                                      "polynomial",
                                      "pot",
                                      "pow",
                                      "ppm",
                                      "precision",
                                      "precompute",
                                      "premultiplied",
                                      "pretrace_end",
                                      "pretrace_start",
                                      "prism",
                                      "prod",
                                      "projected_through",
                                      "pwr",
                                      "quadratic_spline",
                                      "quadric",
                                      "quartic",
                                      "quaternion",
                                      "quick_color",
                                      "quick_colour",
                                      "quilted",
                                      "radial",
                                      "radians",
                                      "radiosity",
                                      "radius",
                                      "rainbow",
                                      "ramp_wave",
                                      "rand",
                                      "ratio",
                                      "reciprocal",
                                      "recursion_limit",
                                      "reflection",
                                      "reflection_exponent",
                                      "refraction",
                                      "ripples",
                                      "save_file",
                                      "scallop_wave",
                                      "scattering",
                                      "seed",
                                      "select",
                                      "sin",
                                      "sine_wave",
                                      "sinh",
                                      "size",
                                      "sky_sphere",
                                      "slice",
                                      "slope",
                                      "slope_map",
                                      "smooth",
                                      "smooth_triangle",
                                      "solid",
                                      "sor",
                                      "spacing",
                                      "sphere",
                                      "sphere_sweep",
                                      "spherical",
                                      "spiral1",
                                      "spiral2",
                                      "spline",
                                      "split_union",
                                      "spotlight",
                                      "spotted",
                                      "sqr",
                                      "sqrt",
                                      "square",
                                      "srgb",
                                      "srgbf",
                                      "srgbft",
                                      "srgbt",
                                      "statistics",
                                      "str",
                                      "strcmp",
                                      "strength",
                                      "strlen",
                                      "strlwr",
                                      "strupr",
                                      "sturm",
                                      "substr",
                                      "subsurface",
                                      "sum",
                                      "superellipsoid",
                                      "sys",
                                      "t",
                                      "tan",
                                      "tanh",
                                      "target",
                                      "text",
                                      "texture_list",
                                      "texture_map",
                                      "tga",
                                      "thickness",
                                      "threshold",
                                      "tiff",
                                      "tightness",
                                      "tile2",
                                      "tiles",
                                      "tiling",
                                      "tolerance",
                                      "toroidal",
                                      "torus",
                                      "trace",
                                      "transform",
                                      "translucency",
                                      "triangle",
                                      "triangle_wave",
                                      "triangular",
                                      "true",
                                      "ttf",
                                      "turb_depth",
                                      "turbulence",
                                      "u",
                                      "ultra_wide_angle",
                                      "use_alpha",
                                      "use_color",
                                      "use_colour",
                                      "use_index",
                                      "utf8",
                                      "uv_indices",
                                      "uv_mapping",
                                      "uv_vectors",
                                      "v",
                                      "val",
                                      "variance",
                                      "vaxis_rotate",
                                      "vcross",
                                      "vdot",
                                      "vertex_vectors",
                                      "vlength",
                                      "vnormalize",
                                      "vrotate",
                                      "vstr",
                                      "vturbulence",
                                      "warp",
                                      "water_level",
                                      "waves",
                                      "while",
                                      "width",
                                      "wood",
                                      "wrinkles",
                                      "yes"};

static const char *const SHAPES[] = {
  "blob",           "box",          "cone",       "cubic",           "cylinder", "difference", "disc",
  "height_field",   "intersection", "isosurface", "julia_fractal",   "lathe",    "merge",      "mesh",
  "mesh2",          "ovus",         "parametric", "plane",           "poly",     "polygon",    "polynomial",
  "prism",          "quadric",      "quartic",    "smooth_triangle", "sor",      "sphere",     "sphere_sweep",
  "superellipsoid", "text",         "torus",      "triangle"};

#define COUNT(table) (sizeof(table) / sizeof *(table))

int words_compare(const char *word, size_t length, const char *name)
{
  const int order = strncmp(word, name, length);
  return order ? order : name[length] ? -1 : 0;
}

/* The row of a sorted table, whose rows of `size` bytes begin with a name, or NULL. */
static const void *find(const char *word, size_t length, const void *table, size_t count, size_t size)
{
  size_t low = 0, high = count;
  while (low < high) {
    const size_t middle = (low + high) / 2;
    const char *const *row = (const void *)((const char *)table + middle * size);
    const int order = words_compare(word, length, *row);
    if (order == 0) return row;
    if (order < 0) high = middle;
    else low = middle + 1;
  }
  return NULL;
}

#define FIND(word, length, table) find(word, length, table, COUNT(table), sizeof *(table))

int words_token(const char *word, size_t length)
{
  const struct keyword *found = FIND(word, length, KEYWORDS);
  if (found) return found->token;
  return FIND(word, length, FOREIGN) ? PSCN_TOKEN_FOREIGN : PSCN_TOKEN_WORD;
}

bool words_foreign_shape(const char *word, size_t length) { return FIND(word, length, SHAPES) != NULL; }

const char *words_directive(const char *text, size_t *length)
{
  do text++, --*length;
  while (strchr(" \t\r\n\f\v", *text));
  return text;
}

int words_directive_token(const char *text, size_t length)
{
  const char *name = words_directive(text, &length);
  const struct keyword *found = FIND(name, length, DIRECTIVES);
  if (!found) found = FIND(name, length, FOREIGN_DIRECTIVES);
  return found ? found->token : TOKEN_UNKNOWN_DIRECTIVE;
}

static bool is_one_of(int token, const int tokens[], size_t count)
{
  for (size_t k = 0; k < count; k++)
    if (tokens[k] == token) return true;
  return false;
}

bool words_begin_statement(int token)
{
  static const int statements[] = {PSCN_TOKEN_VERSION,         PSCN_TOKEN_DECLARE,    PSCN_TOKEN_LOCAL,
                                   PSCN_TOKEN_GLOBAL_SETTINGS, PSCN_TOKEN_DEFAULT,    PSCN_TOKEN_CAMERA,
                                   PSCN_TOKEN_LIGHT_SOURCE,    PSCN_TOKEN_BACKGROUND, PSCN_TOKEN_BICUBIC_PATCH,
                                   PSCN_TOKEN_UNION,           PSCN_TOKEN_OBJECT};
  return is_one_of(token, statements, COUNT(statements));
}

bool words_begin_item(int token)
{
  static const int in_values[] = {
    PSCN_TOKEN_WORD, PSCN_TOKEN_NUMBER, PSCN_TOKEN_POINT,  PSCN_TOKEN_STRING,       PSCN_TOKEN_COLOR,
    PSCN_TOKEN_RGB,  PSCN_TOKEN_RED,    PSCN_TOKEN_GREEN,  PSCN_TOKEN_BLUE,         PSCN_TOKEN_X,
    PSCN_TOKEN_Y,    PSCN_TOKEN_Z,      PSCN_TOKEN_PI,     PSCN_TOKEN_IMAGE_WIDTH,  PSCN_TOKEN_IMAGE_HEIGHT,
    PSCN_TOKEN_RGBF, PSCN_TOKEN_RGBFT,  PSCN_TOKEN_FILTER, PSCN_TOKEN_VERSION_WORD, PSCN_TOKEN_FOREIGN};
  return token > 255 && !is_one_of(token, in_values, COUNT(in_values));
}

/* ---- lists and guesses ---- */

void words_list(const char *const words[], size_t count, char *out, size_t size)
{
  size_t used = 0;
  out[0] = '\0';
  for (size_t k = 0; k < count && used < size; k++) {
    const char *before = k == 0 ? "" : k + 1 == count ? " or " : ", ";
    used += (size_t)snprintf(out + used, size - used, "%s%s", before, words[k]);
  }
}

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

struct guess guess_begin(const char *word, size_t length)
{
  return (struct guess){.word = word, .length = length, .distance = length < 6 ? 1 : length / 3};
}

void guess_consider(struct guess *guess, const char *candidate, size_t length)
{
  if (guess->length > LONGEST_COMPARED || length > LONGEST_COMPARED) return;
  if (guess->length > length + guess->distance || length > guess->length + guess->distance) return;
  const size_t d = distance_between(guess->word, guess->length, candidate, length);
  /* A word all of whose letters are wrong is no misspelling. */
  if (d >= guess->length || d > guess->distance || (guess->best && d == guess->distance)) return;
  guess->best = candidate;
  guess->best_length = length;
  guess->distance = d;
}

void guess_keywords(struct guess *guess)
{
  for (size_t k = 0; k < COUNT(KEYWORDS); k++) guess_consider(guess, KEYWORDS[k].name, strlen(KEYWORDS[k].name));
}

void guess_directives(struct guess *guess)
{
  for (size_t k = 0; k < COUNT(DIRECTIVES); k++) guess_consider(guess, DIRECTIVES[k].name, strlen(DIRECTIVES[k].name));
}

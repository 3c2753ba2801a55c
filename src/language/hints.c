/* One table of hints: for a word of POV-Ray's, what replaces it here, or that it can be left out. */
#include "language/hints.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

struct hint {
  const char *words; /* separated by one blank */
  bool shape;
  const char *text; /* or NULL */
};

static const struct hint HINTS[] = {
  {"plane disc polygon", true, "a large flat patch does it, see scenes/teapot.pscn"},
  {"box", true, "six flat patches do it"},
  {"triangle smooth_triangle", true, "a patch does it, of which one edge is a point"},
  {"mesh mesh2", true, "let the modeller write its surface as patches"},
  {"sphere cone cylinder lathe sor sphere_sweep superellipsoid torus ovus", true,
   "patches come near what is round, see docs/povray.md"},
  {"height_field", true, "a grid of patches does it, see scenes/waves.pscn"},
  {"difference intersection merge", true, "surfaces have no inside: union puts them together"},
  {"blob cubic isosurface julia_fractal parametric poly polynomial prism quadric quartic text", true, NULL},
  {"clipped_by cutaway_textures inside_vector inverse", false, "surfaces have no inside: a patch is shown whole"},
  {"bounded_by split_union hierarchy sturm hollow no_image double_illuminate", false, "leave it out"},
  {"no_shadow no_reflection no_radiosity", false, "every patch throws its shadow, and nothing is reflected"},
  {"transform", false, "its translate, rotate, scale and matrix do it, where it stands"},
  {"material", false, "its texture stands for itself"},
  {"interior ior caustics fade_color fade_colour dispersion media absorption refraction", false,
   "what is rendered is opaque: leave it out"},
  {"gradient checker brick hexagon marble wood granite agate bozo leopard onion spotted crackle wrinkles spherical "
   "cylindrical planar radial boxed mandel julia image_map material_map bump_map image_pattern cells ripples waves "
   "dents bumps quilted spiral1 spiral2 square color_map colour_map pigment_map texture_map texture_list "
   "slope average turbulence warp uv_mapping uv_vectors tiling facets magnet",
   false, "a pigment is one colour"},
  {"quick_color quick_colour", false, "leave it out: the pigment's colour is the one that counts"},
  {"normal normal_map slope_map bump_size", false, "the patch itself is what is bumpy: leave it out"},
  {"reflection metallic reflection_exponent conserve_energy irid crand albedo emission subsurface fresnel", false,
   "a finish has ambient, diffuse, brilliance, phong, phong_size, specular, roughness"},
  {"area_light adaptive jitter circular orient area_illumination", false,
   "a light is a point: several of them come near a large one"},
  {"spotlight parallel point_at radius falloff tightness looks_like projected_through light_group", false,
   "a light is a point and shines everywhere"},
  {"fade_distance fade_power media_attenuation media_interaction", false, "a light is as bright from afar"},
  {"fisheye omnimax panoramic ultra_wide_angle mesh_camera", false, "cameras are in perspective"},
  {"orthographic", false, "cameras are in perspective: from far away with a small angle it comes near orthographic"},
  {"aperture blur_samples focal_point confidence variance", false, "a camera is sharp everywhere: leave it out"},
  {"sky_sphere fog rainbow", false, "background { } is one colour"},
  {"radiosity photons adc_bailout number_of_waves max_intersections noise_generator mm_per_unit hf_gray_16 "
   "irid_wavelength",
   false, "light is local here, as without it: leave it out"},
  {"charset ascii utf8 sys", false, "comments may hold any bytes: leave it out"},
  {"clock", false, "a declared name does it: pscn render --declare NAME=NUMBER, for each picture"},
  {"true yes on", false, "1 stands for it"},
  {"false no off", false, "0 stands for it"},
  {"abs acos asin atan atan2 ceil cos degrees div exp floor int ln log max min mod pow radians rand seed select sin "
   "sqrt sqr tan vcross vdot vlength vnormalize vrotate vaxis_rotate t u v defined clock_on now",
   false, "write the number, or give it by --declare NAME=NUMBER"},
  {"! != & | ? <= >=", false, "write what it amounts to, or choose by #ifdef and #ifndef"},
  {"array function spline dimensions dimension_size str chr concat vstr substr strlen", false,
   "names stand for numbers, vectors, colours, textures and objects"},
  {"break case debug declare default else elseif end error fclose fopen for if ifdef ifndef include local macro range "
   "read render statistics switch undef warning while write",
   false, "directives begin with #"},
  {"#if #elseif #while #for #switch #case #range #break", false,
   "conditions are #ifdef and #ifndef; let a script write what a loop stands for"},
  {"#read #write #fopen #fclose", false, "text comes in by #include"},
  {"#debug #warning #error #statistics #render", false, "leave it out"},
};

/* What colors.inc declares, without Gray05 to Gray95. */
static const char COLORS[] =
  "Aquamarine BakersChoc Black Blue BlueViolet Brass BrightGold Bronze Bronze2 Brown CadetBlue Clear CoolCopper "
  "Copper Coral CornflowerBlue Cyan DarkBrown DarkGreen DarkOliveGreen DarkOrchid DarkPurple DarkSlateBlue "
  "DarkSlateGray DarkSlateGrey DarkTan DarkTurquoise DarkWood DimGray DimGrey DkGreenCopper DustyRose Feldspar "
  "Firebrick Flesh ForestGreen Gold Goldenrod Gray Green GreenCopper GreenYellow Grey HuntersGreen IndianRed Khaki "
  "LightBlue LightGray LightGrey LightSteelBlue LightWood Light_Purple LimeGreen Magenta MandarinOrange Maroon "
  "Med_Purple MediumAquamarine MediumBlue MediumForestGreen MediumGoldenrod MediumOrchid MediumSeaGreen "
  "MediumSlateBlue MediumSpringGreen MediumTurquoise MediumVioletRed MediumWood Mica MidnightBlue Navy NavyBlue "
  "NeonBlue NeonPink NewMidnightBlue NewTan OldGold Orange OrangeRed Orchid PaleGreen Pink Plum Quartz Red RichBlue "
  "Salmon Scarlet SeaGreen SemiSweetChoc Sienna Silver SkyBlue SlateBlue SpicyPink SpringGreen SteelBlue SummerSky "
  "Tan Thistle Turquoise VLightGray VLightGrey VeryDarkBrown Very_Light_Purple Violet VioletRed Wheat White Yellow "
  "YellowGreen";

/* Whether the list contains that very word. */
static bool holds(const char *list, const char *word, size_t length)
{
  while (*list != '\0') {
    const size_t size = strcspn(list, " ");
    if (size == length && memcmp(list, word, length) == 0) return true;
    list += size + (list[size] == ' ');
  }
  return false;
}

void hint_write(const char *word, size_t length, char *out, size_t size)
{
  const struct hint *hint = NULL;
  for (size_t k = 0; hint == NULL && k < sizeof HINTS / sizeof *HINTS; k++)
    if (holds(HINTS[k].words, word, length)) hint = &HINTS[k];
  const char *text = hint == NULL || hint->text == NULL ? "" : hint->text, *joint = *text == '\0' ? "" : "; ";
  if (hint != NULL && hint->shape) snprintf(out, size, "renders bicubic_patch only%s%s", joint, text);
  else snprintf(out, size, "has no %.*s%s%s", (int)length, word, joint, text);
}

const char *hint_file(const char *word, size_t length)
{
  const bool grey = length == 6 && (memcmp(word, "Gray", 4) == 0 || memcmp(word, "Grey", 4) == 0);
  return grey || holds(COLORS, word, length) ? "colors.inc" : NULL;
}

/* Names of POV-Ray's colours. */
#include "language/hints.h"

#include <stdbool.h>
#include <string.h>

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

const char *hint_file(const char *word, size_t length)
{
  const bool grey = length == 6 && (memcmp(word, "Gray", 4) == 0 || memcmp(word, "Grey", 4) == 0);
  return grey || holds(COLORS, word, length) ? "colors.inc" : NULL;
}

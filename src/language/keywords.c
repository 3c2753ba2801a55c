/* The words of the language. */
#include <string.h>

#include "language/tokens.h"
#include "language/words.h"

struct keyword {
  const char *name;
  int token;
};

/* Sorted for bsearch. */
static const struct keyword KEYWORDS[] = {
    {"ambient", PSCN_TOKEN_AMBIENT}, {"ambient_light", PSCN_TOKEN_AMBIENT_LIGHT}, {"angle", PSCN_TOKEN_ANGLE},
    {"assumed_gamma", PSCN_TOKEN_ASSUMED_GAMMA}, {"background", PSCN_TOKEN_BACKGROUND},
    {"bicubic_patch", PSCN_TOKEN_BICUBIC_PATCH}, {"blue", PSCN_TOKEN_BLUE}, {"brilliance", PSCN_TOKEN_BRILLIANCE},
    {"camera", PSCN_TOKEN_CAMERA}, {"color", PSCN_TOKEN_COLOR}, {"colour", PSCN_TOKEN_COLOR},
    {"diffuse", PSCN_TOKEN_DIFFUSE}, {"direction", PSCN_TOKEN_DIRECTION}, {"finish", PSCN_TOKEN_FINISH},
    {"flatness", PSCN_TOKEN_FLATNESS}, {"global_settings", PSCN_TOKEN_GLOBAL_SETTINGS}, {"green", PSCN_TOKEN_GREEN},
    {"image_height", PSCN_TOKEN_IMAGE_HEIGHT}, {"image_width", PSCN_TOKEN_IMAGE_WIDTH},
    {"light_source", PSCN_TOKEN_LIGHT_SOURCE}, {"location", PSCN_TOKEN_LOCATION}, {"look_at", PSCN_TOKEN_LOOK_AT},
    {"matrix", PSCN_TOKEN_MATRIX}, {"max_trace_level", PSCN_TOKEN_MAX_TRACE_LEVEL}, {"object", PSCN_TOKEN_OBJECT},
    {"perspective", PSCN_TOKEN_PERSPECTIVE}, {"phong", PSCN_TOKEN_PHONG}, {"phong_size", PSCN_TOKEN_PHONG_SIZE},
    {"pi", PSCN_TOKEN_PI}, {"pigment", PSCN_TOKEN_PIGMENT}, {"red", PSCN_TOKEN_RED}, {"rgb", PSCN_TOKEN_RGB},
    {"right", PSCN_TOKEN_RIGHT}, {"rotate", PSCN_TOKEN_ROTATE}, {"roughness", PSCN_TOKEN_ROUGHNESS},
    {"scale", PSCN_TOKEN_SCALE}, {"shadowless", PSCN_TOKEN_SHADOWLESS}, {"sky", PSCN_TOKEN_SKY},
    {"solver", PSCN_TOKEN_SOLVER}, {"specular", PSCN_TOKEN_SPECULAR}, {"texture", PSCN_TOKEN_TEXTURE},
    {"translate", PSCN_TOKEN_TRANSLATE}, {"type", PSCN_TOKEN_TYPE}, {"u_steps", PSCN_TOKEN_U_STEPS},
    {"union", PSCN_TOKEN_UNION}, {"up", PSCN_TOKEN_UP}, {"v_steps", PSCN_TOKEN_V_STEPS}, {"x", PSCN_TOKEN_X},
    {"y", PSCN_TOKEN_Y}, {"z", PSCN_TOKEN_Z}};

static const struct keyword DIRECTIVES[] = {
    {"declare", PSCN_TOKEN_DECLARE}, {"else", TOKEN_ELSE}, {"end", TOKEN_ENDIF}, {"ifdef", TOKEN_IFDEF},
    {"ifndef", TOKEN_IFNDEF}, {"include", TOKEN_INCLUDE}, {"local", PSCN_TOKEN_LOCAL}, {"version", PSCN_TOKEN_VERSION}};

/* POV-Ray 3.7's other directives. */
static const struct keyword FOREIGN[] = {
    {"break", TOKEN_FOREIGN_DIRECTIVE}, {"case", TOKEN_FOREIGN_DIRECTIVE}, {"debug", TOKEN_FOREIGN_DIRECTIVE},
    {"default", TOKEN_FOREIGN_DIRECTIVE}, {"elseif", TOKEN_FOREIGN_DIRECTIVE}, {"error", TOKEN_FOREIGN_DIRECTIVE},
    {"fclose", TOKEN_FOREIGN_DIRECTIVE}, {"fopen", TOKEN_FOREIGN_DIRECTIVE}, {"for", TOKEN_FOREIGN_OPENER},
    {"if", TOKEN_FOREIGN_OPENER}, {"macro", TOKEN_FOREIGN_OPENER}, {"range", TOKEN_FOREIGN_DIRECTIVE},
    {"read", TOKEN_FOREIGN_DIRECTIVE}, {"render", TOKEN_FOREIGN_DIRECTIVE}, {"statistics", TOKEN_FOREIGN_DIRECTIVE},
    {"switch", TOKEN_FOREIGN_OPENER}, {"undef", TOKEN_FOREIGN_DIRECTIVE}, {"warning", TOKEN_FOREIGN_DIRECTIVE},
    {"while", TOKEN_FOREIGN_OPENER}, {"write", TOKEN_FOREIGN_DIRECTIVE}};

#define COUNT(table) (sizeof(table) / sizeof *(table))

static const struct keyword *find(const char *text, size_t length, const struct keyword *table, size_t count)
{
  size_t low = 0, high = count;
  while (low < high) {
    const size_t middle = (low + high) / 2;
    const int order = words_compare(text, length, table[middle].name);
    if (order == 0) return &table[middle];
    if (order < 0) high = middle;
    else low = middle + 1;
  }
  return NULL;
}

int keyword_token(const char *text, size_t length)
{
  const struct keyword *found = find(text, length, KEYWORDS, COUNT(KEYWORDS));
  if (found) return found->token;
  return words_foreign(text, length) ? PSCN_TOKEN_FOREIGN : PSCN_TOKEN_WORD;
}

/* The name begins behind the # and blanks. */
int keyword_directive(const char *text, size_t length)
{
  do text++, length--;
  while (strchr(" \t\r\n\f\v", *text));
  const struct keyword *found = find(text, length, DIRECTIVES, COUNT(DIRECTIVES));
  if (!found) found = find(text, length, FOREIGN, COUNT(FOREIGN));
  return found ? found->token : TOKEN_UNKNOWN_DIRECTIVE;
}

void keywords_consider(const char *word, size_t length, const char **best, size_t *best_length, size_t *distance)
{
  for (size_t k = 0; k < COUNT(KEYWORDS); k++) {
    words_consider(word, length, KEYWORDS[k].name, strlen(KEYWORDS[k].name), best, best_length, distance);
  }
}

void keywords_consider_directives(const char *word, size_t length, const char **best, size_t *best_length,
                                  size_t *distance)
{
  for (size_t k = 0; k < COUNT(DIRECTIVES); k++) {
    words_consider(word, length, DIRECTIVES[k].name, strlen(DIRECTIVES[k].name), best, best_length, distance);
  }
}

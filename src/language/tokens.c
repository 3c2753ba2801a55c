/* The stream of tokens: a stack of scanned sources, conditions, and the words of POV-Ray's that pscn does not have. */
#include "language/tokens.h"

#include <stdlib.h>
#include <string.h>

#include "language/words.h"

enum {
  MAX_INCLUDE_DEPTH = 32,
  MAX_CONDITIONS = 256 /* open #ifdefs in one source */
};

/* Every source read stays until the end: tokens, names and places point into their texts. */
struct source_list {
  struct source_list *next;
  struct source *source;
};

struct condition {
  struct place place; /* of the #ifdef */
  bool seen_else;
};

struct frame {
  struct frame *outer;
  const struct source *source;
  struct scan scan;
  char *text; /* the scanner's own copy */
  struct condition condition[MAX_CONDITIONS];
  int conditions;
};

/* ---- words ---- */

struct keyword {
  const char *name;
  int token;
};

/* Sorted for bsearch. */
static const struct keyword keywords[] = {
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

static const struct keyword directives[] = {
    {"declare", PSCN_TOKEN_DECLARE}, {"else", TOKEN_ELSE}, {"end", TOKEN_ENDIF}, {"ifdef", TOKEN_IFDEF},
    {"ifndef", TOKEN_IFNDEF}, {"include", TOKEN_INCLUDE}, {"local", PSCN_TOKEN_LOCAL}, {"version", PSCN_TOKEN_VERSION}};

struct word {
  const char *text;
  size_t length;
};

static int compare(const void *key, const void *element)
{
  const struct word *word = key;
  const char *name = ((const struct keyword *)element)->name;
  const int order = strncmp(word->text, name, word->length);
  return order ? order : name[word->length] ? -1 : 0;
}

int tokens_word(const char *text, size_t length)
{
  const struct word key = {text, length};
  const struct keyword *found = bsearch(&key, keywords, sizeof keywords / sizeof *keywords, sizeof *keywords, compare);
  return found ? found->token : PSCN_TOKEN_WORD;
}

int tokens_directive(const char *text, size_t length)
{
  do text++, length--;
  while (*text == ' ' || *text == '\t');
  const struct word key = {text, length};
  const struct keyword *found = bsearch(&key, directives, sizeof directives / sizeof *directives, sizeof *directives, compare);
  return found ? found->token : TOKEN_FOREIGN_DIRECTIVE;
}

/* ---- sources ---- */

bool tokens_open(struct language *language, struct source *source)
{
  struct source_list *entry = calloc(1, sizeof *entry);
  struct frame *frame = calloc(1, sizeof *frame);
  char *text = malloc(source->length + 2);
  if (!entry || !frame || !text || (memcpy(text, source->text, source->length + 2), !pscn_scan_open(&frame->scan, text, source->length))) {
    free(entry);
    free(frame);
    free(text);
    source_destroy(source);
    return false;
  }
  entry->source = source, entry->next = language->all_sources;
  language->all_sources = entry;
  frame->source = source, frame->text = text, frame->outer = language->frame;
  language->frame = frame;
  return true;
}

static void leave(struct language *language)
{
  struct frame *frame = language->frame;
  symbols_leave(language, language->include_depth);
  if (frame->outer) language->include_depth--;
  language->frame = frame->outer;
  pscn_scan_close(&frame->scan);
  free(frame->text);
  free(frame);
}

void tokens_close(struct language *language)
{
  while (language->frame) leave(language);
  for (struct source_list *entry = language->all_sources, *next; entry; entry = next) {
    next = entry->next;
    source_destroy(entry->source);
    free(entry);
  }
}

static struct place here(const struct frame *frame)
{
  return (struct place){frame->source, frame->scan.begin, frame->scan.end};
}

static const char *text_at(const struct place *place) { return place->source->text + place->begin; }

/* The path of an included file: relative to the folder of the file that includes it. */
static char *include_path(struct language *language, const struct frame *frame, const char *name, size_t length)
{
  const char *slash = strrchr(frame->source->name, '/');
  const size_t folder = name[0] == '/' || !slash ? 0 : (size_t)(slash - frame->source->name) + 1;
  char *path = arena_alloc(language->arena, folder + length + 1, 1);
  if (!path) return NULL;
  memcpy(path, frame->source->name, folder);
  memcpy(path + folder, name, length);
  return path;
}

/* Whether the file is being read already: then the chain is told. */
static bool is_cycle(struct language *language, const struct source *source, struct place place)
{
  for (const struct frame *f = language->frame; f; f = f->outer) {
    if (f->source->device != source->device || f->source->inode != source->inode) continue;
    if (source->device == 0 && source->inode == 0) continue;
    language_error(language, place, "'%s' includes itself", source->name);
    return true;
  }
  return false;
}

static void include(struct language *language)
{
  struct frame *frame = language->frame;
  const int token = pscn_scan_next(&frame->scan);
  const struct place place = here(frame);
  if (token != PSCN_TOKEN_STRING) {
    language_error(language, place, "#include wants a file name in quotes");
    return;
  }
  const size_t length = place.end - place.begin - 2;
  if (memchr(text_at(&place) + 1, '\0', length)) {
    language_error(language, place, "a file name holds no NUL byte");
    return;
  }
  if (language->include_depth == MAX_INCLUDE_DEPTH) {
    language_error(language, place, "files are included more than %d deep", MAX_INCLUDE_DEPTH);
    return;
  }
  const char *path = include_path(language, frame, text_at(&place) + 1, length), *reason;
  struct source *source;
  if (!path) {
    language->no_memory = true;
    return;
  }
  const enum status status = source_read(path, &source, &reason);
  if (status != STATUS_OK) {
    language_error(language, place, "'%s' cannot be included: %s", path, reason);
    if (status == STATUS_LIMIT) language->no_memory = true;
    return;
  }
  source->includer = frame->source, source->include_begin = place.begin, source->include_end = place.end;
  if (is_cycle(language, source, place)) {
    source_destroy(source);
    return;
  }
  if (!tokens_open(language, source)) language->no_memory = true;
  else language->include_depth++;
}

/* ---- conditions ---- */

/* Whether a directive of POV-Ray's has an #end of its own. */
static bool opens_block(struct place place)
{
  static const char *const openers[] = {"if", "while", "macro", "for", "switch"};
  const char *name = text_at(&place) + 1;
  size_t length = place.end - place.begin - 1;
  while (*name == ' ' || *name == '\t') name++, length--;
  for (size_t k = 0; k < sizeof openers / sizeof *openers; k++)
    if (strlen(openers[k]) == length && memcmp(openers[k], name, length) == 0) return true;
  return false;
}

/* Skips to the #else (if `to_else`) or #end that belongs to the innermost condition. */
static void skip_branch(struct language *language, bool to_else)
{
  struct frame *frame = language->frame;
  for (int depth = 0;;) {
    const int token = pscn_scan_next(&frame->scan);
    if (token == 0 || token == TOKEN_NO_MEMORY || token == TOKEN_OPEN_COMMENT) return; /* the end tells of what is open */
    if (token == TOKEN_IFDEF || token == TOKEN_IFNDEF) depth++;
    if (token == TOKEN_FOREIGN_DIRECTIVE && opens_block(here(frame))) depth++;
    if (token == TOKEN_ELSE && depth == 0 && to_else) {
      frame->condition[frame->conditions - 1].seen_else = true;
      return;
    }
    if (token == TOKEN_ENDIF && depth-- == 0) {
      frame->conditions--;
      return;
    }
  }
}

static bool open_condition(struct language *language, struct place place)
{
  struct frame *frame = language->frame;
  if (frame->conditions == MAX_CONDITIONS) {
    language_error(language, place, "conditions are nested more than %d deep", MAX_CONDITIONS);
    language->no_memory = true;
    return false;
  }
  frame->condition[frame->conditions++] = (struct condition){place, false};
  return true;
}

static void begin_condition(struct language *language, bool wanted)
{
  struct frame *frame = language->frame;
  const struct place place = here(frame);
  struct place name = place;
  bool defined = false, right = pscn_scan_next(&frame->scan) == '(';
  if (right) {
    const int token = pscn_scan_next(&frame->scan);
    name = here(frame);
    right = token == PSCN_TOKEN_WORD || (token > 255 && token < TOKEN_FIRST_PRIVATE && token != PSCN_TOKEN_NUMBER &&
                                         token != PSCN_TOKEN_POINT && token != PSCN_TOKEN_STRING);
    defined = right && (token != PSCN_TOKEN_WORD || symbol_find(language, text_at(&name), name.end - name.begin));
    right = right && pscn_scan_next(&frame->scan) == ')';
  }
  if (!right) language_error(language, here(frame), "%s wants a name in parentheses", wanted ? "#ifdef" : "#ifndef");
  if (open_condition(language, place) && defined != wanted) skip_branch(language, true);
}

static void end_condition(struct language *language, int token)
{
  struct frame *frame = language->frame;
  const char *name = token == TOKEN_ELSE ? "#else" : "#end";
  if (frame->conditions == 0) {
    language_error(language, here(frame), "%s without #ifdef", name);
    return;
  }
  struct condition *condition = &frame->condition[frame->conditions - 1];
  if (token == TOKEN_ENDIF) {
    frame->conditions--;
    return;
  }
  if (condition->seen_else) language_error(language, here(frame), "a second #else for the same #ifdef");
  condition->seen_else = true;
  skip_branch(language, false);
}

/* ---- words of POV-Ray's ---- */

/* Skips a block in braces, if one begins here; otherwise the token found is kept for later. */
static int skip_block(struct frame *frame)
{
  int token = pscn_scan_next(&frame->scan);
  if (token != '{') return token;
  for (int depth = 1; depth > 0;) {
    token = pscn_scan_next(&frame->scan);
    if (token == 0 || token == TOKEN_NO_MEMORY || token == TOKEN_OPEN_COMMENT) return token;
    depth += (token == '{') - (token == '}');
  }
  return pscn_scan_next(&frame->scan);
}

static int foreign_word(struct language *language, struct place place)
{
  const size_t length = place.end - place.begin;
  const char *word = text_at(&place);
  if (words_foreign_shape(word, length))
    language_error(language, place, "%.*s is POV-Ray, but pscn renders bicubic_patch only", (int)length, word);
  else language_error(language, place, "%.*s is POV-Ray, but pscn has no %.*s", (int)length, word, (int)length, word);
  language->foreign_distance = 0;
  return skip_block(language->frame);
}

static void foreign_directive(struct language *language)
{
  const struct place place = here(language->frame);
  const char *name = text_at(&place);
  language_error(language, place, "'%.*s' is no directive of pscn: it has #declare, #local, #ifdef, #ifndef, #else, #end, #include and #version",
                 (int)(place.end - place.begin), name);
  language->foreign_distance = 0;
  if (!opens_block(place) || !open_condition(language, place)) return;
  skip_branch(language, false); /* with all that it governs, and its #end */
}

/* ---- the stream ---- */

/* Words in a solver statement are the solver table's, whatever they mean elsewhere. */
static int raw_word(struct language *language, int token)
{
  if (token == PSCN_TOKEN_SOLVER && language->raw_words == 0) {
    language->raw_words = 1;
    return token;
  }
  switch (language->raw_words) {
  case 1: language->raw_words = token == 0 ? 0 : 2; break;
  case 2: language->raw_words = token == '{' ? 3 : 0; return token;
  case 3: if (token == '}' || token == 0) language->raw_words = 0; break;
  default: return token;
  }
  return token > 255 && token < TOKEN_FIRST_PRIVATE && token != PSCN_TOKEN_NUMBER && token != PSCN_TOKEN_POINT &&
                 token != PSCN_TOKEN_STRING
             ? PSCN_TOKEN_WORD
             : token;
}

static bool tell_broken_token(struct language *language, int token)
{
  const struct frame *frame = language->frame;
  const struct place place = here(frame), comment = {frame->source, frame->scan.comment_begin, frame->scan.comment_begin + 2};
  switch (token) {
  case TOKEN_OPEN_COMMENT: language_error(language, comment, "this comment is not closed"); return true;
  case TOKEN_OPEN_STRING: language_error(language, place, "this file name has no closing quote"); return true;
  case TOKEN_BAD_CHARACTER: language_error(language, place, "this character has no place in a scene"); return true;
  case TOKEN_TOO_LARGE: language_error(language, place, "the number is too large"); return true;
  default: return false;
  }
}

/* The end of a source: back to its includer. True where that was the last. */
static bool end_of_source(struct language *language)
{
  struct frame *frame = language->frame;
  for (int k = 0; k < frame->conditions; k++)
    language_error(language, frame->condition[k].place, "this condition has no #end");
  frame->conditions = 0;
  if (!frame->outer) return true;
  leave(language);
  return false;
}

int tokens_next(struct language *language, struct token *out_token, struct place *out_place)
{
  if (language->solver_only && !language->solver_begun) {
    /* What follows is read as behind this word. */
    language->solver_begun = true;
    language->raw_words = 1;
    *out_place = (struct place){language->frame->source, 0, 0};
    return PSCN_TOKEN_SOLVER;
  }
  int pending = -1;
  for (;;) {
    struct frame *frame = language->frame;
    const int scanned = pending >= 0 ? pending : pscn_scan_next(&frame->scan), token = raw_word(language, scanned);
    const struct place place = here(frame);
    pending = -1;
    *out_place = place;
    if (token == TOKEN_NO_MEMORY) language->no_memory = true;
    if (language->no_memory || diagnostics_full(language->diagnostics)) return 0;
    switch (token) {
    case 0:
      if (end_of_source(language)) return 0;
      continue;
    case TOKEN_INCLUDE: include(language); continue;
    case TOKEN_IFDEF: begin_condition(language, true); continue;
    case TOKEN_IFNDEF: begin_condition(language, false); continue;
    case TOKEN_ELSE:
    case TOKEN_ENDIF: end_condition(language, token); continue;
    case TOKEN_FOREIGN_DIRECTIVE: foreign_directive(language); continue;
    default: break;
    }
    if (tell_broken_token(language, token)) {
      language->foreign_distance = 0;
      if (token != TOKEN_TOO_LARGE) continue;
      *out_token = (struct token){.text = text_at(&place), .length = place.end - place.begin, .number = {1, 1, 1}};
      return text_at(&place)[0] == '<' ? PSCN_TOKEN_POINT : PSCN_TOKEN_NUMBER;
    }
    if (token == PSCN_TOKEN_WORD && language->raw_words == 0 && scanned == token &&
        words_foreign(text_at(&place), place.end - place.begin)) {
      pending = foreign_word(language, place);
      continue;
    }
    if (language->foreign_distance < FOREIGN_ECHO) language->foreign_distance++;
    *out_token = (struct token){.text = text_at(&place), .length = place.end - place.begin,
                                .number = {frame->scan.number[0], frame->scan.number[1], frame->scan.number[2]}};
    return token;
  }
}

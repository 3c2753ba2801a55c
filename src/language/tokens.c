/* The stream of tokens, with braces counted for recovery. */
#include "language/tokens.h"

#include <stdio.h>
#include <string.h>

#include "language/hints.h"

static const char *text_at(struct place place) { return place.source->text + place.begin; }

static size_t length_of(struct place place) { return place.end - place.begin; }

static bool is_number(int token) { return token == PSCN_TOKEN_NUMBER || token == PSCN_TOKEN_POINT; }

/* Any word, be it a name or one of the language's or of POV-Ray's. */
static bool is_word(int token)
{
  return token > 255 && token < TOKEN_FIRST_PRIVATE && !is_number(token) && token != PSCN_TOKEN_STRING &&
         token != PSCN_TOKEN_VERSION && token != PSCN_TOKEN_DECLARE && token != PSCN_TOKEN_LOCAL &&
         token != PSCN_TOKEN_DEFAULT;
}

static void tell_open_comment(struct language *language)
{
  const struct frame *frame = language->sources->frame;
  const size_t begin = frame->scan.comment_begin;
  language_tell(language, (struct place){frame->source, begin, begin + 2}, "this comment is not closed");
}

/* ---- conditions ---- */

/* Skips to the #end of a condition, or if `to_else` to its #else; what is skipped may hold conditions of its own,
 * also those that only POV-Ray has. Answers the token it stopped at; 0 is the end of the source. */
static int skip_branch(struct language *language, bool to_else)
{
  for (int depth = 0;;) {
    const int token = pscn_scan_next(&language->sources->frame->scan);
    switch (token) {
    case 0:
    case TOKEN_NO_MEMORY: return token;
    case TOKEN_OPEN_COMMENT: tell_open_comment(language); break;
    case TOKEN_IFDEF:
    case TOKEN_IFNDEF:
    case TOKEN_MACRO:
    case TOKEN_FOREIGN_OPENER: depth++; break;
    case TOKEN_ELSE:
      if (depth == 0 && to_else) return token;
      break;
    case TOKEN_ENDIF:
      if (depth-- == 0) return token;
      break;
    default: break;
    }
  }
}

/* "(NAME)": whether the name is declared. The words of the language never are, as in POV-Ray. */
static bool condition_holds(struct language *language, const char *directive)
{
  struct scan *scan = &language->sources->frame->scan;
  int token = pscn_scan_next(scan);
  const bool opened = token == '(';
  bool declared = true;
  if (opened) {
    token = pscn_scan_next(scan);
    const struct place name = sources_here(language);
    if (is_word(token)) {
      declared = symbol_known(language, text_at(name), length_of(name));
      token = pscn_scan_next(scan);
      if (token == ')') return declared;
    }
  }
  language_tell(language, sources_here(language), "%s wants a name in parentheses", directive);
  while (opened && (token == '.' || is_word(token))) token = pscn_scan_next(scan);
  return declared;
}

static void begin_condition(struct language *language, bool wanted)
{
  struct frame *frame = language->sources->frame;
  const struct place place = sources_here(language);
  const bool holds = condition_holds(language, wanted ? "#ifdef" : "#ifndef") == wanted;
  if (frame->conditions == MAX_CONDITIONS) {
    language_limit(language, place, "conditions are nested more than 200 deep");
    return;
  }
  frame->condition[frame->conditions++] = (struct condition){place, false};
  if (holds) return;
  const int stopped = skip_branch(language, true);
  if (stopped == TOKEN_ELSE) frame->condition[frame->conditions - 1].seen_else = true;
  if (stopped == TOKEN_ENDIF) frame->conditions--;
}

/* At an #else, whose branch is skipped for the one before it has been read, or at an #end. */
static void end_condition(struct language *language, int token)
{
  struct frame *frame = language->sources->frame;
  if (frame->conditions == 0) {
    language_tell(language, sources_here(language), "%s without #ifdef", token == TOKEN_ELSE ? "#else" : "#end");
    return;
  }
  struct condition *condition = &frame->condition[frame->conditions - 1];
  if (token == TOKEN_ELSE) {
    if (condition->seen_else) language_tell(language, sources_here(language), "a second #else for the same #ifdef");
    condition->seen_else = true;
    if (skip_branch(language, false) != TOKEN_ENDIF) return;
  }
  frame->conditions--;
}

/* ---- what is not the grammar's ---- */

/* A macro may be defined; what is in it nobody reads. */
static void skip_macro(struct language *language)
{
  const struct place place = sources_here(language);
  const int token = pscn_scan_next(&language->sources->frame->scan);
  const struct place name = sources_here(language);
  if (is_word(token))
    declare_macro(language, &(struct token){.text = text_at(name), .length = length_of(name), .place = name});
  else language_tell(language, name, "#macro wants a name");
  if (skip_branch(language, false) != TOKEN_ENDIF) language_tell(language, place, "#macro without #end");
}

static void undeclare(struct language *language)
{
  const int token = pscn_scan_next(&language->sources->frame->scan);
  const struct place name = sources_here(language);
  if (is_word(token)) declare_gone(language, &(struct token){.text = text_at(name), .length = length_of(name)});
  else language_tell(language, name, "#undef wants a name");
}

static void tell_directive(struct language *language, int token)
{
  const struct place place = sources_here(language);
  size_t length = length_of(place);
  const char *name = words_directive(text_at(place), &length);
  if (token != TOKEN_UNKNOWN_DIRECTIVE) {
    char directive[HINT_SIZE], hint[HINT_SIZE];
    const int size = snprintf(directive, sizeof directive, "#%.*s", (int)length, name);
    hint_write(directive, (size_t)size, hint, sizeof hint);
    if (!language->tokens->skipping) language_foreign(language, place, "%s is POV-Ray, but pscn %s", directive, hint);
    return;
  }
  struct guess guess = guess_begin(name, length);
  guess_directives(&guess);
  if (guess.best)
    language_tell(language, place, "unknown directive '#%.*s'; did you mean '#%s'?", (int)length, name, guess.best);
  else language_tell(language, place, "unknown directive '#%.*s'", (int)length, name);
}

/* Words in a solver statement are plain, whatever they mean elsewhere. */
static int raw_word(struct language *language, int token)
{
  switch (language->tokens->raw_words) {
  case 0:
    if (token == PSCN_TOKEN_SOLVER) language->tokens->raw_words = 1;
    return token;
  case 1: language->tokens->raw_words = 2; break;
  case 2: language->tokens->raw_words = token == '{' ? 3 : token == PSCN_TOKEN_SOLVER ? 1 : 0; return token;
  default:
    if (token == '}' || token == 0) language->tokens->raw_words = 0;
    break;
  }
  return is_word(token) ? PSCN_TOKEN_WORD : token;
}

/* The end of a source: false where it was the last. */
static bool end_of_source(struct language *language)
{
  struct frame *frame = language->sources->frame;
  while (frame->conditions > 0) {
    const struct place place = frame->condition[--frame->conditions].place;
    source_recall(place.source);
    language_tell(language, place, "%.*s without #end", (int)length_of(place), text_at(place));
  }
  if (!frame->outer) return false;
  sources_leave(language);
  return true;
}

/* Text from a command line names no files and asks nothing. */
static bool refused_directive(struct language *language, int token)
{
  const bool directive = (token >= TOKEN_INCLUDE && token <= TOKEN_UNKNOWN_DIRECTIVE) ||
                         (token >= PSCN_TOKEN_VERSION && token <= PSCN_TOKEN_DEFAULT);
  if (!directive || !language->tokens->solver_only) return false;
  language_tell(language, sources_here(language), "the text of a solver has no directives");
  return true;
}

/* Deals with what is not the grammar's: true where `token` was such and the next one is wanted. */
static bool aside(struct language *language, int token)
{
  if (refused_directive(language, token)) return true;
  switch (token) {
  case 0: return end_of_source(language);
  case TOKEN_INCLUDE: sources_include(language); return true;
  case TOKEN_IFDEF: begin_condition(language, true); return true;
  case TOKEN_IFNDEF: begin_condition(language, false); return true;
  case TOKEN_ELSE:
  case TOKEN_ENDIF: end_condition(language, token); return true;
  case TOKEN_OPEN_COMMENT: tell_open_comment(language); return true;
  case TOKEN_OPEN_STRING: language_tell(language, sources_here(language), "this quote is not closed"); return true;
  case TOKEN_BAD_CHARACTER:
    if (!language->tokens->skipping) language_error(language, sources_here(language), "this means nothing here");
    return true;
  case TOKEN_FOREIGN_OPENER:
    tell_directive(language, token);
    skip_branch(language, false);
    return true;
  case TOKEN_MACRO: skip_macro(language); return true;
  case TOKEN_UNDEF: undeclare(language); return true;
  case TOKEN_NO_MEMORY: language->ended_early = true; return true;
  default: return false;
  }
}

static void tell_too_large(struct language *language)
{
  struct scan *scan = &language->sources->frame->scan;
  language_tell(language, (struct place){language->sources->frame->source, scan->too_large_begin, scan->too_large_end},
                "this number is too large");
  for (int k = 0; k < 3; k++) scan->number[k] = 1;
}

/* ---- the stream ---- */

/* The next token of the grammar, into tokens->last. */
static int advance(struct language *language)
{
  struct tokens *tokens = language->tokens;
  struct delivered *last = &tokens->last;
  if (last->again) {
    last->again = false;
    return last->token;
  }
  tokens->previous = last->place;
  int token;
  do {
    if (language->ended_early || diagnostics_full(language->diagnostics)) {
      token = 0;
      break;
    }
    token = pscn_scan_next(&language->sources->frame->scan);
  } while (aside(language, token));

  struct place place = sources_here(language);
  if (token == 0) place.begin = place.end = place.source->length;
  if (token == TOKEN_FOREIGN_DIRECTIVE || token == TOKEN_UNKNOWN_DIRECTIVE) {
    tell_directive(language, token);
    tokens->told = place;
    token = PSCN_TOKEN_FOREIGN;
  }
  if (is_number(token) && language->sources->frame->scan.too_large) tell_too_large(language);
  last->place = place;
  last->token = raw_word(language, token);
  last->depth = tokens->depth;
  if (token == '{' && tokens->depth < MAX_NESTING) tokens->braces[tokens->depth] = place;
  if (token == '{' && ++tokens->depth > MAX_NESTING)
    language_limit(language, place, "blocks are nested more than 200 deep");
  if (token == '}' && tokens->depth > 0) tokens->depth--;
  return last->token;
}

int tokens_next(struct language *language, struct token *out_token)
{
  struct tokens *tokens = language->tokens;
  if (tokens->made_up < (tokens->solver_only ? 2 : 1)) {
    *out_token = (struct token){.place = {language->sources->frame->source, 0, 0}};
    if (!tokens->solver_only) return tokens->made_up++, PSCN_TOKEN_START_SCENE;
    tokens->raw_words = tokens->made_up;
    return tokens->made_up++ == 0 ? PSCN_TOKEN_START_SOLVER : PSCN_TOKEN_SOLVER;
  }
  const int token = advance(language);
  out_token->place = tokens->last.place;
  if (is_number(token)) memcpy(out_token->number, language->sources->frame->scan.number, sizeof out_token->number);
  else out_token->text = text_at(out_token->place), out_token->length = length_of(out_token->place);
  return token;
}

/* ---- recovery ---- */

static bool recover(struct language *language)
{
  struct tokens *tokens = language->tokens;
  const struct delivered *last = &tokens->last;
  const int block = last->depth;
  const bool twice = last->place.source == tokens->recovered.source && last->place.begin == tokens->recovered.begin;
  int parentheses = 0, before = 0;
  tokens->recovered = last->place;
  tokens->last.again = false;

  for (bool first = true;; first = false, before = last->token, advance(language)) {
    const int token = last->token;
    if (token == 0) return false;
    if (token == '(' && !first) parentheses++;
    if (parentheses > 0) { /* of a function of POV-Ray's: its arguments may be anything */
      parentheses -= token == ')';
      continue;
    }
    /* What was refused where it stands may begin the next item; refused there too, it is dropped. */
    if (!(first && twice)) {
      const bool begins = block == 0 ? words_begin_statement(token) : words_begin_item(token);
      const bool in_value = before == '+' || before == '-' || before == '*' || before == '/' || before == ',';
      const bool foreign = token == PSCN_TOKEN_FOREIGN && !first && !in_value;
      if (last->depth == block && (begins || foreign || (token == '}' && block > 0))) {
        tokens->last.again = true;
        return true;
      }
    }
    /* A block within what is skipped has ended, or a statement: what comes next is on its own. */
    if (!first && token == '}' && last->depth == block + 1) return true;
    if (token == ';' && last->depth == block && block == 0) return true;
  }
}

/* What is skipped may hold what means nothing here, as a map of colours does: it is told of once. */
bool tokens_recover(struct language *language)
{
  language->tokens->skipping = true;
  const bool more = recover(language);
  language->tokens->skipping = false;
  return more;
}

/* Directives, and all other tokens that are not the grammar's. */
#include "language/directives.h"

#include <stdio.h>

#include "language/hints.h"
#include "language/macros.h"
#include "language/syntax_errors.h"
#include "language/tokens.h"

/* The last token of the source being read, whatever it is. */
static struct name here(const struct language *language) { return sources_name(language, sources_here(language)); }

static void tell_open_comment(struct language *language)
{
  const struct frame *frame = language->sources->frame;
  const size_t begin = frame->scan.comment_begin;
  language_tell(language, sources_span(frame, begin, begin + 2), "this comment is not closed");
}

/* ---- conditions ---- */

/* Skips to the #end of a condition, or if `to_else` to its #else. The skipped text may hold conditions of its own, also
 * those that only POV-Ray has. `foreign`: the skipped directive of POV-Ray's, which may read that text; else 0.
 * `macro`: the macro whose text it is, or NULL. Returns the token at which it stopped; 0 is the end of the source. */
static int skip_branch(struct language *language, bool to_else, int foreign, struct macro *macro)
{
  struct naming naming = {0};
  if (foreign) declare_passed(language, foreign, sources_here(language), &naming);
  for (int depth = 0;;) {
    const int token = pscn_scan_next(&language->sources->frame->scan);
    if (macro) macro_note(language, macro, token, sources_here(language));
    if (foreign) declare_passed(language, token, sources_here(language), &naming);
    if (foreign && token == PSCN_TOKEN_WORD) macro_called(language, sources_here(language));
    switch (token) {
    case 0: return token;
    case TOKEN_OPEN_COMMENT: tell_open_comment(language); break;
    case TOKEN_OPEN_STRING: sources_tell_open_string(language); break;
    case TOKEN_IFDEF:
    case TOKEN_IFNDEF:
    case TOKEN_MACRO:
    case TOKEN_FOREIGN_OPENER:
    case TOKEN_FOR: depth++; break;
    case TOKEN_ELSE:
      if (depth == 0 && to_else) return token;
      break;
    case TOKEN_ELSEIF: /* this branch may be the one that counts */
      if (depth == 0 && to_else) directives_tell(language, token);
      break;
    case TOKEN_ENDIF:
      if (depth-- == 0) return token;
      break;
    default: break;
    }
  }
}

/* Reads "(NAME)": whether the name is declared. As in POV-Ray, the words of the language never are; POV-Ray's own names
 * are. */
static bool condition_holds(struct language *language, const char *directive)
{
  struct scan *scan = &language->sources->frame->scan;
  int token = pscn_scan_next(scan);
  const bool opened = token == '(';
  bool declared = true;
  if (opened) {
    token = pscn_scan_next(scan);
    const struct name name = here(language);
    if (scan_is_word(token)) {
      declared = symbol_known(language, &name) || words_declared(name.text, name.length);
      token = pscn_scan_next(scan);
      if (token == ')') return declared;
    }
  }
  language_tell(language, sources_here(language), "%s wants a name in parentheses", directive);
  while (opened && (token == '.' || scan_is_word(token))) token = pscn_scan_next(scan);
  return declared;
}

static void begin_condition(struct language *language, bool wanted)
{
  struct frame *frame = language->sources->frame;
  const struct span place = sources_here(language);
  const bool holds = condition_holds(language, wanted ? "#ifdef" : "#ifndef") == wanted;
  if (frame->conditions == MAX_CONDITIONS) {
    language_limit(language, place, "conditions are nested more than 200 deep");
    return;
  }
  frame->condition[frame->conditions++] = (struct condition){place, false};
  if (holds) return;
  const int stopped = skip_branch(language, true, 0, NULL);
  if (stopped == TOKEN_ELSE) frame->condition[frame->conditions - 1].seen_else = true;
  if (stopped == TOKEN_ENDIF) frame->conditions--;
}

/* At an #else, whose branch is skipped because the one before it has been read, or at an #end. */
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
    if (skip_branch(language, false, 0, NULL) != TOKEN_ENDIF) return;
  }
  frame->conditions--;
}

/* ---- what is not the grammar's ---- */

/* Reads the name behind a directive, which is not a word of the language or of POV-Ray's. False, after an error, if
 * there is none. */
static bool next_name(struct language *language, const char *directive, struct name *out)
{
  const int token = pscn_scan_next(&language->sources->frame->scan);
  *out = here(language);
  if (token == PSCN_TOKEN_WORD) return true;
  if (scan_is_word(token))
    language_tell(language, out->place, "%s wants a name, and '%.*s' is a word of the language", directive,
                  (int)out->length, out->text);
  else language_tell(language, out->place, "%s wants a name", directive);
  return false;
}

/* A macro may be defined. Its text is not read, except for the names that it declares. */
static void skip_macro(struct language *language)
{
  const struct span place = sources_here(language);
  struct name name;
  struct macro *macro = macro_begin(language);
  if (next_name(language, "#macro", &name)) declare_macro(language, &name, macro);
  if (skip_branch(language, false, 0, macro) != TOKEN_ENDIF) language_tell(language, place, "#macro without #end");
}

static void undeclare(struct language *language)
{
  struct name name;
  if (next_name(language, "#undef", &name)) declare_gone(language, &name);
}

void directives_tell(struct language *language, int token)
{
  const struct name whole = here(language);
  const struct span place = whole.place;
  size_t length = whole.length;
  const char *name = words_directive(whole.text, &length);
  if (token != TOKEN_UNKNOWN_DIRECTIVE) {
    char directive[HINT_SIZE], hint[HINT_SIZE];
    const int size = snprintf(directive, sizeof directive, "#%.*s", (int)length, name);
    hint_write(directive, (size_t)size, hint, sizeof hint);
    if (language->tokens->skipping != 0 && language->tokens->skipping <= language->tokens->depth) return;
    language_foreign(language, place, "%s is POV-Ray, but pscn %s", directive, hint);
    return;
  }
  struct guess guess = guess_begin(name, length);
  guess_directives(&guess);
  if (guess.best)
    language_tell(language, place, "unknown directive '#%.*s'; did you mean '#%s'?", (int)length, name, guess.best);
  else language_tell(language, place, "unknown directive '#%.*s'", (int)length, name);
}

/* Ends a source. Returns false if it was the last. */
static bool end_of_source(struct language *language)
{
  struct frame *frame = language->sources->frame;
  while (frame->conditions > 0) {
    source_recall(frame->source);
    const struct name name = sources_name(language, frame->condition[--frame->conditions].place);
    size_t length = name.length;
    const char *directive = words_directive(name.text, &length);
    language_tell(language, name.place, "#%.*s without #end", (int)length, directive);
  }
  if (!frame->outer) return false;
  declare_left_open(language, sources_span(frame, frame->source->length, frame->source->length));
  sources_leave(language);
  return true;
}

/* Text from a command line names no files and has no conditions. */
static bool refused_directive(struct language *language, int token)
{
  const bool directive = (token >= TOKEN_INCLUDE && token <= TOKEN_UNKNOWN_DIRECTIVE) ||
                         (token >= PSCN_TOKEN_VERSION && token <= PSCN_TOKEN_DEFAULT);
  if (!directive || !language->tokens->solver_only) return false;
  language_tell(language, sources_here(language), "the text of a solver has no directives");
  return true;
}

bool directives_pass(struct language *language, int token)
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
  case TOKEN_OPEN_STRING: sources_tell_open_string(language); return true;
  case TOKEN_BAD_CHARACTER:
    if (!language->tokens->skipping) character_error(language);
    return true;
  case TOKEN_FOREIGN_OPENER:
  case TOKEN_FOR:
    directives_tell(language, token);
    skip_branch(language, false, token, NULL);
    return language->tokens->last.token != '='; /* behind = it stands for a value, and is not skipped */
  case TOKEN_MACRO: skip_macro(language); return true;
  case TOKEN_UNDEF: undeclare(language); return true;
  default: return false;
  }
}

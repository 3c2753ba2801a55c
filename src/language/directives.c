/* Directives, and all other tokens that are not the grammar's. */
#include "language/directives.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "language/macros.h"
#include "language/syntax_errors.h"
#include "language/strings.h"
#include "language/tokens.h"
#include "language/values.h"

/* POV-Ray's, absolute: numbers nearer than that are equal. */
#define EQUAL 1e-10

/* The last token of the source being read, whatever it is. */
static struct name here(const struct language *language) { return sources_name(language, sources_here(language)); }

static struct frame *frame_of(const struct language *language) { return language->sources->frame; }

static void tell_open_comment(struct language *language)
{
  const struct frame *frame = frame_of(language);
  const size_t begin = frame->scan.comment_begin;
  language_tell(language, sources_span(frame, begin, begin + 2), "this comment is not closed");
}

int directives_scan(struct language *language)
{
  const struct sources *sources = language->sources;
  if (sources->again > 0 && ++language->work > language->max_work) {
    char text[100];
    snprintf(text, sizeof text, "loops and macros read more than %zu words; this is the last", language->max_work);
    language_limit(language, sources_here(language), text);
  }
  return language_ended(language) ? 0 : pscn_scan_next(&sources->frame->scan);
}

bool directives_name(struct language *language, const char *directive, struct name *out)
{
  const int token = directives_scan(language);
  *out = here(language);
  if (token == PSCN_TOKEN_WORD) return true;
  if (scan_is_word(token))
    language_tell(language, out->place, "%s wants a name, and '%.*s' is a word of the language", directive,
                  (int)out->length, out->text);
  else language_tell(language, out->place, "%s wants a name", directive);
  return false;
}

/* ---- skipping ---- */

enum skip_stop {
  STOP_END,
  STOP_ELSE,
  STOP_CASE
}; /* at #end only; also at #else and #elseif; or at #else, #case, #range */

/* Skips to a directive of the condition whose text this is, and returns it; 0 is the end of the source. The skipped
 * text may hold conditions of its own. */
static int skip(struct language *language, enum skip_stop stop)
{
  for (int depth = 0;;) {
    const int token = directives_scan(language);
    switch (token) {
    case 0: return token;
    case TOKEN_OPEN_COMMENT: tell_open_comment(language); break;
    case TOKEN_OPEN_STRING: sources_tell_open_string(language); break;
    case TOKEN_IFDEF:
    case TOKEN_IFNDEF:
    case TOKEN_IF:
    case TOKEN_WHILE:
    case TOKEN_FOR:
    case TOKEN_SWITCH:
    case TOKEN_MACRO: depth++; break;
    case TOKEN_ELSE:
      if (depth == 0 && stop != STOP_END) return token;
      break;
    case TOKEN_ELSEIF:
      if (depth == 0 && stop == STOP_ELSE) return token;
      break;
    case TOKEN_CASE:
    case TOKEN_RANGE:
      if (depth == 0 && stop == STOP_CASE) return token;
      break;
    case TOKEN_END:
      if (depth-- == 0) return token;
      break;
    default: break;
    }
  }
}

bool directives_skip_to_end(struct language *language) { return skip(language, STOP_END) == TOKEN_END; }

/* Whether this condition is the innermost one. It may have been closed by what its parentheses hold. */
static bool is_open(const struct language *language, const struct condition *condition)
{
  return condition && frame_of(language)->condition == condition;
}

/* Skips the rest of the innermost condition and closes it. At the end of the source it stays open, to be reported. */
static void leave(struct language *language)
{
  const struct condition *condition = frame_of(language)->condition;
  if (condition->end > 0) pscn_scan_seek(&frame_of(language)->scan, condition->end);
  else if (!directives_skip_to_end(language)) return;
  sources_close_condition(language);
}

/* ---- conditions ---- */

/* Parses what stands in parentheses behind a directive: up to `most` numbers. False after an error. */
static bool read_numbers(struct language *language, int start, int most, double out[])
{
  struct value *list = NULL;
  bool read = tokens_parse(language, start, &list);
  int count = 0;
  for (const struct value *v = list; read && v && count < most; v = v->next)
    read = value_to_number(language, v, &out[count++]);
  value_last_of_list(language, list);
  return read;
}

/* Reads "(NAME)", or of an array "(NAME[I])": whether that is declared. As in POV-Ray, the words of the language never
 * are. After an error the answer is yes. */
static bool is_declared(struct language *language, const char *directive)
{
  int token = directives_scan(language);
  const bool opened = token == '(';
  if (opened) {
    token = directives_scan(language);
    struct name name = here(language);
    if (scan_is_word(token)) {
      bool declared = symbol_known(language, &name);
      const struct value *value = declared ? symbol_find(language, name.text, name.length) : NULL;
      struct value *list = NULL;
      token = directives_scan(language);
      if (token == '[' && value) {
        if (!tokens_parse(language, PSCN_TOKEN_START_INDICES, &list)) return true;
        const struct value *element = array_element(language, symbol_find(language, name.text, name.length),
                                                    &(struct value){.place = name.place, .next = list});
        value_last_of_list(language, list);
        return element && element->kind != VALUE_NONE;
      }
      if (token == ')') return declared;
    }
  }
  language_tell(language, sources_here(language), "%s wants a name in parentheses", directive);
  while (opened && (token == '.' || scan_is_word(token))) token = directives_scan(language);
  return true;
}

/* Whether the condition of an #if, #elseif or #while holds. */
static bool holds(struct language *language, bool after_error)
{
  double x;
  return read_numbers(language, PSCN_TOKEN_START_CONDITION, 1, &x) ? fabs(x) > EQUAL : after_error;
}

/* Skips the branches that do not count, up to the one that does or the #end. */
static void choose_branch(struct language *language)
{
  struct condition *condition = frame_of(language)->condition;
  while (is_open(language, condition)) {
    const int stopped = skip(language, STOP_ELSE);
    if (stopped == TOKEN_ELSE) condition->seen_else = true;
    else if (stopped == TOKEN_END) sources_close_condition(language);
    else if (stopped == TOKEN_ELSEIF && !holds(language, true)) continue;
    return;
  }
}

static void begin_if(struct language *language, int directive)
{
  const struct span place = sources_here(language);
  bool wanted;
  if (directive == TOKEN_IF) wanted = holds(language, true);
  else if (directive == TOKEN_IFDEF) wanted = is_declared(language, "#ifdef");
  else wanted = !is_declared(language, "#ifndef");
  if (sources_open_condition(language, OPEN_IF, place) && !wanted) choose_branch(language);
}

/* At an #else or #elseif behind a branch that has been read. */
static void pass_else(struct language *language, int directive)
{
  struct condition *condition = frame_of(language)->condition;
  const char *name = directive == TOKEN_ELSE ? "#else" : "#elseif";
  if (!condition || (directive == TOKEN_ELSEIF && condition->opener != OPEN_IF)) {
    language_tell(language, sources_here(language), "%s without #if", name);
    return;
  }
  if (condition->seen_else) language_tell(language, sources_here(language), "a second #else for the same directive");
  condition->seen_else = directive == TOKEN_ELSE;
  if (condition->opener != OPEN_SWITCH)
    leave(language); /* a #switch goes on without #break; a loop leaves out all of it */
}

/* ---- #switch ---- */

/* Whether the #case or #range just met is chosen. */
static bool is_chosen(struct language *language, int directive, double x)
{
  double limits[2] = {NAN, NAN};
  if (directive == TOKEN_CASE) read_numbers(language, PSCN_TOKEN_START_CONDITION, 1, limits), limits[1] = limits[0];
  else read_numbers(language, PSCN_TOKEN_START_RANGE, 2, limits);
  return x >= limits[0] - EQUAL && x <= limits[1] + EQUAL;
}

static void begin_switch(struct language *language)
{
  const struct span place = sources_here(language);
  double x = NAN;
  read_numbers(language, PSCN_TOKEN_START_CONDITION, 1, &x);
  struct condition *condition = sources_open_condition(language, OPEN_SWITCH, place);
  if (condition) condition->chosen = x;
}

/* At a #case or #range: skips to the one that is chosen, if none was so far; NAN then stands for the choice. */
static void pass_case(struct language *language, int directive)
{
  struct condition *condition = frame_of(language)->condition;
  if (!condition || condition->opener != OPEN_SWITCH) {
    language_tell(language, sources_here(language), "#case and #range stand in a #switch");
    return;
  }
  while (is_open(language, condition)) {
    const bool chosen = is_chosen(language, directive, condition->chosen);
    if (!is_open(language, condition)) return;
    if (condition->rounds > 0 || chosen) {
      condition->rounds = 1;
      return;
    }
    directive = skip(language, STOP_CASE);
    if (directive == TOKEN_ELSE) condition->seen_else = true, condition->rounds = 1;
    if (directive == TOKEN_END) sources_close_condition(language);
    if (directive != TOKEN_CASE && directive != TOKEN_RANGE) return;
  }
}

/* ---- loops ---- */

static void begin_while(struct language *language)
{
  const struct span place = sources_here(language);
  struct condition *loop = sources_open_condition(language, OPEN_WHILE, place);
  if (!loop) return;
  loop->begin = frame_of(language)->scan.end;
  loop->rounds = 1;
  if (!holds(language, false) && is_open(language, loop)) leave(language);
}

/* Whether a #for goes on with that value of its variable. */
static bool goes_on(const struct condition *loop, double x)
{
  return loop->step > 0 ? x <= loop->last + EQUAL : x >= loop->last - EQUAL;
}

static void begin_for(struct language *language)
{
  const struct span place = sources_here(language);
  double number[3] = {0, 0, 1};
  struct value *list = NULL;
  struct condition *loop = sources_open_condition(language, OPEN_FOR, place);
  if (!loop) return;
  bool read = tokens_parse(language, PSCN_TOKEN_START_FOR, &list);
  if (!is_open(language, loop)) return;
  loop->begin = frame_of(language)->scan.end;
  loop->rounds = 1;
  if (read) {
    loop->name = sources_name(language, list->place);
    int count = 0;
    for (const struct value *v = list->next; read && v; v = v->next)
      read = value_to_number(language, v, &number[count++]);
    loop->last = number[1];
    loop->step = number[2];
    if (number[2] == 0) language_error(language, list->place, "the step of a #for is not 0"), read = false;
    value_set(language, declare_local(language, &loop->name), &(struct value){.x = {number[0], number[0], number[0]}});
  }
  value_last_of_list(language, list);
  if (!read || !goes_on(loop, number[0])) leave(language);
}

/* Whether the loop at whose #end this is has another round; the next token is then its first. */
static bool next_round(struct language *language, struct condition *loop)
{
  struct frame *frame = frame_of(language);
  loop->end = frame->scan.end;
  loop->rounds++;
  if (loop->opener == OPEN_WHILE) {
    pscn_scan_seek(&frame->scan, loop->begin);
    return holds(language, false);
  }
  struct value *value = symbol_find(language, loop->name.text, loop->name.length);
  if (!value || value->kind != VALUE_NUMBER) {
    language_error(language, loop->place, "the variable of a #for must stay a number");
    return false;
  }
  const double x = value->x[0] + loop->step;
  value_set(language, value, &(struct value){.x = {x, x, x}});
  if (goes_on(loop, x)) pscn_scan_seek(&frame->scan, loop->begin);
  return goes_on(loop, x);
}

/* Ends the innermost loop or #switch, or else the macro. */
static void break_off(struct language *language)
{
  struct frame *frame = frame_of(language);
  const struct span place = sources_here(language);
  bool inner = true;
  while (inner && frame->condition) {
    struct condition *condition = frame->condition;
    inner = condition->opener == OPEN_IF;
    leave(language);
    if (frame->condition == condition) return; /* the source ends within it */
  }
  if (!inner) return;
  if (frame->macro) sources_leave(language);
  else language_tell(language, place, "#break stands in a loop, a #switch or a macro");
}

static void pass_end(struct language *language)
{
  struct frame *frame = frame_of(language);
  struct condition *condition = frame->condition;
  if (condition) {
    const bool loop = condition->opener == OPEN_WHILE || condition->opener == OPEN_FOR;
    if (!loop) sources_close_condition(language);
    else if (!next_round(language, condition) && is_open(language, condition)) leave(language);
  } else if (frame->macro) {
    sources_leave(language);
  } else {
    language_tell(language, sources_here(language), "#end without #if or another directive that it ends");
  }
}

/* ---- what is not the grammar's ---- */

static void undeclare(struct language *language)
{
  struct name name;
  if (directives_name(language, "#undef", &name)) declare_gone(language, &name);
}

static void tell_directive(struct language *language, int token)
{
  const struct name whole = here(language);
  size_t length = whole.length;
  const char *name = words_directive(whole.text, &length);
  if (token == TOKEN_FOREIGN_DIRECTIVE) {
    language_tell(language, whole.place, "#%.*s is not supported: text comes in by #include", (int)length, name);
    return;
  }
  struct guess guess = guess_begin(name, length);
  guess_directives(&guess);
  if (guess.best)
    language_tell(language, whole.place, "unknown directive '#%.*s'; did you mean '#%s'?", (int)length, name,
                  guess.best);
  else language_tell(language, whole.place, "unknown directive '#%.*s'", (int)length, name);
}

/* Ends a source. Returns false if it was the last. */
static bool end_of_source(struct language *language)
{
  struct frame *frame = frame_of(language);
  while (frame->condition) {
    source_recall(frame->source);
    const struct name name = sources_name(language, frame->condition->place);
    size_t length = name.length;
    const char *directive = words_directive(name.text, &length);
    language_tell(language, name.place, "#%.*s without #end", (int)length, directive);
    sources_close_condition(language);
  }
  if (!frame->outer) return false;
  declare_left_open(language, sources_span(frame, frame->source->length, frame->source->length));
  sources_leave(language);
  return true;
}

/* Text from a command line names no files and has no conditions. */
static bool refused_directive(struct language *language, int token)
{
  const bool directive = token > TOKEN_FIRST_DIRECTIVE || (token >= PSCN_TOKEN_VERSION && token <= PSCN_TOKEN_DEFAULT);
  if (!directive || !language->tokens->solver_only) return false;
  language_tell(language, sources_here(language), "the text of a solver has no directives");
  return true;
}

bool directives_pass(struct language *language, int token)
{
  if (refused_directive(language, token)) return true;
  switch (token) {
  case 0: return !language_ended(language) && end_of_source(language);
  case TOKEN_OPEN_COMMENT: tell_open_comment(language); return true;
  case TOKEN_OPEN_STRING: sources_tell_open_string(language); return true;
  case TOKEN_BAD_CHARACTER:
    if (!language->tokens->skipping) character_error(language);
    return true;
  case TOKEN_INCLUDE: sources_include(language); return true;
  case TOKEN_IF:
  case TOKEN_IFDEF:
  case TOKEN_IFNDEF: begin_if(language, token); return true;
  case TOKEN_ELSE:
  case TOKEN_ELSEIF: pass_else(language, token); return true;
  case TOKEN_END: pass_end(language); return true;
  case TOKEN_WHILE: begin_while(language); return true;
  case TOKEN_FOR: begin_for(language); return true;
  case TOKEN_SWITCH: begin_switch(language); return true;
  case TOKEN_CASE:
  case TOKEN_RANGE: pass_case(language, token); return true;
  case TOKEN_BREAK: break_off(language); return true;
  case TOKEN_MACRO: macro_declare(language); return true;
  case TOKEN_UNDEF: undeclare(language); return true;
  case TOKEN_DEBUG:
  case TOKEN_WARNING:
  case TOKEN_ERROR: message_pass(language, token); return true;
  case TOKEN_FOREIGN_DIRECTIVE:
  case TOKEN_UNKNOWN_DIRECTIVE: tell_directive(language, token); return false;
  default: return false;
  }
}

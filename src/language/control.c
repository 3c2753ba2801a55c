/* Conditions, loops and #switch. */
#include "language/tokens.h"

#include <math.h>
#include <string.h>

#include "language/values.h"

static struct frame *frame_of(const struct language *language) { return language->sources->frame; }

/* ---- skipping ---- */

/* At #end only; also at #else and #elseif; or at #else, #case and #range. */
enum skip_stop { STOP_END, STOP_ELSE, STOP_CASE };

/* Skips to a directive of the condition whose text this is, and returns it; 0 is the end of the source. The skipped
 * text may hold conditions of its own. */
static int skip(struct language *language, enum skip_stop stop)
{
  for (int depth = 0;;) {
    const int token = directives_scan(language);
    switch (token) {
    case 0: return token;
    case TOKEN_OPEN_COMMENT:
    case TOKEN_OPEN_STRING: directives_tell_open(language, token); break;
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

bool control_skip_to_end(struct language *language) { return skip(language, STOP_END) == TOKEN_END; }

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
  else if (!control_skip_to_end(language)) return;
  sources_close_condition(language);
}

void control_leave(struct language *language)
{
  sources_leave(language);
  symbols_leave(language->symbols);
}

/* ---- conditions ---- */

/* Parses what stands in parentheses behind a directive: up to `most` numbers. False after an error. */
static bool read_numbers(struct language *language, int start, int most, double out[])
{
  struct value *list = NULL;
  bool read = tokens_parse(language, start, &list);
  if (read) value_numbers(language, list, most, out, &read);
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
    struct name name = sources_name(language, sources_here(language));
    if (words_is(token)) {
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
  language_tell(language, sources_here(language), "%s needs a name in parentheses", directive);
  while (opened && (token == '.' || words_is(token))) token = directives_scan(language);
  return true;
}

/* Whether the condition of an #if, #elseif or #while holds. */
static bool holds(struct language *language, bool after_error)
{
  double x;
  return read_numbers(language, PSCN_TOKEN_START_CONDITION, 1, &x) ? fabs(x) > VALUE_EQUAL : after_error;
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
  sources_open_condition(language, OPEN_IF, place);
  if (!wanted) choose_branch(language);
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
  return x >= limits[0] - VALUE_EQUAL && x <= limits[1] + VALUE_EQUAL;
}

static void begin_switch(struct language *language)
{
  const struct span place = sources_here(language);
  double x = NAN;
  read_numbers(language, PSCN_TOKEN_START_CONDITION, 1, &x);
  sources_open_condition(language, OPEN_SWITCH, place)->chosen = x;
}

/* At a #case or #range: skips to the one that is chosen, if none was so far; NAN then stands for the choice. */
static void pass_case(struct language *language, int directive)
{
  struct condition *condition = frame_of(language)->condition;
  if (!condition || condition->opener != OPEN_SWITCH) {
    language_tell(language, sources_here(language), "#case or #range outside #switch");
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
  loop->begin = frame_of(language)->scan.end;
  loop->rounds = 1;
  if (!holds(language, false) && is_open(language, loop)) leave(language);
}

/* Whether a #for goes on with that value of its variable. */
static bool goes_on(const struct condition *loop, double x)
{
  return loop->step > 0 ? x <= loop->last + VALUE_EQUAL : x >= loop->last - VALUE_EQUAL;
}

static void begin_for(struct language *language)
{
  const struct span place = sources_here(language);
  double number[3] = {0, 0, 1};
  struct value *list = NULL;
  struct condition *loop = sources_open_condition(language, OPEN_FOR, place);
  bool read = tokens_parse(language, PSCN_TOKEN_START_FOR, &list);
  if (!is_open(language, loop)) return;
  loop->begin = frame_of(language)->scan.end;
  loop->rounds = 1;
  if (read) {
    loop->name = sources_name(language, list->place);
    const int count = value_numbers(language, list->next, 3, number, &read);
    if (read && (count < 2 || count > 3)) {
      language_error(language, list->place, "a #for takes two or three numbers, but this has %d", count);
      read = false;
    }
    loop->last = number[1];
    loop->step = number[2];
    if (number[2] == 0) language_error(language, list->place, "the step of a #for must not be 0"), read = false;
    value_set_number(symbol_begin(language, &loop->name, true)->value, number[0]);
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
  value_set_number(value, x);
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
  if (frame->macro) control_leave(language);
  else language_tell(language, place, "#break outside a loop, a #switch or a macro");
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
    control_leave(language);
  } else {
    language_tell(language, sources_here(language), "#end without #if or another directive to end");
  }
}

/* ---- together ---- */

void control_end(struct language *language)
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
}

bool control_pass(struct language *language, int token)
{
  switch (token) {
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
  default: return false;
  }
}

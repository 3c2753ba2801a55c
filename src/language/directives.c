/* Directives, messages, macros, and all other tokens that are not the grammar's. */
#include "language/tokens.h"

#include <stdio.h>
#include <string.h>

#include "language/sources.h"
#include "language/state.h"
#include "language/symbols.h"
#include "language/values.h"

/* The last token of the source being read, whatever it is. */
static struct name here(const struct language *language) { return sources_name(language, sources_here(language)); }

void directives_tell_open(struct language *language, int token)
{
  const struct frame *frame = language->sources->frame;
  const size_t begin = frame->scan.comment_begin;
  if (token == TOKEN_OPEN_STRING) language_tell(language, sources_here(language), "this quote is not closed");
  else language_tell(language, sources_span(frame, begin, begin + 2), "this comment is not closed");
}

int directives_scan(struct language *language)
{
  const struct sources *sources = language->sources;
  if (sources->again > 0 && ++language->work > language->max_work) {
    char text[100];
    snprintf(text, sizeof text, "loops and macros read more than %zu words; this is the last", language->max_work);
    language_limit(language, sources_here(language), text);
  }
  return pscn_scan_next(&sources->frame->scan);
}

bool directives_name(struct language *language, const char *directive, struct name *out)
{
  const int token = directives_scan(language);
  *out = here(language);
  if (token == PSCN_TOKEN_WORD) return true;
  if (words_is(token))
    language_tell(language, out->place, "%s needs a name, but '%.*s' is a reserved word", directive, (int)out->length,
                  out->text);
  else language_tell(language, out->place, "%s needs a name", directive);
  return false;
}

/* ---- messages ---- */

/* The lines that a stranger's #debug may print; a loop could fill a disk with them. */
enum { UNTRUSTED_LINES = 1000 };

/* The begun line of #debug. */
struct messages {
  char text[1000];
  size_t used, lines;
};

static void print_line(struct language *language)
{
  struct messages *messages = language->messages;
  if (!language->untrusted || messages->lines++ < UNTRUSTED_LINES)
    diagnostics_print(language->diagnostics, messages->text, messages->used);
  messages->used = 0;
}

static void debug(struct language *language, const struct value *value)
{
  if (!language->messages) language->messages = language_alloc(language, sizeof *language->messages);
  struct messages *messages = language->messages;
  for (size_t k = 0; k < value->length; k++) {
    if (value->text[k] != '\n') messages->text[messages->used++] = value->text[k];
    if (value->text[k] == '\n' || messages->used == sizeof messages->text) print_line(language);
  }
}

void messages_end(struct language *language)
{
  if (language->messages && language->messages->used > 0) print_line(language);
}

void message_pass(struct language *language, int directive)
{
  const struct span place = sources_here(language);
  struct value *value = NULL;
  const bool whole = tokens_parse(language, PSCN_TOKEN_START_STRING, &value);
  if (whole && value->kind != VALUE_STRING) {
    symbol_mistaken(language, value, "a string");
  } else if (whole) {
    const int length = (int)value->length;
    if (directive == TOKEN_DEBUG) debug(language, value);
    else if (directive == TOKEN_WARNING)
      diagnostics_warning(language->diagnostics, sources_place(language, place), "%.*s", length, value->text);
    else {
      language_tell(language, place, "%.*s", length, value->text);
      language_end(language, STATUS_INPUT);
    }
  }
  value_last_of_list(language, value);
}

/* ---- macros, whose text is read again at each call ---- */

enum {
  MAX_CALLS = 200, /* calls and includes within each other; POV-Ray's limit is 100 */
  CALL_WORK = 16   /* as many tokens take the time of a call */
};

struct macro {
  struct passage text;
  size_t parameter_count;
  struct parameter {
    struct parameter *next;
    const char *name;
    size_t length;
  } * parameters;
};

/* Reads "(A, B)"; as in POV-Ray the commas may be left out. False after an error. */
static bool read_parameters(struct language *language, struct macro *macro)
{
  struct parameter **end = &macro->parameters;
  int token = directives_scan(language);
  if (token != '(') {
    language_tell(language, sources_here(language), "#macro needs a name and its parameters in parentheses");
    return false;
  }
  while ((token = directives_scan(language)) == PSCN_TOKEN_WORD) {
    const struct name name = sources_name(language, sources_here(language));
    struct parameter *parameter = *end = language_alloc(language, sizeof *parameter);
    const char *kept = language_keep(language, name.text, name.length);
    *parameter = (struct parameter){.name = kept, .length = name.length};
    end = &parameter->next;
    macro->parameter_count++;
    token = directives_scan(language);
    if (token == PSCN_TOKEN_WORD) pscn_scan_seek(&language->sources->frame->scan, language->sources->frame->scan.begin);
    else if (token != ',') break;
  }
  if (token == ')') return true;
  language_tell(language, sources_here(language), "a macro's parameter must be a name that is not reserved");
  return false;
}

void macro_declare(struct language *language)
{
  const struct frame *frame = language->sources->frame;
  const struct span place = sources_here(language);
  struct name name;
  struct macro *macro = language_alloc(language, sizeof *macro);
  const bool named = directives_name(language, "#macro", &name);
  const bool whole = read_parameters(language, macro) && named;
  macro->text = (struct passage){frame->source, frame->base, frame->scan.end};
  if (whole) {
    struct value *value = symbol_begin(language, &name, false)->value;
    if (value->kind != VALUE_NONE && value->kind != VALUE_MACRO && value->kind != VALUE_UNKNOWN)
      language_tell(language, name.place, "'%.*s' is declared already, but not as a macro; #undef it first",
                    (int)name.length, name.text);
    *value = (struct value){.kind = VALUE_MACRO, .macro = macro};
    language->symbols->macros++;
  }
  if (!control_skip_to_end(language)) language_tell(language, place, "#macro without #end");
}

/* Whether the arguments are as many as the parameters, and all have values. */
static bool fit(struct language *language, const struct macro *macro, const struct value *arguments, size_t count,
                const struct name *name)
{
  if (count != macro->parameter_count) {
    language_tell(language, name->place, "the macro '%.*s' has %zu parameter%s, but %zu %s given", (int)name->length,
                  name->text, macro->parameter_count, macro->parameter_count == 1 ? "" : "s", count,
                  count == 1 ? "is" : "are");
    return false;
  }
  for (const struct value *a = arguments; a; a = a->next) {
    if (a->kind != VALUE_NONE && a->kind != VALUE_MACRO) continue;
    symbol_mistaken(language, a, "a value");
    return false;
  }
  return true;
}

static void call(struct language *language, const struct macro *macro, const struct name *name)
{
  size_t count = 0;
  struct value *arguments = NULL;
  if (!tokens_parse(language, PSCN_TOKEN_START_ARGUMENTS, &arguments)) return;
  for (struct value *a = arguments; a; a = a->next, count++)
    if (a->depth > language->symbols->depth) a->named = NULL;
  if (fit(language, macro, arguments, count, name)) {
    if (language->symbols->depth == MAX_CALLS)
      language_limit(language, name->place, "macros are called more than 200 deep");
    language->work += CALL_WORK;
    sources_call(language, &macro->text, name->place);
    symbols_enter(language->symbols);
    const struct value *a = arguments;
    for (const struct parameter *p = macro->parameters; p; p = p->next, a = a->next)
      symbol_parameter(language, &(struct name){.text = p->name, .length = p->length, .place = name->place}, a);
  }
  value_last_of_list(language, arguments);
}

bool macro_called(struct language *language)
{
  if (language->symbols->macros == 0) return false;
  const struct name name = sources_name(language, sources_here(language));
  const struct value *value = symbol_find(language, name.text, name.length);
  if (!value || value->kind != VALUE_MACRO) return false;
  call(language, value->macro, &name);
  return true;
}

/* ---- what is not the grammar's ---- */

/* A quoted name is taken as it is: a \ in it parts folders. */
static void begin_include(struct language *language)
{
  struct value *value = NULL;
  if (!tokens_parse(language, PSCN_TOKEN_START_STRING, &value)) return;
  struct name name = sources_name(language, value->place);
  if (value->kind != VALUE_STRING) symbol_mistaken(language, value, "the name of a file");
  else if (name.text[0] != '"') sources_include(language, name.place, value->text, value->length);
  else if (memchr(name.text, '\n', name.length))
    language_tell(language, name.place, "a file name stands on one line: this quote is not closed there");
  else sources_include(language, name.place, name.text + 1, name.length - 2);
  value_last_of_list(language, value);
}

static void undeclare(struct language *language)
{
  struct name name;
  if (directives_name(language, "#undef", &name)) symbol_gone(language, &name);
}

static void tell_directive(struct language *language, int token)
{
  const struct name whole = here(language);
  size_t length = whole.length;
  const char *name = words_directive(whole.text, &length);
  if (token == TOKEN_FOREIGN_DIRECTIVE) {
    language_tell(language, whole.place, "POV-Ray's #%.*s is not supported; use #include to read text", (int)length,
                  name);
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
  struct frame *frame = language->sources->frame;
  control_end(language);
  if (!frame->outer) return false;
  declare_left_open(language, sources_span(frame, frame->source->length, frame->source->length));
  control_leave(language);
  return true;
}

/* Text from a command line names no files and has no conditions. */
static bool refused_directive(struct language *language, int token)
{
  const bool directive = token > TOKEN_FIRST_DIRECTIVE || (token >= PSCN_TOKEN_VERSION && token <= PSCN_TOKEN_DEFAULT);
  if (!directive || !language->tokens->solver_only) return false;
  language_tell(language, sources_here(language), "directives are not allowed in the text of a solver");
  return true;
}

bool directives_pass(struct language *language, int token)
{
  if (refused_directive(language, token)) return true;
  switch (token) {
  case 0: return end_of_source(language);
  case TOKEN_OPEN_COMMENT:
  case TOKEN_OPEN_STRING: directives_tell_open(language, token); return true;
  case TOKEN_BAD_CHARACTER:
    if (!language->tokens->skipping) character_error(language);
    return true;
  case TOKEN_INCLUDE: begin_include(language); return true;
  case TOKEN_MACRO: macro_declare(language); return true;
  case TOKEN_UNDEF: undeclare(language); return true;
  case TOKEN_DEBUG:
  case TOKEN_WARNING:
  case TOKEN_ERROR: message_pass(language, token); return true;
  case TOKEN_FOREIGN_DIRECTIVE:
  case TOKEN_UNKNOWN_DIRECTIVE: tell_directive(language, token); return false;
  default: return control_pass(language, token);
  }
}

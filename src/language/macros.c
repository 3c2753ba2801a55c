/* Macros, whose text is read again at each call. */
#include "language/directives.h"

#include "language/tokens.h"
#include "language/values.h"

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

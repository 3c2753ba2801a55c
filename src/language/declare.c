/* #declare and #local. */
#include "language/declare.h"

#include "language/tokens.h"
#include "language/values.h"

/* The file ends, and POV-Ray loses such a name, or crashes. */
void declare_left_open(struct language *language, struct span end)
{
  for (const struct declaration *d = language->declaration; d; d = d->outer) {
    if (d->depth == 0 || d->depth < language->symbols->depth) continue;
    const struct name name = sources_name(language, d->name);
    language_tell(language, end, "the file ends within the declaration of its #local '%.*s'", (int)name.length,
                  name.text);
  }
}

static struct declaration *open_declaration(struct language *language, const struct declaration *declaration)
{
  struct declaration *open = language->symbols->ended;
  if (open) language->symbols->ended = open->outer;
  else open = language_alloc(language, sizeof *open);
  *open = *declaration;
  open->frame = language->sources->frame;
  open->braces = language->tokens->depth;
  open->outer = language->declaration;
  language->layered = NULL;
  return language->declaration = open;
}

struct declaration *declare_begin(struct language *language, struct value *target, const struct span *local)
{
  const struct name name = sources_name(language, target->place);
  if (local && !sources_has(language, *local))
    language_tell(language, *local, "#local, its name and the = must be in one file");
  const struct symbol *symbol = symbol_begin(language, &name, local != NULL);
  struct value *to = symbol->value;
  if (target->next) to = array_element(language, to, target);
  else if (to->kind == VALUE_MACRO)
    language_tell(language, name.place, "'%.*s' is a macro already; #undef it first", (int)name.length, name.text);
  value_last_of_list(language, target);
  return open_declaration(language, &(struct declaration){.to = to ? to : value_of(language, VALUE_UNKNOWN, name.place),
                                                          .name = name.place,
                                                          .depth = symbol->depth});
}

void declare_again(struct language *language, struct value *value)
{
  struct declaration *open = open_declaration(language, &(struct declaration){.to = value});
  open->lacks = value->lacks;
}

static void declare_end(struct language *language, struct declaration *declaration)
{
  language->declaration = declaration->outer;
  language->declared++;
  if (language->ended_early) return; /* it may be the spare block */
  declaration->outer = language->symbols->ended;
  language->symbols->ended = declaration;
}

void declare_value(struct language *language, struct declaration *declaration, const struct value *value)
{
  if (value->kind >= VALUE_MACRO) symbol_mistaken(language, value, "a value");
  struct value *to = declaration->to;
  const bool lacks = span_begin(declaration->lacks) > 0 && !language->lenient;
  if (value->kind >= VALUE_MACRO || lacks) *to = (struct value){.kind = VALUE_UNKNOWN};
  else value_set(language, to, value);
  to->lacks = declaration->lacks;
  declare_end(language, declaration);
}

void declare_open(struct language *language, struct declaration *declaration, const struct value *value)
{
  const struct name name = sources_name(language, language->tokens->last.place);
  if (value->kind <= VALUE_COLOUR && !language_ended(language))
    language_tell(language, name.place,
                  name.length ? "unexpected '%.*s', expected ';'" : "the text ends here%.*s, expected ';'",
                  (int)name.length, name.text);
  declare_value(language, declaration, value);
}

void declare_broken(struct language *language, struct declaration *declaration)
{
  declare_value(language, declaration, &(struct value){.kind = VALUE_UNKNOWN});
}

void declare_number(struct language *language, const char *name, size_t length, double number)
{
  const struct name word = {.text = name, .length = length};
  value_set_number(symbol_begin(language, &word, false)->value, number);
}

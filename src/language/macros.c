/* The names that macros declare. */
#include "language/macros.h"

#include <string.h>

#include "language/scan.h"
#include "language/sources.h"

/* The most different words of a macro that are examined, and the most words at all calls: a second's work. A macro with
 * more is reported as one that cannot be skipped. */
enum { MOST_WORDS = 250, MOST_FOLLOWED = 10 * 1000 * 1000 };

enum macro_role { ROLE_PARAMETER, ROLE_LOCAL, ROLE_DECLARED, ROLE_CALLED };

struct macro_word {
  enum macro_role role;
  const char *text;
  size_t length;
  struct macro_word *next;
};

struct macro {
  struct macro_word *words;
  size_t count;
  bool lasting; /* it may do more than its names tell */
  size_t call;  /* the last call that came to it */
  /* while it is read: */
  bool headed; /* its parameters have been read */
  struct naming naming;
  struct name called; /* the word before, the name of a call if a ( follows; its text is NULL for none */
};

struct macro *macro_begin(struct language *language) { return language_alloc(language, sizeof(struct macro)); }

static void add_word(struct language *language, struct macro *macro, enum macro_role role, const struct name *name)
{
  if (language->ended_early) return;
  for (const struct macro_word *w = macro->words; w; w = w->next) {
    if (w->length != name->length || memcmp(w->text, name->text, w->length) != 0) continue;
    /* a declaration of the parameter changes what was passed by its name */
    if (role == ROLE_DECLARED && w->role == ROLE_PARAMETER) macro->lasting = true;
    if (w->role == role || (role == ROLE_DECLARED && w->role != ROLE_CALLED)) return;
  }
  if (macro->count == MOST_WORDS) {
    macro->lasting = true;
    return;
  }
  struct macro_word *word = language_alloc(language, sizeof *word);
  const char *text = language_keep(language, name->text, name->length);
  if (!text) return;
  *word = (struct macro_word){role, text, name->length, macro->words};
  macro->words = word;
  macro->count++;
}

void macro_note(struct language *language, struct macro *macro, int token, struct span place)
{
  const struct name name = sources_name(language, place), none = {.text = NULL}, before = macro->called;
  const int directive = naming_next(&macro->naming, token, place);
  const bool word = token == PSCN_TOKEN_WORD;
  macro->called = word && directive == 0 ? name : none;
  if (!macro->headed) {
    if (word) add_word(language, macro, ROLE_PARAMETER, &name);
    macro->headed = token != '(' && token != ',' && !word;
  } else if (token == PSCN_TOKEN_DEFAULT || token == TOKEN_INCLUDE || token == PSCN_TOKEN_VERSION) {
    macro->lasting = true;
  } else if (directive != 0) {
    add_word(language, macro, directive == PSCN_TOKEN_LOCAL ? ROLE_LOCAL : ROLE_DECLARED, &name);
  } else if (token == '(' && before.text) {
    add_word(language, macro, ROLE_CALLED, &before);
  }
}

static void follow(struct language *language, const struct symbol *symbol, struct span place, int depth)
{
  struct symbols *symbols = language->symbols;
  if (!symbol || symbol->kind != SYMBOL_MACRO || symbol->macro->call == symbols->macro_calls) return;
  struct macro *macro = symbol->macro;
  macro->call = symbols->macro_calls;
  symbols->macro_words += macro->count;
  if (macro->lasting || depth == MAX_NESTING || symbols->macro_words > MOST_FOLLOWED)
    language_tell(language, place, "this macro may change more than what is declared here, and is passed over");
  for (const struct macro_word *w = macro->words; w; w = w->next) {
    const struct name name = {.text = w->text, .length = w->length, .place = place};
    if (w->role == ROLE_DECLARED) declare_lost(language, &name);
    else if (w->role == ROLE_CALLED && depth < MAX_NESTING)
      follow(language, symbol_find(language, w->text, w->length), place, depth + 1);
  }
}

void macro_called(struct language *language, struct span place)
{
  if (language->symbols->macro_count == 0) return;
  const struct name name = sources_name(language, place);
  language->symbols->macro_calls++;
  follow(language, symbol_find(language, name.text, name.length), place, 0);
}

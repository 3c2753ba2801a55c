/* Values, and the names declared for them. */
#ifndef PSCN_LANGUAGE_SYMBOLS_H
#define PSCN_LANGUAGE_SYMBOLS_H

#include "language/state.h"
#include "language/table.h"
#include "language/words.h"

enum value_kind {
  VALUE_NUMBER, /* in all of x, so that it is a vector where one is wanted */
  VALUE_VECTOR,
  VALUE_COLOUR, /* red, green, blue */
  VALUE_NAMED,  /* not a value, but the object or texture `symbol` */
  VALUE_UNKNOWN /* an error has been reported; any use of it is accepted */
};

/* The reasons: a number after `color`, which stands for all five parts of a colour; a filter or transmit part. */
enum { TRANSPARENT_NUMBER = 1, TRANSPARENT_SAID = 2 };

struct value {
  enum value_kind kind;
  unsigned transparent; /* why POV-Ray makes this colour transparent, or 0 */
  bool component;       /* a component, or computed from one; parentheses or a name make it a number */
  bool open;            /* has three parts, but POV-Ray takes it for five behind a colour: an axis, a named vector */
  bool wide;            /* computed from an open one: behind a colour, it makes that transparent in POV-Ray */
  bool bare;            /* a colour followed by a part, without rgb or color before it */
  double x[3];
  const struct symbol *symbol;
  struct span place;
  struct value *next; /* of language->unused */
};

enum symbol_kind {
  SYMBOL_BEGUN,
  SYMBOL_UNKNOWN, /* not declared, but reported as missing */
  SYMBOL_VALUE,
  SYMBOL_TEXTURE,
  SYMBOL_OBJECT,
  SYMBOL_MACRO,
  SYMBOL_FOREIGN, /* its declaration uses what pscn lacks */
  SYMBOL_BROKEN
};

/* A name that was unknown. */
struct missed {
  const struct symbol *symbol;
  size_t times;
  struct span last;
  struct missed *next; /* the one found unknown before it */
};

struct symbol {
  struct table_entry entry;
  struct symbol *before; /* the one before it, of all names */
  struct symbol *older;  /* the local one before it */
  const char *name;
  size_t length;
  int depth; /* 0: global; otherwise the include depth of its #local */
  bool gone; /* undeclared */
  bool lost; /* foreign, because skipped text may declare or undeclare it */
  enum symbol_kind kind;
  union {
    struct value value;
    struct {
      const struct texture *texture;
      const char *texture_kind; /* "a texture", "a pigment", "a finish" */
    };
    const struct node *object;
    struct held *held; /* of a foreign one */
    struct macro *macro;
  };
  struct missed *missed; /* NULL: never unknown */
};

/* Zeroed: no names. */
struct symbols {
  struct table table;
  struct symbol *last;       /* of all names */
  struct symbol *locals;     /* of the files being read, the newest first */
  struct missed *missed;     /* names that were unknown */
  struct declaration *ended; /* of values: to be reused */
  size_t considered;         /* names considered for guesses */
  size_t guessed;            /* guesses made for what is held */
  size_t macro_count;        /* macros that are or were declared, */
  size_t macro_calls;        /* their calls, */
  size_t macro_words;        /* and the words examined for these */
  int depth;                 /* include depth of the file being read */
};

/* A directive in skipped text, whose name is still to come. */
struct naming {
  int token; /* PSCN_TOKEN_DECLARE, PSCN_TOKEN_LOCAL, TOKEN_UNDEF; TOKEN_READ, which has several; 0: none */
  struct span place;
};

/* Takes one token after another of such text. Returns the directive's token if this token is the name that it declares
 * or undeclares, else 0. #for counts as the #declare of its variable; #fopen and #fclose count as that of their
 * name. */
int naming_next(struct naming *naming, int token, struct span place);

/* Begin and end an included file. At its end, its locals are undeclared. */
void symbols_enter(struct symbols *symbols);
void symbols_leave(struct symbols *symbols);

/* What a name stands for. NULL if it is not declared, or if its declaration has only begun. */
const struct symbol *symbol_find(const struct language *language, const char *name, size_t length);
/* Whether #ifdef takes the name for declared: from the = of its declaration on, as in POV-Ray. An error if nobody
 * knows. */
bool symbol_known(struct language *language, const struct name *name);

/* Considers the declared names, the last one first, up to a limit. */
void guess_symbols(struct guess *guess, struct language *language);

/* The symbol of a name, if it is of that `kind`; else NULL, after reporting that `wanted` was expected. */
const struct symbol *symbol_wanted(struct language *language, const struct name *name, enum symbol_kind kind,
                                   const char *wanted);
/* At the end, reports the names that were unknown more than once. */
void symbols_tell_missed(struct language *language);
/* Reports that a name is not what is wanted. */
void symbol_mistaken(struct language *language, struct span place, const struct symbol *symbol, const char *wanted);

/* Begins a declaration; declarations may be nested. `local`: the place of its #local, or NULL. */
struct declaration *declare_begin(struct language *language, struct span name, const struct span *local);
/* Takes one token after another of text that is skipped here but read by POV-Ray: names declared there become
 * foreign. */
void declare_passed(struct language *language, int token, struct span place, struct naming *naming);
/* Declares such a name. */
void declare_unseen(struct language *language, struct span place, const struct span *local);
/* At the end of a file, reports the open declarations of names that are local to it. */
void declare_left_open(struct language *language, struct span end);
/* Ends a declaration. Returns the symbol to write to, or NULL if something was held: the symbol is then foreign. */
struct symbol *declare_end(struct language *language, struct declaration *declaration);
void declare_value(struct language *language, struct declaration *declaration, const struct value *value);
void declare_broken(struct language *language, struct declaration *declaration); /* after an error */
/* Declares a macro, which cannot be called. */
void declare_macro(struct language *language, const struct name *name, struct macro *macro);
/* Makes a name foreign: it stands for something else by now, or for nothing. */
void declare_lost(struct language *language, const struct name *name);
void declare_gone(struct language *language, const struct name *name); /* #undef */

/* Declares a number, such as the one by which a scene tells pscn from POV-Ray. */
void declare_number(struct language *language, const char *name, size_t length, double number);

#endif

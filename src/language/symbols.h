/* Values, and the names declared for them. */
#ifndef PSCN_LANGUAGE_SYMBOLS_H
#define PSCN_LANGUAGE_SYMBOLS_H

#include "language/state.h"
#include "language/table.h"
#include "language/words.h"

enum value_kind {
  VALUE_NUMBER, /* stands in all of x, so that it is a vector where one is wanted */
  VALUE_VECTOR,
  VALUE_COLOUR, /* red, green, blue */
  VALUE_NAMED,  /* no value, but the object or texture `symbol` */
  VALUE_UNKNOWN /* an error has been told; whatever is made of it is right */
};

/* A number after `color` stands in all five parts of a colour; filter and transmit are two of them. */
enum { TRANSPARENT_NUMBER = 1, TRANSPARENT_SAID = 2 };

struct value {
  enum value_kind kind;
  unsigned transparent; /* a colour that POV-Ray gives transparency: why, or 0 */
  bool component;       /* of another, or reckoned from one; until parentheses or a name make a number of it */
  bool open; /* of three parts, which POV-Ray takes for five behind a colour: an axis, a vector by its name */
  bool wide; /* reckoned from such a one: behind a colour POV-Ray makes that transparent by it */
  bool bare; /* a colour with a part behind it and neither rgb nor color before */
  double x[3];
  const struct symbol *symbol;
  struct span place;
  struct value *next; /* of language->unused */
};

enum symbol_kind {
  SYMBOL_BEGUN,
  SYMBOL_UNKNOWN, /* no declaration, but told to be missing */
  SYMBOL_VALUE,
  SYMBOL_TEXTURE,
  SYMBOL_OBJECT,
  SYMBOL_MACRO,
  SYMBOL_FOREIGN, /* declared with what pscn has not */
  SYMBOL_BROKEN
};

/* A name that was unknown. */
struct missed {
  const struct symbol *symbol;
  size_t times;
  struct span last;
  struct missed *next; /* the one that was unknown before it */
};

struct symbol {
  struct table_entry entry;
  struct symbol *before; /* of all names */
  struct symbol *older;  /* local before it */
  const char *name;
  size_t length;
  int depth; /* 0: belongs to all; otherwise the include depth of its #local */
  bool gone; /* forgotten */
  bool lost; /* foreign for what is passed over may declare it or forget it */
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
  struct declaration *ended; /* of values: for the next ones */
  size_t considered;         /* for guesses */
  size_t guessed;            /* for what is held: how many */
  size_t macro_count;        /* macros that are or were declared, */
  size_t macro_calls;        /* their calls, */
  size_t macro_words;        /* and how much has been looked at for these */
  int depth;                 /* files that include the one being read */
};

/* A directive of text that is passed over, whose name is still to come. */
struct naming {
  int token; /* PSCN_TOKEN_DECLARE, PSCN_TOKEN_LOCAL, TOKEN_UNDEF; TOKEN_READ: of several; 0: none */
  struct span place;
};

/* One token after the other of such text: the directive's token where this one is the name that it declares or forgets, else
 * 0. #for counts as the #declare of its variable, #fopen and #fclose as that of their name. */
int naming_next(struct naming *naming, int token, struct span place);

/* The beginning and end of an included file, at which its locals are forgotten. */
void symbols_enter(struct symbols *symbols);
void symbols_leave(struct symbols *symbols);

/* What a name stands for, or NULL: where it is not declared, or its declaration has only begun. */
const struct symbol *symbol_find(const struct language *language, const char *name, size_t length);
/* Whether #ifdef takes it for declared: from the = of its declaration on, as in POV-Ray. Told where nobody knows. */
bool symbol_known(struct language *language, const struct name *name);

/* Considers the declared names, the last one first, as long as there are not too many. */
void guess_symbols(struct guess *guess, struct language *language);

/* What a name that should stand for `wanted` does, if that is `kind`; else NULL, and that has been told. */
const struct symbol *symbol_wanted(struct language *language, const struct name *name, enum symbol_kind kind,
                                   const char *wanted);
/* Tells at the end of the names that have been unknown more than once. */
void symbols_tell_missed(struct language *language);
/* Tells that a name is something else than what is wanted. */
void symbol_mistaken(struct language *language, struct span place, const struct symbol *symbol, const char *wanted);

/* A declaration begins; declarations may stand within each other. `local`: where its #local stands, or NULL. */
struct declaration *declare_begin(struct language *language, struct span name, const struct span *local);
/* One token after the other of what is passed over though POV-Ray reads it: names that are declared there are foreign. */
void declare_passed(struct language *language, int token, struct span place, struct naming *naming);
/* Such a name. */
void declare_unseen(struct language *language, struct span place, const struct span *local);
/* Tells of those that a file leaves open which is about to end, and which are of names of that file. */
void declare_left_open(struct language *language, struct span end);
/* It ends. Returns the symbol to write to, or NULL where something was held: then it is foreign. */
struct symbol *declare_end(struct language *language, struct declaration *declaration);
void declare_value(struct language *language, struct declaration *declaration, const struct value *value);
void declare_broken(struct language *language, struct declaration *declaration); /* it has an error */
/* It can be declared, but not called. */
void declare_macro(struct language *language, const struct name *name, struct macro *macro);
/* A name that stands for something else by now, or for nothing: foreign. */
void declare_lost(struct language *language, const struct name *name);
void declare_gone(struct language *language, const struct name *name); /* #undef */

/* Declares a number, such as the one that tells this program from POV-Ray. */
void declare_number(struct language *language, const char *name, size_t length, double number);

#endif

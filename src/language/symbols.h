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
  VALUE_STRING,
  VALUE_ARRAY,
  VALUE_TEXTURE, /* a texture, a pigment or a finish */
  VALUE_OBJECT,
  VALUE_MACRO,
  VALUE_FOREIGN, /* declared with what pscn lacks */
  VALUE_NONE,    /* a name not declared; an element of an array not set */
  VALUE_UNKNOWN  /* an error has been reported; any use of it is accepted */
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
  bool told;            /* what it lacks has been reported */
  union {
    double x[3];
    struct {
      const char *text;
      size_t length;
    };
    struct array *array;
    const struct texture *texture;
    const struct node *object;
    const struct macro *macro;
  };
  struct span lacks;   /* the first word of its declaration that pscn lacks, or none */
  struct value *named; /* the declared one that this is, unchanged; or NULL */
  int depth;           /* of that one's symbol, which is gone if this is deeper than what is being read */
  struct span place;
  struct value *next; /* of language->unused, or of a list */
};

/* An array of up to 5 dimensions, as POV-Ray's. Arrays are copied by a declaration; arguments of macros are not. */
enum { MAX_DIMENSIONS = 5 };
struct array {
  int dimensions, size[MAX_DIMENSIONS];
  size_t count;
  struct value *elements; /* the last index runs fastest */
};

struct symbol {
  struct table_entry entry;
  struct symbol *before; /* the one before it: of all that are global, or of all that are not */
  const char *name;
  size_t length;
  int depth;           /* 0: global; otherwise the depth in includes and calls of its #local */
  bool gone;           /* undeclared */
  struct value *value; /* `own`, or that of the argument of a macro which this is the parameter for */
  struct value own;    /* VALUE_NONE while it is declared for the first time */
};

/* Zeroed: no names. */
struct symbols {
  struct table table;
  struct symbol *globals;    /* the newest first */
  struct symbol *locals;     /* those of what is being read, the newest first */
  struct symbol *unused;     /* to be reused */
  struct table missing;      /* names that were unknown, */
  struct missed *missed;     /* the newest first */
  struct declaration *ended; /* to be reused */
  size_t considered;         /* names considered for guesses */
  size_t macros;             /* macros that are or were declared */
  int depth;                 /* files included and macros called around what is being read */
};

/* Begin and end an included file or a macro's text. At its end, its locals are undeclared. */
void symbols_enter(struct symbols *symbols);
void symbols_leave(struct symbols *symbols);

/* What a name stands for. NULL if it is not declared, or if its declaration has only begun. */
const struct symbol *symbol_of(const struct language *language, const char *name, size_t length);
struct value *symbol_find(const struct language *language, const char *name, size_t length); /* its value */
/* Whether #ifdef takes the name for declared: from the = of its declaration on, as in POV-Ray. */
bool symbol_known(const struct language *language, const struct name *name);

/* Considers the declared names, the last one first, up to a limit. */
void guess_symbols(struct guess *guess, struct language *language);

/* Reports that a value is not what is wanted, or that its name is not declared; once, if that name is BROKEN then. */
void symbol_mistaken(struct language *language, const struct value *value, const char *wanted);
/* At the end, reports the names that were unknown more than once. */
void symbols_tell_missed(struct language *language);

/* Begins a declaration of a name or of an array's element, whose `target` begins with the name's place, followed by the
 * indices. Declarations may be nested. `local`: the place of its #local, or NULL. */
struct declaration *declare_begin(struct language *language, struct value *target, const struct span *local);
/* Begins another one of a name that has been declared just now. */
void declare_again(struct language *language, struct value *value);
/* Ends it: the name has that value. */
void declare_value(struct language *language, struct declaration *declaration, const struct value *value);
/* The same where the ; is missing, without which POV-Ray reads strings, arrays, textures and objects only. */
void declare_open(struct language *language, struct declaration *declaration, const struct value *value);
void declare_broken(struct language *language, struct declaration *declaration); /* after an error */
/* A #local of the file or macro being read, or a #declare, of a value that is no text's. */
struct value *declare_local(struct language *language, const struct name *name);
struct value *declare_global(struct language *language, const struct name *name);
/* Makes a name of the macro that is being entered stand for an argument. */
void declare_parameter(struct language *language, const struct name *name, const struct value *argument);
void declare_gone(struct language *language, const struct name *name); /* #undef */
/* At the end of a file, reports the open declarations of names that are local to it. */
void declare_left_open(struct language *language, struct span end);

/* Declares a number, such as the one by which a scene tells pscn from POV-Ray. */
void declare_number(struct language *language, const char *name, size_t length, double number);

#endif

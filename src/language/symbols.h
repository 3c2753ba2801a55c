/* Values, and the names declared for them. */
#ifndef PSCN_LANGUAGE_SYMBOLS_H
#define PSCN_LANGUAGE_SYMBOLS_H

#include "base/table.h"
#include "language/state.h"
#include "language/words.h"

enum value_kind {
  VALUE_NUMBER,
  VALUE_VECTOR,
  VALUE_COLOUR,
  VALUE_STRING,
  VALUE_ARRAY,
  VALUE_TEXTURE, /* a texture, a pigment or a finish */
  VALUE_TRANSFORM,
  VALUE_OBJECT,
  VALUE_MACRO,
  VALUE_NONE,   /* a name not declared; an element of an array not set */
  VALUE_UNKNOWN /* an error has been reported; any use of it is accepted */
};

/* POV-Ray's colours have five: red, green, blue, filter, transmit. Vectors have up to as many. */
enum { MAX_PARTS = 5 };

struct value {
  enum value_kind kind;
  bool component; /* a component, or computed from one; parentheses or a name make it a number */
  int parts;      /* of a vector or a colour */
  union {
    double x[MAX_PARTS]; /* of a number only the first counts */
    struct {
      const char *text;
      size_t length;
    };
    struct array *array;
    const struct texture *texture;
    const struct transform *transform;
    const struct node *object;
    const struct macro *macro;
  };
  struct span lacks;   /* the first thing in its declaration that is not supported, or none */
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
  struct symbol *globals; /* the newest first */
  struct symbol *locals;  /* those of what is being read, the newest first */
  struct symbol *unused;  /* to be reused */
  size_t considered;      /* names considered for guesses */
  size_t macros;          /* macros that are or were declared */
  int depth;              /* files included and macros called around what is being read */
};

/* Begin and end an included file or a macro's text. At its end, its locals are undeclared. */
void symbols_enter(struct symbols *symbols);
void symbols_leave(struct symbols *symbols);

/* The meaning of a name. NULL if it is not declared, or if its declaration has only begun. */
const struct symbol *symbol_of(const struct language *language, const char *name, size_t length);
struct value *symbol_find(const struct language *language, const char *name, size_t length); /* its value */
/* Whether #ifdef takes the name for declared: from the = of its declaration on, as in POV-Ray. */
bool symbol_known(const struct language *language, const struct name *name);

/* Considers the declared names, the last one first, up to a limit. */
void guess_symbols(struct guess *guess, struct language *language);

/* Reports that a value is not what is wanted, or that its name is not declared; any use of that name is accepted then. */
void symbol_mistaken(struct language *language, const struct value *value, const char *wanted);
/* Handles the use of a name whose declaration has something that is not supported. */
void symbol_lacks(struct language *language, const struct value *value);

/* The symbol to be written by a #local of the file or macro being read, or by a #declare. */
struct symbol *symbol_begin(struct language *language, const struct name *name, bool local);
/* Makes a name of the macro that is being entered stand for an argument. */
void symbol_parameter(struct language *language, const struct name *name, const struct value *argument);
void symbol_gone(struct language *language, const struct name *name); /* #undef */

/* ---- #declare and #local ---- */

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
/* At the end of a file, reports the open declarations of names that are local to it. */
void declare_left_open(struct language *language, struct span end);

/* Declares a number, such as the one by which a scene tells pscn from POV-Ray. */
void declare_number(struct language *language, const char *name, size_t length, double number);

#endif

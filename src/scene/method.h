/* The method a scene selects: what one `solver` statement says about the solver, and about the way from a ray to the
 * polynomial and back.
 *
 * The items of the statement are a table. So the language reads them, and dumps and reports write them, without knowing
 * any of them. All functions are pure.
 */
#ifndef PSCN_SCENE_METHOD_H
#define PSCN_SCENE_METHOD_H

#include "algebra/solver.h"

enum resultant { RESULTANT_BEZOUT, RESULTANT_SYLVESTER };
enum back_substitution { BACK_SUBSTITUTION_NULL_VECTOR, BACK_SUBSTITUTION_EUCLID };

enum { METHOD_MAX_SPLIT = 64 };

/* Set by method_default, then changed item by item. */
struct method {
  struct solver_options roots; /* the solver and its own choices */
  enum basis basis;            /* in which the resultant is written */
  enum resultant resultant;
  enum back_substitution back_substitution;
  bool polish; /* on: 2-D Newton on the patch, and every answer certified; off: the solver's own roots are the answer */
  double residual; /* polish off: how far an answer may be from a solution of eq 3, see intersect/method.c; 0 = auto */
  int split;      /* N <= METHOD_MAX_SPLIT: each patch is cut into N x N leaves; 0 = auto; 1 = whole, as in the paper */
  bool form_said; /* a choice of iteration was set by name; otherwise they follow from the rest, see method.c */
  bool basis_said; /* the basis was set; otherwise the caller uses what suits it */
};

/* The meaning of a bare `solver NAME`. */
void method_default(const struct solver *solver, struct method *out);

enum method_item_kind { METHOD_ITEM_NUMBER, METHOD_ITEM_INTEGER, METHOD_ITEM_KEYWORD };

struct method_item {
  const char *name;
  const char *summary;
  enum method_item_kind kind;
  const char *const *keywords; /* ends with NULL: values of a KEYWORD, words for 0, 1, ... of an INTEGER; or NULL */
  double minimum, maximum;     /* inclusive range for NUMBER and INTEGER */
  void (*set)(struct method *method, double value); /* value: the number, or the keyword's index */
  double (*get)(const struct method *method);
};

size_t method_item_count(void);
const struct method_item *method_item_at(size_t index);       /* NULL behind the last */
const struct method_item *method_item_find(const char *name); /* NULL if there is none */

bool method_equal(const struct method *a, const struct method *b);

/* The text that would follow `solver`, ended by 0: the name, and in braces the items that do not follow from those
 * before them. Cut off at `size` bytes; METHOD_TEXT_SIZE is enough for everything. */
enum { METHOD_TEXT_SIZE = 512 };
void method_text(const struct method *method, char *out, size_t size);

#endif

/* The items of a solver block, and a method as text. */
#include "scene/method.h"

#include <float.h>
#include <stdio.h>
#include <string.h>

#include "base/number.h"

/* Whether a ray becomes a polynomial, and a root an answer, as in the paper. */
static bool papers_way(const struct method *method)
{
  return method->basis == BASIS_POWER && method->resultant == RESULTANT_SYLVESTER &&
         method->back_substitution == BACK_SUBSTITUTION_EUCLID && !method->polish;
}

/* If the form of the iteration is not named, the paper's form goes with the paper's method, whichever of its items is
 * set first. */
static void follow_form(struct method *method)
{
  if (!method->form_said) solver_options_form(&method->roots, !papers_way(method));
}

/* The items of a solver block. One macro writes the two accessors of an item, whose C types differ; `after` runs after
 * an item was set. */
#define ITEM_ACCESSORS(name, field, type, after)              \
  static void set_##name(struct method *method, double value) \
  {                                                           \
    method->field = (type)value;                              \
    after;                                                    \
  }                                                           \
  static double get_##name(const struct method *method) { return (double)method->field; }

ITEM_ACCESSORS(tolerance, roots.tolerance, double, (void)0)
ITEM_ACCESSORS(max_iterations, roots.max_iterations, int, (void)0)
ITEM_ACCESSORS(start, roots.start, enum start, (void)0)
ITEM_ACCESSORS(split, split, int, (void)0)
ITEM_ACCESSORS(basis, basis, enum basis, (method->basis_said = true, follow_form(method)))
ITEM_ACCESSORS(resultant, resultant, enum resultant, follow_form(method))
ITEM_ACCESSORS(back_substitution, back_substitution, enum back_substitution, follow_form(method))
ITEM_ACCESSORS(polish, polish, bool, follow_form(method))
ITEM_ACCESSORS(residual, residual, double, (void)0)
ITEM_ACCESSORS(radii, roots.radii, enum radii, method->form_said = true)
ITEM_ACCESSORS(stop, roots.stop, enum stop, method->form_said = true)
ITEM_ACCESSORS(horner, roots.horner, enum horner, method->form_said = true)
ITEM_ACCESSORS(update, roots.update, enum update, method->form_said = true)
ITEM_ACCESSORS(rest, roots.rest, bool, method->form_said = true)
ITEM_ACCESSORS(deflation, roots.deflation, enum deflation, method->form_said = true)
ITEM_ACCESSORS(refine, roots.refine, bool, method->form_said = true)

/* `form paper` sets all that the paper does; `form improved` concerns the iteration alone. */
static void set_form(struct method *method, double value)
{
  const bool paper = value == 0.0;
  if (paper) {
    method->basis = BASIS_POWER;
    method->resultant = RESULTANT_SYLVESTER;
    method->back_substitution = BACK_SUBSTITUTION_EUCLID;
    method->polish = false;
    method->split = 1;
  }
  solver_options_form(&method->roots, !paper);
  method->form_said = true;
}

static double get_form(const struct method *method)
{
  return papers_way(method) && method->split == 1 && solver_options_paper(&method->roots) ? 0.0 : 1.0;
}

/* The keywords of an item. */
#define WORDS(...) ((const char *const[]){__VA_ARGS__, NULL})

/* Limits. A tolerance of 1 in a parameter of [0,1] demands nothing. Iterations are bounded so that no solve can
 * hang. */
#define MAX_TOLERANCE 1.0
#define MAX_ITERATIONS 10000
#define MAX_RESIDUAL 1.0 /* relative to the largest coefficient, which no value in [0,1]^2 exceeds */

static const struct method_item items[] = {
  {"tolerance", "a root has converged when a step is below this (eps of eq 10), relative; `form paper`: absolute",
   METHOD_ITEM_NUMBER, NULL, DBL_MIN, MAX_TOLERANCE, set_tolerance, get_tolerance},
  {"max_iterations", "steps a root may take", METHOD_ITEM_INTEGER, NULL, 1, MAX_ITERATIONS, set_max_iterations,
   get_max_iterations},
  {"start", "from Aberth's circle, or from the roots of the previous ray on the same leaf", METHOD_ITEM_KEYWORD,
   WORDS("cold", "previous"), 0, 1, set_start, get_start},
  /* form comes before the items that it sets, so that a block written in this order reads back the same. */
  {"form", "paper: the paper's way, all of the following; improved: the iterations with all improvements",
   METHOD_ITEM_KEYWORD, WORDS("paper", "improved"), 0, 1, set_form, get_form},
  {"basis", "in which the resultant is written", METHOD_ITEM_KEYWORD, WORDS("bernstein", "power"), 0, 1, set_basis,
   get_basis},
  {"resultant", "how v is eliminated", METHOD_ITEM_KEYWORD, WORDS("bezout", "sylvester"), 0, 1, set_resultant,
   get_resultant},
  {"back_substitution", "how v is found from u", METHOD_ITEM_KEYWORD, WORDS("null_vector", "euclid"), 0, 1,
   set_back_substitution, get_back_substitution},
  {"polish", "on: Newton on the patch itself, and every answer certified; off: the solver's roots are the answer",
   METHOD_ITEM_KEYWORD, WORDS("off", "on"), 0, 1, set_polish, get_polish},
  {"residual", "polish off: at a hit both plane polynomials are below this, relative; 1 accepts every root",
   METHOD_ITEM_NUMBER, WORDS("auto"), DBL_MIN, MAX_RESIDUAL, set_residual, get_residual},
  {"split", "each patch is cut into N x N leaves; 1 = whole patches", METHOD_ITEM_INTEGER, WORDS("auto"), 1,
   METHOD_MAX_SPLIT, set_split, get_split},
  {"radii", "cold start values on Aberth's circle, or on circles by Newton's polygon", METHOD_ITEM_KEYWORD,
   WORDS("circle", "polygon"), 0, 1, set_radii, get_radii},
  {"stop", "by eq 10 alone, or also if the value is below its own rounding bound", METHOD_ITEM_KEYWORD,
   WORDS("step", "rounding"), 0, 1, set_stop, get_stop},
  {"horner", "values by Horner's scheme in z as printed, or in 1/z if that is smaller", METHOD_ITEM_KEYWORD,
   WORDS("plain", "charts"), 0, 1, set_horner, get_horner},
  {"update", "aberth, durand_kerner: from the values before the sweep, or from the newest", METHOD_ITEM_KEYWORD,
   WORDS("jacobi", "gauss_seidel"), 0, 1, set_update, get_update},
  {"rest", "aberth, durand_kerner: a finished root stays while others move", METHOD_ITEM_KEYWORD, WORDS("off", "on"), 0,
   1, set_rest, get_rest},
  {"deflation", "newton, laguerre: division from the highest power, or from both ends", METHOD_ITEM_KEYWORD,
   WORDS("forward", "composite"), 0, 1, set_deflation, get_deflation},
  {"refine", "newton, laguerre: last steps on the polynomial before deflation", METHOD_ITEM_KEYWORD, WORDS("off", "on"),
   0, 1, set_refine, get_refine},
};

size_t method_item_count(void) { return sizeof items / sizeof items[0]; }

const struct method_item *method_item_at(size_t index) { return index < method_item_count() ? &items[index] : NULL; }

const struct method_item *method_item_find(const char *name)
{
  for (size_t k = 0; k < method_item_count(); k++)
    if (strcmp(items[k].name, name) == 0) return &items[k];
  return NULL;
}

void method_default(const struct solver *solver, struct method *out)
{
  *out = (struct method){.basis = BASIS_BERNSTEIN,
                         .resultant = RESULTANT_BEZOUT,
                         .back_substitution = BACK_SUBSTITUTION_NULL_VECTOR,
                         .polish = true,
                         .split = 0};
  solver_options_default(solver, &out->roots);
}

bool method_equal(const struct method *a, const struct method *b)
{
  bool equal = a->roots.solver == b->roots.solver;
  for (size_t k = 0; equal && k < method_item_count(); k++) equal = items[k].get(a) == items[k].get(b);
  return equal;
}

/* The keyword that stands for the value, or its number, written to `number`. */
static const char *value_text(const struct method_item *item, double value, char number[NUMBER_TEXT_SIZE])
{
  size_t words = 0;
  while (item->keywords && item->keywords[words]) words++;
  /* 1e-9 is not auto */
  if (value >= 0 && value < (double)words && value == (double)(size_t)value) return item->keywords[(size_t)value];
  number_write(value, number);
  return number;
}

void method_text(const struct method *method, char *out, size_t size)
{
  char number[NUMBER_TEXT_SIZE];
  const char *before = " { ", *end = "";
  struct method said; /* the meaning of the text so far */
  method_default(method->roots.solver, &said);
  size_t used = (size_t)snprintf(out, size, "%s", method->roots.solver->name);
  for (size_t k = 0; k < method_item_count() && used < size; k++) {
    const struct method_item *item = &items[k];
    const double value = item->get(method);
    if (value == item->get(&said)) continue;
    item->set(&said, value);
    used += (size_t)snprintf(out + used, size - used, "%s%s %s", before, item->name, value_text(item, value, number));
    before = " ", end = " }";
  }
  if (used < size) snprintf(out + used, size - used, "%s", end);
}

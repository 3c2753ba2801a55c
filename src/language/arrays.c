/* Arrays. */
#include "language/values.h"

#include <math.h>
#include <string.h>

/* The most elements of one array: as much memory as 100,000 patches. */
enum { MOST_ELEMENTS = 1000000 };

/* An array whose elements are being given. */
struct open_array {
  struct open_array *outer;
  struct value *value;
  int level, at[MAX_DIMENSIONS]; /* rows open; indices of the next element */
  struct block block;
};

static struct array *empty_array(struct language *language, const struct value *sizes, struct span place)
{
  struct array *array = language_alloc(language, sizeof *array);
  array->count = 1;
  for (const struct value *size = sizes; size; size = size->next) {
    double x;
    if (array->dimensions == MAX_DIMENSIONS) {
      language_error(language, size->place, "an array has at most %d dimensions", MAX_DIMENSIONS);
      return NULL;
    }
    if (!value_to_number(language, size, &x)) return NULL;
    if (!(x >= 1 && x < MOST_ELEMENTS + 1.0)) {
      language_error(language, size->place, "the size of an array must be from 1 to %d", MOST_ELEMENTS);
      return NULL;
    }
    array->size[array->dimensions++] = (int)x;
    array->count *= (size_t)x;
    if (array->count > MOST_ELEMENTS) language_limit(language, place, "an array has more than 1,000,000 elements");
  }
  array->elements = language_alloc(language, array->count * sizeof *array->elements);
  for (size_t k = 0; k < array->count; k++) array->elements[k].kind = VALUE_NONE;
  return array;
}

void array_begin(struct language *language, struct value *sizes, struct span place)
{
  struct open_array *open = language_alloc(language, sizeof *open);
  struct array *array = empty_array(language, sizes, place);
  value_last_of_list(language, sizes);
  *open = (struct open_array){.outer = language->array,
                              .value = value_of(language, array ? VALUE_ARRAY : VALUE_UNKNOWN, place),
                              .block = language_block(language, place)};
  open->value->array = array;
  language->array = open;
}

void array_row(struct language *language, struct span brace)
{
  struct open_array *open = language->array;
  const struct array *array = open->value->array;
  if (array && open->level + 1 >= array->dimensions)
    language_error_in(language, &open->block, brace, "the array has fewer dimensions than there are braces");
  else if (++open->level < MAX_DIMENSIONS) open->at[open->level] = 0;
}

void array_given(struct language *language, const struct value *value)
{
  struct open_array *open = language->array;
  const struct array *array = open->value->array;
  if (!array || open->level >= MAX_DIMENSIONS) return;
  const int at = open->at[open->level]++;
  if (open->level != array->dimensions - 1) {
    language_error_in(language, &open->block, value->place,
                      "the elements of an array of several dimensions must be in rows: { { }, { } }");
    return;
  }
  size_t index = 0;
  for (int k = 0; k <= open->level; k++) {
    const int i = k < open->level ? open->at[k] : at;
    if (i >= array->size[k]) {
      language_error_in(language, &open->block, value->place, "this element is one too many for the array");
      return;
    }
    index = index * (size_t)array->size[k] + (size_t)i;
  }
  if (value->kind >= VALUE_MACRO) symbol_mistaken(language, value, "an element");
  else value_set(language, &array->elements[index], value);
}

void array_row_end(struct language *language, struct span brace)
{
  struct open_array *open = language->array;
  const struct array *array = open->value->array;
  if (!array || open->level >= MAX_DIMENSIONS) return;
  if (open->at[open->level] < array->size[open->level])
    language_error_in(language, &open->block, brace, "too few elements are given for the array");
  if (open->level > 0) open->at[--open->level]++;
}

struct value *array_end(struct language *language)
{
  struct open_array *open = language->array;
  language->array = open->outer;
  return open->value;
}

struct array *array_copy(struct language *language, const struct array *array)
{
  struct array *copy = language_alloc(language, sizeof *copy);
  *copy = *array;
  copy->elements = language_alloc(language, copy->count * sizeof *copy->elements);
  for (size_t k = 0; k < copy->count; k++) {
    copy->elements[k] = array->elements[k];
    if (copy->elements[k].kind == VALUE_ARRAY) copy->elements[k].array = array_copy(language, copy->elements[k].array);
  }
  return copy;
}

struct value *array_element(struct language *language, struct value *value, const struct value *name)
{
  size_t index = 0;
  int given = 0;
  if (value->kind != VALUE_ARRAY) {
    struct value named = *value;
    named.place = name->place;
    symbol_mistaken(language, &named, "an array");
    return NULL;
  }
  const struct array *array = value->array;
  for (const struct value *i = name->next; i; i = i->next, given++) {
    double x;
    if (!value_to_number(language, i, &x)) return NULL;
    if (given == array->dimensions) {
      language_error(language, i->place, "the array has %d dimension%s", given, given == 1 ? "" : "s");
      return NULL;
    }
    x = trunc(x);
    if (!(x >= 0 && x < array->size[given])) {
      language_error(language, i->place, "the index must be from 0 to %d, not %g", array->size[given] - 1, x);
      return NULL;
    }
    index = index * (size_t)array->size[given] + (size_t)x;
  }
  if (given < array->dimensions) {
    language_error(language, name->place, "the array has %d dimensions, but %d %s given", array->dimensions, given,
                   given == 1 ? "is" : "are");
    return NULL;
  }
  return &array->elements[index];
}

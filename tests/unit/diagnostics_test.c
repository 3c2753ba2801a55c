/* Errors told while memory runs short: whole, or without their place; nothing said is lost. */
#include "base/diagnostics.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "cmocka_test.h"

enum { LONG_NAME = 300 };

static const char SAID[] = "'loaction' is what a message begins with, which takes more than is left of the room that a "
                           "long name has made, and it goes on so that it is asked for again and again and again";

static long left; /* this many blocks are given before memory runs out; negative: all */

static void *resize(void *context, void *block, size_t size)
{
  (void)context;
  if (size == 0) {
    free(block);
    return NULL;
  }
  return left >= 0 && left-- == 0 ? NULL : realloc(block, size);
}

static void *resize_until(void *context, void *block, size_t size)
{
  return left == 0 && size > 0 ? NULL : resize(context, block, size);
}

struct told {
  char text[4000];
  struct diagnostics diagnostics;
};

static void keep(void *context, const char *text, size_t length)
{
  struct told *told = context;
  assert_true(length < sizeof told->text);
  memcpy(told->text, text, length);
  told->text[length] = '\0';
}

/* Whether the message has its place. */
static bool told_whole(const struct told *told, const char *name)
{
  const struct diagnostics_parts *parts = &told->diagnostics.parts;
  assert_int_equal(parts->said_end - parts->said_begin, strlen(SAID));
  assert_memory_equal(told->text + parts->said_begin, SAID, strlen(SAID));
  if (parts->line == 0) {
    assert_int_equal(strlen(told->text), strlen("error: ") + strlen(SAID) + 1);
    return false;
  }
  assert_int_equal(parts->line, 2);
  assert_int_equal(parts->name_end - parts->name_begin, strlen(name));
  assert_memory_equal(told->text + parts->name_begin, name, strlen(name));
  assert_non_null(strstr(told->text, "  camera { loaction 1 }\n           ^~~~~~~~\n"));
  return true;
}

static void told_with_the_nth_block_missing(void *(*hook)(void *context, void *block, size_t size), size_t name_length)
{
  static const char text[] = "// a scene\ncamera { loaction 1 }\n";
  char name[LONG_NAME + 1];
  memset(name, 'n', name_length);
  name[name_length] = '\0';
  struct source *source = source_from_text(name, text, sizeof text - 1);
  const struct place place = {source, 20, 28};
  bool whole = false;
  for (long n = 0; !whole; n++) {
    struct told told = {.diagnostics = {.tell = keep}};
    told.diagnostics.context = &told;
    left = n;
    const struct memory_hooks before = memory_use((struct memory_hooks){.resize = hook});
    diagnostics_error(&told.diagnostics, place, "%s", SAID);
    (void)memory_use(before);
    whole = told_whole(&told, name) && left != 0;
    assert_true(n < 100);
  }
  source_destroy(source);
}

TEST(nothing_said_is_lost)
{
  for (size_t length = 1; length <= LONG_NAME; length++) {
    told_with_the_nth_block_missing(resize, length);
    told_with_the_nth_block_missing(resize_until, length);
  }
}

/* Well-formed UTF-8, at the edges of its table (RFC 3629, section 4). */
TEST(characters_are_well_formed)
{
  static const struct {
    const char *text;
    size_t bytes;
  } table[] = {
    {"\x7f", 1},
    {"\x80", 0},
    {"\xc1\xbf", 0},
    {"\xc2\x80", 2},
    {"\xdf\xbf", 2},
    {"\xdf\x7f", 0},
    {"\xdf\xc0", 0},
    {"\xe0\x9f\xbf", 0},
    {"\xe0\xa0\x80", 3},
    {"\xed\x9f\xbf", 3},
    {"\xed\xa0\x80", 0},
    {"\xed\xbf\xbf", 0},
    {"\xee\x80\x80", 3},
    {"\xef\xbf\xbf", 3},
    {"\xef\xbf\x41", 0},
    {"\xf0\x8f\xbf\xbf", 0},
    {"\xf0\x90\x80\x80", 4},
    {"\xf4\x8f\xbf\xbf", 4},
    {"\xf4\x90\x80\x80", 0},
    {"\xf5\x80\x80\x80", 0},
  };
  for (size_t k = 0; k < sizeof table / sizeof *table; k++) {
    const size_t length = strlen(table[k].text);
    assert_int_equal(source_character(table[k].text, length), table[k].bytes);
    if (table[k].bytes > 1) assert_int_equal(source_character(table[k].text, length - 1), 0); /* cut off */
  }
}

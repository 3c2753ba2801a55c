/* Proves that the table of names finds what is put in, the newest first, whatever its bytes are; and that nobody can
 * predict where an entry lies, or a text could be made that takes quadratic time to read. */
#include "base/table.h"

#include <stdio.h>
#include <string.h>

#include "cmocka_test.h"

enum { NAMES = 5000, LONGEST = 40 };

struct item {
  struct table_entry entry;
  char name[LONGEST];
  size_t length;
};

static struct item *find(const struct table *table, const char *name, size_t length)
{
  struct table_entry *entry = table_find(table, name, length);
  while (entry && (((struct item *)entry)->length != length || memcmp(((struct item *)entry)->name, name, length) != 0))
    entry = entry->older;
  return (struct item *)entry;
}

TEST(test_found_again)
{
  static struct item items[NAMES], again[NAMES];
  struct arena *arena = arena_create();
  struct table table = {0};
  assert_null(find(&table, "", 0));
  for (int n = 0; n < NAMES; n++) { /* of all lengths, some of NULs only */
    struct item *item = &items[n];
    item->length = (size_t)(n % LONGEST);
    if (n >= LONGEST) snprintf(item->name, LONGEST, "%0*d", (int)item->length, n);
    if (item->length >= 7 || n < LONGEST) assert_null(find(&table, item->name, item->length));
    assert_true(table_add(&table, arena, &item->entry, item->name, item->length));
    assert_ptr_equal(find(&table, item->name, item->length), item);
  }
  for (int n = NAMES - 1; n >= 0; n--) {
    struct item *item = &again[n];
    *item = items[n];
    assert_true(table_add(&table, arena, &item->entry, item->name, item->length));
    assert_ptr_equal(find(&table, item->name, item->length), item);
    table_remove(&table, &item->entry);
    const struct item *found = find(&table, item->name, item->length);
    assert_non_null(found);
    assert_memory_equal(found->name, item->name, item->length);
    if (item->length >= 7) assert_ptr_equal(found, &items[n]);
  }
  arena_destroy(arena);
}

TEST(test_no_two_tables_are_alike)
{
  struct arena *arena = arena_create();
  struct table one = {0}, other = {0};
  struct item a = {.name = "Name", .length = 4}, b = a;
  assert_true(table_add(&one, arena, &a.entry, a.name, a.length));
  assert_true(table_add(&other, arena, &b.entry, b.name, b.length));
  assert_true(a.entry.hash != b.entry.hash);
  arena_destroy(arena);
}

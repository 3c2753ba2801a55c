/* Templates: their contents, and the values that fill them; foreign text made printable. */
#include "page/page.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cmocka_test.h"

/* Fills a template with values given as JSON. */
static void expect(const char *template, const char *json, const char *text)
{
  struct text_buffer page = {0};
  json_t *values = json_loads(json, 0, NULL);
  assert_non_null(values);
  fill_template(&page, template, values);
  assert_false(page.failed);
  assert_string_equal(page.text == NULL ? "" : page.text, text);
  assert_int_equal(page.length, strlen(text));
  text_buffer_free(&page);
  json_decref(values);
}

TEST(test_values)
{
  expect("a {{b}} c", "{\"b\":\"<i>&'\\\"\"}", "a &lt;i&gt;&amp;&#39;&quot; c");
  expect("{{&b}}|{{b:4s}}|{{b:-4s}}|", "{\"b\":\"<x\"}", "<x|  <x|<x  |");
  expect("{{n}} {{n:5d}} {{n:.2f}}", "{\"n\":42}", "42    42 42.00");
  expect("{{x}} {{x:1}} {{x:6}} {{x:.3g}} {{x:9.2e}} {{x:8.3f}}", "{\"x\":0.00012345678}",
         "0.00012345678 0.0001 0.000123457 0.000123  1.23e-04    0.000");
  expect("[{{nothing}}{{null}}]", "{\"null\":null}", "[]");
  expect("{{}} {{ {b}", "{\"b\":1}", " {{ {b}");
}

TEST(test_sections)
{
  expect("{{#rows}}<{{a}}{{b}}>{{/rows}}", "{\"b\":9,\"rows\":[{\"a\":1},{\"a\":2,\"b\":3}]}", "<19><23>");
  expect("{{#o}}{{#p}}{{x}}{{y}}{{/p}}{{/o}}", "{\"x\":0,\"o\":{\"x\":1,\"p\":{\"y\":2}}}", "12");
  expect("{{#o}}{{x}}{{/o}}{{x}}", "{\"x\":0,\"o\":{\"x\":1}}", "10"); /* a name regains its outer meaning */
  expect("{{#a}}-{{/a}}", "{\"a\":[1,2,3,4,5,6,7,8,9,10]}", "----------");
  const char *const nothing[] = {"{}", "{\"s\":null}", "{\"s\":false}", "{\"s\":[]}"};
  for (size_t k = 0; k < sizeof nothing / sizeof nothing[0]; k++)
    expect("{{#s}}yes{{/s}}{{^s}}no{{/s}}", nothing[k], "no");
  const char *const something[] = {"{\"s\":0}", "{\"s\":0.0}", "{\"s\":\"\"}", "{\"s\":true}", "{\"s\":{}}"};
  for (size_t k = 0; k < sizeof something / sizeof something[0]; k++)
    expect("{{#s}}yes{{/s}}{{^s}}no{{/s}}", something[k], "yes");
  expect("{{#a}}{{#ab}}x{{/ab}}y{{/a}}z", "{\"a\":[1,2],\"ab\":true}", "xyxyz"); /* names that begin alike */
}

TEST(test_printable)
{
  const struct {
    const char *text, *shown;
  } cases[] = {{"plain \xc3\xa4\n", "plain \xc3\xa4\n"},
               {"\x1b]0;x\x07", "\\x1b]0;x\\x07"},
               {"\xc2\x9b"
                "31m",
                "\\xc2\\x9b31m"},
               {"\xff\xc3", "\\xff\\xc3"},
               {"\r\t\x7f", "\\x0d\\x09\\x7f"}};
  for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
    struct text_buffer page = {0};
    text_buffer_add_printable(&page, cases[k].text, strlen(cases[k].text));
    assert_string_equal(page.text, cases[k].shown);
    text_buffer_free(&page);
  }
  json_t *infinite = page_of_number(INFINITY), *none = page_of_number(NAN);
  assert_true(json_is_null(infinite) && json_is_null(none));
  json_decref(infinite);
  json_decref(none);
}

/* Values that were cut short for lack of memory make no page. */
TEST(test_failed)
{
  struct text_buffer page = {0};
  fill_template(&page, "x", NULL);
  assert_true(page.failed && page.length == 0);
  text_buffer_free(&page);
}

/* There is always room for a NUL. */
TEST(test_room)
{
  struct text_buffer page = {.text = malloc(8), .room = 8};
  assert_non_null(page.text);
  text_buffer_add(&page, "1234567", 7);
  assert_int_equal(page.room, 8);
  text_buffer_add(&page, "8", 1);
  assert_true(page.room > 8);
  assert_string_equal(page.text, "12345678");
  text_buffer_free(&page);
}

/* Each block that a long page asks for fails once. The page then reports it, and keeps what it had. */
static long left = -1;
void *__real_realloc(void *block, size_t size);
void *__wrap_realloc(void *block, size_t size);
void *__wrap_realloc(void *block, size_t size) { return left >= 0 && left-- == 0 ? NULL : __real_realloc(block, size); }

TEST(test_memory)
{
  static const char template[] =
    "{{t}} {{n:5d}} {{x:.3g}} {{x}} {{#rows}}<{{a}}>and much more text than there was before, so that the page "
    "has to grow where nothing is filled in{{/rows}} {{&t}}";
  json_t *values = json_loads("{\"t\":\"<&>\",\"n\":42,\"x\":0.5,\"rows\":[]}", 0, NULL),
         *rows = json_object_get(values, "rows");
  assert_non_null(rows);
  for (int k = 0; k < 40; k++) assert_int_equal(json_array_append_new(rows, json_pack("{s:i}", "a", k)), 0);
  struct text_buffer whole = {0};
  fill_template(&whole, template, values);
  assert_false(whole.failed);
  for (long n = 0;; n++) {
    struct text_buffer page = {0};
    left = n;
    fill_template(&page, template, values);
    text_buffer_add(&page, "", 0);
    text_buffer_format(&page, "%s", "");
    const bool failed = left < 0;
    left = -1;
    assert_true(failed || !page.failed);
    if (page.failed) assert_true(page.length <= whole.length);
    else assert_string_equal(page.text, whole.text);
    text_buffer_free(&page);
    if (!failed) {
      assert_true(n > 2);
      break;
    }
  }
  text_buffer_free(&whole);
  json_decref(values);
}

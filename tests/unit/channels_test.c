/* Lists of channels. */
#include "render/channels.h"

#include <string.h>

#include "cmocka_test.h"

TEST(every_channel_is_found)
{
  struct channel_list list;
  const char *bad;
  size_t length, width = 0;
  assert_true(channel_list_parse("deviation,residual,roots,iterations,status,normal,patch,v,u,depth,coverage,rgb",
                                 &list, &bad, &length));
  assert_int_equal(list.count, CHANNEL_KINDS);
  for (int k = 0; k < CHANNEL_KINDS; k++) {
    assert_int_equal(list.kind[k], CHANNEL_KINDS - 1 - k);
    width += channel_traits((enum channel_kind)k)->width;
  }
  assert_int_equal(list.width, width);
}

TEST(wrong_lists_are_refused)
{
  static const struct {
    const char *text, *bad;
  } cases[] = {{"", ""},         {"rgb,", ""},   {",rgb", ""},     {"rgb,z,u", "z"},
               {"u,rgb,u", "u"}, {"RGB", "RGB"}, {"rgb, u", " u"}, {"normal.x", "normal.x"},
               {"dept", "dept"}};
  for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
    struct channel_list list = {.count = 99};
    const char *bad;
    size_t length;
    assert_false(channel_list_parse(cases[k].text, &list, &bad, &length));
    assert_int_equal(length, strlen(cases[k].bad));
    assert_memory_equal(bad, cases[k].bad, length);
    assert_int_equal(list.count, 99);
  }
}

/* The solver's work is measured if any channel shows it. */
TEST(one_channel_is_enough)
{
  static const struct {
    const char *text;
    bool measures, rgb;
  } cases[] = {{"rgb", false, true},    {"rgb,depth,deviation", false, false},
               {"depth", false, false}, {"iterations", true, false},
               {"roots", true, false},  {"rgb,residual", true, false}};
  for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
    struct channel_list list;
    const char *bad;
    size_t length;
    assert_true(channel_list_parse(cases[k].text, &list, &bad, &length));
    assert_int_equal(channel_list_measures(&list), cases[k].measures);
    assert_int_equal(channel_list_is_rgb(&list), cases[k].rgb);
  }
}

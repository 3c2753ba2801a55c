/* The items of a solver block: see scene/method.h. */
#include "scene/method.h"

#include <string.h>

#include "cmocka_test.h"

/* What get reads, set writes. Set in the order of the table, a block reads back unchanged. */
TEST(items_round_trip)
{
  for (size_t i = 0; i < method_item_count(); i++) {
    const struct method_item *item = method_item_at(i);
    struct method options, copy;
    method_default(solver_at(0), &options);
    int words = 0;
    while (item->keywords != NULL && item->keywords[words] != NULL) words++;
    const double last = item->kind == METHOD_ITEM_KEYWORD ? words - 1 : item->maximum;
    item->set(&options, last);
    assert_true(item->get(&options) == last);
    item->set(&options, item->kind == METHOD_ITEM_KEYWORD ? 0.0 : item->minimum);
    assert_true(item->get(&options) == (item->kind == METHOD_ITEM_KEYWORD ? 0.0 : item->minimum));
    method_default(solver_at(0), &copy);
    for (size_t k = 0; k < method_item_count(); k++) method_item_at(k)->set(&copy, method_item_at(k)->get(&options));
    assert_true(method_equal(&copy, &options));
  }
}

/* The paper's choices select the paper's iteration, in whatever order they are made, unless a form is named. */
TEST(form_follows_the_paper)
{
  static const struct {
    const char *name;
    double value;
  } choices[] = {{"basis", BASIS_POWER},
                 {"resultant", RESULTANT_SYLVESTER},
                 {"back_substitution", BACK_SUBSTITUTION_EUCLID},
                 {"polish", 0.0}};
  const struct method_item *form = method_item_find("form");
  assert_non_null(form);
  for (int first = 0; first < 4; first++) {
    struct method options, said;
    method_default(solver_find("aberth", 6), &options);
    method_default(solver_find("aberth", 6), &said);
    form->set(&said, 1.0);
    for (int k = 0; k < 4; k++) {
      assert_true(form->get(&options) == 1.0);
      const struct method_item *item = method_item_find(choices[(first + k) % 4].name);
      assert_non_null(item);
      item->set(&options, choices[(first + k) % 4].value);
      item->set(&said, choices[(first + k) % 4].value);
    }
    assert_true(solver_options_paper(&options.roots) && !solver_options_paper(&said.roots));
    assert_true(form->get(&options) == 1.0); /* all choices but the split */
    options.split = 1;
    assert_true(form->get(&options) == 0.0);
    method_default(solver_find("aberth", 6), &said);
    form->set(&said, 0.0);
    assert_true(method_equal(&options, &said));
    method_item_find("polish")->set(&options, 1.0);
    assert_true(!solver_options_paper(&options.roots));
  }
}

/* The lists of words for the manual, the completions and the editors are complete, of the right kind, and have each
 * word once. Also tests which word a misspelt one stands for. */
#include "language/words.h"

#include <string.h>

#include "cmocka_test.h"

enum { KINDS = WORDS_FOREIGN + 1, LEAST = 5 };

TEST(test_lists)
{
  const int plain = words_token("plainly_a_name", 14);
  for (int kind = 0; kind < KINDS; kind++) {
    size_t count = 0;
    for (const char *word; (word = words_at((enum words_kind)kind, count)) != NULL; count++) {
      char text[64] = "#";
      strcat(text, word);
      const int token = words_token(word, strlen(word));
      if (kind == WORDS_DIRECTIVES) {
        assert_int_not_equal(words_directive_token(text, strlen(text)), words_directive_token("#no_such", 8));
        continue;
      }
      if (token == plain) fail_msg("'%s' is a name like any other", word);
      assert_int_equal(words_begin_statement(token), kind == WORDS_STATEMENTS);
      if (kind != WORDS_STATEMENTS) assert_int_equal(words_begin_item(token), kind == WORDS_ITEMS);
      for (int other = 0; other <= kind; other++)
        for (size_t k = 0; other != WORDS_DIRECTIVES && (other < kind || k < count); k++) {
          const char *before = words_at((enum words_kind)other, k);
          if (before == NULL) break;
          if (strcmp(before, word) == 0) fail_msg("'%s' is there twice", word);
        }
    }
    assert_true(count >= LEAST);
  }
}

/* A third of the letters may be wrong, in a short word one. Two exchanged letters count as one. */
TEST(test_how_wrong)
{
  const struct {
    const char *word, *other;
    bool meant;
  } cases[] = {{"camxya", "camera", true}, {"camxyz", "camera", false},        {"anglx", "angle", true},
               {"angxy", "angle", false},  {"brillxyzce", "brilliance", true}, {"brilwxyzce", "brilliance", false},
               {"angleab", "angle", true}, {"brillia", "brilliant", true},     {"anlge", "angle", true},
               {"anxge", "angle", false},  {"anlxe", "angle", false},          {"Angle", "angle", true},
               {"angle", "angle", false}};
  for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
    struct guess guess = guess_begin(cases[k].word, strlen(cases[k].word));
    guess_consider(&guess, cases[k].other, strlen(cases[k].other));
    assert_int_equal(guess.best != NULL, cases[k].meant);
  }
  /* Of equally near words the first is meant. */
  struct guess guess = guess_begin("camere", 6);
  guess_consider(&guess, "camera", 6);
  guess_consider(&guess, "cameru", 6);
  assert_string_equal(guess.best, "camera");
  /* A word longer than anybody types is not compared. */
  char large[5000];
  memset(large, 'a', sizeof large);
  guess = guess_begin(large, sizeof large);
  guess_consider(&guess, large, sizeof large - 1);
  assert_null(guess.best);
}

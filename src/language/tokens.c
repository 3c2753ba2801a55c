/* The stream of tokens, with braces counted for recovery. */
#include "language/tokens.h"

#include "language/directives.h"
#include "language/macros.h"
#include "language/syntax_errors.h"

static bool is_number(int token) { return token == PSCN_TOKEN_NUMBER || token == PSCN_TOKEN_POINT; }

static void tell_too_large(struct language *language)
{
  struct frame *frame = language->sources->frame;
  struct scan *scan = &frame->scan;
  language_tell(language, sources_span(frame, scan->too_large_begin, scan->too_large_end),
                "this number is larger than 1e100");
  for (int k = 0; k < 3; k++) scan->number[k] = 1;
}

/* ---- the stream ---- */

/* Follows a solver statement, from the word `solver` on. Returns the token as it counts there. */
static int solver_token(struct tokens *tokens, int token)
{
  switch (tokens->solver_part) {
  case SOLVER_OUTSIDE: tokens->solver_part = SOLVER_NAME; return token;
  case SOLVER_NAME: tokens->solver_part = SOLVER_BEHIND_NAME; break;
  case SOLVER_BEHIND_NAME:
    tokens->solver_part = token == '{' ? SOLVER_BLOCK : token == PSCN_TOKEN_SOLVER ? SOLVER_NAME : SOLVER_OUTSIDE;
    tokens->parentheses = 0;
    return token;
  case SOLVER_BLOCK:
    if (token == '}' || token == 0) tokens->solver_part = SOLVER_OUTSIDE;
    tokens->parentheses += (token == '(') - (token == ')' && tokens->parentheses > 0);
    if (tokens->parentheses > 0) return token;
    break;
  }
  return scan_is_word(token) ? PSCN_TOKEN_WORD : token;
}

/* The next token that is not skipped; 0 also where reading must end early. Most are the grammar's. */
static int scan(struct language *language)
{
  const bool scene = !language->tokens->solver_only;
  for (;;) {
    if (language->ended_early || diagnostics_full(language->diagnostics)) return 0;
    const int token = pscn_scan_next(&language->sources->frame->scan);
    if (scene && token > 0 && token < TOKEN_FIRST_PRIVATE) return token;
    if (!directives_pass(language, token)) return token;
  }
}

static void open_brace(struct language *language, struct span place)
{
  struct tokens *tokens = language->tokens;
  if (tokens->depth < MAX_NESTING) tokens->braces[tokens->depth] = place;
  if (++tokens->depth > MAX_NESTING) language_limit(language, place, "blocks are nested more than 200 deep");
}

/* The tokens given before the text: which grammar it has, and for the text of a solver the word that it follows. */
static int make_up(struct tokens *tokens)
{
  tokens->last.place = span_of(1, 1);
  if (tokens->made_up++ == 0) return tokens->solver_only ? PSCN_TOKEN_START_SOLVER : PSCN_TOKEN_START_SCENE;
  return solver_token(tokens, PSCN_TOKEN_SOLVER);
}

/* Behind a directive of files: their names, and names read from them, stand for values that are unknown here. */
static void pass_files(struct language *language, int directive)
{
  if (!language->declaration && !language->tokens->skipping) return;
  struct naming naming = {0};
  (void)naming_next(&naming, directive, sources_here(language));
  while (naming.token != 0) {
    const int token = pscn_scan_next(&language->sources->frame->scan);
    const struct span place = sources_here(language);
    if (naming_next(&naming, token, place) != 0) declare_unseen(language, place, NULL);
  }
}

/* The token that stands in for one that is not the grammar's, which has been reported. */
static int stand_in(struct language *language, int token)
{
  struct tokens *tokens = language->tokens;
  if (token == TOKEN_SECOND_POINT || token == TOKEN_OPEN_EXPONENT) { /* POV-Ray takes the e for part of the number */
    const char *wrong = token == TOKEN_SECOND_POINT ? "a number has one point" : "the exponent of a number has digits";
    if (!tokens->skipping) language_error(language, tokens->last.place, "%s", wrong);
    return PSCN_TOKEN_NUMBER;
  }
  if (token == TOKEN_OTHER_LETTERS) {
    if (!tokens->skipping) letters_error(language, tokens->last.place);
    return PSCN_TOKEN_WORD;
  }
  if (token != TOKEN_FOREIGN_OPENER && token != TOKEN_FOR) directives_tell(language, token);
  tokens->told = tokens->last.place;
  if (token == TOKEN_FILE || token == TOKEN_READ) pass_files(language, token);
  return PSCN_TOKEN_FOREIGN;
}

int tokens_next(struct language *language)
{
  struct tokens *tokens = language->tokens;
  struct delivered *last = &tokens->last;
  if (tokens->made_up < (tokens->solver_only ? 2 : 1)) return make_up(tokens);
  if (last->again) {
    last->again = false;
    return last->token;
  }
  tokens->previous = last->place;
  int token = scan(language);
  last->place = sources_here(language);
  const struct frame *frame = language->sources->frame;
  if (token == 0) last->place = sources_span(frame, frame->source->length, frame->source->length);
  else if (token > TOKEN_FIRST_PRIVATE) token = stand_in(language, token);
  else if (is_number(token) && frame->scan.too_large) tell_too_large(language);
  if (tokens->solver_part != SOLVER_OUTSIDE || token == PSCN_TOKEN_SOLVER) token = solver_token(tokens, token);
  last->token = token;
  last->depth = tokens->depth;
  const bool passed = language->declaration || tokens->skipping; /* possibly; a macro called elsewhere is an error */
  if (token == PSCN_TOKEN_WORD && tokens->solver_part == SOLVER_OUTSIDE && passed) macro_called(language, last->place);
  if (token == '{') open_brace(language, last->place);
  else if (token == '}' && tokens->depth > 0) tokens->depth--;
  return token;
}

/* ---- recovery ---- */

static bool recover(struct language *language)
{
  struct tokens *tokens = language->tokens;
  const struct delivered *last = &tokens->last;
  const int block = last->depth;
  const bool twice = span_begin(last->place) == span_begin(tokens->recovered);
  int parentheses = 0, before = 0;
  struct naming naming = {0};
  tokens->recovered = last->place;
  tokens->last.again = false;

  for (bool first = true;; first = false, before = last->token, tokens_next(language)) {
    const int token = last->token;
    if (token == 0) return false;
    if (token == '(' && !first) parentheses++;
    if (last->depth != block || parentheses > 0) declare_passed(language, token, last->place, &naming);
    if (parentheses > 0) { /* of a function of POV-Ray's, whose arguments may be anything */
      parentheses -= token == ')';
      continue;
    }
    /* A token that was refused here may begin the next item; one refused there too is dropped. */
    if (last->depth == block && !(first && twice)) {
      const bool begins = block == 0 ? words_begin_statement(token) : words_begin_item(token);
      const bool in_value = before == '+' || before == '-' || before == '*' || before == '/' || before == ',';
      const bool foreign = token == PSCN_TOKEN_FOREIGN && !first && !in_value;
      if (begins || foreign || (token == '}' && block > 0)) {
        tokens->last.again = true;
        return true;
      }
    }
    /* A block within the skipped text has ended, or a statement. What follows is on its own. */
    if (!first && token == '}' && last->depth == block + 1) {
      tokens->skipping = 0;
      tokens->last.again = tokens_next(language) != ';'; /* the ; may end a declaration */
      return true;
    }
    if (token == ';' && last->depth == block && block == 0) return true;
  }
}

/* Skipped text may be full of what means nothing here, as a map of colours is. This is reported once. */
bool tokens_recover(struct language *language)
{
  language->tokens->skipping = 1 + language->tokens->last.depth;
  const bool more = recover(language);
  language->tokens->skipping = 0;
  return more;
}

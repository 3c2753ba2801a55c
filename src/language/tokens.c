/* The stream of tokens, with braces counted for recovery. */
#include "language/tokens.h"

#include "language/state.h"
#include "language/values.h"

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
  return words_is(token) ? PSCN_TOKEN_WORD : token;
}

/* The next token that is not skipped; 0 also after too many errors. Most are the grammar's. */
static int scan(struct language *language)
{
  struct tokens *tokens = language->tokens;
  const bool scene = !tokens->solver_only;
  for (;;) {
    if (diagnostics_full(language->diagnostics)) return 0;
    const int token = directives_scan(language);
    if (scene && token > 0 && token < TOKEN_FIRST_PRIVATE) {
      if (token != PSCN_TOKEN_WORD || tokens->naming || tokens->solver_part != SOLVER_OUTSIDE) return token;
      if (!macro_called(language)) return token;
    } else if (!directives_pass(language, token)) {
      return token;
    }
  }
}

static void open_brace(struct language *language, struct span place)
{
  struct tokens *tokens = language->tokens;
  if (tokens->depth < MAX_NESTING) tokens->braces[tokens->depth] = place;
  if (++tokens->depth > MAX_NESTING) language_limit(language, place, "blocks are nested more than 200 deep");
}

/* The token that stands in for a number that is none; for a directive, one that ends what is being read. */
static int stand_in(struct language *language, int token)
{
  struct tokens *tokens = language->tokens;
  if (token >= TOKEN_FOREIGN_DIRECTIVE) return tokens->told = tokens->last.place, PSCN_TOKEN_REFUSED;
  if (!tokens->skipping) /* POV-Ray takes the e for part of the number */
    language_error(language, tokens->last.place,
                   "this is not a number: it has a second point, or no digits after the e");
  language->sources->frame->scan.number[0] = 1;
  return PSCN_TOKEN_NUMBER;
}

/* The token that begins a parser's text, if it has not been given yet; else 0. */
static int begin(struct tokens *tokens)
{
  const int token = tokens->start[0];
  if (token == 0) return 0;
  tokens->start[0] = tokens->start[1];
  tokens->start[1] = 0;
  return token == PSCN_TOKEN_SOLVER ? solver_token(tokens, token) : token;
}

/* Whether a directive that is read by itself is complete, and this token is behind it. A value of which the ; is missing
 * ends before what cannot belong to it. */
static bool is_behind(const struct language *language, int token)
{
  const struct tokens *tokens = language->tokens;
  const struct own *own = tokens->own;
  const struct declaration *declaration = language->declaration;
  if (!own || own->token == PSCN_TOKEN_DEFAULT) return false;
  const bool ends = words_begin_item(token) || words_are_foreign(token) || token == '}';
  if (own->token == PSCN_TOKEN_VERSION) return ends || token == ',';
  if (declaration == own->outer)
    return language->declared > own->declared && token != ';' && !(language->layered && token == PSCN_TOKEN_TEXTURE);
  return ends && declaration && declaration->outer == own->outer && declaration->begun &&
         tokens->depth == declaration->braces + (token == '{') - (token == '}') &&
         language->sources->frame == declaration->frame;
}

/* Makes the scanner's token the last one. Returns it as it counts. */
static int deliver(struct language *language, int token)
{
  struct tokens *tokens = language->tokens;
  struct delivered *last = &tokens->last;
  const struct frame *frame = language->sources->frame;
  last->place = sources_here(language);
  if (token == 0) last->place = sources_span(frame, frame->source->length, frame->source->length);
  else if (token > TOKEN_FIRST_PRIVATE) token = stand_in(language, token);
  else if ((token == PSCN_TOKEN_NUMBER || token == PSCN_TOKEN_POINT) && frame->scan.too_large) tell_too_large(language);
  if (tokens->solver_part != SOLVER_OUTSIDE || token == PSCN_TOKEN_SOLVER) token = solver_token(tokens, token);
  last->token = token;
  last->depth = tokens->depth;
  if (token == PSCN_TOKEN_WORD && !tokens->naming && tokens->solver_part == SOLVER_OUTSIDE) tokens->word = last->place;
  if (token == PSCN_TOKEN_DECLARE || token == PSCN_TOKEN_LOCAL || token == PSCN_TOKEN_DEFINED) tokens->naming = true;
  else if (token == PSCN_TOKEN_WORD || token == ')' || token == '=') tokens->naming = false;
  if (token == '{') open_brace(language, last->place);
  else if (token == '}' && tokens->depth > 0) tokens->depth--;
  return token;
}

/* Whether the last token is a directive that may stand here, which is not where a declaration's ; is missing. */
static bool is_directive(const struct language *language)
{
  const struct tokens *tokens = language->tokens;
  const int token = tokens->last.token;
  const struct declaration *declaration = language->declaration;
  if (token < PSCN_TOKEN_VERSION || token > PSCN_TOKEN_DEFAULT) return false;
  return !declaration || tokens->depth > declaration->braces || language->sources->frame != declaration->frame;
}

/* Runs a parser of its own over a directive, whose token is the last one. The one behind it may be the next again. */
static void read_directive(struct language *language)
{
  struct tokens *tokens = language->tokens;
  struct own *outer = tokens->own;
  struct own own = {.token = tokens->last.token, .outer = language->declaration, .declared = language->declared};
  const int skipping = tokens->skipping;
  if (tokens->nested == MAX_NESTING)
    language_limit(language, tokens->last.place, "declarations are nested more than 200 deep");
  tokens->start[0] = PSCN_TOKEN_START_DIRECTIVE;
  tokens->start[1] = own.token;
  tokens->skipping = 0;
  tokens->own = &own;
  tokens->nested++;
  const bool read = pscn_parse(language) == 0;
  tokens->own = outer;
  if (!read) (void)tokens_recover(language);
  tokens->nested--;
  tokens->skipping = skipping;
}

int tokens_next(struct language *language)
{
  struct tokens *tokens = language->tokens;
  struct delivered *last = &tokens->last;
  int token = begin(tokens);
  if (token != 0) return token;
  const struct span previous = last->place;
  for (bool again = last->again;; again = last->again) {
    last->again = false;
    token = again ? last->token : deliver(language, scan(language));
    if (!again) tokens->previous = previous;
    if (is_behind(language, token)) {
      last->again = true;
      return 0;
    }
    if (language->declaration && token != '=') language->declaration->begun = true;
    if (!is_directive(language)) return token;
    read_directive(language);
  }
}

/* After an error in parentheses that a directive or a macro's name opened, finds their end, or where they cannot go
 * on. */
static void pass_parentheses(struct language *language, int open)
{
  const struct delivered *last = &language->tokens->last;
  for (int token = last->token; token != 0 && token != ';' && token != '{' && token != '}';
       token = tokens_next(language)) {
    open += (token == '(') - (token == ')');
    if (open == 0) return;
  }
}

bool tokens_parse(struct language *language, int start, struct value **out)
{
  struct tokens *tokens = language->tokens;
  struct tokens before = *tokens;
  *out = NULL;
  if (tokens->nested == MAX_NESTING)
    language_limit(language, sources_here(language), "macros and conditions are nested more than 200 deep");
  const size_t begin = language->sources->frame->scan.end;
  const bool opens = start != PSCN_TOKEN_START_STRING && start != PSCN_TOKEN_START_INDICES;
  if (opens && directives_scan(language) != '(') {
    language_error(language, sources_here(language), "expected (");
    pscn_scan_seek(&language->sources->frame->scan, begin);
    return false;
  }
  pscn_scan_seek(&language->sources->frame->scan, begin);
  tokens->nested++;
  tokens->start[0] = start;
  tokens->start[1] = 0;
  tokens->own = NULL;
  tokens->naming = tokens->last.again = false;
  tokens->solver_part = SOLVER_OUTSIDE;
  tokens->parentheses = 0;
  const bool read = pscn_parse(language) == 0;
  *out = language->list;
  language->list = NULL;
  if (!read) pass_parentheses(language, 1);
  before.told = tokens->told;
  *tokens = before;
  return read;
}

/* ---- recovery ---- */

/* Whether the next item of a block begins with the token, or its brace is here. */
static bool begins_next(int token, int depth)
{
  if (token == '}') return depth > 0;
  return depth == 0 ? words_begin_statement(token) : words_begin_item(token);
}

/* A random number is drawn also in what is left out, so that the next one is that of POV-Ray. */
static void draw(struct language *language)
{
  struct value *list = NULL;
  const struct span place = language->tokens->last.place;
  if (language->diagnostics->error_count > 0 || !function_draws(language, place)) return;
  if (tokens_parse(language, PSCN_TOKEN_START_ARGUMENTS, &list))
    value_last(language, value_function(language, list, place, place));
}

/* False at the end of the text. `wrong`: the token where skipping begins may be that of an item. */
static bool skip_item(struct language *language, bool wrong)
{
  struct tokens *tokens = language->tokens;
  const struct delivered *last = &tokens->last;
  const int block = last->depth;
  const bool twice = span_begin(last->place) == span_begin(tokens->recovered);
  int parentheses = 0, before = 0;
  tokens->recovered = last->place;
  tokens->last.again = false;

  int token = last->token;
  for (bool first = true;; first = false, before = token, token = tokens_next(language)) {
    if (token == 0) return false;
    if (token == PSCN_TOKEN_FUNCTION) draw(language);
    if (token == '(' && !first) parentheses++;
    if (parentheses > 0) { /* of a function of POV-Ray's, whose arguments may be anything */
      parentheses -= token == ')';
      continue;
    }
    /* A token that was refused here may begin the next item; one refused there too is dropped. */
    if (last->depth == block && !(first && (twice || !wrong))) {
      const bool in_value = before == '+' || before == '-' || before == '*' || before == '/' || before == ',';
      const bool of_pattern = span_end(last->place) - span_begin(last->place) == 1; /* the u of gradient u */
      const bool foreign = words_are_foreign(token) && !of_pattern && !first && !in_value;
      if (begins_next(token, block) || foreign) {
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
static bool skip(struct language *language, bool wrong)
{
  language->tokens->skipping = 1 + language->tokens->last.depth;
  const bool more = skip_item(language, wrong);
  language->tokens->skipping = 0;
  return more;
}

bool tokens_recover(struct language *language)
{
  language->idle = 0;
  return skip(language, true);
}

void tokens_pass(struct language *language) { (void)skip(language, false); }

struct span tokens_pass_block(struct language *language)
{
  struct tokens *tokens = language->tokens;
  const struct delivered *last = &tokens->last;
  const int block = last->depth;
  if (tokens_next(language) != '{') {
    language_error(language, last->place, "expected { after the name of a shape");
    tokens->last.again = true;
    return last->place;
  }
  tokens->skipping = 1 + block;
  const struct span brace = last->place;
  int token = '{';
  while (token != 0 && !(token == '}' && last->depth == block + 1)) {
    token = tokens_next(language);
    if (token == PSCN_TOKEN_FUNCTION) draw(language);
  }
  if (token == 0) language_tell(language, brace, "this brace is not closed");
  tokens->skipping = 0;
  return last->place;
}

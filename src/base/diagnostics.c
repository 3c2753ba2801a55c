/* Diagnostics: one error becomes one block of lines. If memory is too short for them, the message is told without its
 * place. */
#include "base/diagnostics.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/text_buffer.h"

enum {
  MESSAGE_BYTES = 2000,   /* longer messages are cut */
  KIND_BYTES = 16,        /* before them; and the end of the line after them */
  SHOWN_CHARACTERS = 110, /* of the source line; longer lines are shown around the place */
  SHOWN_BEFORE = 60,      /* of those, at most this many before the place */
  MAX_INCLUDE_LINES = 64  /* the language allows fewer levels */
};

/* Adds text with control characters and malformed UTF-8 replaced by '?', so that a scene cannot steer a terminal. */
static void add_clean(struct text_buffer *block, const char *text, size_t length)
{
  for (size_t i = 0; i < length;) {
    size_t bytes = source_character(text + i, length - i);
    if (source_is_shown(text + i, bytes) || text[i] == '\t') text_buffer_add(block, text + i, bytes);
    else text_buffer_add(block, "?", 1);
    i += bytes ? bytes : 1;
  }
}

/* Adds the name and the position. Returns where the name ends. */
static size_t add_position(struct text_buffer *block, const struct source *source, struct source_position at)
{
  add_clean(block, source->name, strlen(source->name));
  const size_t name_end = block->length;
  text_buffer_format(block, ":%zu:%zu:", at.line, at.column);
  return name_end;
}

static void add_include_chain(struct text_buffer *block, const struct source *source)
{
  const struct source *chain[MAX_INCLUDE_LINES];
  int levels = 0;
  for (; source->includer && levels < MAX_INCLUDE_LINES; source = source->includer) chain[levels++] = source;
  while (levels-- > 0) {
    const struct source *includer = chain[levels]->includer;
    text_buffer_add_text(block, "included from ");
    (void)add_position(block, includer, source_locate(includer, chain[levels]->include_begin));
    text_buffer_add_text(block, "\n");
  }
}

static void add_around(struct text_buffer *block, const struct diagnostics *diagnostics)
{
  for (size_t k = 0; k < diagnostics->around_count; k++) {
    const struct diagnostics_around *around = &diagnostics->around[k];
    if (!around->place.source) continue;
    if (around->round > 0) text_buffer_format(block, "in round %.0f of the loop at ", around->round);
    else text_buffer_add_text(block, "called from ");
    (void)add_position(block, around->place.source, source_locate(around->place.source, around->place.begin));
    text_buffer_add_text(block, "\n");
  }
}

static size_t step_forward(const char *text, size_t i, size_t end)
{
  size_t bytes = source_character(text + i, end - i);
  return i + (bytes ? bytes : 1);
}

/* Adds the source line and the line of the caret. The caret line repeats the tabs, so both are in the same columns. */
static void add_line(struct text_buffer *block, struct place place, struct source_position at)
{
  const char *text = place.source->text;
  size_t place_begin = place.begin < at.line_end ? place.begin : at.line_end;
  size_t place_end = place.end < at.line_end ? place.end : at.line_end;
  size_t begin = at.line_begin, column = at.column;
  while (column > SHOWN_BEFORE) {
    const size_t skipped = column - SHOWN_BEFORE < 8 ? 0 : source_skip(text + begin, at.line_end - begin);
    begin = skipped ? begin + skipped : step_forward(text, begin, at.line_end);
    column -= skipped ? skipped : 1;
  }
  size_t end = begin;
  for (int shown = 0; end < at.line_end && shown < SHOWN_CHARACTERS; shown++)
    end = step_forward(text, end, at.line_end);
  if (place_end > end) place_end = end;

  text_buffer_add_text(block, begin > at.line_begin ? "  ..." : "  ");
  add_clean(block, text + begin, end - begin);
  text_buffer_add_text(block, end < at.line_end ? "...\n" : "\n");
  text_buffer_add_text(block, begin > at.line_begin ? "     " : "  ");
  for (size_t i = begin; i < place_begin; i = step_forward(text, i, at.line_end))
    text_buffer_add_text(block, text[i] == '\t' ? "\t" : " ");
  text_buffer_add_text(block, "^");
  if (place_begin < place_end)
    for (size_t i = step_forward(text, place_begin, at.line_end); i < place_end; i = step_forward(text, i, at.line_end))
      text_buffer_add_text(block, "~");
  text_buffer_add_text(block, "\n");
}

static void tell_closing_line(struct diagnostics *diagnostics, bool warnings)
{
  char text[64];
  const int length = snprintf(text, sizeof text, "%d %s: no more are shown\n", DIAGNOSTICS_MAX_ERRORS,
                              warnings ? "warnings" : "errors");
  diagnostics->parts = (struct diagnostics_parts){.said_end = (size_t)length - 1, .warning = warnings};
  diagnostics->tell(diagnostics->context, text, (size_t)length);
}

/* Tells a block of lines; `kind` is "error: " or "warning: ". False if the block has no room for them. */
static bool tell_block(struct diagnostics *diagnostics, struct text_buffer *block, struct place place, const char *kind,
                       const char *message)
{
  struct diagnostics_parts parts = {.warning = kind[0] == 'w'};
  struct source_position at = {0};
  if (place.source) {
    at = source_locate(place.source, place.begin);
    add_include_chain(block, place.source);
    add_around(block, diagnostics);
    parts.line = at.line, parts.column = at.column;
    parts.name_begin = block->length;
    parts.name_end = add_position(block, place.source, at);
    text_buffer_add_text(block, " ");
  }
  text_buffer_add_text(block, kind);
  parts.said_begin = block->length;
  add_clean(block, message, strlen(message));
  parts.said_end = block->length;
  text_buffer_add_text(block, "\n");
  if (place.source) add_line(block, place, at);
  if (block->failed) return false;
  diagnostics->parts = parts;
  diagnostics->tell(diagnostics->context, block->text, block->length);
  return true;
}

static void tell(struct diagnostics *diagnostics, struct place place, const char *kind, const char *format,
                 va_list arguments)
{
  char message[MESSAGE_BYTES], memory[MESSAGE_BYTES + KIND_BYTES];
  struct text_buffer block = {0};
  if (vsnprintf(message, sizeof message, format, arguments) < 0) message[0] = '\0';
  const bool told = place.source && tell_block(diagnostics, &block, place, kind, message);
  text_buffer_free(&block);
  /* Without its place, there is room for all of it, and nothing is allocated. */
  block = (struct text_buffer){.text = memory, .room = sizeof memory};
  if (!told) (void)tell_block(diagnostics, &block, (struct place){NULL, 0, 0}, kind, message);
}

/* Whether to tell one more, after `before` of them. For the first one too many, tells the closing line. */
static bool room_for(struct diagnostics *diagnostics, size_t before, bool warning)
{
  if (!diagnostics->tell || before > DIAGNOSTICS_MAX_ERRORS) return false;
  if (before == DIAGNOSTICS_MAX_ERRORS) tell_closing_line(diagnostics, warning);
  return before < DIAGNOSTICS_MAX_ERRORS;
}

void diagnostics_error(struct diagnostics *diagnostics, struct place place, const char *format, ...)
{
  va_list arguments;
  if (!room_for(diagnostics, diagnostics->error_count++, false)) return;
  va_start(arguments, format);
  tell(diagnostics, place, "error: ", format, arguments);
  va_end(arguments);
}

void diagnostics_warning(struct diagnostics *diagnostics, struct place place, const char *format, ...)
{
  va_list arguments;
  if (diagnostics->quiet || !room_for(diagnostics, diagnostics->warning_count++, true)) return;
  va_start(arguments, format);
  tell(diagnostics, place, "warning: ", format, arguments);
  va_end(arguments);
}

void diagnostics_print(struct diagnostics *diagnostics, const char *text, size_t length)
{
  struct text_buffer block = {0};
  if (diagnostics->quiet || !diagnostics->tell) return;
  add_clean(&block, text, length);
  diagnostics->parts = (struct diagnostics_parts){.said_end = block.length, .warning = true};
  text_buffer_add_text(&block, "\n");
  if (!block.failed) diagnostics->tell(diagnostics->context, block.text, block.length);
  text_buffer_free(&block);
}

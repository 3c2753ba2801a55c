/* A scene from a file, its errors told on stderr. */
#include "command/scene_file.h"

#include <stdio.h>
#include <string.h>

#include "base/number.h"
#include "command/values.h"
#include "language/language.h"

static void tell(void *context, const char *text, size_t length)
{
  (void)context;
  (void)fwrite(text, 1, length, stderr);
}

struct diagnostics stderr_diagnostics(void)
{
  return (struct diagnostics){ .tell = tell };
}

enum status scene_request_take(const struct command *command, struct scene_request *request, int val,
                               const char *argument)
{
  switch (val) {
  case OPTION_SIZE:
    if (!value_size(argument, MAX_SIDE, &request->width, &request->height))
      return (enum status)command_usage(command, "'%s' is no size WxH of 1 to %d pixels each", argument, MAX_SIDE);
    break;
  case OPTION_SOLVER:
    request->solver_text = argument;
    break;
  default:
    if (!value_number(argument, &request->tolerance) || request->tolerance == 0)
      return (enum status)command_usage(command, "'%s' is no tolerance", argument);
    break;
  }
  return STATUS_OK;
}

enum status scene_file_load(const struct scene_request *request, struct scene **out)
{
  const struct language_settings settings = { .image_width = (int)request->width,
                                              .image_height = (int)request->height,
                                              .solver_text = request->solver_text,
                                              .tolerance = request->tolerance };
  struct diagnostics diagnostics = stderr_diagnostics();
  return language_load(request->path, &settings, &diagnostics, out);
}

/* Text that grows at the end of a fixed space. */
struct text {
  char *out;
  size_t size, length;
};

static void append(struct text *text, const char *word)
{
  const size_t length = strlen(word);
  if (length >= text->size - text->length)
    return;
  memcpy(text->out + text->length, word, length + 1);
  text->length += length;
}

static void append_value(struct text *text, const struct solver_item *item, double value)
{
  size_t words = 0;
  while (item->keywords != NULL && item->keywords[words] != NULL)
    words++;
  if (value >= 0 && value < (double)words) {
    append(text, item->keywords[(size_t)value]);
    return;
  }
  char number[NUMBER_TEXT_SIZE];
  number_write(value, number);
  append(text, number);
}

void solver_text(const struct solver_options *options, char *out, size_t size)
{
  struct text text = { .out = out, .size = size };
  struct solver_options said; /* what the text so far means */
  solver_options_default(options->solver, &said);
  out[0] = '\0';
  append(&text, options->solver->name);
  bool any = false;
  for (size_t k = 0; k < solver_item_count(); k++) {
    const struct solver_item *item = solver_item_at(k);
    const double value = item->get(options);
    if (value == item->get(&said))
      continue;
    item->set(&said, value);
    append(&text, any ? " " : " { ");
    append(&text, item->name);
    append(&text, " ");
    append_value(&text, item, value);
    any = true;
  }
  append(&text, any ? " }" : "");
}

/* Formats texts for a listener. */
#include "base/listener.h"

#include <stdarg.h>
#include <stdio.h>

enum { TEXT_SIZE = 8192 };

static void tell(const struct listener *listener, enum told what, const char *format, va_list arguments)
{
  char text[TEXT_SIZE];
  vsnprintf(text, sizeof text, format, arguments);
  listener->hear(listener->context, what, text);
}

void listener_tell(const struct listener *listener, enum told what, const char *format, ...)
{
  va_list arguments;
  va_start(arguments, format);
  tell(listener, what, format, arguments);
  va_end(arguments);
}

enum status listener_fail(const struct listener *listener, enum status status, const char *format, ...)
{
  va_list arguments;
  va_start(arguments, format);
  tell(listener, TOLD_ERROR, format, arguments);
  va_end(arguments);
  return status;
}

enum status listener_out_of_memory(const struct listener *listener)
{
  return listener_fail(listener, STATUS_LIMIT, "out of memory");
}

bool listener_stopped(const struct listener *listener)
{
  return listener->stop != NULL && atomic_load(listener->stop) != 0;
}

/* What the files of src/library share. */
#ifndef PSCN_LIBRARY_LIBRARY_H
#define PSCN_LIBRARY_LIBRARY_H

#include <fenv.h>
#include <stdbool.h>
#include <stdint.h>
#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

#include "base/arena.h"
#include "base/diagnostics.h"
#include "base/memory.h"
#include "base/text_buffer.h"
#include "intersect/intersect.h"
#include "language/language.h"
#include "library/pscn.h"
#include "scene/scene.h"

struct message {
  struct message *next;
  struct pscn_message is;
};

struct pscn_scene {
  struct memory_hooks hooks;
  enum pscn_status status;
  struct diagnostics diagnostics;
  struct arena *arena; /* of the messages */
  struct message *messages, **messages_end;
  size_t message_count;
  struct text_buffer text; /* all messages together */
  struct message spare;    /* stands for messages that there was no memory for */
  struct scene *scene;
  struct language_parts parts;     /* of its text, if it is from one */
  struct intersector *intersector; /* NULL if the scene was not built */
};

/* Between calm_begin and calm_end, arithmetic is as our code requires: rounding to nearest, no flush to zero, no traps.
 * On x86-64 two registers say whether it is so already (the x87 has traps of its own); then only what is cheap enough
 * for a single ray is done. */
struct calm {
  fenv_t callers;
  unsigned control; /* MXCSR, the register of SSE */
  unsigned x87;     /* flags of the x87, where libgcc reports over- and underflow of __float128 */
  bool plain;
};

#if defined(__SSE2__)
enum { PLAIN_CONTROL = 0x1f80, CONTROL_FLAGS = 0x3f, PLAIN_X87_CONTROL = 0x37f };

static inline unsigned x87_control(void)
{
  uint16_t control;
  __asm__ volatile("fnstcw %0" : "=m"(control));
  return control;
}

static inline unsigned x87_flags(void)
{
  uint16_t status;
  __asm__ volatile("fnstsw %0" : "=a"(status));
  return status & FE_ALL_EXCEPT;
}
#endif

static inline void calm_begin(struct calm *calm)
{
  calm->plain = false;
#if defined(__SSE2__)
  calm->control = _mm_getcsr();
  calm->plain = (calm->control & ~(unsigned)CONTROL_FLAGS) == PLAIN_CONTROL && x87_control() == PLAIN_X87_CONTROL;
  calm->x87 = x87_flags();
  if (calm->plain) return;
#endif
  (void)fegetenv(&calm->callers);
  (void)fesetenv(FE_DFL_ENV);
}

static inline void calm_end(const struct calm *calm)
{
#if defined(__SSE2__)
  if (calm->plain) {
    const unsigned raised = x87_flags() & ~calm->x87;
    if (raised) (void)feclearexcept((int)raised); /* clears both units */
    if (_mm_getcsr() != calm->control) _mm_setcsr(calm->control);
    return;
  }
#endif
  (void)fesetenv(&calm->callers);
}

#endif

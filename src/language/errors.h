/* An error is reported where it is found, and reading goes on with a harmless value, so that one run finds many. A
 * scene is made only if there was none. */
#ifndef PSCN_LANGUAGE_ERRORS_H
#define PSCN_LANGUAGE_ERRORS_H

#include "language/state.h"

/* Reports an error in how files are put together: in comments, quotes, conditions or blocks as a whole. */
void language_tell(struct language *language, struct span place, const char *format, ...)
  __attribute__((format(printf, 3, 4)));

/* Reports an error in what the text means, unless it is in the branch of a choice that is not chosen. */
void language_error(struct language *language, struct span place, const char *format, ...)
  __attribute__((format(printf, 3, 4)));

/* Leaves out what is not supported, a word of POV-Ray's or a colour: `what`, which is at the place or in the declaration of
 * the name used there. Without settings.lenient, and if it cannot be left out, that is an error, once a kind. In a
 * declaration it counts only where the declared name is used, because libraries declare more than a scene uses. */
void language_lacks(struct language *language, struct span place, struct span what);
/* At the end, warns of what settings.lenient has left out. */
void language_tell_left_out(struct language *language);

struct block language_block(const struct language *language, struct span place);
/* Whether no error has been reported since the block began. If one has, what is missing in it may be a consequence. */
bool language_sound(const struct language *language, const struct block *block);
/* Reports an error about a block, if the block is sound. */
void language_error_in(struct language *language, const struct block *block, struct span place, const char *text);

/* Reports a stated limit, and ends reading with STATUS_LIMIT. */
_Noreturn void language_limit(struct language *language, struct span place, const char *text);

/* Reports the last token, which is none of `count` expected ones. `is_word`: nor is it a word of the language. */
void syntax_error(struct language *language, bool is_word, const char *const expected[], int count);

/* Reports the character at which the scanner stopped. */
void character_error(struct language *language);

#endif

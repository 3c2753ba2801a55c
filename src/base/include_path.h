/* Finds the file that an #include names.
 *
 * Folders are searched as in POV-Ray: first the scene's, because POV-Ray is started there, then the includer's, then
 * those given. A name that ends in neither .inc nor .INC is first tried with each of these endings, in all folders, and
 * then by itself. A name that begins with / is a whole path.
 */
#ifndef PSCN_BASE_INCLUDE_PATH_H
#define PSCN_BASE_INCLUDE_PATH_H

#include <stddef.h>
#include <stdint.h>

#include "base/arena.h"
#include "base/source.h"

struct include_folders {
  const struct source *scene, *includer; /* may be the same */
  const char *const *others;             /* ended by NULL; or NULL */
};

/* Returns the path of the first file that exists, and which file it is. If none exists, *out_inode is 0, and the path
 * is the one beside the includer. NULL if memory is short. */
char *include_path(struct arena *arena, const struct include_folders *folders, const char *name, size_t length,
                   uint64_t *out_device, uint64_t *out_inode);

/* Whether a stranger may ask for that name: it is no whole path, and no part of it is "..". Then whether the file found
 * is, by its descriptor, in one of the folders or below it. A scene that is no file has only the folder in its name. */
bool include_is_modest(const char *name, size_t length);
bool include_is_below(const struct include_folders *folders, int file);

#endif

/* Where the file is that an #include names.
 *
 * Folders are looked through as POV-Ray does: that of the scene, which it is started in, that of the file that includes, those
 * given. Where a name ends in neither .inc nor .INC each is tried behind it first, in all folders, and then the name itself. A
 * name that begins with / is whole.
 */
#ifndef PSCN_LANGUAGE_INCLUDE_PATH_H
#define PSCN_LANGUAGE_INCLUDE_PATH_H

#include <stddef.h>
#include <stdint.h>

#include "base/arena.h"
#include "base/source.h"

struct include_folders {
  const struct source *scene, *includer; /* may be the same */
  const char *const *others;             /* ended by NULL; or NULL */
};

/* The path of the first file there is, and which file that is. *out_inode is 0 where there is none: then it is the path beside the
 * includer. NULL where memory is short. */
char *include_path(struct arena *arena, const struct include_folders *folders, const char *name, size_t length,
                   uint64_t *out_device, uint64_t *out_inode);

#endif

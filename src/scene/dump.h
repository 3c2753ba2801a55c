/* Writes a scene back as canonical text, readable by pscn and by POV-Ray 3.7.
 *
 * Every number is the shortest that reads back to the same double. Transforms are applied. The camera is location,
 * direction, right and up. Textures are declared by number in the order of their first use. `solver` statements are
 * inside #ifdef (pscn) and leave out defaults. Reading the text gives a scene whose dump is the same text, byte for
 * byte.
 */
#ifndef PSCN_SCENE_DUMP_H
#define PSCN_SCENE_DUMP_H

#include <stdio.h>

#include "base/status.h"
#include "scene/scene.h"

/* STATUS_FILE if writing fails (errno says why). Does not flush or close `file`. */
STATUS_MUST_CHECK enum status scene_dump(const struct scene *scene, FILE *file);

/* Only the patches, as `#declare NAME = union { ... }`, preceded by the textures they use. */
STATUS_MUST_CHECK enum status scene_dump_union(const struct scene *scene, const char *name, FILE *file);

#endif

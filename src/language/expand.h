/* From the tree of objects to the list of patches, each with its transforms applied, its texture and its solver; and to
 * the list of copies, the runs of patches that are one declared object, moved. */
#ifndef PSCN_LANGUAGE_EXPAND_H
#define PSCN_LANGUAGE_EXPAND_H

#include "language/language.h"
#include "language/objects.h"
#include "scene/scene.h"

/* Puts all patches of language->objects, with their textures and solvers, into the scene. `method` becomes the scene's
 * first. `parts`, if not NULL, becomes the list of the outermost objects. STATUS_INPUT after reporting that a point is
 * too large; STATUS_LIMIT. */
enum status objects_expand(struct language *language, const struct method *method, struct scene *scene,
                           struct language_parts *parts) STATUS_MUST_CHECK;

#endif

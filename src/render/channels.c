/* The channels of a picture: their table, and the reading of lists. */
#include "render/channels.h"

#include <string.h>

static const struct channel_traits TRAITS[CHANNEL_KINDS] = {
  [CHANNEL_RGB] = {"rgb", "linear colour, mean of the samples", 3, {"R", "G", "B"}, false},
  [CHANNEL_COVERAGE] = {"coverage", "share of the samples that hit a patch", 1, {"coverage"}, true},
  [CHANNEL_DEPTH] = {"depth", "distance from the camera; a miss: infinity", 1, {"depth"}, true},
  [CHANNEL_U] = {"u", "parameter u of the whole patch; a miss: 0", 1, {"u"}, true},
  [CHANNEL_V] = {"v", "parameter v of the whole patch; a miss: 0", 1, {"v"}, true},
  [CHANNEL_PATCH] = {"patch", "number of the patch, from 0; a miss: -1", 1, {"patch"}, true},
  [CHANNEL_NORMAL] =
    {"normal", "unit normal facing the camera; a miss: 0", 3, {"normal.x", "normal.y", "normal.z"}, true},
  [CHANNEL_STATUS] = {"status", "0 miss, 1 hit, both certain; 2 miss, 3 hit, both grazing", 1, {"status"}, true},
  [CHANNEL_ITERATIONS] = {"iterations", "steps of the solver for all roots of all leaves", 1, {"iterations"}, true},
  [CHANNEL_ROOTS] = {"roots", "number of roots that the solver found on all leaves", 1, {"roots"}, true},
  [CHANNEL_RESIDUAL] =
    {"residual", "|P|/delta of the root that is the hit (eq 11), below 1 accurate; a miss: 0", 1, {"residual"}, true},
  [CHANNEL_DEVIATION] =
    {"deviation", "relative, from the certified distance; infinity if only one is a hit", 1, {"deviation"}, true},
};

const struct channel_traits *channel_traits(enum channel_kind kind) { return &TRAITS[kind]; }

/* Returns CHANNEL_KINDS if there is none of that name. */
static enum channel_kind find(const char *name, size_t length)
{
  int kind = 0;
  while (kind < CHANNEL_KINDS && (strlen(TRAITS[kind].name) != length || memcmp(TRAITS[kind].name, name, length) != 0))
    kind++;
  return (enum channel_kind)kind;
}

bool channel_list_has(const struct channel_list *list, enum channel_kind kind)
{
  bool has = false;
  for (size_t k = 0; k < list->count; k++) has |= list->kind[k] == kind;
  return has;
}

bool channel_list_measures(const struct channel_list *list)
{
  return channel_list_has(list, CHANNEL_ITERATIONS) || channel_list_has(list, CHANNEL_ROOTS) ||
         channel_list_has(list, CHANNEL_RESIDUAL);
}

bool channel_list_is_rgb(const struct channel_list *list) { return list->count == 1 && list->kind[0] == CHANNEL_RGB; }

bool channel_list_parse(const char *text, struct channel_list *out, const char **out_bad, size_t *out_bad_length)
{
  struct channel_list list = {0};
  bool seen[CHANNEL_KINDS + 1] = {[CHANNEL_KINDS] = true};
  for (const char *name = text;; name++) {
    const size_t length = strcspn(name, ",");
    const enum channel_kind kind = find(name, length);
    if (seen[kind]) {
      *out_bad = name;
      *out_bad_length = length;
      return false;
    }
    seen[kind] = true;
    list.kind[list.count++] = kind;
    list.width += TRAITS[kind].width;
    name += length;
    if (*name == '\0') break;
  }
  *out = list;
  return true;
}

/* Finds included files. */
#include "base/include_path.h"

#include <stdio.h>
#include <string.h>

/* The path of the file of that name and ending in a folder, which is folder[0 .. length-1] with or without a final
 * slash. */
static char *path_in(struct arena *arena, const char *folder, size_t folder_length, const char *name, size_t length,
                     const char *ending)
{
  const size_t before = name[0] == '/' ? 0 : folder_length, size = before + length + strlen(ending) + 2;
  const char *slash = before > 0 && folder[before - 1] != '/' ? "/" : "";
  char *path = arena_alloc(arena, size, 1);
  if (path) snprintf(path, size, "%.*s%s%.*s%s", (int)before, folder, slash, (int)length, name, ending);
  return path;
}

/* The length of a file's folder in its name, slash included. */
static size_t length_of_folder(const struct source *source)
{
  const char *slash = strrchr(source->name, '/');
  return slash ? (size_t)(slash - source->name) + 1 : 0;
}

/* The k-th folder to look in, or NULL. */
static const char *folder_at(const struct include_folders *folders, size_t k, size_t *out_length)
{
  if (k > 1) {
    const char *folder = folders->others ? folders->others[k - 2] : NULL;
    *out_length = folder ? strlen(folder) : 0;
    return folder;
  }
  const struct source *source = k == 0 ? folders->scene : folders->includer;
  *out_length = length_of_folder(source);
  return source->name;
}

/* The path with that ending. */
static char *path_of(struct arena *arena, const struct include_folders *folders, const char *name, size_t length,
                     const char *ending, uint64_t *out_device, uint64_t *out_inode)
{
  char *beside = NULL;
  const char *folder;
  size_t folder_length;
  for (size_t k = folders->scene == folders->includer; (folder = folder_at(folders, k, &folder_length)) != NULL; k++) {
    char *path = path_in(arena, folder, folder_length, name, length, ending);
    if (!path || source_identify(path, out_device, out_inode)) return path;
    if (k == 1) beside = path;
  }
  *out_device = *out_inode = 0;
  return beside;
}

char *include_path(struct arena *arena, const struct include_folders *folders, const char *name, size_t length,
                   uint64_t *out_device, uint64_t *out_inode)
{
  static const char *const endings[] = {".inc", ".INC", ""};
  const char *end = length < 4 ? "" : name + length - 4;
  const bool whole = strncmp(end, ".inc", 4) == 0 || strncmp(end, ".INC", 4) == 0;
  char *path = NULL;
  *out_inode = 0;
  for (int k = whole ? 2 : 0; k < 3 && *out_inode == 0; k++) {
    path = path_of(arena, folders, name, length, endings[k], out_device, out_inode);
    if (!path) return NULL;
  }
  return path;
}

bool include_is_modest(const char *name, size_t length)
{
  bool modest = length > 0 && name[0] != '/';
  for (size_t begin = 0, end; begin < length && modest; begin = end + 1) {
    for (end = begin; end < length && name[end] != '/';) end++;
    modest = !(end - begin == 2 && memcmp(name + begin, "..", 2) == 0);
  }
  return modest;
}

bool include_is_below(const struct include_folders *folders, int file)
{
  const struct source *scene = folders->scene;
  const size_t length = length_of_folder(scene);
  bool below = (scene->inode != 0 || length > 0) && input_is_below(file, scene->name, length);
  for (size_t k = 0; folders->others && folders->others[k] && !below; k++)
    below = input_is_below(file, folders->others[k], strlen(folders->others[k]));
  return below;
}

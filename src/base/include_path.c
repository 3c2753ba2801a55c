/* Finds included files. */
#include "base/include_path.h"

#include <string.h>

/* The endings to try behind the name, in order, up to NULL. */
static const char *const *endings_of(const char *name, size_t length)
{
  static const char *const as_it_is[] = {"", NULL}, *const longer_first[] = {".inc", ".INC", "", NULL};
  const char *end = length < 4 ? "" : name + length - 4;
  return strncmp(end, ".inc", 4) == 0 || strncmp(end, ".INC", 4) == 0 ? as_it_is : longer_first;
}

/* A file name of an #include, and the ending to try behind it. */
struct wanted {
  const char *name, *ending;
  size_t length;
};

/* The file's path in a folder, which is folder[0 .. length-1] with or without a final slash. */
static char *path_in(struct arena *arena, const char *folder, size_t folder_length, const struct wanted *file)
{
  const size_t before = file->name[0] == '/' ? 0 : folder_length, ending = strlen(file->ending);
  const bool slash = before > 0 && folder[before - 1] != '/';
  char *path = arena_alloc(arena, before + slash + file->length + ending + 1, 1);
  if (!path) return NULL;
  memcpy(path, folder, before);
  if (slash) path[before] = '/';
  memcpy(path + before + slash, file->name, file->length);
  memcpy(path + before + slash + file->length, file->ending, ending);
  return path;
}

/* The length of a file's folder in its name, slash included. */
static size_t folder_length(const struct source *source)
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
  *out_length = folder_length(source);
  return source->name;
}

/* The path with that ending. */
static char *path_of(struct arena *arena, const struct include_folders *folders, const struct wanted *file,
                     uint64_t *out_device, uint64_t *out_inode)
{
  char *beside = NULL;
  const char *folder;
  size_t length;
  for (size_t k = folders->scene == folders->includer; (folder = folder_at(folders, k, &length)) != NULL; k++) {
    char *path = path_in(arena, folder, length, file);
    if (!path || source_identify(path, out_device, out_inode)) return path;
    if (k == 1) beside = path;
  }
  *out_device = *out_inode = 0;
  return beside;
}

char *include_path(struct arena *arena, const struct include_folders *folders, const char *name, size_t length,
                   uint64_t *out_device, uint64_t *out_inode)
{
  char *path = NULL;
  *out_inode = 0;
  for (const char *const *ending = endings_of(name, length); *ending && *out_inode == 0; ending++) {
    path = path_of(arena, folders, &(struct wanted){name, *ending, length}, out_device, out_inode);
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
  const size_t length = folder_length(scene);
  bool below = (scene->inode != 0 || length > 0) && input_is_below(file, scene->name, length);
  for (size_t k = 0; folders->others && folders->others[k] && !below; k++)
    below = input_is_below(file, folders->others[k], strlen(folders->others[k]));
  return below;
}

/* Modules of ours. PSCN_MODULE_FOLDERS, from the build: where they may be, absolute or relative to the program. */
#include "base/module.h"

#include <dlfcn.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

void *module_open(const char *name, int flags)
{
  static const char *const folders[] = {PSCN_MODULE_FOLDERS};
  char program[PATH_MAX], path[2 * PATH_MAX];
  const ssize_t length = readlink("/proc/self/exe", program, sizeof program - 1);
  program[length < 0 ? 0 : length] = '\0';
  char *end = strrchr(program, '/');
  if (end != NULL) end[1] = '\0';
  for (size_t k = 0; k < sizeof folders / sizeof folders[0]; k++) {
    if (folders[k][0] != '/' && end == NULL) continue;
    const int size = snprintf(path, sizeof path, "%s%s/%s", folders[k][0] == '/' ? "" : program, folders[k], name);
    if (size < (int)sizeof path && access(path, F_OK) == 0) return dlopen(path, flags);
  }
  return dlopen(name, flags);
}

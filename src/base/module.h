/* Modules of ours, loaded while the program runs. */
#ifndef PSCN_BASE_MODULE_H
#define PSCN_BASE_MODULE_H

/* dlopen of one of our modules, with its flags. A module is found from the program's own file or where it was installed;
 * otherwise by its name, as dlopen does, which is how the tests of the build tree find it. A run path would instead apply
 * to all libraries of the program, those of the system included. NULL on failure, with the reason in dlerror. */
void *module_open(const char *name, int flags);

#endif

/* Classes of patches, and of rays at them, as pictures have them: for causes.c. */
#ifndef TESTS_STABILITY_NET_CLASSES_H
#define TESTS_STABILITY_NET_CLASSES_H

#include <stddef.h>

#include "intersect/intersect.h"
#include "random.h"

enum { RAYS = 32 }; /* at a patch */

typedef double net4[4][4][3];

struct net_class {
  const char *name;
  void (*make)(struct random *random, net4 P, struct ray rays[RAYS]);
};

enum { NET_FIELD = 0, NET_RANDOM = 3 }; /* the places of two of them */

size_t net_class_count(void);
const struct net_class *net_class_at(size_t index); /* index < the count */

#endif

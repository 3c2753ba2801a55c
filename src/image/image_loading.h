/* OpenImageIO loaded beside other work, which need not wait for it: that takes longer than a small picture to
 * render. */
#ifndef PSCN_IMAGE_IMAGE_LOADING_H
#define PSCN_IMAGE_IMAGE_LOADING_H

#include <pthread.h>
#include <stdatomic.h>

#include "image/image_file.h"

struct image_loading {
  pthread_t thread;
  bool running;           /* image_loading_end has not waited for it yet */
  atomic_int failed;      /* turns nonzero, at any time, where it can not be loaded */
  _Atomic double seconds; /* CPU time of all of it, when it is done */
  enum status status;
  char message[IMAGE_MESSAGE_SIZE];
};

/* Starts it. `loading` stays where it is until image_loading_end, which must follow. */
void image_loading_begin(struct image_loading *loading);

/* CPU seconds that it has taken until now: they are in the process's, but not of the other work. Between image_loading_begin and the
 * end of what follows; by one thread. */
double image_loading_seconds(const struct image_loading *loading);

/* Waits for the end of it, and answers as image_file_ready; the message is the loading's own. */
enum status image_loading_end(struct image_loading *loading, const char **out_message) STATUS_MUST_CHECK;

#endif

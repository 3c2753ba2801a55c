/* Loads OpenImageIO in parallel with other work, because that takes longer than rendering a small picture. Nothing is
 * loaded, and all is well, if it is not needed. */
#ifndef PSCN_IMAGE_IMAGE_LOADING_H
#define PSCN_IMAGE_IMAGE_LOADING_H

#include <pthread.h>
#include <stdatomic.h>

#include "image/image_file.h"

struct image_loading {
  pthread_t thread;
  bool running;           /* image_loading_end has not yet waited for it */
  atomic_int failed;      /* turns nonzero, at any time, if loading fails */
  _Atomic double seconds; /* CPU time of loading, once it is done */
  atomic_bool done;
  enum status status;
  char message[IMAGE_MESSAGE_SIZE];
};

/* Starts loading. `loading` must stay in place until image_loading_end, which must follow. */
void image_loading_begin(struct image_loading *loading, bool needed);

/* CPU seconds that loading has taken so far. They are in the process's time, but not in the other work's. To be called
 * after image_loading_begin, also after image_loading_end, by one thread. */
double image_loading_seconds(const struct image_loading *loading);

/* Whether loading has ended, well or not, or was never begun. */
bool image_loading_done(const struct image_loading *loading);

/* Waits until loading ends, and returns what image_file_ready does. `loading` owns the message. */
enum status image_loading_end(struct image_loading *loading, const char **out_message) STATUS_MUST_CHECK;

#endif

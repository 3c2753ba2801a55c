/* Calls that fail. */
#include "fault/calls.h"

#include <errno.h>
#include <execinfo.h>
#include <pthread.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

enum call failing;
atomic_long *left;
bool armed;

/* An allocation's place: its caller, the caller's caller, and so on; memory.c and arena.c are among them. */
enum { MOST_PLACES = 4096, FRAMES = 8 };

long place_count;
static void *places[MOST_PLACES][FRAMES];
static pthread_mutex_t places_lock = PTHREAD_MUTEX_INITIALIZER;

static long place_here(void)
{
  void *frames[FRAMES] = {NULL};
  backtrace(frames, FRAMES);
  pthread_mutex_lock(&places_lock);
  long k = 0;
  while (k < place_count && memcmp(places[k], frames, sizeof places[k]) != 0) k++;
  if (k == place_count && k < MOST_PLACES) memcpy(places[place_count++], frames, sizeof places[k]);
  pthread_mutex_unlock(&places_lock);
  return k;
}

static bool fails(enum call call)
{
  if (!armed || call != (failing == ALLOCATE_AT ? ALLOCATE : failing)) return false;
  if (failing != ALLOCATE_AT) return atomic_fetch_sub(left, 1) == 0;
  long here = place_here();
  return atomic_compare_exchange_strong(left, &here, -1);
}

static int failure(int reason)
{
  errno = reason;
  return -1;
}

void *__real_malloc(size_t size);
void *__real_calloc(size_t count, size_t size);
void *__real_realloc(void *block, size_t size);
char *__real_strdup(const char *text);
int __real_pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*run)(void *), void *argument);
int __real_open(const char *path, int flags, ...);
ssize_t __real_write(int file, const void *bytes, size_t size);
int __real_fchmod(int file, mode_t mode);
int __real_linkat(int from_folder, const char *from, int to_folder, const char *to, int flags);
int __real_rename(const char *from, const char *to);
int __real_close(int file);
void *__real_mmap(void *place, size_t size, int protection, int flags, int file, off_t offset);
FILE *__real_fopen(const char *path, const char *mode);
int __real_fclose(FILE *file);
int __real_mkdir(const char *path, mode_t mode);
char *__real_mkdtemp(char *name);
int __real_dup(int file);
pid_t __real_fork(void);
int __real_pipe(int files[2]);
void *__wrap_malloc(size_t size);
void *__wrap_calloc(size_t count, size_t size);
void *__wrap_realloc(void *block, size_t size);
char *__wrap_strdup(const char *text);
int __wrap_pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*run)(void *), void *argument);
int __wrap_open(const char *path, int flags, ...);
ssize_t __wrap_write(int file, const void *bytes, size_t size);
int __wrap_fsync(int file);
int __wrap_fchmod(int file, mode_t mode);
int __wrap_linkat(int from_folder, const char *from, int to_folder, const char *to, int flags);
int __wrap_rename(const char *from, const char *to);
int __wrap_close(int file);
void *__wrap_mmap(void *place, size_t size, int protection, int flags, int file, off_t offset);
FILE *__wrap_fopen(const char *path, const char *mode);
int __wrap_fclose(FILE *file);
int __wrap_mkdir(const char *path, mode_t mode);
char *__wrap_mkdtemp(char *name);
int __wrap_dup(int file);
pid_t __wrap_fork(void);
int __wrap_pipe(int files[2]);

void *__wrap_malloc(size_t size) { return fails(ALLOCATE) ? NULL : __real_malloc(size); }
void *__wrap_calloc(size_t count, size_t size) { return fails(ALLOCATE) ? NULL : __real_calloc(count, size); }
void *__wrap_realloc(void *block, size_t size) { return fails(ALLOCATE) ? NULL : __real_realloc(block, size); }
char *__wrap_strdup(const char *text) { return fails(ALLOCATE) ? NULL : __real_strdup(text); }

int __wrap_pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*run)(void *), void *argument)
{
  return fails(THREAD) ? EAGAIN : __real_pthread_create(thread, attributes, run, argument);
}

int __wrap_open(const char *path, int flags, ...)
{
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = va_arg(arguments, mode_t); /* undefined if there is none */
  va_end(arguments);
  return fails(OPEN) ? failure(EMFILE) : __real_open(path, flags, mode);
}

ssize_t __wrap_write(int file, const void *bytes, size_t size)
{
  return fails(WRITE) ? failure(ENOSPC) : __real_write(file, bytes, size);
}

/* Nothing here need outlast the machine, and a disk would take most of the test's time. */
int __wrap_fsync(int file)
{
  (void)file;
  return fails(FSYNC) ? failure(EIO) : 0;
}

int __wrap_fchmod(int file, mode_t mode) { return fails(FCHMOD) ? failure(EPERM) : __real_fchmod(file, mode); }
int __wrap_rename(const char *from, const char *to) { return fails(RENAME) ? failure(EIO) : __real_rename(from, to); }

int __wrap_linkat(int from_folder, const char *from, int to_folder, const char *to, int flags)
{
  return fails(LINK) ? failure(ENOSPC) : __real_linkat(from_folder, from, to_folder, to, flags);
}

int __wrap_close(int file)
{
  const bool told = fails(CLOSE);
  const int result = __real_close(file); /* a file is closed even if that fails */
  return told ? failure(EIO) : result;
}

int __wrap_fclose(FILE *file)
{
  const bool told = fails(FCLOSE);
  const int result = __real_fclose(file); /* the same */
  return told ? failure(ENOSPC) : result;
}

FILE *__wrap_fopen(const char *path, const char *mode)
{
  return fails(FOPEN) ? (void)failure(EMFILE), NULL : __real_fopen(path, mode);
}

void *__wrap_mmap(void *place, size_t size, int protection, int flags, int file, off_t offset)
{
  return fails(MMAP) ? (void)failure(ENOMEM), MAP_FAILED : __real_mmap(place, size, protection, flags, file, offset);
}

int __wrap_mkdir(const char *path, mode_t mode) { return fails(MKDIR) ? failure(EACCES) : __real_mkdir(path, mode); }
char *__wrap_mkdtemp(char *name) { return fails(MKDTEMP) ? (void)failure(ENOSPC), NULL : __real_mkdtemp(name); }
int __wrap_dup(int file) { return fails(DUP) ? failure(EMFILE) : __real_dup(file); }
pid_t __wrap_fork(void) { return fails(FORK) ? failure(EAGAIN) : __real_fork(); }
int __wrap_pipe(int files[2]) { return fails(PIPE) ? failure(EMFILE) : __real_pipe(files); }

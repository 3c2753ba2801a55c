/* Files appear whole or not at all. */
#define _GNU_SOURCE /* O_TMPFILE */
#include "base/atomic_file.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <unistd.h>

#include "cmocka_test.h"
#include "files.h"

/* This many renamings succeed before one fails (the linker passes them here); negative: all do. */
static long rename_left = -1;

int __real_rename(const char *from, const char *to);
int __wrap_rename(const char *from, const char *to);

int __wrap_rename(const char *from, const char *to)
{
  if (rename_left < 0 || rename_left-- > 0) return __real_rename(from, to);
  errno = EIO;
  return -1;
}

/* The error of opening a file without a name, as on file systems that have none of these; 0: it succeeds. */
static int no_unnamed;

/* This many temporary names are taken by somebody else. */
static int guessed;

/* The permissions that the last file was created with. */
static mode_t made_mode;

int __real_open(const char *path, int flags, ...);
int __wrap_open(const char *path, int flags, ...);

int __wrap_open(const char *path, int flags, ...)
{
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = flags & O_CREAT || (flags & O_TMPFILE) == O_TMPFILE ? va_arg(arguments, mode_t) : 0;
  va_end(arguments);
  errno = (flags & O_TMPFILE) == O_TMPFILE ? no_unnamed : (flags & O_EXCL) != 0 && guessed-- > 0 ? EEXIST : 0;
  if (errno != 0) return -1;
  if (mode != 0) made_mode = mode;
  return __real_open(path, flags, mode);
}

/* The errors of asking whether a file may be written, and of closing one; 0: none. */
static int access_reason, close_reason;

int __real_access(const char *path, int how);
int __wrap_access(const char *path, int how);

int __wrap_access(const char *path, int how)
{
  errno = how == W_OK ? access_reason : 0;
  return errno != 0 ? -1 : __real_access(path, how);
}

int __real_close(int descriptor);
int __wrap_close(int descriptor);

int __wrap_close(int descriptor)
{
  const int result = __real_close(descriptor);
  if (result == 0) errno = close_reason;
  return result == 0 && close_reason != 0 ? -1 : result;
}

/* What the system says of the file "a" and of its folder, unless NULL: attributes, owners, mode; and the user. */
static const struct told {
  uint64_t attributes;
  mode_t folder_mode;
  uid_t owner, folder_owner, user;
} * told;

int __real_statx(int folder, const char *path, int flags, unsigned mask, struct statx *out);
int __wrap_statx(int folder, const char *path, int flags, unsigned mask, struct statx *out);

int __wrap_statx(int folder, const char *path, int flags, unsigned mask, struct statx *out)
{
  const size_t length = strlen(path);
  const bool is_a = length > 2 && strcmp(path + length - 2, "/a") == 0;
  const int result = __real_statx(folder, path, flags, mask, out);
  if (result != 0 || told == NULL) return result;
  if (is_a) out->stx_attributes = told->attributes, out->stx_uid = told->owner;
  else out->stx_mode = (uint16_t)(S_IFDIR | told->folder_mode), out->stx_uid = told->folder_owner;
  return result;
}

uid_t __real_geteuid(void);
uid_t __wrap_geteuid(void);

uid_t __wrap_geteuid(void) { return told == NULL ? __real_geteuid() : told->user; }

/* The permissions of the unfinished file when it is flushed to the disk; -1: it has no name. */
static int unfinished_mode;

/* The error of flushing a regular file; 0: none. And the number of folders flushed. */
static int fsync_reason, folders_flushed;

int __real_fsync(int descriptor);
int __wrap_fsync(int descriptor);

int __wrap_fsync(int descriptor)
{
  struct stat info;
  if (fstat(descriptor, &info) == 0 && S_ISREG(info.st_mode))
    unfinished_mode = info.st_nlink == 0 ? -1 : (int)(info.st_mode & 07777);
  folders_flushed += S_ISDIR(info.st_mode);
  errno = fsync_reason;
  return fsync_reason != 0 ? -1 : __real_fsync(descriptor);
}

static int count_entries(void)
{
  int count = 0;
  DIR *folder = opendir(".");
  assert_non_null(folder);
  for (struct dirent *entry = readdir(folder); entry != NULL; entry = readdir(folder))
    count += strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0;
  closedir(folder);
  return count;
}

static mode_t mode_of(const char *path)
{
  struct stat info;
  assert_int_equal(lstat(path, &info), 0);
  return info.st_mode & 07777;
}

static enum status write_text(const char *path, const char *text, int *out_errno)
{
  size_t failed;
  return atomic_files_write(&(struct atomic_file){path, text, strlen(text)}, 1, NULL, &failed, out_errno);
}

IN_FOLDER(new_file_has_the_masks_permissions)
{
  int reason = -1;
  folders_flushed = 0;
  assert_int_equal(atomic_file_probe("a", &reason), STATUS_OK);
  assert_int_equal(count_entries(), 0);
  assert_int_equal(write_text("a", "text", &reason), STATUS_OK);
  assert_int_equal(reason, 0);
  assert_int_equal(folders_flushed, 1); /* otherwise a power failure may lose the name */
  expect_file("a", "text");
  assert_int_equal(mode_of("a"), 0644);
  assert_int_equal(count_entries(), 1);
}

IN_FOLDER(old_file_is_replaced_and_keeps_its_permissions)
{
  int reason;
  put_text("a", "old and longer");
  assert_int_equal(chmod("a", 04750), 0);
  assert_int_equal(link("a", "other"), 0);
  assert_int_equal(write_text("a", "new", &reason), STATUS_OK);
  expect_file("a", "new");
  expect_file("other", "old and longer"); /* never written in place */
  assert_int_equal(mode_of("a"), 04750);
}

/* Although its folder could be written. */
IN_FOLDER(what_may_not_be_written_is_not_replaced)
{
  int reason = 0;
  put_text("a", "old");
  access_reason = EACCES; /* root may write all files */
  const enum status probed = atomic_file_probe("a", &reason), written = write_text("a", "new", &reason);
  access_reason = 0;
  assert_true(probed == STATUS_FILE && written == STATUS_FILE && reason == EACCES);
  expect_file("a", "old");
}

/* A file that is a mount point, append-only, or another user's in a sticky folder is refused before the work; but not
 * in one's own folder, nor for root. */
IN_FOLDER(what_cannot_be_replaced_is_known_before)
{
#if defined(STATX_ATTR_MOUNT_ROOT)
  static const struct {
    struct told told;
    int reason;
  } cases[] = {{{STATX_ATTR_MOUNT_ROOT, 0777, 8, 8, 8}, EBUSY},
               {{STATX_ATTR_APPEND, 0777, 8, 8, 8}, EPERM},
               {{0, 01777, 9, 9, 8}, EPERM},
               {{0, 01777, 9, 9, 0}, 0},
               {{0, 01777, 8, 9, 8}, 0},
               {{0, 01777, 9, 8, 8}, 0},
               {{0, 0777, 9, 9, 8}, 0}};
  put_text("a", "old");
  for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
    int reason = -1;
    told = &cases[k].told;
    const enum status status = atomic_file_probe("a", &reason);
    told = NULL;
    assert_int_equal(reason, cases[k].reason);
    assert_int_equal(status, reason == 0 ? STATUS_OK : STATUS_FILE);
  }
#else
  skip();
#endif
}

IN_FOLDER(names_that_others_made_are_passed_over)
{
  int reason;
  if (no_unnamed == 0) return; /* no name is created */
  guessed = 3;
  assert_int_equal(write_text("a", "text", &reason), STATUS_OK);
  guessed = 1000;
  assert_int_equal(write_text("b", "text", &reason), STATUS_FILE);
  guessed = 0;
  assert_int_equal(reason, EEXIST);
  assert_int_equal(count_entries(), 1);
}

IN_FOLDER(impossible_names_have_their_reasons)
{
  char long_name[300];
  memset(long_name, 'x', sizeof long_name - 1);
  long_name[sizeof long_name - 1] = '\0';
  assert_int_equal(symlink("nowhere", "dangling"), 0);
  const struct {
    const char *path;
    int reason;
  } cases[] = {
    {"", ENOENT},        {".", EISDIR}, {"no/such/folder", ENOENT}, {"/dev/null/x", ENOTDIR}, {long_name, ENAMETOOLONG},
    {"dangling", ENOENT}};
  for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
    int reason = 0;
    assert_int_equal(atomic_file_probe(cases[k].path, &reason), STATUS_FILE);
    assert_int_equal(reason, cases[k].reason);
    assert_int_equal(write_text(cases[k].path, "text", &reason), STATUS_FILE);
    assert_int_equal(reason, cases[k].reason);
  }
  assert_int_equal(count_entries(), 1);
}

IN_FOLDER(device_is_written_to_not_replaced)
{
  int reason = 0;
  if (access("/dev/full", W_OK) != 0) skip();
  assert_int_equal(symlink("/dev/full", "full"), 0);
  assert_int_equal(atomic_file_probe("full", &reason), STATUS_OK);
  assert_int_equal(write_text("full", "text", &reason), STATUS_FILE);
  assert_int_equal(reason, ENOSPC);
  assert_int_equal(symlink("/dev/null", "null"), 0);
  close_reason = EIO; /* some file systems report only then that nothing was written */
  const enum status closed = write_text("null", "text", &reason);
  close_reason = 0;
  assert_true(closed == STATUS_FILE && reason == EIO);
  struct stat info;
  assert_int_equal(stat("full", &info), 0);
  assert_true(S_ISCHR(info.st_mode));
}

IN_FOLDER(stopped_write_leaves_the_old_file)
{
  int reason = 0;
  atomic_int stop = 1;
  size_t failed;
  const struct atomic_file file = {"a", "new", 3};
  put_text("a", "old");
  assert_int_equal(atomic_files_write(&file, 1, &stop, &failed, &reason), STATUS_INTERRUPTED);
  expect_file("a", "old");
  assert_int_equal(count_entries(), 1);
}

/* Nor does it remove a file that is to go. */
IN_FOLDER(stopped_writing_takes_nothing_away)
{
  int reason = 0;
  atomic_int stop = 1;
  size_t failed;
  const struct atomic_file file = {"a", NULL, 0};
  put_text("a", "old");
  assert_int_equal(atomic_files_write(&file, 1, &stop, &failed, &reason), STATUS_INTERRUPTED);
  expect_file("a", "old");
}

/* A file system that cannot flush is no failure; a disk that fails to is. */
IN_FOLDER(what_is_not_on_the_disk_is_not_written)
{
  int reason = 0;
  size_t failed;
  const struct atomic_file file = {"a", "new", 3};
  put_text("a", "old");
  fsync_reason = EIO;
  assert_int_equal(atomic_files_write(&file, 1, NULL, &failed, &reason), STATUS_FILE);
  assert_int_equal(reason, EIO);
  expect_file("a", "old");
  fsync_reason = EINVAL;
  assert_int_equal(atomic_files_write(&file, 1, NULL, &failed, &reason), STATUS_OK);
  fsync_reason = 0;
  expect_file("a", "new");
  assert_int_equal(count_entries(), 1);
}

/* A bell that keeps ringing: its first stroke may come before anybody waits. */
static atomic_int rung;
static void ring(int signal) { atomic_store(&rung, signal); }

IN_FOLDER(a_signal_ends_the_wait_for_a_reader)
{
  int reason = 0;
  size_t failed;
  const struct atomic_file file = {"pipe", "text", 4};
  const struct itimerval often = {{0, 10000}, {0, 10000}}, never = {{0, 0}, {0, 0}};
  struct sigaction action = {.sa_handler = ring}, before;
  assert_int_equal(mkfifo("pipe", 0600), 0);
  assert_int_equal(sigaction(SIGALRM, &action, &before), 0);
  assert_int_equal(setitimer(ITIMER_REAL, &often, NULL), 0);
  atomic_store(&rung, 0);
  const enum status status = atomic_files_write(&file, 1, &rung, &failed, &reason);
  assert_int_equal(setitimer(ITIMER_REAL, &never, NULL), 0);
  assert_int_equal(sigaction(SIGALRM, &before, NULL), 0);
  assert_int_equal(status, STATUS_INTERRUPTED);
  assert_int_equal(count_entries(), 1);
}

/* Nobody can open a file while it is written; or, if it needs a name, only those who could open the old one. */
IN_FOLDER(unfinished_files_are_private)
{
  int reason;
  put_text("a", "old");
  assert_int_equal(chmod("a", 0600), 0);
  assert_int_equal(write_text("a", "new", &reason), STATUS_OK);
  assert_int_equal(made_mode, 0600); /* from the start: whoever opens it then could read it later */
  assert_int_equal(unfinished_mode, no_unnamed != 0 ? 0600 : -1);
  assert_int_equal(mode_of("a"), 0600);
}

/* Of several files all appear, or none, and the old ones stay. The last name is a folder, found only when everything is
 * written. */
IN_FOLDER(several_files_appear_together)
{
  struct atomic_file files[] = {{"first", "new", 3}, {"second", "new", 3}, {"gone", NULL, 0}, {"last", "new", 3}};
  size_t failed;
  int reason;
  put_text("first", "old");
  put_text("gone", "old");
  assert_int_equal(mkdir("last", 0777), 0);
  assert_int_equal(atomic_files_write(files, 4, NULL, &failed, &reason), STATUS_FILE);
  assert_true(failed == 3 && reason == EISDIR && count_entries() == 3);
  expect_file("first", "old");
  assert_int_equal(rmdir("last"), 0);
  assert_int_equal(atomic_files_write(files, 4, NULL, &failed, &reason), STATUS_OK);
  assert_int_equal(count_entries(), 3);
  expect_file("first", "new");
  expect_file("second", "new");
  expect_file("last", "new");
  atomic_int stop = 2;
  files[0].bytes = "two", files[1].bytes = NULL;
  assert_int_equal(atomic_files_write(files, 4, &stop, &failed, &reason), STATUS_INTERRUPTED);
  expect_file("first", "new");
  assert_int_equal(count_entries(), 3);
}

/* A file to be removed that another process has removed meanwhile is no failure. Here the file before it in the list is
 * the same one. */
IN_FOLDER(a_file_may_go_twice)
{
  const struct atomic_file files[] = {{"first", "new", 3}, {"gone", NULL, 0}, {"gone", NULL, 0}};
  size_t failed;
  int reason;
  put_text("first", "old");
  put_text("gone", "old");
  assert_int_equal(atomic_files_write(files, 3, NULL, &failed, &reason), STATUS_OK);
  assert_int_equal(count_entries(), 1);
  expect_file("first", "new");
}

/* The same, if the last file cannot get its name. */
IN_FOLDER(a_failing_name_undoes_those_before)
{
  const struct atomic_file files[] = {
    {"kept", "new", 3}, {"made", "new", 3}, {"removed", NULL, 0}, {"there", "new", 3}};
  size_t failed;
  int reason;
  put_text("kept", "old");
  put_text("removed", "old");
  put_text("there", "old");
  rename_left = no_unnamed != 0 ? 2 : 1; /* those of "kept", and of "made" unless it is linked; that of "there" fails */
  assert_int_equal(atomic_files_write(files, 4, NULL, &failed, &reason), STATUS_FILE);
  rename_left = -1;
  assert_true(failed == 3 && reason == EIO && count_entries() == 3);
  expect_file("kept", "old");
  expect_file("removed", "old");
  expect_file("there", "old");
}

/* Of a link only the name is removed or replaced: what it points to may be somebody else's. */
IN_FOLDER(a_link_goes_without_its_file)
{
  struct atomic_file files[] = {{"link", NULL, 0}, {"last", "new", 3}};
  size_t failed;
  int reason;
  put_text("far", "old");
  assert_int_equal(symlink("far", "link"), 0);
  assert_int_equal(mkdir("last", 0777), 0);
  assert_int_equal(atomic_files_write(files, 2, NULL, &failed, &reason), STATUS_FILE);
  expect_file("link", "old");
  assert_int_equal(rmdir("last"), 0);
  assert_int_equal(atomic_files_write(files, 1, NULL, &failed, &reason), STATUS_OK);
  expect_file("far", "old");
  assert_int_equal(count_entries(), 1);
  assert_int_equal(symlink("far", "link"), 0);
  assert_int_equal(atomic_file_put(&(struct atomic_file){"link", "new", 3}, &reason), STATUS_OK);
  expect_file("link", "new");
  expect_file("far", "old");
}

int main(void)
{
  umask(022);
  int failed = test_run();
  const int reasons[] = {EOPNOTSUPP, EISDIR, EINVAL}; /* the last two from systems that do not know such files */
  for (size_t k = 0; k < sizeof reasons / sizeof *reasons; k++) {
    no_unnamed = reasons[k];
    failed += test_run();
  }
  return failed;
}

/* Files that appear whole or not at all. */
#define _GNU_SOURCE /* O_TMPFILE */
#include "base/atomic_file.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <unistd.h>

#include "cmocka_test.h"

/* Renamings that succeed before one fails (the linker hands them over to us); negative: all do. */
static long rename_left = -1;

int __real_rename(const char *from, const char *to);
int __wrap_rename(const char *from, const char *to);

int __wrap_rename(const char *from, const char *to)
{
  if (rename_left < 0 || rename_left-- > 0) return __real_rename(from, to);
  errno = EIO;
  return -1;
}

/* Whether the file system has no files without a name. */
static bool no_unnamed;

int __real_open(const char *path, int flags, ...);
int __wrap_open(const char *path, int flags, ...);

int __wrap_open(const char *path, int flags, ...)
{
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = flags & O_CREAT || (flags & O_TMPFILE) == O_TMPFILE ? va_arg(arguments, mode_t) : 0;
  va_end(arguments);
  if (!no_unnamed || (flags & O_TMPFILE) != O_TMPFILE) return __real_open(path, flags, mode);
  errno = EOPNOTSUPP;
  return -1;
}

/* What others may do with the unfinished file when it is flushed to the disk; -1: there is none by any name. */
static int unfinished_mode;

/* What flushing a regular file fails with; 0: it does not. */
static int fsync_reason;

int __real_fsync(int descriptor);
int __wrap_fsync(int descriptor);

int __wrap_fsync(int descriptor)
{
  struct stat info;
  if (fstat(descriptor, &info) == 0 && S_ISREG(info.st_mode))
    unfinished_mode = info.st_nlink == 0 ? -1 : (int)(info.st_mode & 07777);
  errno = fsync_reason;
  return fsync_reason != 0 ? -1 : __real_fsync(descriptor);
}

/* A new empty folder for each test, and the process's mask of permissions set to a known value. */
static int enter_folder(void **state)
{
  char *name = strdup("/tmp/pscn-test-XXXXXX");
  *state = name;
  umask(022);
  return name == NULL || mkdtemp(name) == NULL || chdir(name) != 0;
}

static int leave_folder(void **state)
{
  DIR *folder = opendir(*state);
  for (struct dirent *entry = readdir(folder); entry != NULL; entry = readdir(folder)) unlink(entry->d_name);
  closedir(folder);
  const int result = rmdir(*state);
  free(*state);
  return result;
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

static void put(const char *path, const char *text)
{
  FILE *file = fopen(path, "w");
  assert_non_null(file);
  assert_true(fputs(text, file) >= 0);
  assert_int_equal(fclose(file), 0);
}

static void expect_text(const char *path, const char *text)
{
  char buffer[64] = "";
  FILE *file = fopen(path, "r");
  assert_non_null(file);
  const size_t length = fread(buffer, 1, sizeof buffer - 1, file);
  fclose(file);
  assert_int_equal(length, strlen(text));
  assert_string_equal(buffer, text);
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

static void new_file_has_the_masks_permissions(void **state)
{
  (void)state;
  int reason = -1;
  assert_int_equal(atomic_file_probe("a", &reason), STATUS_OK);
  assert_int_equal(count_entries(), 0);
  assert_int_equal(write_text("a", "text", &reason), STATUS_OK);
  assert_int_equal(reason, 0);
  expect_text("a", "text");
  assert_int_equal(mode_of("a"), 0644);
  assert_int_equal(count_entries(), 1);
}

static void old_file_is_replaced_and_keeps_its_permissions(void **state)
{
  (void)state;
  int reason;
  put("a", "old and longer");
  assert_int_equal(chmod("a", 0640), 0);
  assert_int_equal(link("a", "other"), 0);
  assert_int_equal(write_text("a", "new", &reason), STATUS_OK);
  expect_text("a", "new");
  expect_text("other", "old and longer"); /* never written in place */
  assert_int_equal(mode_of("a"), 0640);
}

static void symbolic_link_is_followed(void **state)
{
  (void)state;
  int reason;
  put("a", "old");
  assert_int_equal(symlink("a", "link"), 0);
  assert_int_equal(write_text("link", "new", &reason), STATUS_OK);
  expect_text("a", "new");
  struct stat info;
  assert_int_equal(lstat("link", &info), 0);
  assert_true(S_ISLNK(info.st_mode));
}

static void impossible_names_have_their_reasons(void **state)
{
  (void)state;
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

static void device_is_written_to_not_replaced(void **state)
{
  (void)state;
  int reason = 0;
  if (access("/dev/full", W_OK) != 0) skip();
  assert_int_equal(symlink("/dev/full", "full"), 0);
  assert_int_equal(atomic_file_probe("full", &reason), STATUS_OK);
  assert_int_equal(write_text("full", "text", &reason), STATUS_FILE);
  assert_int_equal(reason, ENOSPC);
  struct stat info;
  assert_int_equal(stat("full", &info), 0);
  assert_true(S_ISCHR(info.st_mode));
}

static void stopped_write_leaves_the_old_file(void **state)
{
  (void)state;
  int reason = 0;
  atomic_int stop = 1;
  size_t failed;
  const struct atomic_file file = {"a", "new", 3};
  put("a", "old");
  assert_int_equal(atomic_files_write(&file, 1, &stop, &failed, &reason), STATUS_INTERRUPTED);
  expect_text("a", "old");
  assert_int_equal(count_entries(), 1);
}

/* Nor does a file go then for which nothing is written. */
static void stopped_writing_takes_nothing_away(void **state)
{
  (void)state;
  int reason = 0;
  atomic_int stop = 1;
  size_t failed;
  const struct atomic_file file = {"a", NULL, 0};
  put("a", "old");
  assert_int_equal(atomic_files_write(&file, 1, &stop, &failed, &reason), STATUS_INTERRUPTED);
  expect_text("a", "old");
}

/* A file system that cannot flush is no failure, a disk that does not is one. */
static void what_is_not_on_the_disk_is_not_written(void **state)
{
  (void)state;
  int reason = 0;
  size_t failed;
  const struct atomic_file file = {"a", "new", 3};
  put("a", "old");
  fsync_reason = EIO;
  assert_int_equal(atomic_files_write(&file, 1, NULL, &failed, &reason), STATUS_FILE);
  assert_int_equal(reason, EIO);
  expect_text("a", "old");
  fsync_reason = EINVAL;
  assert_int_equal(atomic_files_write(&file, 1, NULL, &failed, &reason), STATUS_OK);
  fsync_reason = 0;
  expect_text("a", "new");
  assert_int_equal(count_entries(), 1);
}

/* A bell that rings on, since its first stroke may come before anybody waits. */
static atomic_int rung;
static void ring(int signal) { atomic_store(&rung, signal); }

static void a_signal_ends_the_wait_for_a_reader(void **state)
{
  (void)state;
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

/* While a file is written nobody can open it, or where it needs a name, only who could open the old one. */
static void unfinished_files_are_private(void **state)
{
  (void)state;
  int reason;
  put("a", "old");
  assert_int_equal(chmod("a", 0600), 0);
  assert_int_equal(write_text("a", "new", &reason), STATUS_OK);
  assert_int_equal(unfinished_mode, no_unnamed ? 0600 : -1);
  assert_int_equal(mode_of("a"), 0600);
}

/* Several files: all, or none and the old ones stay. The last name is a folder, found when everything is written. */
static void several_files_appear_together(void **state)
{
  (void)state;
  struct atomic_file files[] = {{"first", "new", 3}, {"second", "new", 3}, {"gone", NULL, 0}, {"last", "new", 3}};
  size_t failed;
  int reason;
  put("first", "old");
  put("gone", "old");
  assert_int_equal(mkdir("last", 0777), 0);
  assert_int_equal(atomic_files_write(files, 4, NULL, &failed, &reason), STATUS_FILE);
  assert_true(failed == 3 && reason == EISDIR && count_entries() == 3);
  expect_text("first", "old");
  assert_int_equal(rmdir("last"), 0);
  assert_int_equal(atomic_files_write(files, 4, NULL, &failed, &reason), STATUS_OK);
  assert_int_equal(count_entries(), 3);
  expect_text("first", "new");
  expect_text("second", "new");
  expect_text("last", "new");
  atomic_int stop = 2;
  files[0].bytes = "two", files[1].bytes = NULL;
  assert_int_equal(atomic_files_write(files, 4, &stop, &failed, &reason), STATUS_INTERRUPTED);
  expect_text("first", "new");
  assert_int_equal(count_entries(), 3);
}

/* What is to go and has gone meanwhile, by another process, is no failure: here the file before it has taken it away. */
static void a_file_may_go_twice(void **state)
{
  (void)state;
  const struct atomic_file files[] = {{"first", "new", 3}, {"gone", NULL, 0}, {"gone", NULL, 0}};
  size_t failed;
  int reason;
  put("first", "old");
  put("gone", "old");
  assert_int_equal(atomic_files_write(files, 3, NULL, &failed, &reason), STATUS_OK);
  assert_int_equal(count_entries(), 1);
  expect_text("first", "new");
}

/* The same where a name cannot be given in the end. */
static void a_failing_name_undoes_those_before(void **state)
{
  (void)state;
  const struct atomic_file files[] = {
    {"kept", "new", 3}, {"made", "new", 3}, {"removed", NULL, 0}, {"there", "new", 3}};
  size_t failed;
  int reason;
  put("kept", "old");
  put("removed", "old");
  put("there", "old");
  rename_left = no_unnamed ? 2 : 1; /* of kept, and of made unless it is linked; that of there fails */
  assert_int_equal(atomic_files_write(files, 4, NULL, &failed, &reason), STATUS_FILE);
  rename_left = -1;
  assert_true(failed == 3 && reason == EIO && count_entries() == 3);
  expect_text("kept", "old");
  expect_text("removed", "old");
  expect_text("there", "old");
}

#define IN_FOLDER(test) cmocka_unit_test_setup_teardown(test, enter_folder, leave_folder)

int main(void)
{
  const struct CMUnitTest tests[] = {
    IN_FOLDER(new_file_has_the_masks_permissions),  IN_FOLDER(old_file_is_replaced_and_keeps_its_permissions),
    IN_FOLDER(symbolic_link_is_followed),           IN_FOLDER(impossible_names_have_their_reasons),
    IN_FOLDER(device_is_written_to_not_replaced),   IN_FOLDER(stopped_write_leaves_the_old_file),
    IN_FOLDER(stopped_writing_takes_nothing_away),  IN_FOLDER(what_is_not_on_the_disk_is_not_written),
    IN_FOLDER(a_signal_ends_the_wait_for_a_reader), IN_FOLDER(unfinished_files_are_private),
    IN_FOLDER(several_files_appear_together),       IN_FOLDER(a_file_may_go_twice),
    IN_FOLDER(a_failing_name_undoes_those_before),
  };
  const int failed = cmocka_run_group_tests_name("files without a name", tests, NULL, NULL);
  no_unnamed = true;
  return failed + cmocka_run_group_tests_name("files with names only", tests, NULL, NULL);
}

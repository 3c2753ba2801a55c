/* Files in tests: writing them, what they hold, and a folder for them. */
#ifndef TESTS_FILES_H
#define TESTS_FILES_H

#include <dirent.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cmocka_test.h"

/* Makes the file hold exactly these bytes, or this text. */
static inline void put_bytes(const char *path, const void *bytes, size_t size)
{
  FILE *file = fopen(path, "wb");
  assert_non_null(file);
  assert_int_equal(fwrite(bytes, 1, size, file), size);
  assert_int_equal(fclose(file), 0);
}

static inline void put_text(const char *path, const char *text) { put_bytes(path, text, strlen(text)); }

/* Asserts that the file holds exactly this text, of less than 512 bytes. */
static inline void expect_file(const char *path, const char *text)
{
  char held[512];
  FILE *file = fopen(path, "r");
  assert_non_null(file);
  const size_t length = fread(held, 1, sizeof held - 1, file);
  held[length] = '\0';
  assert_int_equal(fclose(file), 0);
  assert_int_equal(length, strlen(text));
  assert_string_equal(held, text);
}

/* Removes a file, or a folder with all that is in it. */
static inline void remove_all(const char *path)
{
  if (remove(path) == 0) return;
  DIR *folder = opendir(path);
  if (folder == NULL) return;
  for (const struct dirent *entry; (entry = readdir(folder)) != NULL;) {
    char within[600];
    const int length = snprintf(within, sizeof within, "%s/%s", path, entry->d_name);
    const bool other = strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0;
    if (other && length > 0 && length < (int)sizeof within) remove_all(within);
  }
  closedir(folder);
  remove(path);
}

/* IN_FOLDER(name) { ... } is a test with a new empty folder, which is the current one. */
#define IN_FOLDER(name) TEST_WITH(name, enter_folder, leave_folder)

static inline int enter_folder(void **state)
{
  char *name = strdup("/tmp/pscn-test-XXXXXX");
  *state = name;
  return name == NULL || mkdtemp(name) == NULL || chdir(name) != 0;
}

static inline int leave_folder(void **state)
{
  const int result = chdir("/");
  remove_all(*state);
  free(*state);
  return result;
}

#endif

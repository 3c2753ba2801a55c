/* The text that POV-Ray reads: a file is included from where the language finds it, and copied once. */
#include "language/plain_copy.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cmocka_test.h"
#include "files.h"

static char place[] = "/tmp/pscn-test-XXXXXX";

/* A folder with two others: sub, of files to include, and out, of the copies. */
static int make_folders(void **state)
{
  (void)state;
  return mkdtemp(place) == NULL || chdir(place) != 0 || mkdir("sub", 0700) != 0 || mkdir("out", 0700) != 0;
}

static int empty_folder(const char *name)
{
  char path[300];
  DIR *folder = opendir(name);
  if (folder == NULL) return 1;
  for (struct dirent *entry = readdir(folder); entry != NULL; entry = readdir(folder)) {
    snprintf(path, sizeof path, "%s/%s", name, entry->d_name);
    (void)unlink(path);
  }
  return closedir(folder);
}

static int remove_folders(void **state)
{
  (void)state;
  return empty_folder("sub") || empty_folder("out") || rmdir("sub") || rmdir("out") || empty_folder(".") ||
         rmdir(place);
}

static void copy(const char *scene)
{
  const char *reason;
  assert_int_equal(plain_copy(scene, NULL, "out", "scene.pov", &reason), STATUS_OK);
}

static void the_scenes_folder_comes_first(void **state)
{
  (void)state;
  put_text("scene.pscn", "#include \"sub/a.inc\"\n");
  put_text("sub/a.inc", "#include \"b.inc\"\n#include \"c.inc\"\n");
  put_text("b.inc", "// beside the scene\n");
  put_text("sub/b.inc", "// beside a.inc\n");
  put_text("sub/c.inc", "// beside a.inc alone\n");
  copy("scene.pscn");
  expect_file("out/scene.pov", "#include \"1-a.inc\"\n");
  expect_file("out/1-a.inc", "#include \"2-b.inc\"\n#include \"3-c.inc\"\n");
  expect_file("out/2-b.inc", "// beside the scene\n");
  expect_file("out/3-c.inc", "// beside a.inc alone\n");
}

/* Even one that includes itself in a branch that is never read. */
static void a_file_is_copied_once(void **state)
{
  (void)state;
  put_text("scene.pscn", "#include \"d.inc\"\n#include \"d.inc\"\n");
  put_text("d.inc", "#ifdef (Never) #include \"d.inc\" #end\n");
  copy("scene.pscn");
  expect_file("out/scene.pov", "#include \"1-d.inc\"\n#include \"1-d.inc\"\n");
  expect_file("out/1-d.inc", "#ifdef (Never) #include \"1-d.inc\" #end\n");
  assert_int_not_equal(access("out/2-d.inc", F_OK), 0);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(the_scenes_folder_comes_first),
                                     cmocka_unit_test(a_file_is_copied_once)};
  return cmocka_run_group_tests(tests, make_folders, remove_folders);
}

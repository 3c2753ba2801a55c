/* The text for POV-Ray: files are included from where the language finds them, and copied once. */
#include "page/plain_copy.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cmocka_test.h"
#include "files.h"

static void copy(const char *scene)
{
  const char *reason;
  char word[PLAIN_COPY_WORD_SIZE];
  assert_int_equal(plain_copy(scene, NULL, "out", "scene.pov", &reason, word), STATUS_OK);
  assert_string_equal(word, "");
}

TEST(the_scenes_folder_comes_first)
{
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

/* Even a file that includes itself, or the scene, in a branch that is never read. */
TEST(a_file_is_copied_once)
{
  put_text("scene.pscn", "#include \"d.inc\"\n#include \"d.inc\"\n");
  put_text("d.inc", "#ifdef (Never) #include \"d.inc\" #include \"scene.pscn\" #end\n");
  copy("scene.pscn");
  expect_file("out/scene.pov", "#include \"1-d.inc\"\n#include \"1-d.inc\"\n");
  expect_file("out/1-d.inc", "#ifdef (Never) #include \"1-d.inc\" #include \"scene.pov\" #end\n");
  assert_int_not_equal(access("out/2-d.inc", F_OK), 0);
}

/* A name as long as a file system takes, to which a number is added. */
TEST(a_long_name_is_cut)
{
  char name[300], scene[600];
  snprintf(name, sizeof name, "sub/%0251d.inc", 0);
  put_text(name, "// long\n");
  snprintf(scene, sizeof scene, "#include \"%s\"", name);
  put_text("scene.pscn", scene);
  copy("scene.pscn");
  snprintf(name, sizeof name, "out/1-%0250d", 0);
  expect_file(name, "// long\n");
  snprintf(scene, sizeof scene, "#include \"1-%0250d\"", 0);
  expect_file("out/scene.pov", scene);
}

/* Blanks replace them, so that POV-Ray's messages name the scene's lines. */
TEST(solver_statements_are_left_out)
{
  static const struct {
    const char *scene, *copy;
  } cases[] = {
    {"a solver newton b", "a               b"},
    {"a solver newton", "a              "},
    {"solver aberth { form paper } b", "                             b"},
    {"a solver\n aberth\n { polish on\n } b\n", "a       \n       \n            \n   b\n"},
    {"solver newton solver aberth{}{ }", "                             { }"},
    {"a { solver newton } b", "a {               } b"},
    {"solver newton #include \"e.inc\"", "              #include \"1-e.inc\""},
    {"solver aberth { polish on", "                         "},
    /* These are none. */
    {"// solver newton", "// solver newton"},
    {"\"solver newton\" solver", "\"solver newton\" solver"},
    {"solver 1 solver { } b", "solver 1 solver { } b"},
    {"solver #include \"e.inc\"", "solver #include \"1-e.inc\""},
  };
  put_text("e.inc", "");
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    put_text("scene.pscn", cases[k].scene);
    copy("scene.pscn");
    expect_file("out/scene.pov", cases[k].copy);
  }
}

/* It may be in a branch that is not read. */
TEST(what_is_not_found_is_left_alone)
{
  static const char scene[] = "#include \"none.inc\" #include \"out\"";
  put_text("scene.pscn", scene);
  copy("scene.pscn");
  expect_file("out/scene.pov", scene);
}

/* What POV-Ray could do with files is found wherever it stands. */
TEST(words_that_use_files_are_found)
{
  static const struct {
    const char *scene, *word;
  } cases[] = {
    {"#ifndef (pscn) #fopen F \"x\" write #end", "#fopen in 'scene.pscn'"},
    {"#macro M() # write (F, 1) #end", "# write in 'scene.pscn'"},
    {"#declare A = 1; #/*a*/read (F, A)", "read in 'scene.pscn'"},
    {"#fclose F", "#fclose in 'scene.pscn'"},
    {"#declare A = pigment { image_map { png \"/x\" } };", "image_map in 'scene.pscn'"},
    {"#declare A = pigment { density_file df3 \"/x\" };", "density_file in 'scene.pscn'"},
    {"text { ttf \"/x\" \"a\" 1, 0 }", "ttf in 'scene.pscn'"},
    {"height_field { png \"/x\" }", "height_field in 'scene.pscn'"},
    {"#if (file_exists (\"/x\")) #end", "file_exists in 'scene.pscn'"},
    {"#include \"f.inc\"", "#fopen in 'f.inc'"},
    {"#include concat (\"f\", \".inc\")", "#include concat in 'scene.pscn'"},
    {"#include Name", "#include Name in 'scene.pscn'"},
    /* No such words. */
    {"// #fopen\n\"#write\" #debug \"image_map\" reads writer Fopen", ""},
  };
  put_text("f.inc", "#fopen F \"x\" write");
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    const char *reason;
    char word[PLAIN_COPY_WORD_SIZE];
    put_text("scene.pscn", cases[k].scene);
    assert_int_equal(plain_copy("scene.pscn", NULL, "out", "scene.pov", &reason, word), STATUS_OK);
    assert_string_equal(word, cases[k].word);
  }
}

TEST(a_disk_that_is_full_is_told)
{
  static char text[1 << 20];
  const char *reason = NULL;
  char word[PLAIN_COPY_WORD_SIZE];
  assert_int_equal(plain_copy("scene.pscn", NULL, "none", "scene.pov", &reason, word), STATUS_FILE);
  assert_string_equal(reason, strerror(ENOENT));
  assert_int_equal(plain_copy("none.pscn", NULL, "out", "scene.pov", &reason, word), STATUS_FILE);
  assert_non_null(reason);
  memset(text, ' ', sizeof text - 1);
  assert_int_equal(symlink("/dev/full", "out/full.pov"), 0);
  for (size_t length = 1; length < sizeof text; length *= 1000000) {
    put_text("scene.pscn", text + sizeof text - 1 - length);
    reason = NULL;
    assert_int_equal(plain_copy("scene.pscn", NULL, "out", "full.pov", &reason, word), STATUS_FILE);
    assert_string_equal(reason, strerror(ENOSPC));
  }
}

/* A folder with two others: sub for include files, out for the copies. */
int main(void)
{
  void *folder;
  if (enter_folder(&folder) != 0 || mkdir("sub", 0700) != 0 || mkdir("out", 0700) != 0) return 1;
  const int failed = test_run();
  return leave_folder(&folder) == 0 ? failed : 1;
}

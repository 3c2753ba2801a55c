/* Proves that `pscn merge` makes no picture of a piece that is rewritten meanwhile, between the reading of its header
 * and of its pixels. */
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "cmocka_test.h"
#include "command/command.h"
#include "command/piece.h"
#include "files.h"

enum { MOST_ARGUMENTS = 16 };

static int run(const char *const arguments[])
{
  const char *argv[MOST_ARGUMENTS] = {NULL};
  int argc = 0;
  while (arguments[argc]) argv[argc] = arguments[argc], argc++;
  const struct command *command = command_find(argv[0]);
  assert_non_null(command);
  const int code = (int)command_run(command, argc, argv);
  fflush(stdout);
  return code;
}

/* The linker passes calls of piece_read here. Before pixels are read for the first time, "other" becomes "one". */
static bool change;
enum status __real_piece_read(const char *path, bool pixels, struct piece *out, char *message);
enum status __wrap_piece_read(const char *path, bool pixels, struct piece *out, char *message);
enum status __wrap_piece_read(const char *path, bool pixels, struct piece *out, char *message)
{
  if (pixels && change) assert_int_equal(rename("other.exr", "one.exr"), 0);
  change &= !pixels;
  return __real_piece_read(path, pixels, out, message);
}

static void render(const char *tile, const char *output, const char *samples)
{
  assert_int_equal(run((const char *const[]){"render", "scene.pscn", "--size", "64x48", "--tile", tile, "-o", output,
                                             "--samples", samples, "--quiet", NULL}),
                   STATUS_OK);
}

TEST(test_changed)
{
  static const char *const again[][3] = {{"1/2", "2", "another picture's"},
                                         {"2/2", "1", "another number"},
                                         {"1/3", "1", "of more pieces"},
                                         {"1/2", "1", "nothing else"}};
  for (size_t k = 0; k < sizeof again / sizeof *again; k++) {
    render("1/2", "one.exr", "1"), render("2/2", "two.exr", "1"), render(again[k][0], "other.exr", again[k][1]);
    change = true;
    const int code = run((const char *const[]){"merge", "one.exr", "two.exr", "-o", "picture.png", "--quiet", NULL});
    assert_false(change);
    print_message("%s: exit code %d\n", again[k][2], code);
    assert_int_equal(code, k == 3 ? STATUS_OK : STATUS_DIFFERENT);
    assert_int_equal(access("picture.png", F_OK) == 0, k == 3);
  }
}

int main(void)
{
  static const char scene[] = "camera { location <0, 0, -3> }\n"
                              "bicubic_patch { type 1 flatness 0 u_steps 3 v_steps 3\n"
                              "  <0,0,0> <1,0,0> <2,0,0> <3,0,0> <0,1,0> <1,1,1> <2,1,1> <3,1,0>\n"
                              "  <0,2,0> <1,2,1> <2,2,1> <3,2,0> <0,3,0> <1,3,0> <2,3,0> <3,3,0>\n"
                              "  pigment { rgb 1 } translate <-1.5, -1.5, 0> }\n";
  void *folder;
  if (enter_folder(&folder) != 0) return 1;
  put_text("scene.pscn", scene);
  const int failed = test_run();
  return leave_folder(&folder) == 0 ? failed : 1;
}

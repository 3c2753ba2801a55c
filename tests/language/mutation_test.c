/* Scenes with accidents: the files of ok/ and bad/ with bytes and words changed, cut out, doubled and strewn in.
 * Whatever comes of it, reading ends with a scene or with errors, never both and never neither; a scene is finite,
 * and its dump reads back as the same dump. Run under the sanitizers this also shows that nothing is read or freed
 * wrongly.
 */
#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cmocka_test.h"
#include "language/language.h"
#include "random.h"
#include "scene/dump.h"

enum {
  SEED = 20260601,
  ROUNDS = 60,           /* of each file */
  MAX_ACCIDENTS = 4,     /* in one text */
  MAX_FILE_BYTES = 6000, /* longer files test lengths, not contents */
  MAX_FILES = 200
};

static const struct language_settings SETTINGS = {.image_width = 800, .image_height = 600, .tolerance = NAN};

static const char *const STREWN[] = {"{",
                                     "}",
                                     "(",
                                     ")",
                                     "<",
                                     ">",
                                     ",",
                                     ";",
                                     "+",
                                     "-",
                                     "*",
                                     "/",
                                     ".x",
                                     "/*",
                                     "*/",
                                     "//",
                                     "\"",
                                     "#",
                                     "#ifdef (pscn)",
                                     "#else",
                                     "#end",
                                     "#if",
                                     "#macro",
                                     "#declare A = ",
                                     "#local B = ",
                                     "#include \"included/values.inc\"",
                                     "#version",
                                     "1e308",
                                     "1e-320",
                                     "0",
                                     "-1",
                                     "<1, 2, 3>",
                                     "<1e200, 0, 0>",
                                     "object {",
                                     "union {",
                                     "bicubic_patch {",
                                     "matrix <",
                                     "scale 0",
                                     "rotate 1e308",
                                     "texture {",
                                     "pigment {",
                                     "finish {",
                                     "solver aberth {",
                                     "camera {",
                                     "look_at",
                                     "light_source {",
                                     "background { rgb 1 }",
                                     "rgb",
                                     "x",
                                     "A",
                                     "sphere",
                                     "\n",
                                     "\t",
                                     "\xc3\xa9",
                                     "\xff"};

struct text {
  char *bytes;
  size_t length, capacity;
};

static void replace(struct text *text, size_t at, size_t removed, const char *inserted, size_t length)
{
  assert_true(text->length - removed + length <= text->capacity);
  memmove(text->bytes + at + length, text->bytes + at + removed, text->length - at - removed);
  memcpy(text->bytes + at, inserted, length);
  text->length += length - removed;
}

static size_t below(struct random *random, size_t limit) { return (size_t)(random_bits(random) % limit); }

static void accident(struct text *text, struct random *random)
{
  char piece[64];
  const size_t at = below(random, text->length + 1), left = text->length - at;
  const size_t length = below(random, (left < sizeof piece ? left : sizeof piece) + 1);
  memcpy(piece, text->bytes + at, length);
  const char *strewn = STREWN[below(random, sizeof STREWN / sizeof *STREWN)];
  switch (below(random, 5)) {
  case 0: replace(text, at, length, "", 0); break;
  case 1: replace(text, below(random, text->length + 1), 0, piece, length); break;
  case 2: replace(text, at, 0, strewn, strlen(strewn)); break;
  case 3: text->length = at; break;
  default:
    piece[0] = (char)below(random, 256);
    replace(text, at, left > 0, piece, 1);
    break;
  }
}

struct told {
  size_t count;
  bool whole_lines;
};

static void tell(void *context, const char *text, size_t length)
{
  struct told *told = context;
  told->count++;
  told->whole_lines &= length > 0 && text[length - 1] == '\n' && !memchr(text, '\x1b', length) &&
                       !memchr(text, '\0', length);
}

static enum status load(const struct text *text, const char *name, struct scene **out_scene)
{
  struct told told = {.whole_lines = true};
  struct diagnostics diagnostics = {.tell = tell, .context = &told};
  const enum status status = language_load_text(name, text->bytes, text->length, &SETTINGS, &diagnostics, out_scene);
  assert_true(told.whole_lines);
  assert_int_equal(status == STATUS_OK, diagnostics.error_count == 0); /* there may be warnings */
  assert_true(status == STATUS_OK || told.count > 0);
  assert_int_equal(status == STATUS_OK, *out_scene != NULL);
  assert_true(status == STATUS_OK || status == STATUS_INPUT || status == STATUS_LIMIT);
  return status;
}

static struct text dump(const struct scene *scene)
{
  struct text text = {0};
  FILE *memory = open_memstream(&text.bytes, &text.length);
  assert_non_null(memory);
  assert_int_equal(scene_dump(scene, memory), STATUS_OK);
  assert_int_equal(fclose(memory), 0);
  return text;
}

static void check_scene(struct scene *scene)
{
  for (size_t k = 0; k < scene->patch_count; k++) {
    const double *p = &scene->patches[k].P[0][0][0];
    for (int i = 0; i < 48; i++) assert_true(isfinite(p[i]));
    assert_true(scene->patches[k].texture < scene->texture_count && scene->patches[k].solver < scene->solver_count);
  }
  struct text first = dump(scene), second;
  struct scene *again = NULL;
  assert_int_equal(load(&first, "<dump>", &again), STATUS_OK);
  second = dump(again);
  assert_int_equal(first.length, second.length);
  assert_memory_equal(first.bytes, second.bytes, first.length);
  free(first.bytes);
  free(second.bytes);
  scene_destroy(again);
}

static size_t read_file(const char *path, char *out)
{
  FILE *file = fopen(path, "rb");
  assert_non_null(file);
  const size_t length = fread(out, 1, MAX_FILE_BYTES + 1, file);
  (void)fclose(file);
  return length;
}

/* The outcomes of all texts: shows if the test only ever meets errors. */
struct tally {
  int scenes, errors;
};

static void run_file(const char *path, struct random *random, struct tally *tally)
{
  static char original[MAX_FILE_BYTES + 1], bytes[2 * MAX_FILE_BYTES];
  const size_t length = read_file(path, original);
  if (length > MAX_FILE_BYTES) return;
  for (int round = 0; round < ROUNDS; round++) {
    struct text text = {bytes, length, sizeof bytes};
    memcpy(bytes, original, length);
    for (size_t k = below(random, MAX_ACCIDENTS) + 1; k > 0; k--) accident(&text, random);
    struct scene *scene = NULL;
    if (load(&text, path, &scene) == STATUS_OK) {
      check_scene(scene);
      tally->scenes++;
    } else {
      tally->errors++;
    }
    scene_destroy(scene);
  }
}

static int is_scene(const struct dirent *entry)
{
  const size_t length = strlen(entry->d_name);
  return length > 5 && strcmp(entry->d_name + length - 5, ".pscn") == 0;
}

static void test_accidents(void **state)
{
  (void)state;
  struct random random = {SEED};
  struct tally tally = {0};
  static const char *const folders[] = {"bad", "ok"};
  for (int f = 0; f < 2; f++) {
    struct dirent **entries;
    const int count = scandir(folders[f], &entries, is_scene, alphasort);
    assert_true(count > 0);
    for (int k = 0; k < count; k++) {
      char path[600];
      (void)snprintf(path, sizeof path, "%s/%s", folders[f], entries[k]->d_name);
      run_file(path, &random, &tally);
      free(entries[k]);
    }
    free(entries);
  }
  print_message("seed %d: %d scenes, %d with errors\n", SEED, tally.scenes, tally.errors);
  assert_true(tally.scenes > 100 && tally.errors > 1000);
}

static void test_noise(void **state)
{
  (void)state;
  struct random random = {SEED + 1};
  char bytes[300];
  for (int round = 0; round < 1000; round++) {
    struct text text = {bytes, below(&random, sizeof bytes), sizeof bytes};
    for (size_t k = 0; k < text.length; k++) bytes[k] = (char)below(&random, 256);
    struct scene *scene = NULL;
    (void)load(&text, "<noise>", &scene);
    scene_destroy(scene);
  }
}

int main(void)
{
  if (chdir(PSCN_SOURCE_DIR "/tests/language") != 0) return 1;
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_accidents), cmocka_unit_test(test_noise)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}

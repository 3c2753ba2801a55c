/* The language by example.
 *
 * bad/NAME.pscn is wrong. Below each wrong line a comment holds what is told of it, with the caret at its place:
 *
 *     camera { angle 180 }
 *   //               ^~~ error: the angle must be at least 0 and less than 180 degrees
 *
 * Behind "//|" stands, to the letter, what has no such form: a line that is not shown whole, a place in columns 1 and 2,
 * loops and macros around it; and the status, as "exit N", unless it is 3, STATUS_INPUT. If comments would
 * change the errors, all of this is in bad/NAME.errors, without "//|".
 * ok/NAME.pscn is right: ok/NAME.dump holds its canonical text, which read again gives itself, without the first lines
 * that are those of ok/empty.dump, and with names for parts that are as usual.
 *
 * With PSCN_UPDATE set in the environment the expected texts are written instead; look at what changed. Run it twice:
 * comments move the lines that messages name.
 */
#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cmocka_test.h"
#include "files.h"
#include "language/language.h"
#include "scene/scene.h"

static const struct language_settings SETTINGS = {
  .image_width = 800, .image_height = 600, .tolerance = NAN, .max_work = 200000};

/* ---- wrong scenes ---- */

enum { MOST_TOLD = DIAGNOSTICS_MAX_ERRORS + 10 };

struct told {
  const struct diagnostics *by;
  char *text[MOST_TOLD]; /* of each message, with the line that it shows and the carets */
  struct diagnostics_parts parts[MOST_TOLD];
  size_t count;
};

static void tell(void *context, const char *text, size_t length)
{
  struct told *told = context;
  assert_true(told->count < MOST_TOLD && length > 0 && text[length - 1] == '\n');
  told->parts[told->count] = told->by->parts;
  told->text[told->count++] = strndup(text, length);
}

/* Writes lines up to `end`, each behind "//|", equal ones once, with their number. */
static void put_lines(const char *line, const char *end, FILE *out)
{
  while (line < end) {
    const size_t length = strcspn(line, "\n") + 1;
    size_t count = 1;
    while (line + count * length < end && strncmp(line, line + count * length, length) == 0) count++;
    (void)fprintf(out, "//|%.*s", (int)length - 1, line);
    (void)(count > 1 ? fprintf(out, " (%zu times)\n", count) : fputc('\n', out));
    line += count * length;
  }
}

/* Writes "//", carets and message, if it is of this line of the file `path`, which is shown whole. What is around that
 * place comes before, in lines of its own. */
static bool put_below(const char *text, const struct diagnostics_parts *parts, const char *path, const char *line,
                      size_t length, FILE *out)
{
  const size_t name = strlen(path);
  const char *at = text + parts->name_begin;
  if (parts->line == 0 || strncmp(at, path, name) != 0 || at[name] != ':') return false;
  const char *said = text + parts->said_begin - strlen(parts->warning ? "warning: " : "error: ");
  const char *shown = strchr(said, '\n') + 3, *carets = shown + length + 1;
  if (strncmp(shown, line, length) != 0 || shown[length] != '\n' || strncmp(carets, "    ", 4) != 0) return false;
  put_lines(text, at, out);
  carets += 4; /* the two blanks before each line, and two for which "//" stands */
  (void)fprintf(out, "//%.*s %.*s\n", (int)strcspn(carets, "\n"), carets, (int)strcspn(said, "\n"), said);
  return true;
}

static bool is_expectation(const char *line)
{
  return strncmp(line, "//|", 3) == 0 || (strncmp(line, "//", 2) == 0 && line[2 + strspn(line + 2, " \t")] == '^');
}

/* The source text without what is expected, and what has been told in its places. False if that was not in the order of
 * the lines. */
static bool put_expected(const struct told *told, enum status status, const char *path, const char *text, FILE *out)
{
  size_t next = 0, number = 1;
  for (const char *line = text; *line != '\0'; number++) {
    const size_t length = strcspn(line, "\n");
    if (!is_expectation(line)) (void)fprintf(out, "%.*s\n", (int)length, line);
    for (; next < told->count && (told->parts[next].line == number || told->parts[next].line == 0); next++)
      if (!put_below(told->text[next], &told->parts[next], path, line, length, out))
        put_lines(told->text[next], strchr(told->text[next], '\0'), out);
    line += length + (line[length] == '\n');
  }
  if (status != STATUS_INPUT) (void)fprintf(out, "//|exit %d\n", (int)status);
  return next == told->count;
}

/* A file's text, freed by the caller; NULL if there is no such file. */
static char *read_text(const char *path, size_t *out_length)
{
  FILE *file = fopen(path, "rb");
  if (file == NULL) return NULL;
  enum { ROOM = 1 << 20 };
  char *text = malloc(ROOM + 1);
  assert_non_null(text);
  *out_length = fread(text, 1, ROOM, file);
  assert_true(*out_length < ROOM);
  text[*out_length] = '\0';
  (void)fclose(file);
  return text;
}

/* Whether the file holds this text. On request the text is written to it. */
static bool is_expected(const char *path, const char *text, size_t length)
{
  if (getenv("PSCN_UPDATE")) {
    put_bytes(path, text, length);
    return true;
  }
  size_t size = 0;
  char *expected = read_text(path, &size);
  const bool same = expected != NULL && size == length && memcmp(expected, text, length) == 0;
  if (!same) print_error("%s: this is expected no longer:\n%.*s\n", path, (int)length, text);
  free(expected);
  return same;
}

static bool bad_case(const char *path, const char *errors_path)
{
  char *out = NULL, *text;
  size_t length = 0, text_length = 0;
  FILE *memory = open_memstream(&out, &length);
  assert_non_null(memory);
  struct told told = {.count = 0};
  struct diagnostics diagnostics = {.tell = tell, .context = &told};
  told.by = &diagnostics;
  struct scene *scene = NULL;
  const enum status status = language_load(path, &SETTINGS, &diagnostics, &scene);
  assert_int_not_equal(status, STATUS_OK);
  assert_null(scene);
  assert_true(diagnostics.error_count > 0 && told.count > 0);
  bool good = true;
  const bool apart = access(errors_path, F_OK) == 0;
  if (apart) {
    for (size_t k = 0; k < told.count; k++) (void)fputs(told.text[k], memory);
    if (status != STATUS_INPUT) (void)fprintf(memory, "exit %d\n", (int)status);
  } else {
    text = read_text(path, &text_length);
    assert_non_null(text);
    good = put_expected(&told, status, path, text, memory);
    if (!good) print_error("%s: what is told is not in the order of the lines\n", path);
    free(text);
  }
  assert_int_equal(fclose(memory), 0);
  good = good && is_expected(apart ? errors_path : path, out, length);
  for (size_t k = 0; k < told.count; k++) free(told.text[k]);
  free(out);
  return good;
}

/* ---- right scenes ---- */

static void print(void *context, const char *text, size_t length)
{
  (void)context;
  print_error("%.*s", (int)length, text);
}

/* The dump of a scene, freed by the caller. */
static char *dump(const struct scene *scene, size_t *length)
{
  char *text = NULL;
  FILE *memory = open_memstream(&text, length);
  assert_non_null(memory);
  assert_int_equal(scene_dump(scene, memory), STATUS_OK);
  assert_int_equal(fclose(memory), 0);
  return text;
}

/* What stands in many dumps, and what stands for it. */
#define POINTS_0                                                                                   \
  "  <0, 0, 0>, <0, 0, 0>, <0, 0, 0>, <0, 0, 0>,\n  <0, 0, 0>, <0, 0, 0>, <0, 0, 0>, <0, 0, 0>,\n" \
  "  <0, 0, 0>, <0, 0, 0>, <0, 0, 0>, <0, 0, 0>,\n  <0, 0, 0>, <0, 0, 0>, <0, 0, 0>, <0, 0, 0>\n"
static const struct {
  const char *text, *name;
} USUAL[] = {
  {"camera {\n  location <0, 0, 0>\n  direction <0, 0, 1>\n  right <1.33, 0, 0>\n  up <0, 1, 0>\n}\n",
   "(usual camera)\n"},
  {"  finish {\n    ambient rgb <0.1, 0.1, 0.1>\n    diffuse 0.6 brilliance 1\n    phong 0 phong_size 40\n"
   "    specular 0 roughness 0.05\n  }\n",
   "  (usual finish)\n"},
  {"bicubic_patch {\n  type 0 flatness 0 u_steps 0 v_steps 0\n" POINTS_0, "bicubic_patch { (all 0)\n"},
  {POINTS_0, "  (all points 0)\n"},
};
#undef POINTS_0

/* A text with such parts replaced, freed by the caller. */
static char *shortened(const char *text, size_t *out_length)
{
  char *out = NULL;
  FILE *memory = open_memstream(&out, out_length);
  assert_non_null(memory);
  while (*text != '\0') {
    size_t k = 0;
    while (k < sizeof USUAL / sizeof *USUAL && strncmp(text, USUAL[k].text, strlen(USUAL[k].text)) != 0) k++;
    const bool usual = k < sizeof USUAL / sizeof *USUAL;
    if (usual) (void)fputs(USUAL[k].name, memory);
    else (void)fputc(*text, memory);
    text += usual ? strlen(USUAL[k].text) : 1;
  }
  assert_int_equal(fclose(memory), 0);
  return out;
}

/* How many bytes of whole lines two texts have in common. */
static size_t common_lines(const char *a, const char *b)
{
  size_t lines = 0;
  for (size_t k = 0; a[k] != '\0' && a[k] == b[k]; k++)
    if (a[k] == '\n') lines = k + 1;
  return lines;
}

static char *of_nothing; /* the dump of an empty scene; NULL until it is known */

static bool ok_case(const char *path, const char *expected_path)
{
  struct diagnostics diagnostics = {.tell = print};
  struct scene *scene = NULL, *again = NULL;
  assert_int_equal(language_load(path, &SETTINGS, &diagnostics, &scene), STATUS_OK);
  assert_int_equal(diagnostics.error_count, 0);
  size_t length, length_again;
  char *text = dump(scene, &length);
  assert_int_equal(language_load_text("<dump>", text, length, &SETTINGS, &diagnostics, &again), STATUS_OK);
  char *text_again = dump(again, &length_again);
  assert_int_equal(length, length_again);
  assert_memory_equal(text, text_again, length);
  bool same;
  if (of_nothing == NULL) {
    same = is_expected(expected_path, text, length);
    of_nothing = text;
  } else {
    char *rest = shortened(text + common_lines(text, of_nothing), &length);
    same = is_expected(expected_path, rest, length);
    free(rest);
    free(text);
  }
  free(text_again);
  scene_destroy(scene);
  scene_destroy(again);
  return same;
}

static int is_scene(const struct dirent *entry)
{
  const size_t length = strlen(entry->d_name);
  return length > 5 && strcmp(entry->d_name + length - 5, ".pscn") == 0 && strcmp(entry->d_name, "empty.pscn") != 0;
}

static void run_folder(const char *folder, const char *ending, bool (*run)(const char *, const char *))
{
  struct dirent **entries;
  const int count = scandir(folder, &entries, is_scene, alphasort);
  assert_true(count > 0);
  int failed = 0;
  for (int k = 0; k < count; k++) {
    char path[600], expected[600];
    const int stem = (int)strlen(entries[k]->d_name) - 5;
    (void)snprintf(path, sizeof path, "%s/%s", folder, entries[k]->d_name);
    (void)snprintf(expected, sizeof expected, "%s/%.*s.%s", folder, stem, entries[k]->d_name, ending);
    failed += !run(path, expected);
    free(entries[k]);
  }
  free(entries);
  assert_int_equal(failed, 0);
}

TEST(test_bad) { run_folder("bad", "errors", bad_case); }

TEST(test_ok)
{
  assert_true(ok_case("ok/empty.pscn", "ok/empty.dump"));
  run_folder("ok", "dump", ok_case);
  free(of_nothing);
  of_nothing = NULL;
}

/* Pieces of a picture may be rendered on different machines, so the hash must be the same on all of them. A Python
 * program has computed this one. */
TEST(test_hash)
{
  static const char text[] = "background { rgb <1, 0.5, 0.25> } // \xc3\xa4\xc3\xb6\xc3\xbc\n";
  struct diagnostics diagnostics = {.tell = print};
  struct scene *scene = NULL;
  assert_int_equal(language_load_text("<text>", text, sizeof text - 1, &SETTINGS, &diagnostics, &scene), STATUS_OK);
  assert_string_equal(scene->text_hash, "1384bce67a8bde7f78487bf0bba79e90");
  scene_destroy(scene);
}

int main(void)
{
  /* Names in messages are relative to this folder. */
  if (chdir(PSCN_SOURCE_DIR "/tests/language") != 0) return 1;
  return test_run();
}

/* Runs a fuzz target on files and on all files of folders, named by whole paths, without libFuzzer. What it says goes
 * nowhere; each input has SECONDS_EACH, so that one that has become slow is seen. Without an input at all it fails.
 * Behind -accidents each input is also run ROUNDS times with pieces cut out, doubled, changed and strewn in. */
#include <dirent.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "random.h"
#include "target.h"

enum { SECONDS_EACH = 60, ROUNDS = 60, MOST_ACCIDENTS = 4, MOST_BYTES = 6000, PIECE = 64 };

/* What is strewn into texts, between tabs. */
static const char STREWN[] =
  "{\t}\t(\t)\t<\t>\t,\t;\t+\t-\t*\t/\t.x\t/*\t*/\t//\t\"\t#\t#ifdef (pscn)\t#else\t#end\t#if\t#macro\t#declare A = \t"
  "#local B = \t#include \"nested.inc\"\t#version\t1e308\t1e-320\t0\t-1\t<1, 2, 3>\t<1e200, 0, 0>\tobject {\tunion {\t"
  "bicubic_patch {\tmatrix <\tscale 0\trotate 1e308\ttexture {\tpigment {\tfinish {\tsolver aberth {\tcamera "
  "{\tlook_at\t"
  "light_source {\tbackground { rgb 1 }\trgb\tx\tA\tsphere\t\n\t\xc3\xa9\t\xff";

static bool accidents;
static struct random dice = {20260601};
static size_t inputs;
static FILE *say;

static size_t below(size_t limit) { return (size_t)(random_bits(&dice) % limit); }

/* Puts `length` bytes in the place of `removed` ones. */
static size_t replace(uint8_t *data, size_t size, size_t at, size_t removed, const void *bytes, size_t length)
{
  memmove(data + at + length, data + at + removed, size - at - removed);
  memcpy(data + at, bytes, length);
  return size - removed + length;
}

/* An accident to data, with room for PIECE bytes more. Returns their new size. */
static size_t have_accident(uint8_t *data, size_t size)
{
  uint8_t piece[PIECE];
  const size_t at = below(size + 1), left = size - at, length = below((left < PIECE ? left : PIECE) + 1);
  const char *word = STREWN + below(sizeof STREWN);
  while (word > STREWN && word[-1] != '\t') word--;
  switch (below(6)) {
  case 0: return replace(data, size, at, length, "", 0);
  case 1: memcpy(piece, data + at, length); return replace(data, size, below(size + 1), 0, piece, length);
  case 2: return replace(data, size, at, 0, word, strcspn(word, "\t"));
  case 3: return at;
  case 4:
    for (size_t k = 0; k < PIECE; k++) piece[k] = (uint8_t)below(256);
    return replace(data, size, at, 0, piece, below(PIECE));
  default: piece[0] = (uint8_t)below(256); return replace(data, size, at, left > 0, piece, 1);
  }
}

static void run(const uint8_t *data, size_t size)
{
  alarm(SECONDS_EACH);
  (void)LLVMFuzzerTestOneInput(data, size);
  alarm(0);
}

static void run_accidents(const uint8_t *data, size_t size)
{
  static uint8_t changed[MOST_BYTES + MOST_ACCIDENTS * PIECE];
  for (int round = 0; accidents && size <= MOST_BYTES && round < ROUNDS; round++) {
    size_t left = size;
    memcpy(changed, data, size);
    for (size_t k = below(MOST_ACCIDENTS) + 1; k > 0; k--) left = have_accident(changed, left);
    run(changed, left);
  }
}

static void run_file(const char *path)
{
  FILE *file = fopen(path, "rb");
  uint8_t *data = NULL;
  size_t size = 0, got;
  assert(file);
  do {
    data = realloc(data, size + 65536);
    assert(data);
    got = fread(data + size, 1, 65536, file);
    size += got;
  } while (got > 0);
  (void)fclose(file);
  (void)fprintf(say, "%s\n", path); /* the last name is that of the input that crashed */
  run(data, size);
  run_accidents(data, size);
  free(data);
  inputs++;
}

static void run_folder(const char *folder)
{
  struct dirent **entries;
  const int count = scandir(folder, &entries, NULL, alphasort);
  for (int k = 0; k < count; k++) {
    char path[4096];
    (void)snprintf(path, sizeof path, "%s/%s", folder, entries[k]->d_name);
    if (entries[k]->d_name[0] != '.') run_file(path);
    free(entries[k]);
  }
  if (count >= 0) free(entries);
  else run_file(folder);
}

int main(int argc, char **argv)
{
  const int terminal = dup(STDERR_FILENO), nowhere = open("/dev/null", O_WRONLY);
  say = fdopen(terminal, "w");
  assert(say && nowhere >= 0);
  (void)setvbuf(say, NULL, _IONBF, 0);
  dup2(nowhere, STDOUT_FILENO);
  if (getenv("PSCN_FUZZ_LOUD") == NULL) dup2(nowhere, STDERR_FILENO);
  for (int k = 1; k < argc; k++)
    if (strcmp(argv[k], "-accidents") == 0) accidents = true;
    else run_folder(argv[k]);
  (void)fprintf(say, "%zu inputs\n", inputs);
  return inputs > 0 ? 0 : 1;
}

/* Reading polynomials.txt. Numbers by strtod: tests run in the C locale. */
#include "corpus/corpus.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char PATH[] = PSCN_SOURCE_DIR "/tests/corpus/polynomials.txt";

/* Reads "# name: what"; false for a plain comment. */
static int read_name(const char *line, struct corpus_entry *out)
{
  const char *colon = strstr(line, ": ");
  if (colon == NULL || colon - line - 2 >= (long)sizeof out->name || strchr(line + 2, ' ') < colon) return 0;
  memcpy(out->name, line + 2, (size_t)(colon - line - 2));
  out->name[colon - line - 2] = '\0';
  snprintf(out->what, sizeof out->what, "%.*s", (int)strcspn(colon + 2, "\n"), colon + 2);
  return 1;
}

static int read_coefficients(const char *line, struct corpus_entry *out)
{
  double high_first[POLYNOMIAL_MAX_DEGREE + 1];
  int count = 0;
  char *end;
  for (const char *at = line; count <= POLYNOMIAL_MAX_DEGREE; at = end) {
    high_first[count] = strtod(at, &end);
    if (end == at) break;
    count++;
  }
  out->degree = count - 1;
  for (int k = 0; k < count; k++) out->c[k] = high_first[count - 1 - k];
  const struct polynomial power = {out->degree, BASIS_POWER, out->c, NULL};
  if (count >= 2) polynomial_to_bernstein(&power, out->b, out->error);
  return count >= 2;
}

size_t corpus_read(struct corpus_entry out[CORPUS_MAX])
{
  FILE *file = fopen(PATH, "r");
  char line[8192];
  size_t count = 0;
  int named = 0, good = file != NULL;
  while (good && count < CORPUS_MAX && fgets(line, sizeof line, file) != NULL) {
    if (line[0] == '#') {
      named = read_name(line, &out[count]);
    } else {
      good = named && read_coefficients(line, &out[count]);
      named = 0;
      count++;
    }
  }
  if (file != NULL) fclose(file);
  return good ? count : 0;
}

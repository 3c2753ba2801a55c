/* The situations where methods fail, with every solver in our form and in the paper's, with and without polish. Prints
 * what is lost and invented, by the reference, as Markdown.
 *
 * Forms without polish promise nothing; what they lose is the finding. With `polish on` no solver may lose or invent
 * anything: otherwise the program fails. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "accuracy/situations.h"
#include "accuracy/trial.h"
#include "base/diagnostics.h"
#include "effort.h"
#include "language/language.h"
#include "random.h"

enum { FULL_RAYS = 10000, LEAST_RAYS = 32, MOST_CLASSES = 32 };

/* A column of the summary. The texts may follow `solver`. */
struct form {
  const char *name, *text;
  bool polish;
};

/* The paper's own method as a scene says it. With polish its plain iteration must be asked for. */
#define PAPER "{ form paper }"
#define PAPER_POLISHED "{ form paper polish on }"

static const struct form forms[] = {
  {"bernstein", "bernstein", true},
  {"aberth", "aberth", true},
  {"laguerre", "laguerre", true},
  {"newton", "newton", true},
  {"paper's aberth", "aberth " PAPER_POLISHED, true},
  {"paper's laguerre", "laguerre " PAPER_POLISHED, true},
  {"paper's newton", "newton " PAPER_POLISHED, true},
  {"bernstein", "bernstein { polish off }", false},
  {"aberth", "aberth { polish off }", false},
  {"laguerre", "laguerre { polish off }", false},
  {"newton", "newton { polish off }", false},
  {"paper's aberth", "aberth " PAPER, false},
  {"paper's laguerre", "laguerre " PAPER, false},
  {"paper's newton", "newton " PAPER, false},
};
enum { FORMS = sizeof forms / sizeof forms[0] };

static struct method options[FORMS];
static struct tally tallies[MOST_CLASSES][FORMS];

static void tell(void *context, const char *text, size_t length)
{
  (void)context;
  fwrite(text, 1, length, stderr);
}

static void run_situation(const struct situation *situation, struct tally row[FORMS])
{
  struct trial trials[FORMS];
  trial_create(&trials[0], (const double(*)[4][4][3])situation->P, situation->count, &options[0]);
  for (int form = 1; form < FORMS; form++) trial_create_beside(&trials[form], &trials[0], &options[form]);
  for (int first = 0; first < SITUATION_RAYS; first += PACKET_SIZE) {
    const struct ray *rays = &situation->rays[first];
    struct reference_answer truth[PACKET_SIZE];
    for (int n = 0; n < PACKET_SIZE; n++)
      reference_closest(trials[0].reference, rays[n].origin, rays[n].direction, &truth[n]);
    for (int form = 0; form < FORMS; form++) {
      struct hit hits[PACKET_SIZE];
      tracer_closest(trials[form].tracer, PACKET_SIZE, rays, hits);
      for (int n = 0; n < PACKET_SIZE; n++) trial_judge_by(&trials[form], &rays[n], &hits[n], &truth[n], &row[form]);
    }
  }
  for (int form = FORMS; form-- > 0;) trial_destroy(&trials[form]);
}

static void run_class(const struct situation_class *class, struct tally row[FORMS])
{
  size_t wanted = effort_count((size_t)(class->share * FULL_RAYS), LEAST_RAYS);
  struct random random = {.state = class->seed};
  for (int form = 0; form < FORMS; form++) row[form] = (struct tally){.name = class->name, .quiet = true};
  for (size_t index = 0; row[0].rays < wanted; index++) {
    struct situation situation;
    class->generate(&random, index, &situation);
    run_situation(&situation, row);
  }
}

/* Classes down, forms across. A cell is "lost + invented", or empty if both are 0. */
static void print_summary(bool polish)
{
  printf("| class | rays |");
  for (int form = 0; form < FORMS; form++)
    if (forms[form].polish == polish) printf(" %s |", forms[form].name);
  printf("\n|---|---|");
  for (int form = 0; form < FORMS; form++)
    if (forms[form].polish == polish) printf("---|");
  printf("\n");
  for (size_t n = 0; n < situation_class_count(); n++) {
    printf("| %s | %zu |", situation_class_at(n)->name, tallies[n][0].rays);
    for (int form = 0; form < FORMS; form++) {
      const struct tally *tally = &tallies[n][form];
      if (forms[form].polish != polish) continue;
      if (tally->lost + tally->invented == 0) printf(" 0 |");
      else printf(" %zu + %zu |", tally->lost, tally->invented);
    }
    printf("\n");
  }
  printf("\n");
}

/* Two digits, or a dash if nothing was measured. */
static void print_error(double error, bool measured)
{
  if (measured) printf(" %.1e |", error);
  else printf(" - |");
}

static void print_class(const struct situation_class *class, const struct tally row[FORMS])
{
  printf(
    "<details><summary>%s (seed %llu): %zu rays; the reference says %zu hits, %zu misses, %zu grazing</summary>\n\n",
    class->name, (unsigned long long)class->seed, row[0].rays, row[0].hits, row[0].misses, row[0].undecided);
  printf("| solver | lost | of these holes | invented | grazing | worst error of T, certain | grazing |\n"
         "|---|---|---|---|---|---|---|\n");
  for (int form = 0; form < FORMS; form++) {
    const struct tally *tally = &row[form];
    double worst = 0;
    for (size_t k = 0; k < tally->t_count; k++) worst = fmax(worst, tally->t_errors[k]);
    printf("| `%s` | %zu | %zu | %zu |", forms[form].text, tally->lost, tally->holes, tally->invented);
    if (forms[form].polish) printf(" %zu |", tally->grazing);
    else printf(" all |");
    print_error(worst, tally->t_count > 0);
    print_error(tally->worst_t_grazing, tally->worst_t_grazing > 0);
    printf("\n");
  }
  printf("\n</details>\n\n");
}

/* Whether all choices but polish are the paper's, as the solver statement of its method must mean. */
static bool is_papers(const struct method *o)
{
  return o->basis == BASIS_POWER && o->resultant == RESULTANT_SYLVESTER &&
         o->back_substitution == BACK_SUBSTITUTION_EUCLID && o->split == 1 && o->roots.start == START_COLD &&
         solver_options_paper(&o->roots);
}

int main(void)
{
  struct diagnostics diagnostics = {.tell = tell};
  for (int form = 0; form < FORMS; form++)
    if (language_parse_solver(forms[form].text, &diagnostics, &options[form]) != STATUS_OK) return EXIT_FAILURE;
  for (int form = 0; form < FORMS; form++)
    if (strstr(forms[form].name, "paper") != NULL && !is_papers(&options[form])) return EXIT_FAILURE;
  size_t count = situation_class_count(), defects = 0;
  if (count > MOST_CLASSES) return EXIT_FAILURE;
  for (size_t n = 0; n < count; n++) {
    run_class(situation_class_at(n), tallies[n]);
    for (int form = 0; form < FORMS; form++)
      if (forms[form].polish) defects += tallies[n][form].lost + tallies[n][form].invented;
  }
  printf("### With polish: lost + invented\n\n");
  print_summary(true);
  printf("### Without polish: lost + invented\n\n");
  print_summary(false);
  printf("### Each class\n\n");
  for (size_t n = 0; n < count; n++) {
    print_class(situation_class_at(n), tallies[n]);
    for (int form = 0; form < FORMS; form++) tally_free(&tallies[n][form]);
  }
  return defects == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}

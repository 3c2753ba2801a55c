/* The scene language for editors: words from the tables of the language and of the solvers. */
#include <string.h>

#include "language/words.h"
#include "packaging/pages.h"
#include "scene/method.h"

/* A word of solver statements by number: the names of solvers, of items and of their values; NULL behind the last. Some
 * occur twice. */
static const char *solver_word(size_t index)
{
  if (index < solver_count()) return solver_at(index)->name;
  index -= solver_count();
  if (index < method_item_count()) return method_item_at(index)->name;
  index -= method_item_count();
  for (size_t k = 0; k < method_item_count(); k++)
    for (const char *const *word = method_item_at(k)->keywords; word != NULL && *word != NULL; word++)
      if (index-- == 0) return *word;
  return NULL;
}

static bool is_solver_word(const char *word)
{
  const char *other;
  for (size_t k = 0; (other = solver_word(k)) != NULL; k++)
    if (strcmp(word, other) == 0) return true;
  return false;
}

/* Writes all words of a kind, except `solver`, which has its own rules, and except those of POV-Ray's other words that
 * solver statements use. */
static void put_words(FILE *file, enum words_kind kind, const char *between)
{
  const char *word, *before = "";
  for (size_t k = 0; (word = words_at(kind, k)) != NULL; k++) {
    if (strcmp(word, "solver") == 0 || (kind == WORDS_FOREIGN && is_solver_word(word))) continue;
    fprintf(file, "%s%s", before, word);
    before = between;
  }
}

static void put_solver_words(FILE *file, const char *between)
{
  const char *word;
  for (size_t k = 0; (word = solver_word(k)) != NULL; k++) fprintf(file, "%s%s", k > 0 ? between : "", word);
}

/* ---- Vim ---- */

static void put_vim_words(FILE *file, const char *group, enum words_kind kind)
{
  fprintf(file, "syntax keyword %s ", group);
  put_words(file, kind, " ");
  fputc('\n', file);
}

void write_vim(FILE *file)
{
  fputs("\" Vim syntax of pscn's scenes, made from the tables of the language.\n"
        "if exists(\"b:current_syntax\") | finish | endif\n"
        "syntax case match\n",
        file);
  put_vim_words(file, "pscnForeign", WORDS_FOREIGN);
  put_vim_words(file, "pscnStatement", WORDS_STATEMENTS);
  put_vim_words(file, "pscnItem", WORDS_ITEMS);
  put_vim_words(file, "pscnValue", WORDS_VALUES);
  fputs("syntax match pscnDirective \"#\\s*\\(", file);
  put_words(file, WORDS_DIRECTIVES, "\\|");
  fputs("\\)\\>\"\n"
        "syntax match pscnNumber \"\\(\\<\\d\\+\\.\\=\\d*\\|\\.\\d\\+\\)\\([eE][-+]\\=\\d\\+\\)\\=\"\n"
        "syntax region pscnString start=+\"+ end=+\"+ oneline\n"
        "syntax match pscnComment \"//.*\"\n"
        "syntax region pscnComment start=\"/\\*\" end=\"\\*/\" contains=pscnComment\n"
        "syntax keyword pscnSolverWord contained ",
        file);
  put_solver_words(file, " ");
  fputs("\nsyntax keyword pscnSolverName solver nextgroup=pscnSolver skipwhite skipempty\n"
        "syntax match pscnSolver \"\\w\\+\" contained nextgroup=pscnSolverBlock skipwhite skipempty\n"
        "syntax region pscnSolverBlock start=\"{\" end=\"}\" contained contains=pscnSolverWord,pscnNumber,pscnComment\n"
        "highlight default link pscnForeign Error\n"
        "highlight default link pscnStatement Statement\n"
        "highlight default link pscnItem Type\n"
        "highlight default link pscnValue Constant\n"
        "highlight default link pscnDirective PreProc\n"
        "highlight default link pscnNumber Number\n"
        "highlight default link pscnString String\n"
        "highlight default link pscnComment Comment\n"
        "highlight default link pscnSolver Identifier\n"
        "highlight default link pscnSolverName Statement\n"
        "highlight default link pscnSolverWord Type\n"
        "let b:current_syntax = \"pscn\"\n",
        file);
}

/* ---- TextMate grammar: VS Code and others ---- */

static void put_rule(FILE *file, const char *name, enum words_kind kind, const char *before)
{
  fprintf(file, "    { \"name\": \"%s.pscn\", \"match\": \"%s(", name, before);
  put_words(file, kind, "|");
  fputs(")\\\\b\" },\n", file);
}

void write_textmate(FILE *file)
{
  fputs("{\n  \"name\": \"pscn\",\n  \"scopeName\": \"source.pscn\",\n  \"fileTypes\": [\"pscn\"],\n  \"patterns\": [\n"
        "    { \"include\": \"#comment\" },\n"
        "    { \"name\": \"comment.line.pscn\", \"match\": \"//.*$\" },\n"
        "    { \"name\": \"string.quoted.pscn\", \"begin\": \"\\\"\", \"end\": \"\\\"|$\" },\n"
        "    { \"begin\": \"\\\\b(solver)\\\\s+(\\\\w+)\\\\s*\\\\{\", \"end\": \"\\\\}\",\n"
        "      \"beginCaptures\": { \"1\": { \"name\": \"keyword.control.pscn\" },\n"
        "        \"2\": { \"name\": \"entity.name.function.pscn\" } },\n"
        "      \"patterns\": [{ \"include\": \"#number\" }, { \"include\": \"#comment\" },\n"
        "        { \"name\": \"support.type.pscn\", \"match\": \"\\\\b(",
        file);
  put_solver_words(file, "|");
  fputs(
    ")\\\\b\" }] },\n"
    "    { \"match\": \"\\\\b(solver)\\\\s+(\\\\w+)\", \"captures\": { \"1\": { \"name\": \"keyword.control.pscn\" },\n"
    "      \"2\": { \"name\": \"entity.name.function.pscn\" } } },\n",
    file);
  put_rule(file, "keyword.control.directive", WORDS_DIRECTIVES, "#\\\\s*");
  put_rule(file, "keyword.control", WORDS_STATEMENTS, "\\\\b");
  put_rule(file, "support.type", WORDS_ITEMS, "\\\\b");
  put_rule(file, "constant.language", WORDS_VALUES, "\\\\b");
  put_rule(file, "invalid.illegal", WORDS_FOREIGN, "\\\\b");
  fputs("    { \"include\": \"#number\" }\n  ],\n"
        "  \"repository\": {\n"
        "    \"number\": { \"name\": \"constant.numeric.pscn\",\n"
        "      \"match\": \"(\\\\b[0-9]+\\\\.?[0-9]*|\\\\.[0-9]+)([eE][-+]?[0-9]+)?\" },\n"
        "    \"comment\": { \"name\": \"comment.block.pscn\", \"begin\": \"/\\\\*\", \"end\": \"\\\\*/\",\n"
        "      \"patterns\": [{ \"include\": \"#comment\" }] }\n"
        "  }\n}\n",
        file);
}

/* A scene as canonical text. Numbers are the shortest that read back to the same double, so a dump of what is read from a dump is
 * the same text. */
#include "scene/dump.h"


#include "base/number.h"

static void write_number(FILE *file, double value)
{
  char text[NUMBER_TEXT_SIZE];
  number_write(value, text);
  fputs(text, file);
}

static void write_vector(FILE *file, const double v[3])
{
  for (int k = 0; k < 3; k++) {
    fputs(k == 0 ? "<" : ", ", file);
    write_number(file, v[k]);
  }
  fputc('>', file);
}

static void write_item(FILE *file, const char *name, double value)
{
  fprintf(file, " %s ", name);
  write_number(file, value);
}

/* All items, so that the text does not lean on defaults that a later version may change. */
static void write_solver(FILE *file, const struct solver_options *options)
{
  fprintf(file, "solver %s {", options->solver->name);
  for (size_t k = 0; k < solver_item_count(); k++) {
    const struct solver_item *item = solver_item_at(k);
    const double value = item->get(options);
    size_t words = 0;
    while (item->keywords && item->keywords[words]) words++;
    if (value >= 0 && value < (double)words) fprintf(file, " %s %s", item->name, item->keywords[(size_t)value]);
    else write_item(file, item->name, value);
  }
  fputs(" }", file);
}

/* POV-Ray does not know solvers; what it does not see it does not mind. */
static void write_guarded_solver(FILE *file, const struct solver_options *options)
{
  fputs("  #ifdef (pscn)\n    ", file);
  write_solver(file, options);
  fputs("\n  #end\n", file);
}

static void write_camera(FILE *file, const struct scene_camera *camera)
{
  fputs("camera {\n  location ", file);
  write_vector(file, camera->location);
  fputs("\n  direction ", file);
  write_vector(file, camera->direction);
  fputs("\n  right ", file);
  write_vector(file, camera->right);
  fputs("\n  up ", file);
  write_vector(file, camera->up);
  fputs("\n}\n", file);
}

static void write_light(FILE *file, const struct scene_light *light)
{
  fputs("light_source { ", file);
  write_vector(file, light->position);
  fputs(", rgb ", file);
  write_vector(file, light->color);
  fputs(light->shadowless ? " shadowless }\n" : " }\n", file);
}

static void write_texture(FILE *file, const struct scene_texture *texture)
{
  const struct scene_finish *finish = &texture->finish;
  fputs("  texture {\n    pigment { color rgb ", file);
  write_vector(file, texture->pigment);
  fputs(" }\n    finish { ambient rgb ", file);
  write_vector(file, finish->ambient);
  write_item(file, "diffuse", finish->diffuse);
  write_item(file, "brilliance", finish->brilliance);
  write_item(file, "phong", finish->phong);
  write_item(file, "phong_size", finish->phong_size);
  write_item(file, "specular", finish->specular);
  write_item(file, "roughness", finish->roughness);
  fputs(" }\n  }\n", file);
}

static void write_patch(FILE *file, const struct scene *scene, const struct scene_patch *patch)
{
  fprintf(file, "bicubic_patch {\n  type %d flatness ", patch->type);
  write_number(file, patch->flatness);
  fprintf(file, " u_steps %d v_steps %d\n", patch->u_steps, patch->v_steps);
  for (int i = 0; i < 4; i++) {
    for (int j = 0; j < 4; j++) {
      fputs(j == 0 ? "  " : ", ", file);
      write_vector(file, patch->P[i][j]);
    }
    fputs(i < 3 ? ",\n" : "\n", file);
  }
  write_texture(file, &scene->textures[patch->texture]);
  if (patch->solver != 0) write_guarded_solver(file, &scene->solvers[patch->solver]);
  fputs("}\n", file);
}

enum status scene_dump(const struct scene *scene, FILE *file)
{
  fputs("#version 3.7;\nglobal_settings {\n  assumed_gamma 1\n  ambient_light rgb ", file);
  write_vector(file, scene->ambient_light);
  fputc('\n', file);
  write_guarded_solver(file, &scene->solvers[0]);
  fputs("}\n", file);
  write_camera(file, &scene->camera);
  fputs("background { rgb ", file);
  write_vector(file, scene->background);
  fputs(" }\n", file);
  for (size_t k = 0; k < scene->light_count; k++) write_light(file, &scene->lights[k]);
  for (size_t k = 0; k < scene->patch_count; k++) write_patch(file, scene, &scene->patches[k]);
  return ferror(file) ? STATUS_FILE : STATUS_OK;
}

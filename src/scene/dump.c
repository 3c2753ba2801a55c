/* A scene as canonical text. There is one order, one layout, and numbers are written by number_write, so equal scenes
 * give equal text. Textures keep the scene's numbers, which are in the order in which patches first use them. */
#include "scene/scene.h"

#include "base/number.h"

static void put_item(FILE *file, const char *before, double value)
{
  char text[NUMBER_TEXT_SIZE];
  number_write(value, text);
  fputs(before, file);
  fputs(text, file);
}

/* In two calls of stdio, each of which costs as much as writing a number. */
static void put_vector(FILE *file, const char *before, const double v[3])
{
  char text[3 * (NUMBER_TEXT_SIZE + 2)], *end = text;
  for (int k = 0; k < 3; k++) {
    *end++ = k == 0 ? '<' : ',';
    if (k > 0) *end++ = ' ';
    end += number_write(v[k], end);
  }
  *end++ = '>';
  *end = '\0';
  fputs(before, file);
  fputs(text, file);
}

static void put_solver(FILE *file, const struct method *method)
{
  char text[METHOD_TEXT_SIZE];
  method_text(method, text, sizeof text);
  fprintf(file, "#ifdef (pscn)\n  solver %s\n#end\n", text);
}

static void put_texture(FILE *file, const struct scene_texture *texture, size_t number)
{
  const struct scene_finish *finish = &texture->finish;
  fprintf(file, "#declare Texture%zu", number);
  put_vector(file, " = texture {\n  pigment { rgb ", texture->pigment);
  put_vector(file, " }\n  finish {\n    ambient rgb ", finish->ambient);
  put_item(file, "\n    diffuse ", finish->diffuse);
  put_item(file, " brilliance ", finish->brilliance);
  put_item(file, "\n    phong ", finish->phong);
  put_item(file, " phong_size ", finish->phong_size);
  put_item(file, "\n    specular ", finish->specular);
  put_item(file, " roughness ", finish->roughness);
  fputs("\n  }\n}\n", file);
}

static void put_settings(FILE *file, const struct scene *scene)
{
  fputs("#version 3.7;\nglobal_settings {\n  assumed_gamma ", file);
  if (scene->gamma == GAMMA_SRGB) fputs("srgb", file);
  else put_item(file, "", scene->gamma);
  put_vector(file, "\n  ambient_light rgb ", scene->ambient_light);
  fputs("\n", file);
  put_solver(file, &scene->solvers[0]);
  put_vector(file, "}\nbackground { rgb ", scene->background);
  put_vector(file, " }\ncamera {\n  location ", scene->camera.location);
  put_vector(file, "\n  direction ", scene->camera.direction);
  put_vector(file, "\n  right ", scene->camera.right);
  put_vector(file, "\n  up ", scene->camera.up);
  fputs("\n}\n", file);
}

static void put_light(FILE *file, const struct scene_light *light)
{
  put_vector(file, "light_source { ", light->position);
  put_vector(file, ", rgb ", light->color);
  fputs(light->shadowless ? " shadowless }\n" : " }\n", file);
}

static void put_patch(FILE *file, const struct scene_patch *patch, const struct method solvers[])
{
  put_item(file, "bicubic_patch {\n  type ", patch->type);
  put_item(file, " flatness ", patch->flatness);
  put_item(file, " u_steps ", patch->u_steps);
  put_item(file, " v_steps ", patch->v_steps);
  for (int i = 0; i < 4; i++) {
    for (int j = 0; j < 4; j++) put_vector(file, j == 0 ? "\n  " : ", ", patch->P[i][j]);
    if (i < 3) fputs(",", file);
  }
  fprintf(file, "\n  texture { Texture%lu }\n", (unsigned long)patch->texture);
  if (!method_equal(&solvers[patch->solver], &solvers[0])) put_solver(file, &solvers[patch->solver]);
  fputs("}\n", file);
}

static void put_textures(FILE *file, const struct scene *scene)
{
  for (size_t i = 0; i < scene->texture_count; i++) put_texture(file, &scene->textures[i], i);
}

static void put_patches(FILE *file, const struct scene *scene)
{
  for (size_t i = 0; i < scene->patch_count && !ferror(file); i++) put_patch(file, &scene->patches[i], scene->solvers);
}

enum status scene_dump(const struct scene *scene, FILE *file)
{
  put_settings(file, scene);
  for (size_t i = 0; i < scene->light_count; i++) put_light(file, &scene->lights[i]);
  put_textures(file, scene);
  put_patches(file, scene);
  return ferror(file) ? STATUS_FILE : STATUS_OK;
}

enum status scene_dump_union(const struct scene *scene, const char *name, FILE *file)
{
  put_textures(file, scene);
  fprintf(file, "#declare %s = union {\n", name);
  put_patches(file, scene);
  fputs("}\n", file);
  return ferror(file) ? STATUS_FILE : STATUS_OK;
}

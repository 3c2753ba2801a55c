/* A scene as canonical text. There is one order, one layout, and numbers are written by number_write, so equal scenes
 * give equal text. Textures keep the scene's numbers, which are in the order in which patches first use them. */
#include "scene/dump.h"

#include "base/number.h"
#include "scene/gamma.h"

struct dump {
  const struct scene *scene;
  FILE *file;
  bool failed;
};

static void put(struct dump *dump, const char *text) { dump->failed |= fputs(text, dump->file) == EOF; }

static void put_number(struct dump *dump, double value)
{
  char text[NUMBER_TEXT_SIZE];
  number_write(value, text);
  put(dump, text);
}

static void put_item(struct dump *dump, const char *before, double value)
{
  put(dump, before);
  put_number(dump, value);
}

/* In two calls of stdio, each of which costs as much as writing a number. */
static void put_vector(struct dump *dump, const char *before, const double v[3])
{
  char text[3 * (NUMBER_TEXT_SIZE + 2)], *end = text;
  for (int k = 0; k < 3; k++) {
    *end++ = k == 0 ? '<' : ',';
    if (k > 0) *end++ = ' ';
    end += number_write(v[k], end);
  }
  *end++ = '>';
  *end = '\0';
  put(dump, before);
  put(dump, text);
}

static void put_solver(struct dump *dump, const struct method *method)
{
  char text[METHOD_TEXT_SIZE];
  method_text(method, text, sizeof text);
  put(dump, "#ifdef (pscn)\n  solver ");
  put(dump, text);
  put(dump, "\n#end\n");
}

/* ---- textures ---- */

static void put_texture_name(struct dump *dump, uint32_t number)
{
  char text[32];
  snprintf(text, sizeof text, "Texture%lu", (unsigned long)number);
  put(dump, text);
}

static void put_texture(struct dump *dump, uint32_t number)
{
  const struct scene_texture *texture = &dump->scene->textures[number];
  const struct scene_finish *finish = &texture->finish;
  put(dump, "#declare ");
  put_texture_name(dump, number);
  put_vector(dump, " = texture {\n  pigment { rgb ", texture->pigment);
  put_vector(dump, " }\n  finish {\n    ambient rgb ", finish->ambient);
  put_item(dump, "\n    diffuse ", finish->diffuse);
  put_item(dump, " brilliance ", finish->brilliance);
  put_item(dump, "\n    phong ", finish->phong);
  put_item(dump, " phong_size ", finish->phong_size);
  put_item(dump, "\n    specular ", finish->specular);
  put_item(dump, " roughness ", finish->roughness);
  put(dump, "\n  }\n}\n");
}

/* ---- the parts of a scene ---- */

static void put_settings(struct dump *dump)
{
  const struct scene *scene = dump->scene;
  put(dump, "#version 3.7;\nglobal_settings {\n  assumed_gamma ");
  if (scene->gamma == GAMMA_SRGB) put(dump, "srgb");
  else put_number(dump, scene->gamma);
  put_vector(dump, "\n  ambient_light rgb ", scene->ambient_light);
  put(dump, "\n");
  put_solver(dump, &scene->solvers[0]);
  put_vector(dump, "}\nbackground { rgb ", scene->background);
  put_vector(dump, " }\ncamera {\n  location ", scene->camera.location);
  put_vector(dump, "\n  direction ", scene->camera.direction);
  put_vector(dump, "\n  right ", scene->camera.right);
  put_vector(dump, "\n  up ", scene->camera.up);
  put(dump, "\n}\n");
}

static void put_light(struct dump *dump, const struct scene_light *light)
{
  put_vector(dump, "light_source { ", light->position);
  put_vector(dump, ", rgb ", light->color);
  put(dump, light->shadowless ? " shadowless }\n" : " }\n");
}

static void put_patch(struct dump *dump, const struct scene_patch *patch)
{
  put_item(dump, "bicubic_patch {\n  type ", patch->type);
  put_item(dump, " flatness ", patch->flatness);
  put_item(dump, " u_steps ", patch->u_steps);
  put_item(dump, " v_steps ", patch->v_steps);
  for (int i = 0; i < 4; i++) {
    for (int j = 0; j < 4; j++) put_vector(dump, j == 0 ? "\n  " : ", ", patch->P[i][j]);
    if (i < 3) put(dump, ",");
  }
  put(dump, "\n  texture { ");
  put_texture_name(dump, patch->texture);
  put(dump, " }\n");
  const struct method *solvers = dump->scene->solvers;
  if (!method_equal(&solvers[patch->solver], &solvers[0])) put_solver(dump, &solvers[patch->solver]);
  put(dump, "}\n");
}

static void put_textures(struct dump *dump)
{
  for (uint32_t i = 0; i < dump->scene->texture_count; i++) put_texture(dump, i);
}

static void put_patches(struct dump *dump)
{
  for (size_t i = 0; i < dump->scene->patch_count && !dump->failed; i++) put_patch(dump, &dump->scene->patches[i]);
}

enum status scene_dump(const struct scene *scene, FILE *file)
{
  struct dump dump = {.scene = scene, .file = file};
  put_settings(&dump);
  for (size_t i = 0; i < scene->light_count; i++) put_light(&dump, &scene->lights[i]);
  put_textures(&dump);
  put_patches(&dump);
  return dump.failed ? STATUS_FILE : STATUS_OK;
}

enum status scene_dump_union(const struct scene *scene, const char *name, FILE *file)
{
  struct dump dump = {.scene = scene, .file = file};
  put_textures(&dump);
  put(&dump, "#declare ");
  put(&dump, name);
  put(&dump, " = union {\n");
  put_patches(&dump);
  put(&dump, "}\n");
  return dump.failed ? STATUS_FILE : STATUS_OK;
}

/* Plain numbers in a file. */
#include "chart/exchange.h"

#include <string.h>

static const char MAGIC[8] = "pscn 1\n";

static bool put(FILE *file, const void *bytes, size_t size, size_t count)
{
  return fwrite(bytes, size, count, file) == count;
}

static bool get(FILE *file, void *bytes, size_t size, size_t count) { return fread(bytes, size, count, file) == count; }

bool exchange_write_question(FILE *file, const struct exchange_question *question)
{
  bool good = put(file, MAGIC, sizeof MAGIC, 1) && put(file, question, sizeof *question, 1) &&
              put(file, question->nets, sizeof *question->nets, question->patch_count);
  for (int kind = 0; good && kind < RAY_KINDS; kind++) {
    const struct ray_list *list = &question->rays[kind];
    good = put(file, list->rays, sizeof *list->rays, list->count) &&
           put(file, list->packets, sizeof *list->packets, list->packet_count);
  }
  return good;
}

bool exchange_read_question(FILE *file, struct arena *arena, struct exchange_question *out)
{
  char magic[sizeof MAGIC];
  if (!get(file, magic, sizeof magic, 1) || memcmp(magic, MAGIC, sizeof magic) != 0 ||
      !get(file, out, sizeof *out, 1) || out->side_count > EXCHANGE_MAX_SIDES || out->rounds > MEASURE_MAX_ROUNDS)
    return false;
  out->nets = arena_alloc(arena, out->patch_count + 1, sizeof *out->nets);
  bool good = out->nets != NULL && get(file, out->nets, sizeof *out->nets, out->patch_count);
  for (int kind = 0; good && kind < RAY_KINDS; kind++) {
    struct ray_list *list = &out->rays[kind];
    list->rays = arena_alloc(arena, list->count + 1, sizeof *list->rays);
    list->packets = arena_alloc(arena, list->packet_count + 1, sizeof *list->packets);
    good = list->rays != NULL && list->packets != NULL && get(file, list->rays, sizeof *list->rays, list->count) &&
           get(file, list->packets, sizeof *list->packets, list->packet_count);
  }
  return good;
}

bool exchange_write_answer(FILE *file, const struct exchange_answer *answer, size_t camera,
                           const struct answer *answers, size_t shadow, const bool *occluded)
{
  return put(file, answer, sizeof *answer, 1) && put(file, answers, sizeof *answers, camera) &&
         put(file, occluded, sizeof *occluded, shadow);
}

bool exchange_read_answer(FILE *file, struct exchange_answer *out, size_t camera, struct answer *answers, size_t shadow,
                          bool *occluded)
{
  return get(file, out, sizeof *out, 1) && get(file, answers, sizeof *answers, camera) &&
         get(file, occluded, sizeof *occluded, shadow);
}

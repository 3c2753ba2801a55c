/* The numbers of `pscn check` as a table and as JSON. */
#include <math.h>

#include "command/check.h"
#include "base/version.h"

static void row_name(const struct check_row *row, char *out, size_t size)
{
  if (row->steps == 0)
    snprintf(out, size, "as written");
  else
    snprintf(out, size, "u_steps %zu", row->steps);
}

static double percent(size_t count, size_t of)
{
  return 100 * (double)count / (double)of;
}

static void print_pictures(const struct check *check)
{
  printf("\npictures    %%>1/255  %%>4/255 %%>16/255      max     psnr  off edges  only here  only there  seconds    "
         "cpu\n");
  for (size_t k = 0; k < check->row_count; k++) {
    const struct check_row *row = &check->row[k];
    char name[32];
    row_name(row, name, sizeof name);
    printf("%-10s", name);
    for (int c = 0; c < CHECK_CODES; c++)
      printf(" %8.4f", percent(row->over[c], row->result.pixels));
    printf(" %4.0f/255 %8.2f %10zu %10zu %11zu %8.2f %6.2f\n", 255 * row->result.max, row->result.psnr,
           row->over_limit_on[CHECK_EDGE_NONE], row->mask_ours, row->mask_theirs, row->picture.wall, row->picture.cpu);
  }
  printf("%-84s %8.2f %6.2f\n", "pscn", check->ours.time.wall, check->ours.time.cpu);
}

static void print_distances(const struct check *check)
{
  printf("\ndistances       rays  hit by both  only here  only there     median         99%%         max\n");
  for (size_t k = 0; k < check->row_count; k++) {
    const struct check_distances *d = &check->row[k].distances;
    char name[32];
    row_name(&check->row[k], name, sizeof name);
    printf("%-10s %9zu %12zu %10zu %11zu", name, d->rays, d->both, d->only_ours, d->only_theirs);
    if (d->both == 0)
      printf(" %10s  %10s  %10s\n", "-", "-", "-");
    else
      printf(" %10.2e  %10.2e  %10.2e\n", d->median, d->most, d->max);
  }
}

void check_print(const struct check *check)
{
  printf("scene       %s, %zux%zu pixels\n", check->request->scene.path, check->width, check->height);
  printf("povray      %s\n", check->povray.version);
  print_pictures(check);
  if (check->request->grid > 0)
    print_distances(check);
}

/* ---- JSON ---- */

/* JSON has no infinity: null stands for it. */
static json_t *number(double value)
{
  return isfinite(value) ? json_real(value) : json_null();
}

static json_t *count(size_t value)
{
  return json_integer((json_int_t)value);
}

static json_t *distances_json(const struct check_distances *d)
{
  return json_pack("{s:o,s:o,s:o,s:o,s:o,s:o,s:o}", "rays", count(d->rays), "both", count(d->both), "only_here",
                   count(d->only_ours), "only_there", count(d->only_theirs), "median", number(d->median), "percent_99",
                   number(d->most), "max", number(d->max));
}

static json_t *row_json(const struct check *check, const struct check_row *row)
{
  const struct compare_result *r = &row->result;
  json_t *over = json_pack("{s:o,s:o,s:o,s:o}", "1/255", count(row->over[0]), "4/255", count(row->over[1]), "16/255",
                           count(row->over[2]), "limit", count(row->over_limit));
  json_t *root =
    json_pack("{s:o,s:o,s:o,s:o,s:o,s:o,s:o,s:o}", "u_steps", row->steps == 0 ? json_null() : count(row->steps), "over",
              over, "over_limit_off_edges", count(row->over_limit_on[CHECK_EDGE_NONE]), "mean", number(r->mean),
              "rms", number(r->rms),
              "psnr", number(r->psnr), "max", number(r->max), "worst",
              json_pack("[i,i]", (int)r->worst_x, (int)r->worst_y));
  if (root == NULL)
    return NULL;
  json_t *on = json_object();
  for (int edge = CHECK_EDGE_NONE + 1; edge < CHECK_EDGES; edge++)
    json_object_set_new(on, CHECK_EDGE_NAME[edge], count(row->over_limit_on[edge]));
  json_object_set_new(root, "over_limit_on", on);
  json_object_set_new(root, "mask", json_pack("{s:o,s:o}", "only_here", count(row->mask_ours), "only_there",
                                              count(row->mask_theirs)));
  if (check->request->grid > 0)
    json_object_set_new(root, "distances", distances_json(&row->distances));
  json_object_set_new(root, "time", json_pack("{s:f,s:f}", "wall", row->picture.wall, "cpu", row->picture.cpu));
  return root;
}

static json_t *worst_json(const struct check *check, const struct check_worst *worst)
{
  const struct check_pixel *pixel = &check->ours.pixel[worst->y * check->width + worst->x];
  const bool hit = pixel->hit.patch != HIT_NONE;
  json_t *here = !hit ? json_null()
                      : json_pack("{s:o,s:o,s:f,s:f,s:b}", "distance", number(pixel->distance), "patch",
                                  count(pixel->hit.patch), "u", pixel->hit.u, "v", pixel->hit.v, "certain",
                                  pixel->hit.certainty == CERTAINTY_CERTAIN);
  json_t *edge = pixel->edge == CHECK_EDGE_NONE ? json_null() : json_string(CHECK_EDGE_NAME[pixel->edge]);
  return json_pack("{s:[i,i],s:f,s:o,s:o,s:o}", "pixel", (int)worst->x, (int)worst->y, "difference", worst->difference,
                   "edge", edge, "here", here, "there_distance", number(worst->distance));
}

json_t *check_json(const struct check *check)
{
  const struct check_request *request = check->request;
  json_t *rows = json_array(), *worst = json_array();
  for (size_t k = 0; k < check->row_count; k++)
    json_array_append_new(rows, row_json(check, &check->row[k]));
  for (size_t k = 0; k < check->worst_count; k++)
    json_array_append_new(worst, worst_json(check, &check->worst[k]));
  char message[256];
  const bool within = check_within_limits(check, message, sizeof message);
  json_t *limits = json_pack("{s:o,s:o,s:o,s:o,s:o,s:o}", "fail", number(request->fail.each), "failpercent",
                             number(request->fail.percent), "allowfailures", number(request->fail.allowed_pixels),
                             "hardfail", number(request->fail.any), "failpsnr", number(request->fail_psnr), "failmask",
                             number(request->fail_mask));
  return json_pack("{s:s,s:s,s:s,s:[i,i],s:o,s:b,s:o,s:o,s:{s:f,s:f}}", "version", PSCN_VERSION, "povray",
                   check->povray.version, "scene", request->scene.path, "size", (int)check->width, (int)check->height,
                   "limits", limits, "within_limits", within, "rows", rows, "worst", worst, "time", "wall",
                   check->ours.time.wall, "cpu", check->ours.time.cpu);
}

/* The numbers of a check as JSON. */
#include "check/measure.h"

#include <stdio.h>

#include "base/json_text.h"
#include "page/page.h"
#include "library/pscn.h"

static void row_name(const struct check *check, const struct check_row *row, char *out, size_t size)
{
  if (row->steps == 0) snprintf(out, size, check->dumped[0] == '\0' ? "as written" : "dump");
  else snprintf(out, size, "u_steps %zu", row->steps);
}

static json_t *distances_json(const struct check_distances *d)
{
  return json_pack("{s:o,s:o,s:o,s:o,s:o,s:o,s:o}", "rays", json_count(d->rays), "both", json_count(d->both),
                   "only_here", json_count(d->only_ours), "only_there", json_count(d->only_theirs), "median",
                   page_of_number(d->median), "percent_99", page_of_number(d->p99), "max", page_of_number(d->max));
}

static json_t *row_json(const struct check *check, const struct check_row *row)
{
  const struct compare_result *r = &row->result;
  const size_t *on = row->over_limit_on;
  char name[32];
  row_name(check, row, name, sizeof name);
  json_t *root = json_pack(
    "{s:o,s:s,s:{s:o,s:o,s:o,s:o},s:o,s:o,s:o,s:o,s:o,s:[i,i],s:{s:o,s:o,s:o},s:{s:o,s:o},s:{s:f,s:f}}", "u_steps",
    row->steps == 0 ? json_null() : json_count(row->steps), "name", name, "over", "1/255", json_count(row->over[0]),
    "4/255", json_count(row->over[1]), "16/255", json_count(row->over[2]), "limit", json_count(row->over_limit),
    "over_limit_off_edges", json_count(on[CHECK_EDGE_NONE]), "mean", page_of_number(r->mean), "rms",
    page_of_number(r->rms), "psnr", page_of_number(r->psnr), "max", page_of_number(r->max), "worst", (int)r->worst_x,
    (int)r->worst_y, "over_limit_on", CHECK_EDGE_NAME[CHECK_EDGE_CREASE], json_count(on[CHECK_EDGE_CREASE]),
    CHECK_EDGE_NAME[CHECK_EDGE_SHADOW], json_count(on[CHECK_EDGE_SHADOW]), CHECK_EDGE_NAME[CHECK_EDGE_SILHOUETTE],
    json_count(on[CHECK_EDGE_SILHOUETTE]), "mask", "only_here", json_count(row->mask_ours), "only_there",
    json_count(row->mask_theirs), "time", "wall", row->picture.time.wall, "cpu", row->picture.time.cpu);
  if (root == NULL || check->request->grid == 0) return root;
  return json_join(root, json_pack("{s:o}", "distances", distances_json(&row->distances)));
}

static json_t *worst_json(const struct check *check, const struct check_worst *worst)
{
  const struct check_pixel *pixel = &check->ours.pixel[worst->y * check->request->width + worst->x];
  const bool hit = pixel->patch != HIT_NONE;
  json_t *here = !hit ? json_null()
                      : json_pack("{s:o,s:o,s:f,s:f,s:b}", "distance", page_of_number(pixel->distance), "patch",
                                  json_count(pixel->patch), "u", pixel->u, "v", pixel->v, "certain",
                                  pixel->certainty == CERTAINTY_CERTAIN);
  json_t *edge = pixel->edge == CHECK_EDGE_NONE ? json_null() : json_string(CHECK_EDGE_NAME[pixel->edge]);
  return json_pack("{s:[i,i],s:f,s:o,s:o,s:o}", "pixel", (int)worst->x, (int)worst->y, "difference", worst->difference,
                   "edge", edge, "here", here, "there_distance", page_of_number(worst->distance));
}

json_t *check_json(const struct check *check)
{
  const struct check_request *request = check->request;
  json_t *rows = json_array(), *worst = json_array();
  char message[256];
  for (size_t k = 0; k < check->row_count; k++) rows = json_append(rows, row_json(check, &check->row[k]));
  for (size_t k = 0; k < check->worst_count; k++) worst = json_append(worst, worst_json(check, &check->worst[k]));
  return json_pack("{s:s,s:s,s:o,s:o,s:[i,i],s:{s:o,s:o,s:o,s:o,s:o,s:o},s:b,s:o,s:o,s:{s:f,s:f}}", "version",
                   PSCN_VERSION, "povray", check->povray.version, "scene", page_of_text(request->path), "dumped",
                   check->dumped[0] == '\0' ? json_null() : page_of_text(check->dumped), "size", (int)request->width,
                   (int)request->height, "limits", "fail", page_of_number(request->fail.each), "failpercent",
                   page_of_number(request->fail.percent), "allowfailures", page_of_number(request->fail.allowed_pixels),
                   "hardfail", page_of_number(request->fail.any), "failpsnr", page_of_number(request->fail_psnr),
                   "failmask", page_of_number(request->fail_mask), "within_limits",
                   check_within_limits(check, message, sizeof message), "rows", rows, "worst", worst, "time", "wall",
                   check->ours.time.wall, "cpu", check->ours.time.cpu);
}

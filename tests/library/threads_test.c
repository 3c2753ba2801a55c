/* Threads that share a scene get its answers, each on a stack of the size that pscn.h asks for, while others build scenes of
 * their own. */
#include <math.h>
#include <pthread.h>
#include <stddef.h>
#include <string.h>

#include "library/ball_rays.h"

/* The stack that pscn.h asks for, and our own arrays. Sanitizers need more. */
enum { THREADS = 4, TURNS = 6, STACK = (1024 << 10) + COUNT * 200 };

/* Rays past a pole at 2^-1 ... 2^-64, from outside and along the surface, which take the deepest search. */
static char *ask_at_pole(const struct pscn_scene *scene)
{
  for (int n = 0; n < 512; n++) {
    const double off = ldexp(1, -1 - n / 8), x = off * cos(n % 8), z = off * sin(n % 8);
    const struct pscn_ray rays[2] = {{{x, 3, z}, {0, -1, 0}, 0, INFINITY}, {{x, 1, z}, {1, -off, 0.25}, 0, INFINITY}};
    struct pscn_hit hits[2];
    if (pscn_nearest(scene, 2, rays, sizeof *rays, hits, sizeof *hits) != PSCN_OK) return "no answer at a pole";
    if (hits[0].verdict == PSCN_MISS) return "a ray goes through the pole";
  }
  return NULL;
}

/* Again and again asks the shared scene, and builds, asks and frees its own one. Returns what went wrong. */
static void *thread_run(void *context)
{
  (void)context;
  struct pscn_hit hits[COUNT];
  char *wrong = ask_at_pole(ball.scene);
  if (wrong) return wrong;
  for (int turn = 0; turn < TURNS; turn++) {
    memset(hits, 0, sizeof hits);
    if (pscn_nearest(ball.scene, COUNT, ball.ray, sizeof *ball.ray, hits, sizeof *hits) != PSCN_OK ||
        memcmp(hits, ball.hit, sizeof hits) != 0)
      return "the shared scene answers otherwise";
    struct pscn_hits counts[COUNT];
    if (pscn_all(ball.scene, COUNT, ball.ray, sizeof *ball.ray, counts, sizeof *counts, hits, sizeof *hits, 1) !=
        PSCN_OK)
      return "all hits cannot be had";
    for (int n = 0; n < COUNT; n++) /* all members up to the normal */
      if (memcmp(&hits[n], &ball.hit[n], offsetof(struct pscn_hit, normal)) != 0 || hits[n].patch != ball.hit[n].patch)
        return "the first of all hits is not the nearest";
    struct pscn_scene *own;
    double points[BALL_PATCHES][4][4][3];
    ball_points(points);
    if (pscn_scene_from_points(**points[0], BALL_PATCHES, sizeof *points, sizeof ***points, NULL, &own) != PSCN_OK ||
        pscn_nearest(own, COUNT, ball.ray, sizeof *ball.ray, hits, sizeof *hits) != PSCN_OK ||
        memcmp(hits, ball.hit, sizeof hits) != 0)
      return "a scene of its own answers otherwise";
    pscn_scene_free(own);
    if (pscn_scene_from_text("wrong", "camera { loaction }", 19, NULL, &own) != PSCN_INPUT ||
        pscn_message_count(own) == 0)
      return "a wrong text has no message";
    pscn_scene_free(own);
  }
  return NULL;
}

TEST(test_threads)
{
  pthread_t threads[THREADS];
  pthread_attr_t attributes;
  assert_int_equal(pthread_attr_init(&attributes), 0);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  assert_int_equal(pthread_attr_setstacksize(&attributes, STACK), 0);
#endif
  for (int k = 0; k < THREADS; k++) assert_int_equal(pthread_create(&threads[k], &attributes, thread_run, NULL), 0);
  for (int k = 0; k < THREADS; k++) {
    void *wrong;
    assert_int_equal(pthread_join(threads[k], &wrong), 0);
    if (wrong) fail_msg("%s", (const char *)wrong);
  }
  assert_int_equal(pthread_attr_destroy(&attributes), 0);
}

int main(void) { return test_run_with_rays(); }

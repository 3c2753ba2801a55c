/* The points of a chart: which there are, and their Pareto front. */
#ifndef PSCN_CHART_POINT_H
#define PSCN_CHART_POINT_H

#include "chart/measure.h"

enum family {
  FAMILY_DEFAULT, /* `bernstein` */
  FAMILY_NEWTON,
  FAMILY_LAGUERRE,
  FAMILY_ABERTH,
  FAMILY_PAPER, /* the paper's own form of its three solvers */
  FAMILY_OTHER, /* durand_kerner */
  FAMILY_RIVAL,
  FAMILY_EMBREE,
  FAMILY_POVRAY,
  FAMILIES
};

const char *family_name(enum family family);

enum { POINT_NAME_SIZE = 160 };

struct chart_point {
  enum family family;
  char name[POINT_NAME_SIZE]; /* what was run; for pscn, the text behind `solver` */
  char label[16];             /* the text beside the point in the figure, or "" */
  bool ours;                  /* options is set */
  struct method options;
  struct timing time[RAY_KINDS];
  struct judgement camera, shadow;
  bool has_shadow; /* shadow is set */
  bool front;
};

/* The solvers to chart: all except durand_kerner, with each basis, start, polish and tolerance that makes a difference,
 * and the paper's forms. The first one is the default. Returns their number. */
enum { SWEEP_MOST = 512 };
struct sweep_point {
  enum family family;
  struct method options;
};
size_t point_sweep(bool quick, struct sweep_point out[SWEEP_MOST]);

/* The default, and then these solvers. */
void point_choice(const struct method solvers[], size_t count, struct sweep_point out[]);

/* Scales the times of every point to those at which the yardstick takes yard[kind], its median of the whole run: the
 * median becomes ratio x yard[kind]. Whatever slows the machine for a while also slows the yardstick of the same
 * rounds. */
void point_level(struct chart_point *points, size_t count, const double yard[RAY_KINDS]);

/* Marks the points that no other one beats: one that is no slower and no less exact, and better in one of the two or,
 * if equal in both, earlier. Exactness is camera.p99_of_all. Points without both numbers are never on the front. */
void point_front(struct chart_point *points, size_t count);

#endif

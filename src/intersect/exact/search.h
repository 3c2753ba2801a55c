/* A search that is under way: search.c, which goes through its boxes, and pole.c, which decides those at poles.
 *
 * Internal to src/intersect/exact. How a search is asked for stands in judge.h.
 */
#ifndef PSCN_INTERSECT_EXACT_SEARCH_H
#define PSCN_INTERSECT_EXACT_SEARCH_H

#include "intersect/exact/window.h"

enum { NO_BORDER = -1, TWO_BORDERS = -2 };

struct search {
  struct window window; /* what the whole box is of the patch */
  int ahead;            /* boxes that may wait in the order of the ray */
  int divided;          /* the border by the distance to which the first net is divided (zoom_pole_box), or NO_BORDER */
  bool dependent;       /* some combination is zero, which it then is everywhere: there is nothing to see of it */
  bool met;             /* the pole there may be met: nothing is said of what is nearer to it than ZOOM_POLE_MET, ... */
  double met_error[2];  /* ... and this over the distance from it is what it adds to the errors of the first two nets */
  double error[2];      /* bounds on the errors of coefficients of the first two nets before any halving */
  double extent[2];     /* bounds on the derivatives by the whole box's parameters */
  double resolution;    /* of t */
  bool pole[4];         /* borders of the whole box (geometry/edges.h) that are one point */
};

/* The bounds on the errors of coefficients of the box's first two nets, without what a pole that is met adds. */
void search_rounding(const struct search *s, const struct box *box, double out[2]);

/* Tells of a point of a box that cannot be decided: the one next to its middle that is on the ray, which stands for all of
 * a small one. A box that is not small is a doubt, whether or not it has such a point. */
void search_tell_maybe(struct search *s, struct box *box, bool small);

/* The search of the box by itself, and has it run on the zoomed polynomials. */
struct search search_closer(const struct search *s, const struct box *box);
void search_run_closer(struct search *closer, const struct zoomed *zoomed);

/* ---- pole.c ---- */

/* The border that is one point and that the box lies at; NO_BORDER, TWO_BORDERS. */
int pole_of_box(const struct search *s, const struct box *box);

/* Whether the box, at the pole of its search, is so narrow along the border that it is only to be halved across. */
bool pole_narrow(const struct search *s, const struct box *box);

/* Searches the box, which lies at that border (pole_of_box), by itself, zoomed, where that is to be done for the
 * pole's sake. Returns whether it was. */
bool pole_zoom(struct search *s, const struct box *box, int border);

/* What is left to do with a box at a pole that the ray may meet, that of the search. */
enum pole_box {
  POLE_BOX_DECIDED, /* nothing */
  POLE_BOX_HALVED,  /* it is halved, and that is all */
  POLE_BOX_OPEN     /* what is done with all boxes */
};
enum pole_box pole_decide(struct search *s, struct box *box);

/* What a pole that is met adds to the errors of the first two nets at that distance from it and farther, of the whole box. */
void pole_add_error(const struct search *s, double distance, double error[2]);

/* From where on roots in the box are told, of the whole box: those outside it, but proven there, included. */
double pole_told_from(const struct search *s, const struct box *box);

/* Whether the root, in the box's parameters, is so far from the pole of the search that the certificate speaks of the
 * ray's own polynomials. */
bool pole_far(const struct search *s, const struct box *box, const double root[2]);

#endif

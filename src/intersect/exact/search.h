/* A search under way: search.c goes through its boxes, pole.c decides those at poles.
 *
 * Internal to src/intersect/exact. judge.h states how to ask for a search.
 */
#ifndef PSCN_INTERSECT_EXACT_SEARCH_H
#define PSCN_INTERSECT_EXACT_SEARCH_H

#include "intersect/exact/window.h"

enum { NO_BORDER = -1, TWO_BORDERS = -2 };

struct search {
  struct window window; /* the part of the patch that the whole box is */
  int ahead;            /* most boxes that may wait in the ray's order */
  int divided;          /* the first net is divided by the distance to this border (zoom_pole_box); or NO_BORDER */
  bool dependent;       /* some combination is zero on a box, so it is zero everywhere and tells nothing */
  /* the pole there may be met. Nothing is told of what is nearer to it than ZOOM_POLE_MET, ... */
  bool met;
  /* ... and the first two nets have these additional errors, over the distance from it */
  double met_error[2];
  double error[2];   /* bounds on the errors of the first two nets' coefficients before any halving */
  double extent[2];  /* bounds on the derivatives by the parameters of the whole box */
  double resolution; /* of t */
  bool pole[4];      /* the whole box's borders (geometry/edges.h) that are one point */
};

/* Bounds on the errors of the coefficients of the box's first two nets, without those that a met pole adds. */
void search_rounding(const struct search *s, const struct box *box, double out[2]);

/* Tells of a point of a box that cannot be decided: one on the ray, sought from the box's middle. It stands for all of
 * a small box, which is told even if no such point is found. A box that is not small is a doubt, with or without such a
 * point. */
void search_tell_maybe(struct search *s, struct box *box, bool small);

/* The search of the box by itself; the second runs it on the zoomed polynomials. */
struct search search_closer(const struct search *s, const struct box *box);
void search_run_closer(struct search *closer, const struct zoomed *zoomed);

/* ---- pole.c ---- */

/* The border that is one point which the ray does not meet exactly, and on which the box lies; NO_BORDER for none,
 * TWO_BORDERS for several. */
int pole_of_box(const struct search *s, const struct box *box);

/* How often both polynomials are exactly 0 along the box's borders: those that are one point which the ray meets.
 * Returns whether there is one. */
bool pole_zeros(const struct search *s, const struct box *box, int out[4]);

/* Whether the box, at the pole of its search, is so narrow along the border that it is halved only towards the pole. */
bool pole_narrow(const struct search *s, const struct box *box);

/* Whether to zoom again a box at poles that the ray meets exactly, and with a root too near to them (pole_far). */
bool pole_asks_zoom(const struct search *s, const struct box *box);

/* Searches the box, which lies at that border (pole_of_box), by itself and zoomed, if the pole requires this. Returns
 * whether it did. */
bool pole_zoom(struct search *s, const struct box *box, int border);

/* What remains to be done with a box at the search's pole, which the ray may meet. */
enum pole_box {
  POLE_BOX_DECIDED, /* nothing */
  POLE_BOX_HALVED,  /* only to halve it */
  POLE_BOX_OPEN     /* the same as with all boxes */
};
enum pole_box pole_decide(struct search *s, struct box *box);

/* Adds to error[] what a met pole adds to the errors of the first two nets at that distance from it, a part of the
 * whole box, and farther. */
void pole_add_error(const struct search *s, double distance, double error[2]);

/* Distance from the pole, as a part of the whole box, from which on roots of the box are told, including roots outside
 * the box that are proven from it. */
double pole_told_from(const struct search *s, const struct box *box);

/* Whether the root, in the box's parameters, is so far from the search's pole that the certificate holds for the ray's
 * own polynomials; or from one that the ray meets exactly, that it is told from the pole itself. */
bool pole_far(const struct search *s, const struct box *box, const double root[2]);

#endif

/* Which borders and surfaces patches share: equal control points, to the last bit (0 is -0), of a border in the same or
 * the opposite order.
 *
 * Border 0 is u = 0, 1 is u = 1 (both run along v), 2 is v = 0, 3 is v = 1 (both run along u).
 */
#ifndef PSCN_GEOMETRY_EDGES_H
#define PSCN_GEOMETRY_EDGES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/status.h"
#include "base/team.h"

enum { EDGE_NONE = UINT32_MAX };

/* The border that shares its control points with this one. patch is EDGE_NONE if there is none, if there are several,
 * or if the border is collapsed to a point. */
struct edge_neighbour {
  uint32_t patch; /* may be the patch itself */
  uint8_t border;
  bool reversed;
};

/* The index of control point k of a border, 0..3 in the order of the running parameter, in a net of 16, row after
 * row. */
static inline int edge_at(int border, int k)
{
  const int first = border == 1 ? 12 : border == 3 ? 3 : 0;
  return first + (border < 2 ? k : 4 * k);
}

/* From this index to that of the next control point away from the border. */
static inline int edge_inward(int border) { return (border < 2 ? 4 : 1) * (border & 1 ? -1 : 1); }

/* The place (u,v) on a border where its running parameter is `along`. */
static inline void edge_place(int border, double along, double out[2])
{
  out[border / 2] = border & 1, out[1 - border / 2] = along;
}

/* The four control points of border `border` of the net P[i][j], in the order of the running parameter. */
void edge_points(double P[4][4][3], int border, double out[4][3]);

/* Whether the border is one point: its control points are equal numbers. */
bool edge_is_point(double P[4][4][3], int border);

/* Fills out[4 * patch + border] for `count` nets, net p at nets + p * stride bytes; any team gives the same. Nets that
 * an earlier one equals, by their surfaces (surfaces_find; NULL: none), are nobody's neighbours. STATUS_LIMIT if memory or
 * threads are short. */
enum status edges_match(const void *nets, size_t stride, size_t count, const uint32_t surface[],
                        const struct team *team, struct edge_neighbour *out) STATUS_MUST_CHECK;

/* ---- patches that a ray meets at one t: those that lie in one plane across an axis, such as a floor and what is laid on
 * it, and those with the same control points, in any of the eight orders that give the same surface ---- */

/* Added to the surface of a net whose control points an earlier one has, too. */
#define SURFACE_AGAIN UINT32_C(0x80000000)

/* The axis across which all of that surface lies in a plane; -1 for none. */
#define SURFACE_AXIS(surface) ((int)((surface) >> 29 & 3) - 1)

/* Sets out[p] for net p of `count`, at nets + p * stride bytes: equal numbers for nets of one surface, but for
 * SURFACE_AGAIN; 0 for a net that lies in no plane across an axis and whose surface no other net has. May miss some in a
 * scene that is made for this. STATUS_LIMIT if memory is short. */
enum status surfaces_find(const void *nets, size_t stride, size_t count, uint32_t out[]) STATUS_MUST_CHECK;

#endif

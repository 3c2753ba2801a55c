/* Names of one compilation (base/kernel.h): a function that one file of this folder calls in another has the
 * instruction set's name in its own.
 */
#ifndef PSCN_INTERSECT_LANES_NAMES_H
#define PSCN_INTERSECT_LANES_NAMES_H

#include "base/kernel.h"

#define packet_begin KERNEL(packet_begin)
#define packet_orient KERNEL(packet_orient)
#define packet_set_patch KERNEL(packet_set_patch)
#define packet_exhaust KERNEL(packet_exhaust)
#define packet_postpone KERNEL(packet_postpone)
#define packet_postpone_best KERNEL(packet_postpone_best)
#define packet_enter KERNEL(packet_enter)
#define packet_leave KERNEL(packet_leave)
#define packet_leaf KERNEL(packet_leaf)
#define offer_root KERNEL(offer_root)
#define offer_unproven KERNEL(offer_unproven)
#define stage_slab KERNEL(stage_slab)
#define stage_bilinear KERNEL(stage_bilinear)
#define stage_leaves KERNEL(stage_leaves)
#define stage_cover KERNEL(stage_cover)
#define stage_resultant KERNEL(stage_resultant)
#define method_quadratic_root KERNEL(method_quadratic_root)
#define newton_solve KERNEL(newton_solve)
#define cover_proves KERNEL(cover_proves)
#define finish_hits KERNEL(finish_hits)
#define finish_best KERNEL(finish_best)
#define finish_occluded KERNEL(finish_occluded)
#define explain_before KERNEL(explain_before)
#define explain_after KERNEL(explain_after)
#define gather_start KERNEL(gather_start)
#define gather_best KERNEL(gather_best)
#define gather_postpone KERNEL(gather_postpone)
#define gather_finish KERNEL(gather_finish)
#define leave_some KERNEL(leave_some)

#endif

// SPDX-License-Identifier: Apache-2.0
// The table's functions on submitted calls.
#pragma once

#include "plugin/overcast.h"

namespace ovc {

ovc_result submit_intersect(ovc_scene scene, const ovc_ray* rays, size_t ray_count, ovc_hit* hits,
                            const ovc_query* query, ovc_ticket* ticket);
ovc_result submit_occluded(ovc_scene scene, const ovc_ray* rays, size_t ray_count,
                           uint8_t* occluded, const ovc_query* query, ovc_ticket* ticket);
ovc_result wait(ovc_ticket ticket);
ovc_result poll(ovc_ticket ticket, uint32_t* done, double* progress);
ovc_result cancel(ovc_ticket ticket);
void release(ovc_ticket ticket);

} // namespace ovc

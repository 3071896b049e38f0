// SPDX-License-Identifier: Apache-2.0
// The table's functions that trace rays and return with the answers.
#pragma once

#include "plugin/overcast.h"

namespace ovc {

ovc_result intersect(ovc_scene scene, const ovc_ray* rays, size_t ray_count, ovc_hit* hits,
                     const ovc_query* query);
ovc_result occluded(ovc_scene scene, const ovc_ray* rays, size_t ray_count, uint8_t* occluded,
                    const ovc_query* query);
ovc_result all_hits(ovc_scene scene, const ovc_ray* rays, size_t ray_count, size_t max_hits,
                    ovc_hit* hits, uint64_t* counts, const ovc_query* query);
ovc_result intersect1(ovc_scene scene, const ovc_ray* ray, ovc_hit* hit, const ovc_query* query);
ovc_result occluded1(ovc_scene scene, const ovc_ray* ray, uint8_t* occluded,
                     const ovc_query* query);

} // namespace ovc

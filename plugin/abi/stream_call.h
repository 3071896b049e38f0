// SPDX-License-Identifier: Apache-2.0
// The table's functions on streams.
#pragma once

#include "plugin/overcast.h"

namespace ovc {

ovc_result stream(ovc_scene scene, const ovc_stream_host* host);
ovc_result push(ovc_stream stream, const ovc_ray* rays, const uint64_t* tokens, size_t ray_count,
                uint32_t any_hit, const ovc_query* query);

} // namespace ovc

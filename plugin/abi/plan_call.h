// SPDX-License-Identifier: Apache-2.0
// tell_plan(): the frame of the functions of the table that plan.
#pragma once

#include "core/system/stopwatch.h"
#include "plugin/abi/config.h"
#include "plugin/abi/scene_call.h"
#include "plugin/abi/struct_size.h"

#include <cstddef>
#include <cstring>

namespace ovc {

/// Fills in as much of `plan` as its header knows with make(progress), a Result<ovc_plan>.
template <class Make>
void tell_plan(ovc_plan* plan, const ovc_scene_config& config, const char* call, Make&& make) {
    if (!plan)
        invalid(format_text("{}: plan is NULL", call));
    const size_t size = plan->struct_size;
    check_size<ovc_plan>("ovc_plan", size, offsetof(ovc_plan, saved_bytes));
    const Stopwatch watch;
    ovc_plan all{};
    with_progress(config, call, [&](BuildProgress* progress) {
        const Result<ovc_plan> told = make(progress);
        if (!told)
            throw Failure{code_of(told.error().kind, OVC_ERROR_INTERNAL), told.error().message};
        all = *told;
    });
    all.seconds = watch.seconds();
    all.struct_size = size;
    std::memcpy(plan, &all, size);
}

} // namespace ovc

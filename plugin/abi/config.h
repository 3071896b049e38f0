// SPDX-License-Identifier: Apache-2.0
// The config of a scene: its checks, and what tells its function for progress.
#pragma once

#include "core/build_progress.h"
#include "core/system/stopwatch.h"
#include "core/text/format_text.h"
#include "plugin/abi/handles.h"
#include "plugin/abi/scene_call.h"
#include "plugin/abi/struct_size.h"

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>

namespace ovc {

/// Returns the config, or the defaults for null. Throws a Failure that names a field that is wrong.
inline ovc_scene_config checked_config(const ovc_scene_config* given) {
    if (!given)
        return {sizeof(ovc_scene_config)};
    const auto config = whole("ovc_scene_config", given, offsetof(ovc_scene_config, progress));
    const auto check_choice = [](const char* field, uint32_t value, uint32_t last) {
        if (value > last)
            invalid(format_text("ovc_scene_config.{} is {}, expected {}{}", field, value,
                                last ? "0 to " : "", last));
    };
    if (config.leaf_triangles && config.leaves)
        invalid("ovc_scene_config: leaf_triangles and leaves are both set; one says it all");
    check_choice("precision", config.precision, OVC_PRECISION_FAST);
    check_choice("kernel", config.kernel, OVC_KERNEL_COMPUTE);
    check_choice("structure", config.structure, OVC_STRUCTURE_THESIS_TWO_LEVEL);
    check_choice("level1", config.level1, OVC_LEVEL1_BVH);
    check_choice("level1_build", config.level1_build, OVC_LEVEL1_BUILD_BOTTOM_UP);
    check_choice("tell_active", config.tell_active, 1);
    check_choice("reserved", config.reserved, 0);
    check_choice("ranks_own", config.ranks_own, OVC_RANKS_OWN_ALL);
    if (!(config.rank_timeout >= 0 && config.rank_timeout < 1e9))
        invalid(format_text("ovc_scene_config.rank_timeout is {}, expected 0 to 1e9 seconds",
                            config.rank_timeout));
    if (!config.sample && config.sample_rays)
        invalid("ovc_scene_config.sample is NULL, but sample_rays is not 0");
    if (!config.saved && config.saved_bytes && !config.read_saved)
        invalid("ovc_scene_config.saved is NULL, but saved_bytes is not 0");
    if (config.host_memory_bytes && (!config.read_saved || config.saved))
        invalid("ovc_scene_config.host_memory_bytes is not 0, but read_saved is NULL or saved is "
                "not: such a scene is read from what was saved");
    if (config.read_saved && !config.host_memory_bytes)
        invalid("ovc_scene_config.read_saved is set, but host_memory_bytes is 0");
    return config;
}

/// Runs body(progress), where progress tells the config's function, or is null where there is none.
/// Turns body's Cancelled into a Failure.
template <class Body>
void with_progress(const ovc_scene_config& config, const char* call, Body&& body) {
    bool stopped = false;
    std::optional<BuildProgress> progress;
    if (config.progress)
        progress.emplace([&](double done, const char* stage) {
            const HostFunction mark;
            stopped = config.progress(config.progress_user, done, stage) != 0;
            return !stopped;
        });
    try {
        body(progress ? &*progress : nullptr);
    } catch (const Cancelled&) {
        throw Failure{OVC_ERROR_CANCELLED, format_text("{}: cancelled by {}", call,
                                                       stopped ? "ovc_scene_config.progress"
                                                               : "a function of the host's")};
    }
}

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

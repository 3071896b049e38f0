// SPDX-License-Identifier: Apache-2.0
// The beginning that all commands of several ranks have in common.
#include "host/ranks/join_ranks.h"

#include "host/terminal/interrupt.h"

#include <algorithm>
#include <filesystem>

namespace ovc {

/// Returns the host memory of a rank that has a share of a scene file: a fifth of its part of the
/// file. Of the rest most are pages, which are read once, on their way to the device; it is corners
/// that are read again and again.
static uint64_t share_of_file(const std::string& path, uint32_t ranks) {
    constexpr uint64_t kMin = uint64_t(8) << 20;
    std::error_code unreadable; // which whoever opens it will tell
    const uint64_t bytes = std::filesystem::file_size(path, unreadable);
    return unreadable ? kMin : std::max(kMin, bytes / ranks / 5);
}

Result<Done> join_ranks(std::string_view command, BackendOptions& backend, SceneArguments& scene) {
    if (const Result<Done> done = Ranks::open(command, backend.rank_timeout); !done)
        return done;
    const Ranks* const ranks = Ranks::of_run();
    if (!ranks)
        return Done{};
    if (backend.kind != BackendKind::Auto && backend.kind != BackendKind::TwoLevel)
        return Error{"several processes share the work of --backend two-level alone"};
    backend.kind = BackendKind::TwoLevel;
    if (!ranks->is_first())
        say_nothing_on_interrupt();
    if (backend.ranks_own == OVC_RANKS_OWN_SHARE && scene.is_one_scene_file() &&
        backend.host_bytes == 0) {
        backend.host_bytes = share_of_file(scene.scenes[0], ranks->count());
        backend.host_bytes_may_grow = true;
    }
    scene.host_bytes = backend.host_bytes;
    return Done{};
}

} // namespace ovc

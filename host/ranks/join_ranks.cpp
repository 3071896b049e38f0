// SPDX-License-Identifier: Apache-2.0
// What all commands of several ranks have in common at their beginning.
#include "host/ranks/join_ranks.h"

#include "host/terminal/interrupt.h"

#include <filesystem>

namespace ovc {

/// A host budget that never matters.
static constexpr uint64_t kNoLimit = uint64_t(1) << 60;

Result<Done> join_ranks(BackendOptions& backend, SceneArguments& scene) {
    if (const Result<Done> done = Ranks::open(backend.rank_timeout); !done)
        return done;
    const Ranks* const ranks = Ranks::of_run();
    if (!ranks)
        return Done{};
    if (backend.kind != BackendKind::Auto && backend.kind != BackendKind::TwoLevel)
        return Error{"several processes share the work of --backend two-level alone"};
    backend.kind = BackendKind::TwoLevel;
    if (!ranks->is_first())
        say_nothing_on_interrupt();
    const bool is_scene_file =
        scene.scenes.size() == 1 && std::filesystem::path(scene.scenes[0]).extension() == ".ovc";
    if (backend.ranks_own == OVC_RANKS_OWN_SHARE && is_scene_file && backend.host_bytes == 0)
        backend.host_bytes = kNoLimit;
    scene.host_bytes = backend.host_bytes;
    return Done{};
}

} // namespace ovc

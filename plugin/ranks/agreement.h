// SPDX-License-Identifier: Apache-2.0
// Agreement: ranks that have a scene together bring the same meshes and the same config, go by the
// smallest of their budgets, and check that they share the same pages out.
#pragma once

#include "core/result.h"
#include "plugin/ranks/transport/notes.h"

#include <cstdint>

namespace ovc {

/// A rank's part of a scene that several ranks have together.
struct RankTerms {
    /// Is the same on all of them.
    struct Alike {
        uint64_t meshes = 0, triangles = 0, soup = 0; // soup: a checksum of them
        uint64_t ranks_own = 0, precision = 0, leaf_triangles = 0, leaves = 0; // of the config
        bool operator==(const Alike&) const = default;
    };
    /// Is a rank's own. What holds for all of them is the smallest of each.
    struct Own {
        uint64_t gpu_bytes = kNoLimit, host_bytes = kNoLimit;    // budgets
        uint64_t pool_bytes = kNoLimit, buffer_bytes = kNoLimit; // of MemoryPlan
        uint64_t has_saved = 0;                                  // 1: it need not build
    };
    static constexpr uint64_t kNoLimit = ~uint64_t(0);

    Alike alike;
    Own own;
};

/// Returns what holds for all ranks, which all call this. Error of the kind InvalidArgument, on all
/// of them: a rank has brought other meshes or another config. Error: a rank is lost.
Result<RankTerms::Own> agreed_terms(Notes& notes, const Transport& transport,
                                    const RankTerms& mine);

/// shares: a checksum of what this rank takes the shares of all ranks to be. All ranks call it.
/// Error, on those for which that is not what it is for rank 0: rays would miss what each takes to
/// be another's.
Result<Done> check_shares(Notes& notes, const Transport& transport, uint64_t shares);

} // namespace ovc

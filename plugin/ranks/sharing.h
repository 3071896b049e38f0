// SPDX-License-Identifier: Apache-2.0
// Sharing: decides whether ranks share a scene out, and which pages this rank has.
#pragma once

#include "core/system/log.h"
#include "plugin/build/keep_pages.h"
#include "plugin/ranks/agreement.h"
#include "plugin/ranks/shares.h"
#include "plugin/ranks/stops.h"

#include <cstdint>
#include <memory>

namespace ovc {

/// The scene that a rank keeps pages of.
struct SharingOptions {
    uint32_t rank = 0; // of this process
    bool always = true;
    /// Otherwise only where pages take more than the smallest budgets of a rank.
    uint64_t gpu_bytes = RankTerms::kNoLimit;
    uint64_t host_bytes = RankTerms::kNoLimit;
    ShareOptions shares;
};

class Sharing {
public:
    Sharing(const SharingOptions& options, const LogSink& log) : options_(options), log_(log) {}

    /// Returns the pages that this rank keeps, for TwoLevelOptions::choose_pages.
    PagesKept choose(const BuiltScene& scene);

    /// Whether the pages that were chosen last are a share. Then take_finder() gives the stops of
    /// rays.
    bool shares() const { return finder_ != nullptr; }
    std::unique_ptr<StopFinder> take_finder() { return std::move(finder_); }
    /// Returns a checksum of the pages and of whose they are, for check_shares(); 0: no share.
    uint64_t checksum() const { return checksum_; }

private:
    bool fits(const BuiltScene& scene) const;

    const SharingOptions options_;
    const LogSink& log_;
    std::unique_ptr<StopFinder> finder_;
    uint64_t checksum_ = 0;
};

} // namespace ovc

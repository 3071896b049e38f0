// SPDX-License-Identifier: Apache-2.0
// Claims: what README.md, docs/guide/performance.md and docs/benchmarks.md say that can be measured
// or tested, a row each. A test holds them against the documents, so that neither changes without
// the other.
#pragma once

#include "host/report/experiments/experiment.h"

#include <functional>
#include <optional>

namespace ovc {

/// The results of the runs that claims need; what is not there is null.
class ClaimResults {
public:
    explicit ClaimResults(std::span<const RawResult> results) : results_(results) {}

    /// What the run left, by its key.
    const Json& of(std::string_view key) const;
    /// A line of `overcast bench --bars`, by what it is called.
    const Json& bar(std::string_view line) const;

private:
    std::span<const RawResult> results_;
};

struct ClaimBar {
    bool at_most;
    double value;
};

struct Claim {
    std::string document; // "README.md"
    std::string heading;  // of its section; "" before the first
    std::string what;     // words of a line there, and
    std::string says;     // of what follows in it: as they stand there, but for Markdown's marks
    /// A number or null. Empty: held by `held_by` alone.
    std::function<Json(const ClaimResults&)> measure;
    std::optional<ClaimBar> bar; // of a line of `overcast bench --bars`: that line's
    std::string held_by;         // "ctest -R Plan", a command, a section of the report
};

/// In the order of the documents.
std::vector<Claim> claims();

} // namespace ovc

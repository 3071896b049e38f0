// SPDX-License-Identifier: Apache-2.0
// Claims are the measurable or testable statements of README.md, docs/guide/performance.md and
// docs/benchmarks.md, a row each. A test compares them with the documents, so that neither changes
// without the other.
#pragma once

#include "host/report/experiments/experiment.h"

#include <functional>
#include <optional>

namespace ovc {

/// The results of the runs that claims need. The results must outlive it.
class ClaimResults {
public:
    explicit ClaimResults(std::span<const RawResult> results) : results_(results) {}

    /// Returns the result of the run with this key, or null.
    const Json& of(std::string_view key) const;
    /// Returns the line of `overcast bench --bars` with this name, or null.
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
    std::string what;     // words of a line there, without Markdown's marks
    std::string says;     // words that follow in the same line, without Markdown's marks
    /// Returns a number or null. Empty where `held_by` alone checks the claim.
    std::function<Json(const ClaimResults&)> measure;
    std::optional<ClaimBar> bar; // a measured line of `overcast bench --bars` overrides it
    std::string held_by;         // "ctest -R Plan", a command, a section of the report
};

/// Returns all claims in the order of the documents.
std::vector<Claim> claims();

} // namespace ovc

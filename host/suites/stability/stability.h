// SPDX-License-Identifier: Apache-2.0
// Runs a case of the stability suite and compares the plugin, certified and fast, and Embree with
// double precision.
#pragma once

#include "core/result.h"
#include "core/system/log.h"
#include "host/backend/backend.h"
#include "host/suites/stability/stability_cases.h"

#include <functional>
#include <optional>

namespace ovc {

struct StabilityResult;

struct StabilityOptions {
    BackendOptions backend; // its precision is ignored, because both are run
    uint64_t times = 1;     // multiplies the short form's rays
    bool peers = true;      // fast mode and Embree too
    /// Called after each batch of a case with the result so far; false: stop. Empty: go on.
    std::function<bool(const StabilityResult&)> go_on;
};

/// The score of one program. An answer of certified is wrong where any bit differs from the
/// reference. An answer of others is tied where it names another triangle, which the ray meets at
/// exactly the same t, else wrong. Those that miss what is hit, or a closed mesh, are leaks.
struct StabilityScore {
    uint64_t tied = 0;
    uint64_t wrong = 0;
    uint64_t leaks = 0;
    double t_error = 0; // largest |t - reference t| / |reference t| where both hit
};

struct StabilityResult {
    std::string name;
    std::string renderer;
    bool closed = false; // see StabilityCase
    uint64_t triangles = 0;
    uint64_t rays = 0;
    uint64_t hits = 0;
    uint64_t reference_leaks = 0;  // misses of the reference in a closed case
    uint64_t wrong_occlusions = 0; // certified's occluded() that differ from the nearest hit
    uint64_t miscounted = 0; // by how many statistics' invalid rays and dropped triangles are off
    uint64_t dropped = 0;
    uint64_t invalid = 0;
    uint64_t flagged = 0;
    uint64_t retraced = 0;
    double microseconds = 0; // per ray, certified nearest hits
    double time_ratio = 0;   // to a ray's time in the case time_as; 0: none
    std::string time_as;     // see StabilityCase
    double bar = 0;          // likewise
    StabilityScore certified;
    std::optional<StabilityScore> fast, embree_robust, embree_default;
};

/// Returns the result of one case, without a time ratio. Rays come in batches, each drawn from its
/// own seed. Error: the plugin failed.
Result<StabilityResult> run_stability_case(const StabilityCase& stability_case,
                                           const StabilityOptions& options, const LogSink& log);

/// Returns the results of all cases in turn, with time ratios. Where go_on() returned false, the
/// last result is that of a part of its case. seen: called after each case. Error: the plugin
/// failed.
Result<std::vector<StabilityResult>>
run_stability(std::span<const StabilityCase> cases, const StabilityOptions& options,
              const LogSink& log, const std::function<void(const StabilityResult&)>& seen);

/// Returns the rays of batch `batch`, as run_stability_case draws them.
AimedRays stability_rays(const StabilityCase& stability_case, const Soup& soup, uint64_t batch,
                         size_t count);

} // namespace ovc

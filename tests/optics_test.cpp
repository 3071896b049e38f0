// SPDX-License-Identifier: Apache-2.0
// Tests the optics table in a short form: spawned rays neither hit the surface that they leave nor
// escape, glass bends light as it must, mirrors are deep.
#include "host/suites/optics/optics.h"

#include <gtest/gtest.h>

#include <cstdio>

namespace ovc {
namespace {

TEST(Optics, NoRayIsLostAndNoneMeetsWhatItLeaves) {
    OpticsOptions options;
    options.shapes = 60;
    const std::vector<OpticsCase> cases = optics_cases();
    const auto results = run_optics(cases, options, {}, [](const OpticsResult&) {});
    if (!results)
        GTEST_SKIP() << results.error().message;
    std::fputs(optics_markdown(*results).c_str(), stdout);
    ASSERT_EQ(results->size(), cases.size());
    for (const OpticsResult& r : *results) {
        EXPECT_EQ(r.score.wrong, 0u) << r.name << ": " << r.counted;
        EXPECT_EQ(r.score.leaks, 0u) << r.name;
        EXPECT_GT(r.score.rays, 15'000u) << r.name;
    }
}

} // namespace
} // namespace ovc

// SPDX-License-Identifier: Apache-2.0
// TwoLevelGl: the fixture that the tests of two-level on a device share; variants(): the kinds of
// structures that they build.
#pragma once

#include "plugin/two_level/two_level.h"

#include "gpu/gl/test_gl.h"
#include "plugin/structure/test_structures.h"

#include <string>
#include <vector>

namespace ovc {

/// The kinds of structures that answer alike.
struct Variant {
    std::string name;
    TwoLevelOptions options;
};

inline std::vector<Variant> variants() {
    return {{"ten leaves", {}},
            {"one leaf", {.leaf_triangles = 1u << 30}},
            {"leaves of 40", {.leaf_triangles = 40}},
            {"compute", {.leaf_triangles = 500, .compute = true}},
            {"smallest budget", {.budget_bytes = 96u << 10, .leaf_triangles = 100}},
            {"beside", {.budget_bytes = 96u << 10, .leaf_triangles = 100, .beside = true}}};
}

class TwoLevelGl : public test::OnGl {
protected:
    std::unique_ptr<TwoLevel> build(const Soup& soup, const TwoLevelOptions& options) {
        Result<std::unique_ptr<TwoLevel>> built = TwoLevel::build(soup, *gl, options, {});
        EXPECT_TRUE(built) << built.error().message;
        return built ? std::move(*built) : nullptr;
    }
};

} // namespace ovc

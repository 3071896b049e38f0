// SPDX-License-Identifier: Apache-2.0
// TwoLevelGl: the fixture that the tests of two-level on a device share.
#pragma once

#include "plugin/two_level/two_level.h"

#include "gpu/gl/test_gl.h"
#include "plugin/structure/test_structures.h"

namespace ovc {

class TwoLevelGl : public test::OnGl {
protected:
    std::unique_ptr<TwoLevel> build(const Soup& soup, const TwoLevelOptions& options) {
        Result<std::unique_ptr<TwoLevel>> built = TwoLevel::build(soup, *gl, options, {});
        EXPECT_TRUE(built) << built.error().message;
        return built ? std::move(*built) : nullptr;
    }
};

} // namespace ovc

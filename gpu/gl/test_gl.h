// SPDX-License-Identifier: Apache-2.0
// OnGl: a test fixture with a device, skipped if none opens.
#pragma once

#include "gpu/gl/gl_thread.h"

#include <gtest/gtest.h>

namespace ovc::test {

class OnGl : public testing::Test {
protected:
    void SetUp() override {
        Result<std::unique_ptr<GlThread>> started = GlThread::start("", {});
        if (!started)
            GTEST_SKIP() << started.error().message;
        gl = std::move(*started);
    }

    std::unique_ptr<GlThread> gl;
};

inline testing::AssertionResult ok(const Result<Done>& result) {
    if (result)
        return testing::AssertionSuccess();
    return testing::AssertionFailure() << result.error().message;
}

} // namespace ovc::test

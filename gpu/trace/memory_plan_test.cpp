// SPDX-License-Identifier: Apache-2.0
// A plan of memory suits the device, and more memory never gives a scene less.
#include "gpu/trace/tracer.h"

#include "shaders/layout.h"

#include <gtest/gtest.h>

namespace ovc {
namespace {

DeviceInfo device_with(uint64_t texels) {
    DeviceInfo device;
    device.max_texture_size = 16384;
    device.max_buffer_texels = texels;
    device.passes_in_flight = 2;
    return device;
}

TEST(MemoryPlan, RaysFitTheSmallestBufferTextureOfOpenGL) {
    const Result<MemoryPlan> plan = plan_memory(1u << 30, device_with(65536));
    ASSERT_TRUE(plan) << plan.error().message;
    EXPECT_LE(plan->batch_rays * uint64_t(OVC_RAY_TEXELS), 65536u);
    EXPECT_GE(plan->batch_rays, 8192u) << "no fewer than fit";
}

TEST(MemoryPlan, ALargerBudgetNeverHasASmallerPool) {
    for (const uint64_t texels : {uint64_t(65536), uint64_t(1) << 27}) {
        uint64_t pool = 0;
        for (uint64_t budget = 1 << 20; budget < 1 << 28; budget += budget / 64 + 4321) {
            const Result<MemoryPlan> plan = plan_memory(budget, device_with(texels));
            ASSERT_TRUE(plan) << plan.error().message;
            EXPECT_GE(plan->pool_bytes, pool) << budget;
            pool = plan->pool_bytes;
        }
    }
}

} // namespace
} // namespace ovc

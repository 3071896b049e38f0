// SPDX-License-Identifier: Apache-2.0
// Variants have a text, and those that are tried are sound and differ in one switch.
#include "gpu/tuning/kernel_variant.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace ovc {
namespace {

using testing::HasSubstr;

DeviceInfo software() {
    DeviceInfo device;
    device.is_software = device.has_ballots = true;
    return device;
}
DeviceInfo gpu(uint32_t lanes) {
    DeviceInfo device;
    device.has_ballots = true;
    device.subgroup_lanes = lanes;
    return device;
}

TEST(KernelVariant, IsReadBackFromItsText) {
    for (const DeviceInfo& device : {software(), gpu(32)})
        for (const bool compute : {false, true}) {
            const KernelVariant from = default_variants(device, compute)[RayKind{}];
            std::vector<KernelVariant> all = neighbours(from, device, /* other_kernel= */ true);
            all.push_back(from);
            for (const KernelVariant& variant : all) {
                const Result<KernelVariant> parsed = parse_variant(variant.text());
                ASSERT_TRUE(parsed) << variant.text() << ": " << parsed.error().message;
                EXPECT_EQ(*parsed, variant) << variant.text();
            }
        }
}

TEST(KernelVariant, RefusesTextsThatAreNone) {
    for (const char* text : {"", "compute,", "compute,warps", "group=", "group=6x", "group=-1",
                             "registers=0", "registers=65", "registers=99999999999"}) {
        const Result<KernelVariant> parsed = parse_variant(text);
        ASSERT_FALSE(parsed) << text;
        EXPECT_THAT(parsed.error().message, HasSubstr("is no switch of a kernel")) << text;
    }
    for (const char* text : {"group=48", "fragment,packets", "refill,fragment"}) {
        const Result<KernelVariant> parsed = parse_variant(text);
        ASSERT_FALSE(parsed) << text;
        EXPECT_THAT(parsed.error().message, HasSubstr("no kernel is")) << text;
    }
}

TEST(KernelVariant, RefillsWhereABallotHasRoomForAllLanes) {
    const auto refills = [](const KernelVariant& variant) { return variant.refill; };
    const auto tried = [&](const DeviceInfo& device) {
        return std::ranges::any_of(
            neighbours(default_variants(device)[RayKind{}], device, /* other_kernel= */ true),
            refills);
    };
    EXPECT_TRUE(tried(gpu(32)));
    EXPECT_FALSE(tried(gpu(64)));
    EXPECT_FALSE(tried(gpu(0))) << "nobody says how many lanes there are";
    EXPECT_TRUE(refills(default_variants(software())[RayKind{}]));
}

TEST(KernelVariant, ReadsImagesOnSoftwareRenderers) {
    for (const bool compute : {false, true}) {
        const ChosenVariants variants = default_variants(software(), compute);
        for (size_t kind = 0; kind < RayKind::kCount; ++kind)
            EXPECT_EQ(variants[RayKind::of(kind)].reads, TexelReads::Images)
                << RayKind::of(kind).text();
    }
}

TEST(KernelVariant, ChangesOfSeveralAddUp) {
    const KernelVariant from;
    KernelVariant a = from, b = from;
    a.branches = !from.branches;
    b.group_size = 128;
    const KernelVariant both = with_changes(a, from, b);
    EXPECT_EQ(both.branches, a.branches);
    EXPECT_EQ(both.group_size, 128u);
}

TEST(KernelVariant, ReadsNoMoreThanTheDriverLetsIt) {
    DeviceInfo device;
    device.pool_buffers_by_reads = {27, 3, 11};
    device.max_storage_bytes = 1 << 20;
    KernelVariant variant;
    EXPECT_TRUE(can_read(device, variant, 27, 1 << 30));
    variant.reads = TexelReads::Images;
    EXPECT_FALSE(can_read(device, variant, 4, 1 << 10));
    variant.reads = TexelReads::StorageBuffers;
    EXPECT_TRUE(can_read(device, variant, 4, 1 << 20));
    EXPECT_FALSE(can_read(device, variant, 4, 1 << 21));
    device.pool_buffers_by_reads[size_t(TexelReads::Textures)] = 0; // Workaround::ConfusedTexels
    variant.reads = TexelReads::Textures;
    EXPECT_FALSE(can_read(device, variant, 1, 1 << 10));
}

} // namespace
} // namespace ovc

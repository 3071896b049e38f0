// SPDX-License-Identifier: Apache-2.0
// Hits are the same bits whichever variant the kernel is, and whatever was measured.
#include "plugin/two_level/test_two_level.h"

#include "core/file/checksum.h"
#include "kdtree/test_soups.h"

namespace ovc {
namespace {

class MeasuredVariantsGl : public TwoLevelGl {
protected:
    void SetUp() override {
        TwoLevelGl::SetUp();
        if (!gl)
            return;
        test::Random random(5);
        for (int i = 0; i < 20000; ++i)
            rays.push_back({random.point(-2, 2), 0, random.point(-1, 1)});
    }

    /// Returns the checksum of the hits, or of what is occluded.
    uint64_t hash(const TwoLevelOptions& options, bool any_hit = false) {
        const std::unique_ptr<TwoLevel> structure = build(soup, options);
        if (!structure)
            return 0;
        std::vector<Hit> hits(rays.size());
        std::vector<uint8_t> occluded(rays.size());
        if (any_hit)
            EXPECT_TRUE(structure->occluded(rays, {}, occluded));
        else
            EXPECT_TRUE(structure->intersect(rays, {}, hits));
        last_flagged = structure->report().flagged;
        Checksum sum;
        sum.add(std::as_bytes(std::span(hits)));
        sum.add(std::as_bytes(std::span(occluded)));
        return sum.value();
    }

    Soup soup = test::random_soup(3, 4000, 0.2);
    std::vector<Ray> rays;
    uint64_t last_flagged = 0; // by the kernel, of the call of hash() before
};

TEST_F(MeasuredVariantsGl, AnswerTheSameBits) {
    const std::array<uint64_t, 2> expected{hash({}), hash({}, /* any_hit= */ true)};
    DeviceInfo card = gl->info();
    card.is_software = false;
    size_t tried = 0;
    for (const DeviceInfo& device : {gl->info(), card}) {
        const KernelVariant base = default_variants(device)[RayKind{}];
        std::vector<KernelVariant> variants =
            neighbours(base, gl->info(), /* other_kernel= */ true);
        variants.push_back(base);
        for (const KernelVariant& variant : variants) {
            if (!can_read(gl->info(), variant, 1, 1 << 20))
                continue;
            const bool any_hit = ++tried % 4 == 0; // kernels take long to compile
            const TwoLevelOptions given{.variant = VariantChoice::Given, .given_variant = variant};
            EXPECT_EQ(hash(given, any_hit), expected[any_hit]) << variant.text();
        }
    }
    EXPECT_GT(tried, 12u);
}

TEST_F(MeasuredVariantsGl, ChangeFramesInPairsOfFloatsToTheSameBits) {
    soup = test::closed_grid(30);
    for (const double shift : {0.7, 1.2, 300.0}) {
        Chunk instance = soup.chunks[0].instance();
        instance.place({{{{0.9, 0.1, 0, shift}, {-0.1, 0.9, 0.2, 0.1}, {0, 0, 1.1, 0.3}}}});
        soup.chunks.push_back(std::move(instance));
    }
    for (const bool compute : {true, false}) {
        KernelVariant variant =
            default_variants(gl->info(), compute)[RayKind{.frames = RayKind::Frames::Many}];
        variant.float_pairs = true;
        for (const bool any_hit : {false, true}) {
            const uint64_t expected = hash({.compute = compute}, any_hit);
            const uint64_t flagged = last_flagged;
            EXPECT_EQ(hash({.variant = VariantChoice::Given, .given_variant = variant}, any_hit),
                      expected);
            EXPECT_LT(last_flagged, flagged + rays.size() / 100) << "hardly more is in doubt";
        }
    }
}

TEST_F(MeasuredVariantsGl, AnswerTheSameBitsWhileTheyAreMeasured) {
    const uint64_t expected = hash({});
    EXPECT_EQ(hash({.variant = VariantChoice::Thorough}), expected);
    EXPECT_EQ(hash({.variant = VariantChoice::Measured}), expected);
    EXPECT_EQ(hash({.certify = false, .variant = VariantChoice::Thorough}),
              hash({.certify = false}))
        << "fast answers depend on what was measured";
}

} // namespace
} // namespace ovc

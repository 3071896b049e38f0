// SPDX-License-Identifier: Apache-2.0
// Pools of several buffers: however small a buffer is, answers are those of one buffer, bit for
// bit.
#include "plugin/two_level/test_two_level.h"

#include <string>
#include <tuple>

namespace ovc {
namespace {

using test::ok;

/// A sheet of 115,200 triangles, or three of them that share their pages: 5 MiB.
Soup scene_of_five_mebibytes(bool with_instances) {
    Soup soup = test::closed_grid(240);
    if (!with_instances)
        return soup;
    for (const double shift : {0.7, 1.2}) {
        Chunk instance = soup.chunks[0].instance();
        instance.place({{{{0.9, 0.1, 0, shift}, {-0.1, 0.9, 0.2, 0.1}, {0, 0, 1.1, 0.3}}}});
        soup.chunks.push_back(std::move(instance));
    }
    return soup;
}

/// The parameters are the max bytes of a buffer, whether meshes are shared, and whether the kernel
/// is the compute kernel.
class ManyBuffersGl : public TwoLevelGl,
                      public testing::WithParamInterface<std::tuple<uint64_t, bool, bool>> {
protected:
    /// Returns the statistics of the structure with many buffers.
    ovc_statistics expect_alike(const Soup& soup, TwoLevelOptions options) {
        const std::vector<Ray> rays = test::rays_from_outside(31, 20000);
        const auto one = build(soup, options);
        options.buffer_bytes = std::get<0>(GetParam());
        const auto many = build(soup, options);
        if (!one || !many)
            return {};
        EXPECT_EQ(one->plan().pool().count(), 1u);
        EXPECT_GT(many->plan().pool().count(), 1u);
        std::vector<Hit> expected(rays.size()), hits(rays.size());
        EXPECT_TRUE(ok(one->intersect(rays, {}, expected)));
        for (int call = 0; call < 2; ++call) { // pages move in the first
            EXPECT_TRUE(ok(many->intersect(rays, {}, hits)));
            size_t unlike = 0;
            for (size_t i = 0; i < rays.size(); ++i)
                unlike += !test::same(hits[i], expected[i]);
            EXPECT_EQ(unlike, 0u);
        }
        std::vector<uint8_t> occluded(rays.size());
        EXPECT_TRUE(ok(many->occluded(rays, {}, occluded)));
        size_t unlike = 0;
        for (size_t i = 0; i < rays.size(); ++i)
            unlike += (occluded[i] != 0) != expected[i].is_hit();
        EXPECT_EQ(unlike, 0u);
        EXPECT_LT(many->report().flagged, rays.size() / 10);
        return many->report();
    }
    TwoLevelOptions options() const {
        return {.leaf_triangles = 2000, .compute = std::get<2>(GetParam())};
    }
};
std::string name_of(const testing::TestParamInfo<std::tuple<uint64_t, bool, bool>>& of) {
    const auto [bytes, instances, compute] = of.param;
    return std::to_string(bytes >> 20) + "MiB" + (instances ? "Instances" : "") +
           (compute ? "Compute" : "Fragment");
}
INSTANTIATE_TEST_SUITE_P(BufferBytes, ManyBuffersGl,
                         testing::Combine(testing::Values(1 << 20, 3 << 20), testing::Bool(),
                                          testing::Bool()),
                         name_of);

TEST_P(ManyBuffersGl, AnswerAsOneDoes) {
    const ovc_statistics told =
        expect_alike(scene_of_five_mebibytes(std::get<1>(GetParam())), options());
    EXPECT_EQ(told.pages_in, told.leaves) << "all pages fit, so each is moved once";
    EXPECT_EQ(told.queues, 0u);
}

TEST_P(ManyBuffersGl, AnswerAsOneDoesWherePagesMove) {
    TwoLevelOptions some = options();
    some.budget_bytes = 5 << 20;
    expect_alike(scene_of_five_mebibytes(std::get<1>(GetParam())), some);
}

TEST_F(TwoLevelGl, BuffersOfSomeKilobytesAnswerAsBruteForceDoes) {
    for (const auto& [name, soup] : test::unpleasant_soups()) {
        const auto rays = test::unpleasant_rays(soup, 41, 1000);
        const std::vector<Hit> expected = test::brute_force(soup, rays);
        std::vector<Hit> hits(rays.size());
        for (const uint64_t budget : {uint64_t(0), uint64_t(160) << 10})
            for (const bool certify : {true, false}) {
                SCOPED_TRACE(name + ", budget " + std::to_string(budget));
                const auto structure = build(soup, {.budget_bytes = budget,
                                                    .leaf_triangles = 60,
                                                    .certify = certify,
                                                    .compute = true,
                                                    .buffer_bytes = 64 << 10});
                ASSERT_TRUE(structure);
                if (certify)
                    test::expect_answers(*structure, rays, expected);
                else
                    EXPECT_TRUE(ok(structure->intersect(rays, {}, hits)));
            }
    }
}

} // namespace
} // namespace ovc

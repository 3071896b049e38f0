// SPDX-License-Identifier: Apache-2.0
// What a driver ends or refuses: long loops, uploads; and stacks that are too short.
#include "plugin/two_level/test_two_level.h"

#include "gpu/gl/gl.h"

#include <atomic>
#include <utility>

namespace ovc {
namespace {

using test::ok;

/// Lets the driver refuse the next so many requests for memory to upload through.
class RefusedUploads {
public:
    explicit RefusedUploads(int count) {
        left_ = count;
        real_ = std::exchange(epoxy_glMapNamedBufferRange, refuse);
    }
    ~RefusedUploads() { epoxy_glMapNamedBufferRange = real_; }
    RefusedUploads(const RefusedUploads&) = delete;

    int left() const { return left_; }

private:
    static void* EPOXY_CALLSPEC refuse(GLuint buffer, GLintptr offset, GLsizeiptr bytes,
                                       GLbitfield access) {
        if (left_ <= 0)
            return real_(buffer, offset, bytes, access);
        --left_;
        glDisable(GL_DEBUG_OUTPUT); // which asserts that no call is a mistake
        glEnable(GL_NONE);          // GL has an error from now on
        glEnable(GL_DEBUG_OUTPUT);
        return nullptr;
    }

    static inline std::atomic<int> left_{0};
    static inline PFNGLMAPNAMEDBUFFERRANGEPROC real_ = nullptr;
};

/// Triangles one behind the other along z, each with a corner on the z axis; a ray past all of them
/// at (0.9, 0.9) goes through all their boxes.
Soup stack_of_triangles(int count) {
    std::vector<vec3> corners;
    for (int i = 0; i < count; ++i)
        for (const vec3& v : {vec3(0), vec3(1, 0, 0), vec3(0, 1, 0)})
            corners.push_back(v + vec3(0, 0, float(i) / float(count)));
    return test::one_chunk(std::move(corners));
}

TEST_F(TwoLevelGl, ALoopThatTheDriverEndsIsCountedAndDecidedInDouble) {
    const Soup soup = stack_of_triangles(200'000);
    const std::vector<Ray> rays = {
        {dvec3(0, 0, -1), 0, dvec3(0, 0, 1)},        // each in doubt: ends at the first
        {dvec3(0.9, 0.9, -1), 0, dvec3(0, 0, 1)},    // each box, no triangle
        {dvec3(0.25, 0.25, 2), 0, dvec3(0, 0, -1)}}; // the first is certain
    for (const uint64_t buffer_bytes : {0, 1 << 20})
        for (const auto& [certify, compute] :
             {std::pair(true, false), {true, true}, {false, false}, {false, true}}) {
            SCOPED_TRACE(std::string(certify ? "certified" : "fast") +
                         (compute ? ", compute" : "") + (buffer_bytes ? ", many buffers" : ""));
            const auto structure = build(soup, {.leaf_triangles = buffer_bytes ? 2000u : 1u << 30,
                                                .certify = certify,
                                                .compute = compute,
                                                .buffer_bytes = buffer_bytes});
            ASSERT_TRUE(structure);
            std::vector<Hit> hits(rays.size());
            ASSERT_TRUE(ok(structure->intersect(rays, {}, hits)));
            EXPECT_EQ(hits[0].id, (TriangleId{0, 0}));
            EXPECT_FALSE(hits[1].is_hit());
            EXPECT_EQ(hits[2].id, (TriangleId{0, 199'999}));
            const ovc_statistics& s = structure->statistics();
            EXPECT_LE(s.capped, s.retraced);
            if (gl->info().is_software && buffer_bytes == 0) {
                EXPECT_EQ(s.capped, 1u) << "no loop was ended, or one of a ray in doubt";
            }
        }
}

/// The pool has no page then where the tracer believes that it has one.
TEST_F(TwoLevelGl, APageThatDidNotGetThereFailsOneCallAlone) {
    if (!gl->info().is_software)
        GTEST_SKIP() << "uploads go through memory that stays mapped";
    const Soup soup = test::random_soup(9, 4000, 0.2);
    const std::vector<Ray> rays = test::rays_from_outside(3, 3000);
    const std::vector<Hit> expected = test::brute_force(soup, rays);
    const auto structure = build(soup, {.budget_bytes = 96u << 10, .leaf_triangles = 40});
    ASSERT_TRUE(structure);
    test::expect_answers(*structure, rays, expected);
    {
        const RefusedUploads refused(2);
        std::vector<Hit> hits(rays.size());
        EXPECT_FALSE(structure->intersect(rays, {}, hits));
        EXPECT_EQ(refused.left(), 0);
    }
    test::expect_answers(*structure, rays, expected);
}

TEST_F(TwoLevelGl, AStackGrowsUntilFewRaysNeedMore) {
    const Soup soup = test::random_soup(9, 4000, 0.2);
    const std::vector<Ray> rays = test::rays_from_outside(3, 3000);
    const KernelVariant variant = *parse_variant("compute,group=64,both-sides,registers=1,images");
    const auto structure = build(soup, {.variant = VariantChoice::Given, .given_variant = variant});
    ASSERT_TRUE(structure);
    test::expect_answers(*structure, rays, test::brute_force(soup, rays));
    EXPECT_LT(structure->statistics().capped, rays.size() / 256); // most need more than one word
}

} // namespace
} // namespace ovc

// SPDX-License-Identifier: Apache-2.0
// Rays that are traced together, and rays that meet few triangles, find what testing every triangle
// finds.
#include "plugin/fallback/rays_together.h"

#include "kdtree/test_soups.h"
#include "plugin/build/build_scene.h"
#include "plugin/fallback/exact_fallback.h"

#include <gtest/gtest.h>

#include <cmath>
#include <span>

namespace ovc {
namespace {

const MemoryPlan kRoomForAll{.budget_bytes = 1 << 26, .batch_rays = 1024, .pool_bytes = 1 << 25};

/// Returns `count` triangles round the z axis, which all overlap near it, with corners at
/// height(x, y, i) for triangle i.
template <class Height>
Soup stacked(int count, Height&& height) {
    test::Random random(/* seed= */ 7);
    std::vector<dvec3> corners;
    for (int i = 0; i < 3 * count; ++i) {
        const double a = 2.0943951023931953 * (i % 3);
        const double x = std::round(1024 * (8 * std::cos(a) + random(-1, 1))) / 1024;
        const double y = std::round(1024 * (8 * std::sin(a) + random(-1, 1))) / 1024;
        corners.push_back({x, y, height(x, y, i / 3)});
    }
    Soup soup;
    soup.chunks.push_back(Chunk::owning_doubles(dvec3(0), std::move(corners)));
    return soup;
}

/// Returns soups with a point in which a ray meets hundreds of triangles: the origin.
std::vector<test::NamedSoup> heaps() {
    std::vector<test::NamedSoup> soups;
    std::vector<vec3> fan;
    for (int i = 0; i < 700; ++i) {
        const double a = 6.283185307179586 * i / 700, b = 6.283185307179586 * (i + 1) / 700;
        fan.insert(fan.end(), {vec3(0), vec3(dvec3(std::cos(a), std::sin(a), 0.1)),
                               vec3(dvec3(std::cos(b), std::sin(b), 0.1))});
    }
    soups.push_back({"hub", test::one_chunk(std::move(fan))});
    soups.push_back({"plane", stacked(700, [](double x, double y, int) { return x + y; })});
    soups.push_back({"ulps apart",
                     stacked(700, [](double x, double y, int i) { return x + y + i * 0x1p-50; })});
    test::Random random(/* seed= */ 8);
    std::vector<dvec3> corners;
    for (int i = 0; i < 3 * 300; ++i)
        corners.push_back((i < 3 ? 1e76 : 1e-71) * random.point(-1, 1));
    soups.push_back({"large and small", Soup()});
    soups.back().soup.chunks.push_back(Chunk::owning_doubles(dvec3(0), std::move(corners)));
    return soups;
}

std::vector<Ray> rays_at_origin(const Soup& soup, size_t count) {
    Box bounds;
    hittable_triangles(soup, nullptr, &bounds);
    test::Random random(/* seed= */ 9);
    std::vector<Ray> rays;
    for (size_t i = 0; i < count; ++i) {
        const dvec3 org = max_component(bounds.extent()) * random.point(-1, 1);
        rays.push_back({org, 0, -org});
    }
    return rays;
}

/// A built scene, and rays with the hits that testing every triangle finds.
class Compared {
public:
    Compared(const Soup& soup, const TwoLevelOptions& options, std::span<const Ray> rays)
        : soup_(soup) {
        Result<BuiltScene> built = build_scene(soup, options, kRoomForAll, {}, nullptr);
        EXPECT_TRUE(built) << built.error().message;
        scene_.emplace(std::move(*built));
        ids_ = hittable_triangles(soup, nullptr, nullptr);
        for (const Ray& ray : rays)
            if (ray.valid())
                add(ray);
    }

    /// Traces the rays in groups of different sizes. Returns how many met many triangles.
    template <bool kAnyHit>
    size_t expect_expected() const {
        size_t many = 0;
        size_t size = 1;
        for (size_t first = 0; first < rays_.size(); first += size) {
            size = std::min(1 + size % RaysTogether<kAnyHit>::kMaxRays, rays_.size() - first);
            RaysTogether<kAnyHit> together(*scene_);
            for (size_t i = first; i < first + size; ++i) {
                const FewFound few = trace_few<kAnyHit>(*scene_, rays_[i]);
                many += !few.is_answer;
                expect_same_from_begin<kAnyHit>(i);
                expect_hit<kAnyHit>(i, trace_exactly<kAnyHit>(*scene_, rays_[i]));
                together.add(rays_[i], few.found.hit.id);
            }
            together.trace([] { return true; });
            for (size_t k = 0; k < size; ++k)
                expect_hit<kAnyHit>(first + k, together.hit(k));
        }
        return many;
    }

private:
    void add(const Ray& ray) {
        const Hit first = hit_of(PreparedRay(ray));
        Exclusion without;
        if (rays_.size() % 3 == 1)
            without.skip = first.id;
        if (rays_.size() % 3 == 2 && first.is_hit())
            without.after = HitPlace(first);
        rays_.emplace_back(ray, without);
        expected_.push_back(hit_of(rays_.back()));
    }

    /// A walk that is told where the ray's hits begin finds what it finds without.
    template <bool kAnyHit>
    void expect_same_from_begin(size_t i) const {
        const Hit& expected = expected_[i];
        const FewFound few = trace_few<kAnyHit>(*scene_, rays_[i], expected.t);
        if (!few.is_answer)
            return;
        ASSERT_EQ(few.found.hit.is_hit(), expected.is_hit()) << "ray " << i;
        if (!kAnyHit) {
            ASSERT_EQ(few.found.hit.id, expected.id) << "ray " << i;
        }
    }

    Hit hit_of(const PreparedRay& p) const {
        const bool is_named = soup_.has(p.after.id);
        const Triangle after = is_named ? soup_.triangle(p.after.id) : Triangle();
        Nearest nearest(p, is_named ? &after : nullptr);
        for (const TriangleId id : ids_)
            nearest.offer(soup_.triangle(id), id);
        return nearest.hit();
    }

    template <bool kAnyHit>
    void expect_hit(size_t i, const Hit& found) const {
        if (kAnyHit)
            ASSERT_EQ(found.is_hit(), expected_[i].is_hit()) << "ray " << i;
        else
            ASSERT_TRUE(test::same(expected_[i], found))
                << "ray " << i << ": " << test::describe(expected_[i]) << " but found "
                << test::describe(found);
    }

    const Soup& soup_;
    std::optional<BuiltScene> scene_;
    std::vector<TriangleId> ids_;
    std::vector<PreparedRay> rays_;
    std::vector<Hit> expected_;
};

class RaysTogetherIn : public testing::TestWithParam<uint32_t> {
protected:
    TwoLevelOptions options() const {
        TwoLevelOptions options;
        options.leaf_triangles = GetParam();
        return options;
    }
};
/// The parameter is the number of triangles in a leaf; 0: as many as there are room for.
INSTANTIATE_TEST_SUITE_P(Leaves, RaysTogetherIn, testing::Values(0, 60));

TEST_P(RaysTogetherIn, FindWhatBruteForceFinds) {
    for (const auto& [name, soup] : test::unpleasant_soups()) {
        SCOPED_TRACE(name);
        const Compared compared(soup, options(), test::unpleasant_rays(soup, 12, 300));
        compared.expect_expected</* kAnyHit= */ false>();
        compared.expect_expected</* kAnyHit= */ true>();
    }
}

TEST_P(RaysTogetherIn, FindTheNearestOfHundredsInOnePoint) {
    for (const auto& [name, soup] : heaps()) {
        SCOPED_TRACE(name);
        const std::vector<Ray> rays = rays_at_origin(soup, 60);
        const Compared compared(soup, options(), rays);
        EXPECT_GT(compared.expect_expected</* kAnyHit= */ false>(), rays.size() / 2);
        compared.expect_expected</* kAnyHit= */ true>();
    }
}

TEST(RaysTogether, StopWhenAsked) {
    const Soup soup = std::move(heaps().front().soup);
    Result<BuiltScene> built = build_scene(soup, TwoLevelOptions(), kRoomForAll, {}, nullptr);
    ASSERT_TRUE(built) << built.error().message;
    RaysTogether</* kAnyHit= */ false> together(*built);
    for (const Ray& ray : rays_at_origin(soup, 3))
        together.add(PreparedRay(ray), TriangleId());
    size_t asked = 0;
    together.trace([&] { return ++asked < 2; });
    EXPECT_EQ(asked, 2u) << "of 700 / 64 batches";
}

} // namespace
} // namespace ovc

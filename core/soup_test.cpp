// SPDX-License-Identifier: Apache-2.0
// Soup: tests who owns the corners, where they lie, which triangles can be hit, and their numbers.
#include "core/soup.h"

#include "core/numbering.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

namespace ovc {
namespace {

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::vector<vec3> unit_triangle() {
    return {vec3(0), vec3(1, 0, 0), vec3(0, 1, 0)};
}

TEST(Chunk, AddsItsOriginInDouble) {
    const dvec3 origin(1e9 + 0.125, -1e9, 0.1);
    const Chunk chunk = Chunk::owning(origin, unit_triangle());
    ASSERT_EQ(chunk.size(), 1u);
    const Triangle t = chunk.triangle(0);
    EXPECT_EQ(t[0], origin);
    EXPECT_EQ(t[1], origin + dvec3(1, 0, 0));
    EXPECT_EQ(t[2], origin + dvec3(0, 1, 0));
}

/// Corners that are told from other corners when they are asked for.
template <class Corner>
class CornersAsked final : public StoredCorners {
public:
    explicit CornersAsked(std::span<const Corner> corners) : corners_(corners) {}

    bool has_doubles() const override { return sizeof(Corner) == sizeof(dvec3); }
    bool read(uint32_t first, std::span<std::byte> to) const override {
        std::memcpy(to.data(), &corners_[first * size_t(3)], to.size());
        return true;
    }

private:
    std::span<const Corner> corners_;
};

TEST(Chunk, PutsTheCoordinatesOfTriangles) {
    const std::vector<dvec3> doubles = {{1e-90, 1e90, 1}, {-1e90, 2, -1e-90}, {0.1, 0.2, 0.3}};
    const std::vector<vec3> floats = {{1, 2, 3}, {1e-30f, 1e30f, 5}, {0, -1, 0.1f}};
    for (const dvec3& origin : {dvec3(0), dvec3(0.1, 3, 1e-80)})
        for (const bool are_floats : {false, true}) {
            const Chunk chunk = are_floats ? Chunk::borrowing(origin, floats)
                                           : Chunk::borrowing_doubles(origin, doubles);
            const Triangle triangle = chunk.triangle(0);
            std::array<double, 18> put{};
            chunk.put_triangle<2>(0, put.data());
            for (int i = 0; i < 9; ++i)
                EXPECT_EQ(put[size_t(2 * i)], triangle[size_t(i / 3)][i % 3]) << i;
        }
}

TEST(Chunk, StoredCornersLieWhereThoseInMemoryDo) {
    std::mt19937 random(3);
    const auto coordinate = [&] { return double(random()) * 0x1p-30 - 2; };
    std::vector<vec3> floats;
    std::vector<dvec3> doubles;
    for (int i = 0; i < 12; ++i) {
        doubles.push_back({coordinate(), coordinate(), coordinate()});
        floats.push_back(vec3(doubles.back()));
    }
    const dvec3 origin(1e5, 0.1, 0);
    const CornersAsked<vec3> asked_floats{floats};
    const CornersAsked<dvec3> asked_doubles{doubles};
    Transform turn = kIdentity;
    turn.rows[0] = {0, 1, 0, 0.3};
    turn.rows[1] = {-1, 0, 0, 7};
    const std::pair<Chunk, Chunk> pairs[] = {
        {Chunk::borrowing(origin, floats), Chunk::stored(origin, asked_floats, 4)},
        {Chunk::borrowing_doubles(origin, doubles), Chunk::stored(origin, asked_doubles, 4)}};
    for (const auto& [there, stored] : pairs) {
        ASSERT_EQ(stored.size(), there.size());
        const auto expect_same = [](const Chunk& a, const Chunk& b) {
            for (uint32_t prim = 0; prim < a.size(); ++prim) {
                EXPECT_EQ(a.triangle(prim), b.triangle(prim));
                std::array<double, 9> put{};
                b.put_triangle<1>(prim, put.data());
                EXPECT_EQ(put[5], b.triangle(prim)[1].z);
            }
        };
        expect_same(there, stored);
        Chunk placed = there.instance(), stored_placed = stored.instance();
        placed.place(turn);
        stored_placed.place(turn);
        expect_same(placed, stored_placed);
        expect_same(there, stored_placed.unplaced());
        std::vector<Triangle> all;
        for_each_triangle(stored_placed, 1, 4, [&](const Triangle& t) { all.push_back(t); });
        EXPECT_EQ(all, (std::vector{placed.triangle(1), placed.triangle(2), placed.triangle(3)}));
        EXPECT_EQ(stored.mesh_key(), stored_placed.mesh_key());
    }
    EXPECT_NE(pairs[0].second.mesh_key(), pairs[1].second.mesh_key());
}

TEST(Chunk, OwnedCornersSurviveMoves) {
    Chunk first = Chunk::owning(dvec3(0), unit_triangle());
    const vec3* corners = first.corners().data();
    Chunk second = std::move(first);
    std::vector<Chunk> many;
    many.push_back(std::move(second));
    for (int i = 0; i < 100; ++i) // the vector moves its chunks as it grows
        many.push_back(Chunk::owning(dvec3(i), unit_triangle()));
    EXPECT_EQ(many[0].corners().data(), corners);
    EXPECT_EQ(many[0].triangle(0)[1], dvec3(1, 0, 0));
}

TEST(Chunk, BorrowedCornersAreTheCallers) {
    const std::vector<vec3> corners = unit_triangle();
    const Chunk chunk = Chunk::borrowing(dvec3(2), corners);
    EXPECT_EQ(chunk.corners().data(), corners.data());
    EXPECT_EQ(chunk.owned_bytes(), 0u);
    EXPECT_EQ(chunk.triangle(0)[0], dvec3(2));
}

TEST(TriangleFault, NamesWhyATriangleCanNeverBeHit) {
    const struct {
        const char* name;
        Triangle triangle;
        TriangleFault fault;
    } cases[] = {
        {"plain", {dvec3(0), dvec3(1, 0, 0), dvec3(0, 1, 0)}, TriangleFault::None},
        {"plain, mirrored", {dvec3(0), dvec3(0, 1, 0), dvec3(1, 0, 0)}, TriangleFault::None},
        {"tiny", {dvec3(0), dvec3(1e-60, 0, 0), dvec3(0, 1e-60, 0)}, TriangleFault::None},
        {"smallest floats",
         {dvec3(0), dvec3(0x1p-149, 0, 0), dvec3(0, 0x1p-149, 0)},
         TriangleFault::None},
        {"one ulp off a line",
         {dvec3(0), dvec3(1, 1, 1), dvec3(2, 2, std::nextafter(2.0, 3.0))},
         TriangleFault::None},
        {"one point", {dvec3(3), dvec3(3), dvec3(3)}, TriangleFault::Degenerate},
        {"a = b", {dvec3(1), dvec3(1), dvec3(0, 5, 0)}, TriangleFault::Degenerate},
        {"b = c", {dvec3(0, 5, 0), dvec3(1), dvec3(1)}, TriangleFault::Degenerate},
        {"a = c", {dvec3(1), dvec3(0, 5, 0), dvec3(1)}, TriangleFault::Degenerate},
        {"on a slanted line",
         {dvec3(0), dvec3(1, 2, 3), dvec3(2, 4, 6)},
         TriangleFault::Degenerate},
        {"back along its line",
         {dvec3(0), dvec3(1, 2, 3), dvec3(-3, -6, -9)},
         TriangleFault::Degenerate},
        {"NaN", {dvec3(0), dvec3(1, kNotANumber, 0), dvec3(0, 1, 0)}, TriangleFault::NotFinite},
        {"infinite", {dvec3(0), dvec3(1, 0, 0), dvec3(0, 1, -kInfinity)}, TriangleFault::NotFinite},
        {"NaN and no area",
         {dvec3(kNotANumber), dvec3(kNotANumber), dvec3(kNotANumber)},
         TriangleFault::NotFinite},
    };
    for (const auto& c : cases)
        EXPECT_EQ(triangle_fault(c.triangle), c.fault) << c.name;
}

TEST(TriangleFault, DoesNotDependOnTheOrderOfCorners) {
    for (uint32_t seed = 0; seed < 2000; ++seed) {
        std::mt19937 random(seed);
        const auto coordinate = [&] { return double(random() % 3); }; // often on a line
        const auto point = [&] { return dvec3(coordinate(), coordinate(), coordinate()); };
        const dvec3 a = point(), b = point(), c = point();
        const TriangleFault fault = triangle_fault({a, b, c});
        EXPECT_EQ(triangle_fault({b, c, a}), fault) << seed;
        EXPECT_EQ(triangle_fault({c, b, a}), fault) << seed;
    }
}

TEST(HittableTriangles, OfAnEmptySoupAreNone) {
    Soup soup;
    soup.chunks.push_back(Chunk::owning(dvec3(0), {}));
    Dropped dropped;
    Box bounds;
    EXPECT_TRUE(hittable_triangles(soup, &dropped, &bounds).empty());
    EXPECT_EQ(dropped.total(), 0u);
    EXPECT_TRUE(bounds.empty());
    EXPECT_TRUE(hittable_triangles(soup, nullptr, nullptr).empty());
}

TEST(HittableTriangles, KeepOrderAndCountWhatTheyDrop) {
    constexpr uint32_t kTriangles = 20000; // several ranges of the parallel loop
    std::vector<vec3> corners;
    for (uint32_t prim = 0; prim < kTriangles; ++prim) {
        const vec3 at(float(prim % 7), 0, 0);
        const float height = prim % 5 == 1 ? 0.0f : prim % 5 == 2 ? float(kNotANumber) : 1.0f;
        corners.insert(corners.end(), {at, at + vec3(1, 0, 0), at + vec3(0, height, 0)});
    }
    Soup soup;
    soup.chunks.push_back(Chunk::owning(dvec3(0), unit_triangle()));
    soup.chunks.push_back(Chunk::owning(dvec3(100), std::move(corners)));
    EXPECT_EQ(soup.triangle_count(), kTriangles + 1);

    Dropped dropped;
    Box bounds;
    const std::vector<TriangleId> ids = hittable_triangles(soup, &dropped, &bounds);
    EXPECT_EQ(dropped.degenerate, kTriangles / 5);
    EXPECT_EQ(dropped.not_finite, kTriangles / 5);
    ASSERT_EQ(ids.size(), kTriangles / 5 * 3 + 1);
    EXPECT_EQ(ids[0], (TriangleId{0, 0}));
    for (size_t i = 1; i < ids.size(); ++i)
        ASSERT_LT(ids[i - 1], ids[i]);
    EXPECT_EQ(bounds.lo, dvec3(0));
    EXPECT_EQ(bounds.hi, dvec3(107, 101, 100));
}

TEST(HittableTriangles, BoundsLeaveOutWhatIsDropped) {
    std::vector<vec3> corners = unit_triangle();
    corners.insert(corners.end(), {vec3(50), vec3(60), vec3(70)}); // a line
    corners.insert(corners.end(),
                   {vec3(-90), vec3(float(kNotANumber)), vec3(-90, -80, -90)}); // NaN
    Soup soup;
    soup.chunks.push_back(Chunk::owning(dvec3(0), std::move(corners)));
    Box bounds;
    EXPECT_EQ(hittable_triangles(soup, nullptr, &bounds).size(), 1u);
    EXPECT_EQ(bounds.lo, dvec3(0));
    EXPECT_EQ(bounds.hi, dvec3(1, 1, 0));
}

void add(Soup& soup, uint32_t triangles) {
    soup.chunks.push_back(Chunk::owning(dvec3(0), std::vector<vec3>(triangles * size_t(3))));
}

void expect_names(const Soup& soup, const Numbering& numbering) {
    uint32_t number = numbering.first();
    for (uint32_t mesh = 0; mesh < soup.chunks.size(); ++mesh)
        for (uint32_t prim = 0; prim < soup.chunks[mesh].size(); ++prim, ++number) {
            ASSERT_EQ(numbering.of({mesh, prim}), number);
            ASSERT_EQ(numbering.id(number), (TriangleId{mesh, prim}));
        }
    EXPECT_EQ(numbering.count(), number);
}

TEST(Numbering, LeadsBackToTriangles) {
    std::mt19937 random(1);
    for (const uint32_t chunks : {1u, 2u, 3u, 10u, 500u})
        for (const uint32_t largest : {0u, 1u, 3u, 4000u})
            for (const uint32_t first : {0u, 77u}) {
                SCOPED_TRACE(testing::Message() << chunks << " chunks of up to " << largest);
                Soup soup;
                for (uint32_t i = 0; i < chunks; ++i) // most are small, some empty, few large
                    add(soup, random() % (random() % 20 == 0 ? largest + 1 : largest % 5 + 1));
                Numbering numbering(soup, first);
                expect_names(soup, numbering);
                add(soup, 0);
                add(soup, 9);
                numbering.append(soup);
                expect_names(soup, numbering);
            }
}

} // namespace
} // namespace ovc

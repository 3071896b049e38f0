// SPDX-License-Identifier: Apache-2.0
// Tests what is told from frame to frame, and that the soup is then the next frame's.
#include "host/scene/soup_difference.h"

#include <gtest/gtest.h>

namespace ovc {
namespace {

/// Returns corners of triangles along x, from `from` on.
std::vector<vec3> row(float from, size_t triangles) {
    std::vector<vec3> corners;
    for (size_t i = 0; i < triangles; ++i)
        for (const vec3& corner : {vec3(0), vec3(1, 0, 0), vec3(0, 1, 0)})
            corners.push_back(vec3(from + float(i), 0, 0) + corner);
    return corners;
}

Transform shifted(double x) {
    Transform transform = kIdentity;
    transform.rows[0][3] = x;
    return transform;
}

/// Returns a lone mesh, a mesh with two instances, and one more mesh.
Soup example_soup() {
    Soup soup;
    soup.chunks.push_back(Chunk::owning(dvec3(0), row(0, 200)));
    soup.chunks.push_back(Chunk::owning(dvec3(5, 0, 0), row(0, 3)));
    soup.chunks[1].place(shifted(1));
    soup.chunks.push_back(soup.chunks[1].unplaced());
    soup.chunks[2].place(shifted(2));
    soup.chunks.push_back(Chunk::owning_doubles(dvec3(0), {dvec3(0), dvec3(1), dvec3(2)}));
    return soup;
}

void expect_same(const Soup& a, const Soup& b) {
    ASSERT_EQ(a.chunks.size(), b.chunks.size());
    for (uint32_t m = 0; m < a.chunks.size(); ++m) {
        ASSERT_EQ(a.chunks[m].size(), b.chunks[m].size()) << m;
        EXPECT_EQ(a.chunks[m].mask(), b.chunks[m].mask()) << m;
        EXPECT_EQ(a.chunks[m].origin(), b.chunks[m].origin()) << m;
        for (uint32_t prim = 0; prim < a.chunks[m].size(); ++prim)
            ASSERT_EQ(a.chunks[m].triangle(prim), b.chunks[m].triangle(prim)) << m << " " << prim;
    }
}

using Ranges = std::vector<PrimRange>;

TEST(SoupDifference, OfTheSameIsNothing) {
    EXPECT_FALSE(difference(example_soup(), example_soup()).any());
}

TEST(SoupDifference, NamesTrianglesThatMoveAndJoinsNeighbours) {
    Soup now = example_soup(), next = example_soup();
    const vec3 moved[3] = {{7, 7, 7}, {8, 7, 7}, {7, 8, 7}};
    for (const uint32_t prim : {10u, 20u, 199u})
        next.chunks[0].set_corners(prim, std::span(moved));
    const SoupDifference found = difference(now, next);
    EXPECT_EQ(found.moved, (Ranges{{0, 10, 21}, {0, 199, 200}}));
    EXPECT_EQ(found.kept, 4u);
    EXPECT_TRUE(found.placed.empty());
    const void* const where = now.chunks[0].address_of(0);
    EXPECT_TRUE(take_over(now, std::move(next), found).empty());
    EXPECT_EQ(now.chunks[0].address_of(0), where);
    EXPECT_EQ(now.chunks[0].triangle(20)[1], dvec3(8, 7, 7));
    EXPECT_EQ(now.chunks[0].triangle(15)[0], dvec3(15, 0, 0));
}

TEST(SoupDifference, TellsEachInstanceOfAMeshThatMoves) {
    Soup now = example_soup(), next = example_soup();
    next.chunks[1].set_corners(2, std::span<const vec3>(row(9, 1)));
    next.chunks[2].place_anew(shifted(4));
    const SoupDifference found = difference(now, next);
    EXPECT_EQ(found.moved, (Ranges{{1, 2, 3}, {2, 2, 3}}));
    EXPECT_EQ(found.placed, std::vector<uint32_t>{2});
    const Soup copy = [] {
        Soup soup = example_soup();
        soup.chunks[1].set_corners(2, std::span<const vec3>(row(9, 1)));
        soup.chunks[2].place_anew(shifted(4));
        return soup;
    }();
    take_over(now, std::move(next), found);
    expect_same(now, copy);
}

TEST(SoupDifference, ReplacesFromTheFirstMeshOnThatIsNotTheSame) {
    const struct {
        const char* what;
        void (*change)(Soup&);
        uint32_t kept;
    } cases[] = {
        {"size", [](Soup& s) { s.chunks[3] = Chunk::owning_doubles(dvec3(0), {}); }, 3},
        {"origin", [](Soup& s) { s.chunks[0] = Chunk::owning(dvec3(1), row(0, 200)); }, 0},
        {"type", [](Soup& s) { s.chunks[3] = Chunk::owning(dvec3(0), row(0, 1)); }, 3},
        {"mask", [](Soup& s) { s.chunks[2].set_mask(4); }, 2},
        {"lender", [](Soup& s) { s.chunks[2] = Chunk::owning(dvec3(5, 0, 0), row(0, 3)); }, 2},
        {"one less", [](Soup& s) { s.chunks.pop_back(); }, 3},
        {"one more", [](Soup& s) { s.chunks.push_back(s.chunks[1].unplaced()); }, 4},
        {"none", [](Soup& s) { s.chunks.clear(); }, 0},
    };
    for (const auto& c : cases) {
        SCOPED_TRACE(c.what);
        Soup now = example_soup(), next = example_soup(), expected = example_soup();
        c.change(next);
        c.change(expected);
        const SoupDifference found = difference(now, next);
        EXPECT_EQ(found.kept, c.kept);
        EXPECT_EQ(take_over(now, std::move(next), found).size(), 4 - c.kept);
        expect_same(now, expected);
        EXPECT_FALSE(difference(now, expected).any());
    }
}

TEST(SoupDifference, WritesToNoCornersOfOthers) {
    const std::vector<vec3> before = row(0, 2), after = row(1, 2);
    Soup now, next;
    now.chunks.push_back(Chunk::borrowing(dvec3(0), before));
    next.chunks.push_back(Chunk::borrowing(dvec3(0), after));
    const SoupDifference found = difference(now, next);
    EXPECT_EQ(found.kept, 0u);
    take_over(now, std::move(next), found);
    EXPECT_EQ(now.chunks[0].triangle(0)[0], dvec3(1, 0, 0));
    EXPECT_EQ(before[0], vec3(0));
}

} // namespace
} // namespace ovc

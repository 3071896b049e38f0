// SPDX-License-Identifier: Apache-2.0
// The triangles of a polygon cover it once, as seen along its normal.
#include "importers/mesh/polygon.h"

#include <gtest/gtest.h>

#include <chrono>
#include <random>

namespace ovc {
namespace {

using Triangles = std::vector<std::array<uint32_t, 3>>;

dvec3 area_vector(const dvec3& a, const dvec3& b, const dvec3& c) {
    return glm::cross(b - a, c - a) * 0.5;
}

dvec3 area_vector(const std::vector<dvec3>& polygon) {
    dvec3 area(0);
    for (size_t i = 1; i + 1 < polygon.size(); ++i)
        area += area_vector(polygon[0], polygon[i], polygon[i + 1]);
    return area;
}

/// Areas that are all wound as the polygon and add up to its own cannot overlap.
void expect_covered_once(const std::vector<dvec3>& polygon) {
    Triangles triangles;
    triangulate(polygon, triangles);
    ASSERT_EQ(triangles.size(), polygon.size() - 2);
    const dvec3 whole = area_vector(polygon);
    const double area = glm::length(whole);
    double sum = 0;
    for (const auto& t : triangles) {
        const double part =
            glm::dot(area_vector(polygon[t[0]], polygon[t[1]], polygon[t[2]]), whole) / area;
        EXPECT_GE(part, -1e-12 * area);
        sum += std::abs(part);
    }
    EXPECT_NEAR(sum, area, 1e-9 * area);
}

std::vector<dvec3> flat(std::initializer_list<dvec2> corners) {
    std::vector<dvec3> polygon;
    for (const dvec2& c : corners)
        polygon.emplace_back(c.x, c.y, 0);
    return polygon;
}

TEST(Polygon, FewerThanThreeCornersGiveNothing) {
    for (size_t n = 0; n < 3; ++n) {
        Triangles triangles;
        triangulate(std::vector<dvec3>(n, dvec3(1)), triangles);
        EXPECT_TRUE(triangles.empty()) << n;
    }
}

TEST(Polygon, ConvexBecomesTheFanOfCornerZero) {
    Triangles triangles;
    triangulate(flat({{0, 0}, {2, 0}, {3, 1}, {2, 2}, {0, 2}}), triangles);
    EXPECT_EQ(triangles, (Triangles{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}}));
}

TEST(Polygon, AppendsToWhatIsThere) {
    Triangles triangles{{7, 8, 9}};
    triangulate(flat({{0, 0}, {1, 0}, {0, 1}}), triangles);
    EXPECT_EQ(triangles, (Triangles{{7, 8, 9}, {0, 1, 2}}));
}

TEST(Polygon, ConcaveQuadIsCutAtItsReflexCorner) {
    const auto arrow = flat({{0, 0}, {2, -1}, {0, 3}, {-2, -1}});
    for (int turn = 0; turn < 4; ++turn) {
        auto polygon = arrow;
        std::rotate(polygon.begin(), polygon.begin() + turn, polygon.end());
        expect_covered_once(polygon);
        std::reverse(polygon.begin(), polygon.end());
        expect_covered_once(polygon);
    }
}

TEST(Polygon, CombSpiralAndHoleAreCoveredOnce) {
    std::vector<dvec3> comb{{200, -1, 0}, {200, 0, 0}};
    for (int tooth = 99; tooth >= 0; --tooth) {
        comb.emplace_back(2 * tooth + 1, 10, 0);
        comb.emplace_back(2 * tooth, 0, 0);
    }
    comb.emplace_back(0, -1, 0);
    expect_covered_once(comb);

    std::vector<dvec3> spiral;
    for (int i = 0; i < 60; ++i)
        spiral.emplace_back((2.0 + i) * std::cos(0.3 * i), (2.0 + i) * std::sin(0.3 * i), 0);
    for (int i = 59; i >= 0; --i)
        spiral.emplace_back((1.0 + i) * std::cos(0.3 * i), (1.0 + i) * std::sin(0.3 * i), 0);
    expect_covered_once(spiral);

    expect_covered_once(flat({{0, 0},
                              {4, 0},
                              {4, 4},
                              {0, 4},
                              {0, 0}, // the outside, back to its start,
                              {1, 1},
                              {1, 3},
                              {3, 3},
                              {3, 1},
                              {1, 1}})); // and a hole
}

TEST(Polygon, StraightCornersDoNoHarm) {
    expect_covered_once(flat({{0, 0}, {1, 0}, {2, 0}, {2, 1}, {2, 2}, {1, 2}, {1, 1}, {0, 1}}));
}

TEST(Polygon, RandomStarsInRandomPlanesAreCoveredOnce) {
    for (unsigned seed = 0; seed < 300; ++seed) {
        SCOPED_TRACE(seed);
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> unit(0, 1);
        const size_t n = 4 + random() % 150;
        const dvec3 u =
            glm::normalize(dvec3(unit(random) - 0.5, unit(random) - 0.5, 1e-3 + unit(random)));
        const dvec3 v = glm::normalize(glm::cross(u, dvec3(0.3, -0.8, 0.1)));
        std::vector<dvec3> polygon;
        for (size_t i = 0; i < n; ++i) {
            const double angle = (double(i) + 0.8 * unit(random)) * 6.283185307179586 / double(n);
            const double radius = 0.1 + unit(random);
            polygon.push_back(dvec3(1000) + radius * (std::cos(angle) * u + std::sin(angle) * v));
        }
        expect_covered_once(polygon);
    }
}

TEST(Polygon, DegenerateAndCrossingOnesStillGiveAllTriangles) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const std::vector<std::vector<dvec3>> polygons = {
        std::vector<dvec3>(7, dvec3(1)),
        flat({{0, 0}, {1, 0}, {2, 0}, {3, 0}}),
        flat({{0, 0}, {2, 2}, {2, 0}, {0, 2}}),
        flat({{0, 0}, {4, 1}, {0, 2}, {3, -1}, {3, 3}}),
        {{0, 0, 0}, {nan, 0, 0}, {1, 1, 0}, {0.1, 0.1, 0}, {0, 1, 0}}};
    for (const auto& polygon : polygons) {
        Triangles triangles;
        triangulate(polygon, triangles);
        EXPECT_EQ(triangles.size(), polygon.size() - 2);
    }
}

TEST(Polygon, AsManyConcaveCornersAsMayBeAreCutInLittleTime) {
    constexpr int kHalf = int(kMaxConcaveCorners) / 2;
    std::vector<dvec3> comb{{2 * kHalf, -1, 0}}, spiral, cavity, dented, wild;
    for (int tooth = kHalf - 2; tooth >= 0; --tooth) {
        comb.emplace_back(2 * tooth + 1, 10, 0);
        comb.emplace_back(2 * tooth, 0, 0);
    }
    comb.emplace_back(0, -1, 0);
    const auto add = [](std::vector<dvec3>& polygon, double radius, double angle) {
        polygon.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
    };
    for (int i = 0; i < 2 * kHalf; ++i) {
        const int along = i < kHalf ? i : 2 * kHalf - 1 - i; // there and back
        add(spiral, (i < kHalf ? 2 : 1) + 0.1 * along, 0.3 * along);
        add(cavity, i < kHalf ? 1 : 0.999, 3.1 * along / kHalf);
        add(dented, i == 7 ? 0.5 : 1, 3.141592653589793 * i / kHalf);
    }
    std::mt19937 random(1);
    std::uniform_real_distribution<double> unit(0, 1);
    for (int i = 0; i < 2 * kHalf; ++i)
        wild.emplace_back(unit(random), unit(random), 0);
    const struct {
        const char* name;
        const std::vector<dvec3>& polygon;
        bool crosses;
    } cases[] = {{"comb", comb, false},
                 {"spiral", spiral, false}, // took 16 s
                 {"cavity", cavity, false},
                 {"dented", dented, false},
                 {"wild", wild, true}}; // took 3 s
    for (const auto& test : cases) {
        SCOPED_TRACE(test.name);
        const auto start = std::chrono::steady_clock::now();
        Triangles triangles;
        triangulate(test.polygon, triangles);
        EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(1));
        EXPECT_EQ(triangles.size(), test.polygon.size() - 2);
        if (!test.crosses)
            expect_covered_once(test.polygon);
    }
}

TEST(Polygon, ManyCornersDoNotHang) {
    std::vector<dvec3> saw;
    for (int i = 0; i < 200000; ++i)
        saw.emplace_back(i, i % 2, 0);
    saw.emplace_back(0, 10, 0);
    Triangles triangles;
    triangulate(saw, triangles);
    EXPECT_EQ(triangles.size(), saw.size() - 2);
}

} // namespace
} // namespace ovc

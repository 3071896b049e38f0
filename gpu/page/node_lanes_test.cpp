// SPDX-License-Identifier: Apache-2.0
// Compares meet_children() with clip() in core/exact/triangle.h, child by child.
#include "gpu/page/node_lanes.h"

#include "gpu/page/page_walk.h"
#include "kdtree/test_soups.h"

#include <gtest/gtest.h>

namespace ovc {
namespace {

constexpr double kMargin = 1e-9;

class Random : public test::Random {
public:
    using test::Random::Random;
    double uniform(double lo, double hi) { return (*this)(lo, hi); }
    /// Returns a direction with components that are 0, of either sign, or denormal.
    dvec3 direction() {
        dvec3 dir;
        for (int axis = 0; axis < 3; ++axis) {
            const double unpleasant[] = {0.0, -0.0, 1e-310, -1e-310};
            dir[axis] = below(3) ? uniform(-1, 1) : unpleasant[below(4)];
        }
        dir[int(below(3))] = below(2) ? 1 : -1;
        return dir;
    }
};

/// A node whose children are any boxes, some of them flat or missing.
struct Node {
    std::array<uvec4, 3> texels{};
    std::array<std::array<GridRange, 3>, 4> ranges{};

    explicit Node(Random& random) {
        for (uint32_t child = 0; child < 4; ++child) {
            const bool missing = random.below(6) == 0;
            for (size_t axis = 0; axis < 3; ++axis) {
                const uint32_t a = 1 + random.below(kGridLast), b = 1 + random.below(kGridLast);
                GridRange range{std::min(a, b), random.below(8) ? std::max(a, b) : std::min(a, b)};
                if (missing)
                    range = GridRange();
                ranges[child][axis] = range;
                put_range(texels[axis], child, range);
            }
        }
    }
    Box box(const GridHeader& grid, size_t child) const {
        Box box;
        for (int axis = 0; axis < 3; ++axis) {
            const GridRange& range = ranges[child][size_t(axis)];
            const auto at = [&](uint32_t c) {
                return double(grid.middle[axis]) +
                       (double(c) - double(kGridMiddle)) * double(grid.cell[axis]);
            };
            box.lo[axis] = at(range.lo);
            box.hi[axis] = at(range.hi);
        }
        return box;
    }
};

void expect_place(const NodeMeeting& meeting) {
    for (size_t a = 0; a < 4; ++a)
        for (size_t b = 0; b < 4; ++b)
            if (a != b) {
                ASSERT_NE(meeting.place[a], meeting.place[b]);
                if (meeting.enter[a] > meeting.enter[b]) {
                    ASSERT_LT(meeting.place[a], meeting.place[b]);
                }
            }
}

/// Fails where a child is left out that the ray meets, or is met far beside it.
void expect_as_clip(const NodeMeeting& meeting, const Node& node, const GridHeader& grid,
                    const WalkedRay& walked, double to) {
    uint32_t met = 0;
    for (size_t child = 0; child < 4; ++child) {
        const bool is_met = meeting.enter[child] >= 0;
        met += is_met;
        ASSERT_EQ(is_met, size_t(meeting.place[child]) < meeting.count);
        if (node.ranges[child][0].empty()) {
            ASSERT_FALSE(is_met);
            continue;
        }
        const Box box = node.box(grid, child);
        const Interval exactly = clip(walked.ray, box, 0, to);
        const Interval widely = clip(walked.ray, box.padded(2 * kMargin), 0, to);
        if (!exactly.empty()) {
            ASSERT_TRUE(is_met);
            ASSERT_LE(meeting.enter[child], exactly.enter);
        }
        if (is_met) {
            ASSERT_FALSE(widely.empty());
        }
    }
    ASSERT_EQ(met, meeting.count);
}

TEST(NodeLanes, MeetsWhatClipMeets) {
    uint32_t met = 0;
    for (uint64_t seed = 0; seed < 20'000; ++seed) {
        SCOPED_TRACE(seed);
        Random random(seed);
        const Node node(random);
        const GridHeader grid{vec3(0), vec3(0x1p-15f, 0x1p-15f, random.below(8) ? 0x1p-15f : 0)};
        const Ray ray{{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)},
                      0,
                      random.direction()};
        const WalkedRay walked{PreparedRay(ray), kMargin};
        const double to = random.below(2) ? random.uniform(0, 1) : 1e300;
        const NodeRay asked = node_ray(grid, walked, 0);
        const std::vector<MeetChildren> ways = ways_to_meet_children();
        NodeMeeting first;
        ways[0](asked, &node.texels[0].x, to, first);
        expect_as_clip(first, node, grid, walked, to);
        expect_place(first);
        met += first.count;
        for (const MeetChildren way : ways) {
            NodeMeeting again;
            way(asked, &node.texels[0].x, to, again);
            ASSERT_EQ(again.count, first.count);
            for (size_t child = 0; child < 4; ++child) {
                ASSERT_EQ(again.enter[child], first.enter[child]);
                ASSERT_EQ(again.place[child], first.place[child]);
            }
        }
    }
    EXPECT_GT(met, 2'000u);
}

} // namespace
} // namespace ovc

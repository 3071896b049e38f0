// SPDX-License-Identifier: Apache-2.0
// Compares meet_children() with clip() in core/exact/triangle.h, child by child.
#include "gpu/page/node_lanes.h"

#include "gpu/page/page_walk.h"
#include "kdtree/test_soups.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

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
                    const WalkedRay& walked) {
    uint32_t met = 0;
    for (size_t child = 0; child < 4; ++child) {
        const bool is_met = meeting.enter[child] >= 0;
        met += is_met;
        ASSERT_EQ(is_met, size_t(meeting.place[child]) < meeting.count);
        ASSERT_EQ(is_met, meeting.rays[child] != 0);
        if (node.ranges[child][0].empty()) {
            ASSERT_FALSE(is_met);
            continue;
        }
        const Box box = node.box(grid, child);
        const double to = walked.ray.ray.t_max;
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

/// A node on a grid, which may be flat, and rays to it.
struct Asked {
    Node node;
    GridHeader grid;
    std::vector<WalkedRay> walked;
    NodeRays rays;

    Asked(Random& random, uint32_t count)
        : node(random), grid{vec3(0), vec3(0x1p-15f, 0x1p-15f, random.below(8) ? 0x1p-15f : 0)} {
        for (int axis = 0; axis < 3; ++axis)
            rays.cell[axis] = double(grid.cell[axis]);
        for (uint32_t i = 0; i < count; ++i) {
            Ray ray{{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)},
                    0,
                    random.direction()};
            ray.t_max = random.below(2) ? random.uniform(0, 1) : 1e300;
            walked.push_back({PreparedRay(ray), kMargin});
            rays.rays[i] = node_ray(grid, walked.back());
        }
    }
    NodeMeeting meet(MeetChildren way, RaySet which) const {
        NodeMeeting meeting;
        way(rays, which, &node.texels[0].x, meeting);
        return meeting;
    }
};

void expect_same(const NodeMeeting& a, const NodeMeeting& b) {
    ASSERT_EQ(a.count, b.count);
    for (size_t child = 0; child < 4; ++child) {
        ASSERT_EQ(a.enter[child], b.enter[child]);
        ASSERT_EQ(a.place[child], b.place[child]);
        ASSERT_EQ(a.rays[child], b.rays[child]);
    }
}

TEST(NodeLanes, MeetsWhatClipMeets) {
    uint32_t met = 0;
    for (uint64_t seed = 0; seed < 20'000; ++seed) {
        SCOPED_TRACE(seed);
        Random random(seed);
        const Asked asked(random, 1);
        const std::vector<MeetChildren> ways = ways_to_meet_children();
        const NodeMeeting first = asked.meet(ways[0], 1);
        expect_as_clip(first, asked.node, asked.grid, asked.walked[0]);
        expect_place(first);
        met += first.count;
        for (const MeetChildren way : ways)
            expect_same(first, asked.meet(way, 1));
    }
    EXPECT_GT(met, 2'000u);
}

TEST(NodeLanes, RaysTogetherMeetWhatEachMeetsAlone) {
    for (uint64_t seed = 0; seed < 4'000; ++seed) {
        SCOPED_TRACE(seed);
        Random random(seed);
        const Asked asked(random, NodeRays::kMax);
        const RaySet which = 1 + RaySet(random.below((1 << NodeRays::kMax) - 1));
        for (const MeetChildren way : ways_to_meet_children()) {
            NodeMeeting expected{};
            std::ranges::fill(expected.enter, -std::numeric_limits<double>::infinity());
            for_each_ray(which, [&](uint32_t r) {
                const NodeMeeting alone = asked.meet(way, RaySet(1) << r);
                for (size_t child = 0; child < 4; ++child) {
                    if (alone.rays[child] == 0)
                        continue;
                    double& enter = expected.enter[child];
                    enter = expected.rays[child] == 0 ? alone.enter[child]
                                                      : std::min(enter, alone.enter[child]);
                    expected.rays[child] |= alone.rays[child];
                }
            });
            const NodeMeeting together = asked.meet(way, which);
            expect_place(together);
            for (size_t child = 0; child < 4; ++child) {
                ASSERT_EQ(together.enter[child], expected.enter[child]);
                ASSERT_EQ(together.rays[child], expected.rays[child]);
                ASSERT_EQ(together.rays[child] != 0,
                          size_t(together.place[child]) < together.count);
            }
        }
    }
}

} // namespace
} // namespace ovc

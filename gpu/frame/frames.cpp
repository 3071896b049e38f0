// SPDX-License-Identifier: Apache-2.0
// Estimates doubt from the error bound of the kernel's sides, over a sample of triangles.
#include "gpu/frame/frames.h"

#include "core/vec.h"
#include "shaders/layout.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace ovc {
namespace {

/// A triangle of a sample, with the part of its area that float32 leaves in doubt.
struct Patch {
    dvec3 center;
    double area;
    double doubtful; // of the area
};

/// Adds up over the patches the doubtful share of the area in each one's small neighbourhood.
/// Neighbourhoods have about as many patches each. Rays that come to one hit its triangles by their
/// area, but a large triangle far away says nothing about small ones here.
double sum_of_shares(std::span<Patch> patches) {
    constexpr size_t kNeighbours = 64;
    if (patches.size() <= kNeighbours) {
        double area = 0, doubtful = 0;
        for (const Patch& patch : patches) {
            area += patch.area;
            doubtful += patch.doubtful;
        }
        return area > 0 ? doubtful / area * double(patches.size()) : double(patches.size());
    }
    Box box;
    for (const Patch& patch : patches)
        box.add(patch.center);
    const int axis = major_axis(box.extent());
    const size_t half = patches.size() / 2;
    std::nth_element(
        patches.begin(), patches.begin() + ptrdiff_t(half), patches.end(),
        [axis](const Patch& a, const Patch& b) { return a.center[axis] < b.center[axis]; });
    return sum_of_shares(patches.first(half)) + sum_of_shares(patches.subspan(half));
}

} // namespace

double doubtful_share(const Soup& soup, std::span<const TriangleId> triangles, const Frame& frame) {
    constexpr size_t kSample = 4096;
    // The bound of a corner as far off as the frame is wide, whose neighbours are close to the ray.
    constexpr double kBound = OVC_BOUND_UNIT * (OVC_BOUND_CONSTANT + OVC_BOUND_RELATIVE);
    const size_t step = triangles.size() / kSample + 1;
    std::vector<Patch> patches;
    for (size_t i = 0; i < triangles.size(); i += step) {
        const Triangle t = soup.triangle(triangles[i]);
        const double around =
            glm::length(t[1] - t[0]) + glm::length(t[2] - t[1]) + glm::length(t[0] - t[2]);
        const double area = glm::length(glm::cross(t[1] - t[0], t[2] - t[0])) / 2;
        const double band = kBound / frame.scale * around;
        patches.push_back({t[0] / 3.0 + t[1] / 3.0 + t[2] / 3.0, area, std::min(band, area)});
    }
    return patches.empty() ? 0 : sum_of_shares(patches) / double(patches.size());
}

bool one_frame_suits(const Soup& soup, std::span<const TriangleId> triangles, const Box& bounds) {
    return doubtful_share(soup, triangles, scene_leaf(bounds).frame) <= kMaxDoubtful;
}

namespace {

/// Returns an even sample of the triangles in the leaves.
std::vector<TriangleId> sample_of(std::span<const Leaf> leaves) {
    constexpr size_t kSample = 8192;
    size_t all = 0;
    for (const Leaf& leaf : leaves)
        all += leaf.triangles.size();
    const size_t step = all / kSample + 1;
    std::vector<TriangleId> sample;
    size_t at = 0; // in the next leaf
    for (const Leaf& leaf : leaves) {
        for (; at < leaf.triangles.size(); at += step)
            sample.push_back(leaf.triangles[at]);
        at -= leaf.triangles.size();
    }
    return sample;
}

class FrameChooser {
public:
    FrameChooser(const Soup& soup, Level1& level1) : soup_(soup), level1_(level1) {}

    void choose(uint32_t node) {
        const auto [first, end] = leaves_below(node);
        const auto leaves = std::span(level1_.leaves).subspan(first, end - first);
        if (leaves.empty())
            return;
        share_frame(leaves);
        if (leaves.size() == 1 ||
            doubtful_share(soup_, sample_of(leaves), leaves.front().frame) <= kMaxDoubtfulOfPart)
            return;
        const KdNode& n = level1_.nodes[node];
        if (n.is_leaf()) {
            for (Leaf& leaf : leaves)
                share_frame(std::span(&leaf, 1));
            return;
        }
        choose(node + 1);
        choose(n.above());
    }

private:
    /// Returns the leaves below the node, [first, end), which may be none. They lie in the order of
    /// their cells.
    std::pair<uint32_t, uint32_t> leaves_below(uint32_t node) const {
        const KdNode& n = level1_.nodes[node];
        if (n.is_leaf())
            return {n.first(), n.first() + n.count()};
        const auto below = leaves_below(node + 1), above = leaves_below(n.above());
        return {below.first, std::max(below.second, above.second)};
    }

    const Soup& soup_;
    Level1& level1_;
};

} // namespace

void share_frames(const Soup& soup, Level1& level1) {
    for (uint32_t i = 0; i < level1.far_leaves; ++i)
        share_frame(std::span(&level1.leaves[i], 1));
    FrameChooser(soup, level1).choose(0);
}

} // namespace ovc

// SPDX-License-Identifier: Apache-2.0
// The error bound of the kernel's sides, over a sample of triangles.
#include "gpu/frames.h"

#include "core/vec.h"
#include "shaders/layout.h"

#include <algorithm>
#include <vector>

namespace ovc {
namespace {

/// A triangle of a sample: where it is, and how much of it float32 leaves in doubt.
struct Patch {
    dvec3 center;
    double area;
    double doubtful; // of the area
};

/// The doubtful share of the area, of small neighbourhoods with as many patches each, added up over
/// the patches. Rays that come to a neighbourhood hit its triangles by their area; but a large
/// triangle far away says nothing about small ones here.
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
    // Of a corner as far off as the frame is wide, its neighbours close to the ray.
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
    return doubtful_share(soup, triangles, scene_leaf(bounds).frame) <= kMostDoubtful;
}

} // namespace ovc

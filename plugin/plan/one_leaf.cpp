// SPDX-License-Identifier: Apache-2.0
// one_leaf_pays(): compares one tree over the sample with a tree for each cell under another one.
#include "plugin/plan/one_leaf.h"

#include "core/system/parallel.h"
#include "gpu/bvh/bvh.h"
#include "kdtree/cells.h"
#include "kdtree/clip.h"
#include "kdtree/partition.h"

#include <cassert>
#include <vector>

namespace ovc {
namespace {

/// The max cost of leaves in steps, where one leaf costs 1 (decision 16). Below it they are worth
/// the steps, because leaves are built and moved one by one. Measured: 1.00 to 1.04 on meshes, 1.06
/// on plants, 1.11 on a power plant.
constexpr double kMaxCost = 1.05;
/// The max copies of a triangle that all leaves have together, on average. Measured: 1.0 to 1.06,
/// but 1.26 among slivers.
constexpr double kMaxCopies = 1.15;

/// Returns the sum of half the areas of all inner nodes, to which the steps of a ray are in
/// proportion.
double cost_of(std::span<const BvhNode> nodes) {
    double sum = 0;
    for (const BvhNode& node : nodes)
        sum += node.is_leaf() ? 0 : double(node.box.half_area());
    return sum;
}

} // namespace

bool one_leaf_pays(const Soup& soup, std::span<const TriangleId> sample, uint32_t rate,
                   const Box& bounds, uint32_t max_leaf_triangles) {
    assert(rate > 0 && max_leaf_triangles > 0);
    const Frame frame = scene_leaf(bounds).frame;
    const auto local = [&](const Box& box) {
        return Boxf{vec3(frame.to_local(box.lo)), vec3(frame.to_local(box.hi))};
    };
    const double padding = padding_of(bounds);
    const KdTree tree = cut_sample(soup, sample, rate, bounds, padding, max_leaf_triangles);
    const std::vector<Cell> cells = cells_of(tree.nodes, bounds, padding);
    const CellFinder finder(tree.nodes, cells, padding);
    size_t copies = 0;
    double cut = 0, whole = 0;
    const auto cost_in_parts = [&] {
        std::vector<std::vector<Boxf>> parts(cells.size());
        for (const TriangleId id : sample) {
            const Triangle triangle = soup.triangle(id);
            finder.find(triangle, [&](uint32_t c) {
                const Box clipped = clipped_bounds(triangle, cells[c].padded);
                if (!clipped.empty())
                    parts[c].push_back(local(clipped));
                copies += !clipped.empty();
            });
        }
        std::vector<Boxf> roots;
        for (const std::vector<Boxf>& part : parts)
            if (const std::vector<BvhNode> nodes = build_bvh(part); !nodes.empty()) {
                cut += cost_of(nodes);
                roots.push_back(nodes[0].box);
            }
        cut += cost_of(build_bvh(roots));
    };
    const auto cost_in_one = [&] {
        std::vector<Boxf> boxes;
        for (const TriangleId id : sample)
            boxes.push_back(local(bounds_of(soup.triangle(id))));
        whole = cost_of(build_bvh(boxes));
    };
    parallel_invoke(cost_in_parts, cost_in_one);
    return double(copies) > kMaxCopies * double(sample.size()) || cut > kMaxCost * whole;
}

} // namespace ovc

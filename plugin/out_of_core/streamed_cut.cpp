// SPDX-License-Identifier: Apache-2.0
// The planes of level 1 come of a sample, and leaves are as small as both budgets ask.
#include "plugin/out_of_core/streamed_cut.h"

#include "core/system/parallel.h"
#include "core/text/format_text.h"
#include "kdtree/cells.h"
#include "kdtree/partition.h"
#include "kdtree/sample.h"

#include <algorithm>

namespace ovc {

/// The bytes that pages of meshes have. Leaves whose pages turn out too large are cut again.
static constexpr double kBytesPerTriangle = 52;

uint64_t triangles_of(std::span<const SourceMesh> meshes) {
    uint64_t count = 0;
    for (const SourceMesh& mesh : meshes)
        count += mesh.triangles;
    return count;
}

Soup read_soup(TriangleSource& source) {
    Soup soup;
    for (uint32_t m = 0; m < source.meshes().size(); ++m) {
        const SourceMesh& mesh = source.meshes()[m];
        const auto corners_of = [&](auto corner) {
            std::vector<decltype(corner)> corners(mesh.triangles * 3);
            if (!corners.empty())
                source.read(m, 0, std::as_writable_bytes(std::span(corners)));
            return corners;
        };
        soup.chunks.push_back(mesh.has_doubles
                                  ? Chunk::owning_doubles(mesh.origin, corners_of(dvec3()))
                                  : Chunk::owning(mesh.origin, corners_of(vec3())));
    }
    return soup;
}

/// Returns the bytes of what is kept of each mesh. Any budget has room for a few.
static uint64_t bytes_of_tables(std::span<const SourceMesh> meshes) {
    constexpr uint64_t kFew = 256;
    return (std::max<uint64_t>(meshes.size(), kFew) - kFew) * kBytesOfMesh;
}

HostBudget host_budget(uint64_t bytes, std::span<const SourceMesh> meshes) {
    return {bytes - std::min(bytes, bytes_of_tables(meshes)),
            std::max<size_t>(thread_count(), kMinThreads),
            std::ranges::any_of(meshes, &SourceMesh::has_doubles)};
}

uint64_t smallest_host_bytes(std::span<const SourceMesh> meshes) {
    const uint64_t triangles = triangles_of(meshes);
    const size_t threads = host_budget(0, meshes).threads;
    return bytes_of_tables(meshes) +
           std::min(triangles * kBytesInMemory, smallest_host_budget(triangles, threads));
}

Error too_small(uint64_t bytes, std::span<const SourceMesh> meshes) {
    return over_budget(format_text("{} bytes of host memory are too few for {} triangles on {} "
                                   "threads: the smallest number that works is {}",
                                   bytes, triangles_of(meshes), thread_count(),
                                   smallest_host_bytes(meshes)));
}

StreamedLimits streamed_limits(const TwoLevelOptions& options, const MemoryPlan& plan,
                               const HostBudget& budget, uint64_t triangles) {
    const LeafLimits limits = limits_of(options, plan, triangles, triangles);
    const uint64_t wanted =
        limits.pages_matter() ? limits.triangles_at(kBytesPerTriangle) : limits.triangles;
    return {limits, uint32_t(std::clamp<uint64_t>(std::min(wanted, budget.leaf_triangles()), 1,
                                                  kNone - 1))};
}

uint32_t streamed_sample_rate(const HostBudget& budget, uint64_t triangles,
                              uint32_t max_triangles) {
    return std::max(sample_rate(triangles, max_triangles), budget.sample_rate(triangles));
}

std::vector<KdNode> streamed_planes(const Soup& sample, std::span<const TriangleId> drawn,
                                    uint32_t rate, uint64_t triangles, const Box& bounds,
                                    uint32_t max_triangles, BuildProgress* progress) {
    if (triangles <= max_triangles)
        return {KdNode::leaf(0, 0)};
    return cut_sample(sample, drawn, rate, bounds, padding_of(bounds), max_triangles, progress)
        .nodes;
}

} // namespace ovc

// SPDX-License-Identifier: Apache-2.0
// The CPU KD-tree as a backend: the baseline, and the reference that certified hits must equal.
#include "core/system/stopwatch.h"
#include "core/text/dropped.h"
#include "host/backend/backend.h"
#include "kdtree/build.h"
#include "kdtree/traverse.h"

#include <cassert>

namespace ovc {

class CpuBackend : public Backend {
public:
    CpuBackend(const Soup& soup, const KdTree& tree, double build_seconds)
        : soup_(soup), tree_(tree) {
        statistics_.struct_size = sizeof(statistics_);
        statistics_.triangles = soup.triangle_count();
        statistics_.seconds_level1 = build_seconds;
    }

    Result<Done> intersect(std::span<const Ray> rays, const Exclusions& without,
                           std::span<Hit> hits) override {
        assert(hits.size() == rays.size() && without.are_for(rays.size()));
        const Stopwatch watch;
        ovc::intersect(tree_, soup_, rays, without, hits);
        statistics_.nearest_rays += rays.size();
        statistics_.seconds_trace += watch.seconds();
        return Done{};
    }

    Result<Done> occluded(std::span<const Ray> rays, const Exclusions& without,
                          std::span<uint8_t> occluded) override {
        assert(occluded.size() == rays.size() && without.are_for(rays.size()));
        const Stopwatch watch;
        ovc::occluded(tree_, soup_, rays, without, occluded);
        statistics_.occlusion_rays += rays.size();
        statistics_.seconds_trace += watch.seconds();
        return Done{};
    }

    ovc_statistics statistics() const override { return statistics_; }
    std::string renderer() const override { return "CPU KD-tree in double precision"; }

protected:
    ovc_statistics statistics_{};

private:
    const Soup& soup_;
    const KdTree& tree_;
};

/// Has the tree as well. It is a base that comes first, so that it is there before the backend.
struct OwnedTree {
    KdTree tree;
};
class CpuBackendWithTree final : OwnedTree, public CpuBackend {
public:
    CpuBackendWithTree(const Soup& soup, KdTree built, double build_seconds, const Dropped& dropped)
        : OwnedTree{std::move(built)}, CpuBackend(soup, tree, build_seconds) {
        statistics_.dropped_not_finite = dropped.not_finite;
        statistics_.dropped_degenerate = dropped.degenerate;
    }
};

std::unique_ptr<Backend> make_cpu_backend(const Soup& soup, const KdTree& tree,
                                          double build_seconds) {
    return std::make_unique<CpuBackend>(soup, tree, build_seconds);
}

std::unique_ptr<Backend> make_cpu_backend(const Soup& soup, const LogSink& log) {
    const Stopwatch watch;
    Dropped dropped;
    Box bounds;
    const std::vector<TriangleId> triangles = hittable_triangles(soup, &dropped, &bounds);
    KdTree tree = build_kd_tree(soup, triangles, bounds, {});
    warn_of_dropped(dropped, log);
    return std::make_unique<CpuBackendWithTree>(soup, std::move(tree), watch.seconds(), dropped);
}

} // namespace ovc

// SPDX-License-Identifier: Apache-2.0
// Comparison: a system that two-level is compared with. It has the same interface and the same
// answers: the kernel proves what it can, and doubles decide the rest.
#pragma once

#include "plugin/build/built_scene.h"
#include "plugin/resolve/query.h"
#include "plugin/structure/structure.h"
#include "plugin/thesis/runner.h"

#include <memory>

namespace ovc::thesis {

class Comparison final : public Structure {
public:
    static Result<std::unique_ptr<Structure>> build(const Soup& soup, GlThread& gl,
                                                    const RunnerOptions& options,
                                                    const LogSink& log,
                                                    BuildProgress* progress = nullptr);
    ~Comparison() override;

    Result<Done> intersect(RaySpan rays, const Exclusions& without, std::span<Hit> hits) override;
    Result<Done> occluded(RaySpan rays, const Exclusions& without,
                          std::span<uint8_t> occluded) override;
    ovc_statistics report() const override { return statistics_; }

private:
    Comparison(const Soup& soup, GlThread& gl, const RunnerOptions& options)
        : scene_(soup), gl_(gl), options_(options) {}

    const Leaf& whole() const { return scene_.level1.leaves.front(); }
    Result<Done> build_system(const Hittable& hittable, BuildProgress* progress);

    template <class Query>
    class Batch;
    template <class Query>
    Result<Done> trace(const Query& query);

    BuiltScene scene_; // one leaf; its page is built when a ray needs the exact fallback
    GlThread& gl_;
    RunnerOptions options_;
    uint32_t batch_rays_ = 0;
    std::unique_ptr<Runner> runner_; // made and destroyed on the thread of gl_; none: no triangles
    ovc_statistics statistics_{sizeof(ovc_statistics)};
};

} // namespace ovc::thesis

// SPDX-License-Identifier: Apache-2.0
// Two-level as the thesis has it: level 1 is walked on the CPU, every leaf has a queue of rays, and
// a pass traces one queue. Based on: thesis, sections 3.3 to 3.5 (algorithms 2, 3, 4 and 6).
#pragma once

#include "plugin/structure/structure.h"
#include "plugin/thesis/queued/queued_scene.h"

#include <memory>

namespace ovc::thesis {

class QueuedTwoLevel final : public Structure {
public:
    explicit QueuedTwoLevel(std::unique_ptr<QueuedScene> scene) : scene_(std::move(scene)) {}

    Result<Done> intersect(RaySpan rays, const Exclusions& without, std::span<Hit> hits) override;
    Result<Done> occluded(RaySpan rays, const Exclusions& without,
                          std::span<uint8_t> occluded) override;
    Result<Done> stream(StreamHost& host) override;
    ovc_statistics report() const override { return scene_->statistics; }

private:
    template <class Query>
    Result<Done> trace(const Query& query);

    std::unique_ptr<QueuedScene> scene_;
};

} // namespace ovc::thesis

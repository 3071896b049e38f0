// SPDX-License-Identifier: Apache-2.0
// RankedScene: a scene whose pages are shared out between ranks. Any rank may call at any time,
// with rays of its own or none.
#pragma once

#include "plugin/ranks/routed_call.h"
#include "plugin/ranks/transport/transport.h"
#include "plugin/ranks/visit_server.h"
#include "plugin/structure/structure.h"

#include <memory>
#include <vector>

namespace ovc {

/// The parts of a scene on one rank.
struct RankedParts {
    std::unique_ptr<Transport> transport; // of this scene alone
    std::unique_ptr<Structure> local;     // has the pages of this rank
    std::unique_ptr<StopFinder> finder;
    LoopThreads* threads = nullptr; // that loops run on
};

class RankedScene final : public Structure {
public:
    /// All ranks make one of the same scene. The soup outlives it, and has the corners of all
    /// triangles.
    RankedScene(const Soup& soup, RankedParts parts);
    /// Waits until all ranks do the same: their rays may visit this one until then.
    ~RankedScene() override;

    Result<Done> intersect(RaySpan rays, const Exclusions& without, std::span<Hit> hits) override;
    Result<Done> occluded(RaySpan rays, const Exclusions& without,
                          std::span<uint8_t> occluded) override;
    Result<Done> stream(StreamHost& host) override;
    bool takes_after() const override { return true; }
    Result<Done> all_hits(RaySpan rays, const Exclusions& without, const AllHits& all) override;
    void first_ranks(RaySpan rays, std::span<uint32_t> ranks) const override;
    Result<Done> purge() override;
    void leave_soup() override { server_.leave_soup(); }
    ovc_statistics report() const override;

private:
    Result<Done> run(const RoutedRays& rays);
    Result<Done> wait_for_call();
    Result<Done> route(RaySpan rays, const Exclusions& without, std::span<Hit> hits,
                       std::span<uint8_t> occluded);
    Result<Done> nearest(RaySpan rays, const Exclusions& without, std::span<Hit> hits);

    const RankedParts parts_;
    mutable VisitServer server_;
    const Routing routing_;
    ovc_statistics counted_{sizeof(ovc_statistics)}; // of calls on this rank
    RoutedCounts routed_;
    RoutedCall call_; // of batches, one after the other
};

} // namespace ovc

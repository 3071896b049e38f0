// SPDX-License-Identifier: Apache-2.0
// RoutedStream: a host's stream of rays over ranks. Several routed calls of its rays are under way
// at once, so that this rank has something to trace and to shade while other ranks answer.
#pragma once

#include "core/sieve.h"
#include "core/stream/backlog.h"
#include "core/stream/stream.h"
#include "plugin/ranks/routed_call.h"

#include <memory>
#include <optional>
#include <vector>

namespace ovc {

/// Asks filters about the hits of these rays. Returns those whose hits are dropped; nothing where a
/// filter stops the call.
std::optional<std::vector<uint32_t>> dropped_hits(std::span<const uint32_t> rays,
                                                  const Sieves& sieves, std::span<const Hit> hits);

class RoutedStream final : public RayStream {
public:
    RoutedStream(const Routing& ranks, RoutedCounts& counts, StreamHost& host);
    ~RoutedStream();

    /// Traces what the host pushes until there is no more. Error: a rank is lost or cannot trace,
    /// or the host or a filter stops the stream, which is of the kind Cancelled.
    Result<Done> run();
    void push(const StreamRays& rays) override;

    uint64_t nearest_rays() const { return nearest_rays_; }
    uint64_t occlusion_rays() const { return occlusion_rays_; }
    /// Returns how long the host has worked.
    double seconds_host() const { return seconds_host_; }

private:
    struct Batch;

    Result<Done> begin_batches();
    void begin(Batch& batch, Backlog& backlog, bool any_hit);
    Result<Done> deliver(Batch& batch);
    Result<Done> send_dropped_on(Batch& batch);
    template <class Call>
    bool on_host(Call&& call);
    std::vector<RoutedCall*> under_way() const;

    const Routing& ranks_;
    RoutedCounts& counts_;
    StreamHost& host_;
    const size_t max_rays_; // of a batch
    std::vector<std::unique_ptr<Batch>> batches_;
    Backlog nearest_, any_;
    bool has_more_ = true; // the host
    uint64_t nearest_rays_ = 0, occlusion_rays_ = 0;
    double seconds_host_ = 0;
};

} // namespace ovc

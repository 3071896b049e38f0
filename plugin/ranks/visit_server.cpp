// SPDX-License-Identifier: Apache-2.0
// Joins the visits that wait to batches, traces these, and cuts the answers up again.
#include "plugin/ranks/visit_server.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <exception>
#include <optional>

namespace ovc {

/// A batch has so many rays at most, unless one message has more.
static constexpr size_t kMaxBatch = size_t(1) << 17;

/// The visits of several messages as a call takes them.
struct VisitServer::Batch {
    std::vector<Ray> rays;
    std::vector<TriangleId> skip;
    std::vector<Hit> after;
    std::vector<uint32_t> masks;
    std::vector<Hit> hits;
    std::vector<uint8_t> occluded;

    /// Takes the visits of these messages. The arrays keep their memory from batch to batch.
    void fill(Messages messages) {
        rays.clear();
        skip.clear();
        after.clear();
        masks.clear();
        bool has_after = false, has_masks = false;
        for (const Received* received : messages)
            for (const RankVisit& visit : received->message.items<RankVisit>()) {
                rays.push_back(visit.ray);
                skip.push_back(visit.skip);
                after.push_back({visit.after_t, 0, 0, visit.after});
                masks.push_back(visit.mask);
                has_after = has_after || !HitPlace(after.back()).is_before_all();
                has_masks = has_masks || visit.mask != 0;
            }
        if (!has_after)
            after.clear();
        if (!has_masks)
            masks.clear();
    }

    Exclusions without() const {
        Exclusions all(skip, after);
        all.sieves.masks = masks;
        return all;
    }
};

VisitServer::VisitServer(Structure& local, Transport& transport, LoopThreads* threads)
    : local_(local), transport_(transport), threads_(threads), batch_(std::make_unique<Batch>()) {
    thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

VisitServer::~VisitServer() {
    thread_.request_stop();
    transport_.visits.wake();
}

void VisitServer::run(const std::stop_token& stop) {
    std::optional<LoopThreads::Scope> scope;
    if (threads_)
        scope.emplace(*threads_);
    while (!stop.stop_requested()) {
        std::vector<Received> all = transport_.visits.take(std::chrono::milliseconds(50));
        // Others have waited for their rays to come here already.
        std::ranges::stable_partition(
            all, [&](const Received& received) { return received.from != transport_.rank(); });
        is_idle_ = all.empty();
        // Rays that ask for any hit have no children, so nothing waits for the others' sake.
        for (const MessageKind kind : {MessageKind::NearestVisits, MessageKind::AnyVisits})
            serve(all, kind);
        is_idle_ = true;
    }
}

void VisitServer::serve(std::span<const Received> all, MessageKind kind) {
    std::vector<const Received*> some;
    const auto trace = [&] {
        if (some.empty())
            return;
        const std::lock_guard lock(local_mutex_);
        try {
            batch_->fill(some);
            (kind == MessageKind::AnyVisits) ? trace_any(some) : trace_nearest(some);
        } catch (const std::exception& error) {
            fail(some, Error{error.what()});
        }
        some.clear();
    };
    size_t rays = 0;
    for (const Received& received : all) {
        if (received.message.kind() != kind)
            continue;
        const size_t more = received.message.items<RankVisit>().size();
        if (rays + more > kMaxBatch)
            trace(), rays = 0;
        some.push_back(&received);
        rays += more;
        served_ += received.from == transport_.rank() ? 0 : more;
    }
    trace();
}

void VisitServer::trace_nearest(Messages messages) {
    std::vector<Hit>& hits = batch_->hits;
    hits.resize(batch_->rays.size());
    if (const Result<Done> done = local_.intersect(batch_->rays, batch_->without(), hits); !done)
        return fail(messages, done.error());
    size_t next = 0;
    for (const Received* received : messages) {
        std::vector<HitThere> answers;
        for (const RankVisit& visit : received->message.items<RankVisit>())
            answers.push_back({hits[next++], visit.slot});
        transport_.send(received->from, Message(MessageKind::Hits, received->message.call(),
                                                std::span<const HitThere>(answers)));
    }
}

void VisitServer::trace_any(Messages messages) {
    std::vector<uint8_t>& occluded = batch_->occluded;
    occluded.resize(batch_->rays.size());
    if (const Result<Done> done = local_.occluded(batch_->rays, batch_->without(), occluded); !done)
        return fail(messages, done.error());
    size_t next = 0;
    for (const Received* received : messages) {
        std::vector<OcclusionThere> answers;
        for (const RankVisit& visit : received->message.items<RankVisit>())
            answers.push_back({visit.slot, occluded[next++]});
        transport_.send(received->from, Message(MessageKind::Occlusions, received->message.call(),
                                                std::span<const OcclusionThere>(answers)));
    }
}

void VisitServer::fail(Messages messages, const Error& error) {
    const std::string told = text_of_error(error);
    for (const Received* received : messages)
        transport_.send(received->from, Message(MessageKind::Failure, received->message.call(),
                                                std::span<const char>(told)));
}

} // namespace ovc

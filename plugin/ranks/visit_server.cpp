// SPDX-License-Identifier: Apache-2.0
// Joins the visits that wait to batches, traces these, and cuts the answers up again.
#include "plugin/ranks/visit_server.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <exception>
#include <optional>

namespace ovc {

/// A batch has so many rays at most, unless one parcel has more.
static constexpr size_t kMaxBatch = size_t(1) << 17;

/// The visits of several parcels as a call takes them.
struct VisitServer::Batch {
    std::vector<Ray> rays;
    std::vector<TriangleId> skip;
    std::vector<Hit> after;
    std::vector<uint32_t> masks;
    std::vector<Hit> hits;
    std::vector<uint8_t> occluded;

    /// Takes the visits of these letters. The arrays keep their memory from batch to batch.
    void fill(Letters letters) {
        rays.clear();
        skip.clear();
        after.clear();
        masks.clear();
        bool has_after = false, has_masks = false;
        for (const Inbox::Letter* letter : letters)
            for (const RankVisit& visit : letter->parcel.items<RankVisit>()) {
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

VisitServer::VisitServer(Structure& local, Post& post, LoopThreads* threads)
    : local_(local), post_(post), threads_(threads), batch_(std::make_unique<Batch>()) {
    thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

VisitServer::~VisitServer() {
    thread_.request_stop();
    post_.visits.wake();
}

void VisitServer::run(const std::stop_token& stop) {
    std::optional<LoopThreads::Scope> scope;
    if (threads_)
        scope.emplace(*threads_);
    while (!stop.stop_requested()) {
        std::vector<Inbox::Letter> letters = post_.visits.take(std::chrono::milliseconds(50));
        // Others have waited for their rays to come here already.
        std::ranges::stable_partition(
            letters, [&](const Inbox::Letter& letter) { return letter.from != post_.rank(); });
        is_idle_ = letters.empty();
        // Rays that ask for any hit have no children, so nothing waits for the others' sake.
        for (const ParcelKind kind : {ParcelKind::NearestVisits, ParcelKind::AnyVisits})
            serve(letters, kind);
        is_idle_ = true;
    }
}

void VisitServer::serve(std::span<const Inbox::Letter> letters, ParcelKind kind) {
    std::vector<const Inbox::Letter*> some;
    const auto trace = [&] {
        if (some.empty())
            return;
        const std::lock_guard lock(local_mutex_);
        try {
            batch_->fill(some);
            (kind == ParcelKind::AnyVisits) ? trace_any(some) : trace_nearest(some);
        } catch (const std::exception& error) {
            fail(some, Error{error.what()});
        }
        some.clear();
    };
    size_t rays = 0;
    for (const Inbox::Letter& letter : letters) {
        if (letter.parcel.kind() != kind)
            continue;
        const size_t more = letter.parcel.items<RankVisit>().size();
        if (rays + more > kMaxBatch)
            trace(), rays = 0;
        some.push_back(&letter);
        rays += more;
        served_ += letter.from == post_.rank() ? 0 : more;
    }
    trace();
}

void VisitServer::trace_nearest(Letters letters) {
    std::vector<Hit>& hits = batch_->hits;
    hits.resize(batch_->rays.size());
    if (const Result<Done> done = local_.intersect(batch_->rays, batch_->without(), hits); !done)
        return fail(letters, done.error());
    size_t next = 0;
    for (const Inbox::Letter* letter : letters) {
        std::vector<HitThere> answers;
        for (const RankVisit& visit : letter->parcel.items<RankVisit>())
            answers.push_back({hits[next++], visit.slot});
        post_.send(letter->from, Parcel(ParcelKind::Hits, letter->parcel.call(),
                                        std::span<const HitThere>(answers)));
    }
}

void VisitServer::trace_any(Letters letters) {
    std::vector<uint8_t>& occluded = batch_->occluded;
    occluded.resize(batch_->rays.size());
    if (const Result<Done> done = local_.occluded(batch_->rays, batch_->without(), occluded); !done)
        return fail(letters, done.error());
    size_t next = 0;
    for (const Inbox::Letter* letter : letters) {
        std::vector<OcclusionThere> answers;
        for (const RankVisit& visit : letter->parcel.items<RankVisit>())
            answers.push_back({visit.slot, occluded[next++]});
        post_.send(letter->from, Parcel(ParcelKind::Occlusions, letter->parcel.call(),
                                        std::span<const OcclusionThere>(answers)));
    }
}

void VisitServer::fail(Letters letters, const Error& error) {
    const std::string told = text_of_error(error);
    for (const Inbox::Letter* letter : letters)
        post_.send(letter->from,
                   Parcel(ParcelKind::Failure, letter->parcel.call(), std::span<const char>(told)));
}

} // namespace ovc

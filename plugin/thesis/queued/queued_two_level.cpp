// SPDX-License-Identifier: Apache-2.0
// The loops of the thesis: algorithm 3 for a batch, algorithm 6 for a stream.
#include "plugin/thesis/queued/queued_two_level.h"

#include "core/stream/backlog.h"
#include "core/system/stopwatch.h"
#include "plugin/resolve/query.h"
#include "plugin/thesis/queued/queued_rays.h"

#include <algorithm>
#include <numeric>

namespace ovc::thesis {
namespace {

/// Algorithm 3: traces all queues of leaves, then walks level 1 again.
Result<Done> trace_in_rounds(QueuedRays& states) {
    while (true) {
        states.walk_level1();
        if (!states.waiting())
            return Done{};
        while (states.waiting())
            if (Result<Done> done = states.trace_next_leaf(); !done)
                return done;
    }
}

/// Algorithm 6: walks level 1 after every leaf, for the rays that come from it and those that the
/// host spawned meanwhile.
class MixedStream final : public RayStream {
public:
    MixedStream(QueuedScene& scene, StreamHost& host)
        : statistics_(scene.statistics), host_(host), rays_(scene) {}

    void push(const StreamRays& rays) override { (rays.any_hit ? any_ : nearest_).push(rays); }

    Result<Done> run() {
        while (true) {
            do {
                if (!fill())
                    return stopped_by_host();
                start();
                if (!deliver())
                    return stopped_by_host();
            } while (may_start());
            if (!rays_.waiting())
                return Done{};
            const Stopwatch watch;
            Result<Done> done = rays_.trace_next_leaf();
            statistics_.seconds_trace += watch.seconds();
            if (!done)
                return done;
        }
    }

private:
    size_t backlog() const { return nearest_.size() + any_.size(); }

    /// Asks the host for more rays when at most half of kMax are under way or in the backlog.
    /// Returns false where the host stops the stream.
    bool fill() {
        const size_t busy = rays_.under_way() + backlog();
        if (!more_ || busy > QueuedRays::kMax / 2)
            return true;
        const size_t before = backlog();
        if (!host_.more(*this, QueuedRays::kMax - busy))
            return false;
        more_ = backlog() > before;
        return true;
    }

    /// Returns whether there are more rays to send through level 1 before a leaf is chosen.
    bool may_start() const {
        return (backlog() > 0 && rays_.under_way() < QueuedRays::kMax) ||
               (more_ && !rays_.waiting());
    }

    /// Sends rays of the backlog, and all that have left their leaves, through level 1.
    void start() {
        const Stopwatch watch;
        start(any_, /* any_hit= */ true);
        start(nearest_, /* any_hit= */ false);
        rays_.walk_level1();
        statistics_.seconds_trace += watch.seconds();
    }

    void start(Backlog& backlog, bool any_hit) {
        const size_t count = std::min(backlog.size(), QueuedRays::kMax - rays_.under_way());
        const StreamRays rays = backlog.last(count);
        rays_.add(any_hit, rays.rays, rays.skip, rays.tokens);
        backlog.drop_last(count);
    }

    bool deliver() {
        Answers answers;
        rays_.take_answered([&](const QueuedRay& state) {
            if (state.any_hit) {
                answers.shadow_tokens.push_back(state.token);
                answers.occluded.push_back(state.hit.is_hit());
            } else {
                answers.hit_tokens.push_back(state.token);
                answers.hits.push_back(state.hit);
            }
        });
        return (answers.occluded.empty() ||
                host_.occlusions(*this, answers.shadow_tokens, answers.occluded)) &&
               (answers.hits.empty() || host_.hits(*this, answers.hit_tokens, answers.hits));
    }

    struct Answers {
        std::vector<uint64_t> shadow_tokens;
        std::vector<uint8_t> occluded;
        std::vector<uint64_t> hit_tokens;
        std::vector<Hit> hits;
    };

    ovc_statistics& statistics_;
    StreamHost& host_;
    QueuedRays rays_;
    Backlog nearest_;
    Backlog any_;
    bool more_ = true;
};

} // namespace

template <class Query>
Result<Done> QueuedTwoLevel::trace(const Query& query) {
    const Stopwatch watch;
    std::vector<uint64_t> tokens(query.rays.size());
    std::iota(tokens.begin(), tokens.end(), uint64_t(0));
    QueuedRays states(*scene_);
    for (size_t first = 0; first < query.rays.size(); first += QueuedRays::kMax) {
        const size_t count = std::min(QueuedRays::kMax, query.rays.size() - first);
        const Query part = query.part(first, count);
        states.add(Query::kAnyHit, part.rays, part.without,
                   std::span(tokens).subspan(first, count));
        if (Result<Done> done = trace_in_rounds(states); !done)
            return done;
        states.take_answered([&](const QueuedRay& state) { query.set(state.token, state.hit); });
    }
    scene_->statistics.seconds_trace += watch.seconds();
    return Done{};
}

Result<Done> QueuedTwoLevel::intersect(RaySpan rays, const Exclusions& without,
                                       std::span<Hit> hits) {
    return trace(NearestQuery{rays, without, hits});
}

Result<Done> QueuedTwoLevel::occluded(RaySpan rays, const Exclusions& without,
                                      std::span<uint8_t> occluded) {
    return trace(OcclusionQuery{rays, without, occluded});
}

Result<Done> QueuedTwoLevel::stream(StreamHost& host) {
    return MixedStream(*scene_, host).run();
}

} // namespace ovc::thesis

// SPDX-License-Identifier: Apache-2.0
// QueuedRays: the rays under way between level 1 on the CPU and the queues of its leaves, and the
// steps that algorithms 3, 4 and 6 of the thesis are made of.
#pragma once

#include "core/exact/triangle.h"
#include "core/ray_span.h"
#include "core/result.h"
#include "plugin/thesis/queued/queued_scene.h"
#include "plugin/thesis/queued/queues.h"

#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

namespace ovc::thesis {

/// A ray under way, as the host gave it, and how far it has come.
struct QueuedRay {
    Ray ray;
    TriangleId skip;
    uint64_t token = 0;
    bool any_hit = false;
    /// InLastCell: the ray's hit lies in this cell, so only leaves of it may hold a nearer one.
    enum : uint8_t { New, Walking, InLastCell, Answered } step = New;
    uint32_t leaf = kNone; // whose queue it is in
    RayPlace place;
    double t_end = 0; // nothing beyond is of interest
    Hit hit;          // the nearest so far
};

class QueuedRays {
public:
    explicit QueuedRays(QueuedScene& scene)
        : s_(scene), queues_(scene.built.level1.leaves.size()) {}
    ~QueuedRays();
    QueuedRays(const QueuedRays&) = delete;

    /// Puts rays into the queue of level 1; with those under way they may be at most kMax. Of
    /// `without` only skipped triangles count.
    void add(bool any_hit, const RaySpan& rays, const Exclusions& without,
             std::span<const uint64_t> tokens);
    size_t under_way() const { return states_.size() - free_.size(); }
    static constexpr size_t kMax = size_t(1) << 20; // some 200 bytes each

    /// Sends every ray in the queue of level 1 to the queue of its next leaf (algorithm 4), or to
    /// the answered rays where there is none.
    void walk_level1();

    /// Returns whether rays wait for any leaf.
    bool waiting() const { return !queues_.empty(); }

    /// Chooses a leaf and traces its queue, a pass for each batch; the rays then stand in the queue
    /// of level 1. waiting() must hold. Error: that of the pass.
    Result<Done> trace_next_leaf();

    /// Hands each ray that was answered since the last call to hand_over(state), and forgets it.
    template <class HandOver>
    void take_answered(HandOver&& hand_over) {
        for (const uint32_t i : answered_)
            hand_over(states_[i]);
        free_.insert(free_.end(), answered_.begin(), answered_.end());
        answered_.clear();
    }

private:
    uint32_t slot();
    void begin(QueuedRay& state);
    void find_leaf(QueuedRay& state);
    Result<Done> pass(uint32_t leaf, std::span<const uint32_t> batch);
    void load(uint32_t leaf, std::span<const uint32_t> batch);
    void resolve(QueuedRay& state, const FrameAnswer& answer, bool decidable);
    bool resolve_candidates(QueuedRay& state, const FrameAnswer& answer);
    void enter_fast(QueuedRay& state, const FrameAnswer& answer);
    void end_at(QueuedRay& state, const PreparedRay& p, double end, double slack);
    void fall_back(QueuedRay& state);

    QueuedScene& s_;
    Queues queues_; // of leaves; they hold indices of states_, as all below
    std::vector<QueuedRay> states_;
    std::vector<uint32_t> free_;
    std::vector<uint32_t> level1_queue_;
    std::vector<uint32_t> answered_;
    std::vector<FrameRay> rays_; // of a batch, whole rows, as the answers
    std::vector<FrameAnswer> answers_;
    std::vector<uint8_t> decidable_;
    std::atomic<uint64_t> invalid_{0};
    std::atomic<uint64_t> flagged_{0};
    std::atomic<uint64_t> retraced_{0};
    std::atomic<uint64_t> capped_{0};
};

} // namespace ovc::thesis

// SPDX-License-Identifier: Apache-2.0
// Candidates: the triangles that a kernel found for a ray in certified precision, and the rule by
// which exact arithmetic decides among them. Two-level and the systems of plugin/thesis share the
// rule.
#pragma once

#include "core/lanes/doubt_batch.h"
#include "plugin/build/built_scene.h"

#include <array>
#include <cassert>
#include <cstddef>
#include <span>

namespace ovc {

/// Triangles by their numbers in the scene.
struct Candidates {
    uint32_t certain;                  // the ray hits this one for certain; or OVC_MISS
    std::span<const uint32_t> further; // it may hit these as well; OVC_NO_TRIANGLE stands last

    bool has_further() const { return further[0] != OVC_NO_TRIANGLE; }
    bool is_miss() const { return certain == OVC_MISS && !has_further(); }
    /// The kernel is certain that something is hit; nothing is left to decide for an occlusion ray.
    bool is_certain_hit() const { return certain != OVC_MISS && !has_further(); }

    /// Offers all of them to `nearest`, which is of the ray p. Returns false where exact arithmetic
    /// does not confirm the certain hit, or that is not behind p.after: then farther hits may have
    /// been left out, and the ray goes to the exact fallback.
    bool offer_to(Nearest& nearest, const PreparedRay& p, const BuiltScene& scene) const {
        if (certain != OVC_MISS && !scene.offer(nearest, p, scene.numbers.id(certain)))
            return false;
        for (const uint32_t number : further)
            if (number != OVC_NO_TRIANGLE)
                scene.offer(nearest, p, scene.numbers.id(number));
        return true;
    }
};

/// Collects the candidates of several rays, to test them at once in doubled precision. Most lie at
/// a side or corner that the ray passes by a rounding, which that precision tells. Tag: whatever
/// the caller wants back with each ray.
template <class Tag>
class CandidateBatch {
public:
    bool has_room() const { return count_ < asked_.size(); }

    /// Adds a ray, which does not see the triangle `skip`, and its candidates. Needs room.
    void add(const RaySpan& rays, size_t i, TriangleId skip, const Candidates& found,
             const BuiltScene& scene, const Tag& tag) {
        assert(has_room());
        const auto add = [&](uint32_t number, bool certain) {
            if (pairs_.room() == 0)
                test();
            const TriangleId id = scene.seen(number, skip);
            pairs_.add(rays, i, scene.soup, id, {count_, certain});
        };
        asked_[count_] = {tag, {}, false};
        if (found.certain != OVC_MISS)
            add(found.certain, true);
        for (const uint32_t number : found.further)
            if (number != OVC_NO_TRIANGLE)
                add(number, false);
        ++count_;
    }

    /// Empties the batch. Calls decided(nearest, tag) for each ray with the nearest hit of its
    /// candidates, or none; or unclear(tag) where doubled precision cannot tell it, or does not
    /// confirm the certain hit.
    template <class Decided, class Unclear>
    void finish(Decided&& decided, Unclear&& unclear) {
        test();
        for (size_t i = 0; i < count_; ++i)
            if (asked_[i].is_unclear)
                unclear(asked_[i].tag);
            else
                decided(asked_[i].nearest, asked_[i].tag);
        count_ = 0;
    }

private:
    struct Asked {
        Tag tag;
        Candidate nearest;
        bool is_unclear;

        void take(const RefinedAnswer& answer, bool certain) {
            is_unclear = is_unclear || !answer.known || (certain && !answer.candidate);
            if (is_unclear || !answer.candidate || answer.candidate->hit.id == nearest.hit.id)
                return;
            const int order = nearest.hit.is_hit() ? answer.candidate->compare_t(nearest) : -1;
            is_unclear = order == 0;
            if (order < 0)
                nearest = *answer.candidate;
        }
    };
    struct Pair {
        size_t asked;
        bool certain;
    };

    void test() {
        pairs_.finish([&](const RefinedAnswer& answer, const Triangle&, TriangleId, Pair pair) {
            asked_[pair.asked].take(answer, pair.certain);
        });
    }

    DoubtBatch<Pair> pairs_;
    std::array<Asked, 16> asked_{};
    size_t count_ = 0;
};

} // namespace ovc

// SPDX-License-Identifier: Apache-2.0
// Resolver: tells which rays the kernel is asked about, and resolves its answers by exact
// arithmetic.
#pragma once

#include "core/lanes/far_triangle.h"
#include "core/lanes/hit_batch.h"
#include "core/lanes/rounding_batch.h"
#include "core/system/parallel.h"
#include "gpu/trace/tracer.h"
#include "plugin/fallback/exact_fallback.h"
#include "plugin/resolve/candidates.h"
#include "plugin/resolve/gathered_hits.h"
#include "plugin/resolve/query.h"
#include "plugin/resolve/tracing.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

namespace ovc {

inline constexpr Hit kSomeHit{0, 0, 0, {0, 0}}; // of an occlusion ray, whose triangle is not kept
inline constexpr size_t kRaysPerTask = 256;     // in parallel loops over rays that are traced

/// Whether an answer tells which triangles the ray may hit.
inline bool names_candidates(const Answer& answer) {
    return answer.prim != OVC_FLAGGED && answer.prim != OVC_CAPPED;
}

/// Returns the candidates of an answer that names them.
inline Candidates candidates_of(const Answer& answer) {
    const uint32_t certain = answer.prim == OVC_ENDED ? OVC_MISS : answer.prim;
    return {certain, answer.further()};
}

/// The part of tracing that is the same however rays come to their leaves. Several threads may call
/// its members at once, for different rays. Its counts go to the statistics when it is destroyed.
template <class Query>
class Resolver {
public:
    /// are_whole: no answer is that of a ray that waits, or has waited, for a page. alone: the
    /// thread that asks does all; few rays would wait for other threads longer than these help.
    Resolver(const Tracing& tracing, const Query& query, bool are_whole, bool alone = false)
        : tracing_(tracing),
          scene_(tracing.scene),
          query_(query),
          are_whole_(are_whole),
          alone_(alone),
          may_have_hit_(!are_whole || !scene_.far.empty()),
          scene_leaf_(scene_.top.scene_in(scene_.level1.bounds)),
          ahead_(scene_ahead(scene_)) {}
    ~Resolver() {
        ovc_statistics& statistics = tracing_.statistics;
        statistics.invalid_rays += invalid_;
        statistics.flagged += flagged_;
        statistics.retraced += retraced_;
        statistics.capped += capped_;
    }
    Resolver(const Resolver&) = delete;

    const Query& query() const { return query_; }
    /// Replaces the query where its arrays have moved or have more rays than before.
    void show(const Query& query) { query_ = query; }

    /// The frame in which rays set out, and the box around what the top-level tree leads to.
    const Leaf& scene_leaf() const { return scene_leaf_; }
    Exclusion exclusion(uint32_t i) const {
        Exclusion without = query_.without[i];
        without.after.is_certain = query_.has_own_places;
        return without;
    }
    /// Enters the answer to ray i.
    void enter(uint32_t i, const Hit& hit) { query_.set(i, hit); }

    /// Calls body(states, some, first) for these rays, by as many as there are lanes; states: those
    /// in which they set out; first: the place of the first.
    template <class Body>
    void in_lanes(std::span<const uint32_t> rays, Body&& body) const {
        constexpr size_t kCount = RayLanes::kCount;
        constexpr size_t kRaysAhead = 8 * kCount; // rays between fetching one and reading it
        for (size_t first = 0; first < rays.size(); first += kCount) {
            const size_t ahead = first + kRaysAhead, end = std::min(ahead + kCount, rays.size());
            for (size_t j = ahead; j < end; ++j)
                query_.rays.fetch(rays[j]);
            const auto some = rays.subspan(first, std::min(kCount, rays.size() - first));
            RayStates states = states_of(some);
            body(states, some, first);
        }
    }

    /// Returns a bit for each of these rays, of which these are the states, about which the kernel
    /// is to be asked, and ends those that hit far triangles there. This has answered the others.
    uint32_t begins(RayStates& states, std::span<const uint32_t> rays) {
        const uint32_t all = RayLanes::first(rays.size());
        FarMeeting far;
        if (!scene_.far.empty()) {
            far = meet_far(scene_.far.triangles, states.rays, states.skip.data());
            end_at_hits(states, far);
        }
        const LanesAhead ahead = look_ahead(ahead_, states.rays);
        const uint32_t valid = ahead.valid & all;
        uint32_t begin = valid & ahead.walks & ahead.meets;
        // Of whole answers each is entered, misses as well.
        for (uint32_t none = may_have_hit_ ? all : all & ~begin; none != 0; none &= none - 1)
            query_.set_miss(rays[size_t(std::countr_zero(none))]);
        if (const uint32_t meets = (far.hits | far.unclear) & valid & ahead.walks)
            begin &= ~enter_far(far, meets, states, rays);
        if (valid != all)
            invalid_ += uint64_t(std::popcount(all & ~valid));
        // This comes before the clip: where double cannot walk, rounding may carry a ray past the
        // whole scene.
        for (uint32_t lost = valid & ~ahead.walks; lost != 0; lost &= lost - 1)
            fall_back(rays[size_t(std::countr_zero(lost))]);
        return begin;
    }

    /// Writes those of the states of these rays that have a bit in `which` to the places from `at`
    /// on; returns how many.
    size_t send(SentRays& sent, size_t at, const RayStates& states, std::span<const uint32_t> rays,
                uint32_t which) const {
        if (query_.counts_passes())
            for (size_t lane = 0; lane < rays.size(); ++lane)
                if (which >> lane & 1)
                    query_.count_pass(rays[lane]);
        return sent.put(at, states, which);
    }

    /// Enters answers of a kernel, or others like them, from the `first` on, one per ray, as far as
    /// they are certain or exact arithmetic decides them. takes(i, answer) -> bool is asked before;
    /// false leaves the answer alone. go_on(i, key, limit) is called where a page that is not
    /// resident may hold a hit before `limit`; key: that of the link that leads there.
    template <class SomeAnswers, class Takes, class GoOn>
    void resolve(std::span<const uint32_t> rays, const SomeAnswers& answers, size_t first,
                 Takes&& takes, GoOn&& go_on) {
        if (!tracing_.watch.keeps_on())
            return;
        HitBatch<size_t> certain; // tagged with the index in `answers`
        CandidateBatch<size_t> doubtful;
        Decided decided;
        std::vector<InDoubt> in_doubt;
        // Without any more of an answer, where nothing else is known about rays.
        const bool names_suffice = !may_have_hit_ && query_.without.empty();
        const auto look = [&](size_t j) {
            const Answer answer = answers[first + j];
            if (!resolve_one(rays[j], answer, decided, go_on))
                in_doubt.push_back({rays[j], begin_of(rays[j], answer)});
        };
        const auto enter = [&](const Hit& hit, size_t j) {
            if (names_suffice)
                query_.set(rays[j], hit);
            else if (comes_next(rays[j], hit))
                enter_certain(rays[j], answers[first + j].where, hit, go_on);
            else
                look(j);
        };
        const auto add_certain = [&](TriangleId id, size_t j) {
            certain.add(query_.rays, rays[j], scene_.soup, id, j);
            if (certain.full())
                certain.finish(enter, look);
        };
        const auto enter_nearest = [&](const Candidate& nearest, size_t j) {
            const Answer answer = answers[first + j];
            if (answer.prim == OVC_ENDED && !nearest.hit.is_hit())
                return look(j);
            enter_resolved(rays[j], answer, nearest, limit_of(rays[j], nearest), decided, go_on);
        };
        for (size_t j = 0; j < rays.size(); ++j) {
            if (j + kAhead < rays.size())
                fetch_ahead(answers, first + j + kAhead);
            const uint32_t name = answers.names[first + j];
            if (names_suffice && (name == OVC_MISS || name < OVC_MAX_TRIANGLES)) {
                if (name == OVC_MISS)
                    query_.set_miss(rays[j]);
                else if (Query::kAnyHit)
                    query_.set(rays[j], kSomeHit);
                else
                    add_certain(scene_.numbers.id(name), j);
                continue;
            }
            const Answer answer = answers[first + j];
            if (!takes(rays[j], answer))
                continue;
            if (has_plain_candidates(rays[j], answer)) {
                doubtful.add(query_.rays, rays[j], exclusion(rays[j]).skip, candidates_of(answer),
                             scene_, j);
                if (!doubtful.has_room())
                    doubtful.finish(enter_nearest, look);
                continue;
            }
            if (!is_certain_hit(answer)) {
                look(j);
                continue;
            }
            add_certain(scene_.seen(answer.prim, exclusion(rays[j]).skip), j);
        }
        certain.finish(enter, look);
        doubtful.finish(enter_nearest, look);
        fall_back(in_doubt, decided);
        enter_all(decided);
    }

    /// Answers ray i for good, whatever it has met, unless the call is cancelled. That is asked for
    /// each ray, because some take a hundred times as long as most.
    void answer_exactly(uint32_t i) {
        if (tracing_.watch.keeps_on())
            query_.set(i, trace_exactly<Query::kAnyHit>(scene_, prepared(i)));
    }
    /// Answers ray i, which has a sieve, for good with its first hit that counts, likewise.
    void answer_sifted(uint32_t i) {
        if (tracing_.watch.keeps_on())
            query_.set(i, first_counting_hit(scene_, prepared(i), query_.without.sieves[i]));
    }

private:
    using Together = RaysTogether<Query::kAnyHit>;
    /// Hits that are decided, but not rounded, each tagged with its ray.
    using Decided = RoundingBatch<uint32_t>;
    /// A ray for the exact fallback, and a t before which it hits nothing.
    struct InDoubt {
        uint32_t i;
        double begin;
    };
    /// A ray that meets many triangles, and one that it hits, or none.
    struct Left {
        uint32_t i;
        TriangleId near;
    };

    /// Returns the states in which these rays, at most RayLanes::kCount, set out.
    RayStates states_of(std::span<const uint32_t> rays) const {
        constexpr uint32_t asks = Query::kAnyHit ? OVC_RAY_ANY_HIT : 0;
        RayStates states;
        RayRoom<RayLanes::kCount> room;
        states.set(rays.size(), asks,
                   [&](size_t lane) { return query_.rays.address(rays[lane], room.rays[lane]); });
        if (query_.without.empty())
            return states;
        for (size_t lane = 0; lane < rays.size(); ++lane) {
            const Ray ray = query_.rays[rays[lane]];
            if (!ray.valid())
                continue; // exact arithmetic takes no infinity
            const Exclusion without = exclusion(rays[lane]);
            states.rays.from[lane] = PreparedRay::behind(ray, without.after).t_min;
            states.skip[lane] = scene_.number_to_skip(ray, without);
        }
        return states;
    }

    /// Returns a t before which ray i, of which this is the answer, hits nothing.
    double begin_of(uint32_t i, const Answer& answer) const {
        if (Query::kAnyHit || !are_whole_ || answer.prim != OVC_FLAGGED ||
            !exclusion(i).after.is_before_all())
            return kBeforeAll.t;
        const Ray ray = query_.rays[i];
        LocalTime time;
        if (!scene_.top.portals.empty())
            local_ray(scene_.top.portals[0], ray, OVC_NO_TRIANGLE, false, time);
        else if (scene_.top.way_in)
            local_ray(*scene_.top.way_in, ray, OVC_NO_TRIANGLE, false, time);
        else
            local_ray(scene_leaf_, ray, OVC_NO_TRIANGLE, false, time);
        return time.begin_of(answer.first_t());
    }

    /// Returns ray i as the host gave it.
    PreparedRay prepared(uint32_t i) const { return PreparedRay(query_.rays[i], exclusion(i)); }

    static LanesScene scene_ahead(const BuiltScene& scene) {
        const Box& all = scene.level1.bounds;
        const Box& reached = scene.top.scene ? scene.top.scene->box : all;
        const double padding = scene.level1.padding;
        return {all.empty(), padding, LanesBox(all), LanesBox(reached.padded(padding))};
    }

    static void end_at_hits(RayStates& states, const FarMeeting& far) {
        for (uint32_t lanes = far.hits; lanes != 0; lanes &= lanes - 1) {
            const int lane = std::countr_zero(lanes);
            states.rays.t_max[lane] = std::min(states.rays.t_max[lane], far.last[lane]);
        }
    }

    /// Enters what rays, those that have a bit in `meets`, hit of the far triangles. Returns those
    /// that need not be asked about any more.
    uint32_t enter_far(const FarMeeting& far, uint32_t meets, RayStates& states,
                       std::span<const uint32_t> rays) {
        uint32_t done = 0;
        Decided decided;
        HitBatch<size_t> certain; // tagged with the lane
        const auto decide = [&](size_t lane) {
            const PreparedRay p = prepared(rays[lane]);
            Nearest nearest = scene_.nearest_of(p);
            for (const FarTriangle& triangle : scene_.far.triangles)
                scene_.offer(nearest, p, scene_.numbers.id(triangle.number));
            count_flagged(rays[lane]);
            if (!nearest.is_hit())
                return;
            enter_decided(rays[lane], nearest.best().found, decided);
            states.rays.t_max[lane] = std::min(states.rays.t_max[lane], nearest.limit());
            done |= uint32_t(Query::kAnyHit) << lane;
        };
        for (uint32_t lanes = meets; lanes != 0; lanes &= lanes - 1) {
            const auto lane = size_t(std::countr_zero(lanes));
            const uint32_t i = rays[lane];
            const bool hits = far.hits >> lane & 1;
            if (hits && Query::kAnyHit && query_.without.after.empty()) {
                query_.set(i, kSomeHit);
                done |= 1u << lane;
            } else if (hits && !Query::kAnyHit && !(far.unclear >> lane & 1)) {
                certain.add(query_.rays, i, scene_.soup,
                            scene_.seen(far.nearest[lane], exclusion(i).skip), lane);
            } else {
                decide(lane);
            }
        }
        certain.finish(
            [&](const Hit& hit, size_t lane) {
                if (hit.t > exclusion(rays[lane]).after.t)
                    query_.set(rays[lane], hit);
                else
                    decide(lane);
            },
            decide);
        enter_all(decided);
        return done;
    }

    static constexpr size_t kAhead = 8; // answers between fetching triangles and reading them
    /// Fetches the triangles of an answer that is to be resolved soon.
    template <class SomeAnswers>
    void fetch_ahead(const SomeAnswers& answers, size_t j) const {
        const uint32_t name = answers.names[j];
        if ((name & OVC_SAYS_MORE) == 0) {
            if (!Query::kAnyHit) // else the corners will not be read
                fetch(name);
            return;
        }
        if (!names_candidates(answers[j]))
            return;
        const Answer answer = answers[j];
        const Candidates found = candidates_of(answer);
        fetch(found.certain);
        for (const uint32_t number : found.further)
            fetch(number);
    }
    void fetch(uint32_t number) const {
        if (number >= OVC_MAX_TRIANGLES)
            return;
        const TriangleId id = scene_.numbers.id(number);
        const Chunk& chunk = scene_.soup.chunks[id.mesh];
        __builtin_prefetch(chunk.address_of(id.prim));
        if (!chunk.stored_corners()) // a triangle often lies in two lines
            __builtin_prefetch(static_cast<const char*>(chunk.address_of(id.prim + 1)) - 1);
    }

    /// Whether the answer names the nearest hit, and nothing is left to decide but t, u and v. In
    /// fast precision all that name one do.
    bool is_certain_hit(const Answer& answer) const {
        return !Query::kAnyHit && answer.prim < OVC_MAX_TRIANGLES && !answer.has_further();
    }
    /// Whether a hit, rounded, lies behind the place that the ray's hits lie behind, and before the
    /// hit that was found before this answer, if there was another.
    bool comes_next(uint32_t i, const Hit& hit) const {
        const bool is_first = !was_hit(i) || hit.t < query_.hit(i).t || hit.id == query_.hit(i).id;
        return is_first && hit.t > exclusion(i).after.t;
    }
    /// Whether the ray was found to hit something before this answer.
    bool was_hit(uint32_t i) const { return may_have_hit_ && query_.was_hit(i); }
    /// Enters that the ray hits nothing, unless that has been said when it began.
    void enter_miss(uint32_t i) {
        if (!may_have_hit_)
            query_.set_miss(i);
    }

    /// Whether the answer names several triangles, and nothing but these decides about the ray.
    bool has_plain_candidates(uint32_t i, const Answer& answer) const {
        return names_candidates(answer) && answer.has_further() && !was_hit(i) &&
               exclusion(i).after.is_before_all();
    }

    /// Returns the t beyond which no hit of the ray can win against this one, or against none.
    double limit_of(uint32_t i, const Candidate& nearest) const {
        const double end = std::min(query_.rays[i].t_max, std::numeric_limits<double>::max());
        return nearest.hit.is_hit() ? std::min(nearest.latest_t(), end) : end;
    }

    template <class GoOn>
    void enter_certain(uint32_t i, uint32_t where, const Hit& hit, GoOn&& go_on) {
        query_.set(i, hit);
        if (where != OVC_NO_LEAF)
            go_on(i, where, std::nextafter(hit.t, std::numeric_limits<double>::max()));
    }

    void enter_all(Decided& decided) {
        decided.finish([&](const Hit& hit, uint32_t i) { query_.set(i, hit); });
    }

    /// Enters a hit that exact arithmetic has decided, or none.
    void enter_decided(uint32_t i, const Candidate& found, Decided& decided) {
        if (Query::kAnyHit || !found.hit.is_hit())
            return query_.set(i, found.hit);
        decided.add(query_.rays, i, scene_.soup, found.hit.id, found.support, i);
        if (decided.full())
            enter_all(decided);
    }

    /// Returns false where the ray must go to the exact fallback.
    template <class GoOn>
    bool resolve_one(uint32_t i, const Answer& answer, Decided& decided, GoOn&& go_on) {
        capped_ += answer.prim == OVC_CAPPED;
        return names_candidates(answer) && resolve_candidates(i, answer, decided, go_on);
    }

    /// Returns false where exact arithmetic does not confirm the certain hit.
    template <class GoOn>
    bool resolve_candidates(uint32_t i, const Answer& answer, Decided& decided, GoOn&& go_on) {
        const Candidates found = candidates_of(answer);
        if (found.is_miss()) {
            enter_miss(i);
            return true;
        }
        if (Query::kAnyHit && found.is_certain_hit()) {
            if (!exclusion(i).after.is_before_all())
                return false; // the answer does not tell which hit it is, and so not if it counts
            query_.set(i, kSomeHit);
            return true;
        }
        const PreparedRay p = prepared(i);
        const bool was_ended = answer.prim == OVC_ENDED;
        if (was_ended && !p.after.is_before_all())
            return false;
        Nearest nearest = scene_.nearest_of(p);
        TriangleId before; // which may lie behind something beyond the end of the ray
        if (was_hit(i)) {
            before = query_.hit(i).id;
            nearest.offer(scene_.soup.triangle(before), before);
        }
        if (!found.offer_to(nearest, p, scene_))
            return false;
        if (was_ended && (!nearest.is_hit() || nearest.best().found.hit.id == before))
            return false;
        enter_resolved(i, answer, nearest.best().found, nearest.limit(), decided, go_on);
        return true;
    }

    /// Enters the nearest of the candidates, or none where none is hit. limit: beyond which nothing
    /// can win.
    template <class GoOn>
    void enter_resolved(uint32_t i, const Answer& answer, const Candidate& nearest, double limit,
                        Decided& decided, GoOn&& go_on) {
        const bool hit = nearest.hit.is_hit();
        if (hit)
            enter_decided(i, nearest, decided);
        else
            enter_miss(i);
        if (answer.where != OVC_NO_LEAF && !(Query::kAnyHit && hit))
            go_on(i, answer.where, limit);
        if (answer.has_further()) // fall_back() counts the others
            count_flagged(i);
    }

    /// Answers the rays exactly. Those that meet many triangles are traced together.
    void fall_back(std::span<const InDoubt> rays, Decided& decided) {
        std::vector<FewFound> few(rays.size());
        run(rays.size(), /* worth= */ alone_ ? rays.size() + 1 : 8, [&](size_t j) {
            const auto [i, begin] = rays[j];
            count_fallback(i);
            if (tracing_.watch.keeps_on())
                few[j] = trace_few<Query::kAnyHit>(scene_, prepared(i), begin);
        });
        if (!tracing_.watch.keeps_on())
            return;
        std::vector<Left> left;
        for (size_t j = 0; j < rays.size(); ++j)
            if (few[j].is_answer)
                enter_decided(rays[j].i, few[j].found, decided);
            else
                left.push_back({rays[j].i, few[j].found.hit.id});
        // Rays to the same or to neighbouring triangles probably go the same way.
        std::ranges::sort(left, {}, [](const Left& ray) { return std::pair(ray.near, ray.i); });
        const size_t groups = (left.size() + Together::kMaxRays - 1) / Together::kMaxRays;
        run(groups, /* worth= */ 2, [&](size_t group) {
            const size_t first = left.size() * group / groups;
            const size_t last = left.size() * (group + 1) / groups;
            answer_together(std::span(left).subspan(first, last - first));
        });
    }

    /// Calls each(j) for j < count, in parallel from `worth` on, because one may take as long as
    /// thousands of others.
    template <class Each>
    static void run(size_t count, size_t worth, Each&& each) {
        const auto some = [&](size_t from, size_t to) {
            for (size_t j = from; j < to; ++j)
                each(j);
        };
        if (count < worth)
            some(0, count);
        else
            parallel_for(count, 1, some);
    }

    void answer_together(std::span<const Left> rays) {
        Together together(scene_);
        for (const Left& ray : rays)
            together.add(prepared(ray.i), ray.near);
        together.trace([&] { return tracing_.watch.keeps_on(); });
        if (tracing_.watch.keeps_on())
            for (size_t k = 0; k < rays.size(); ++k)
                query_.set(rays[k].i, together.hit(k));
    }

    void fall_back(uint32_t i) {
        answer_exactly(i);
        count_fallback(i);
    }

    void count_fallback(uint32_t i) {
        count_flagged(i);
        ++retraced_;
    }

    void count_flagged(uint32_t i) {
        query_.flag(i);
        ++flagged_;
    }

    const Tracing tracing_;
    const BuiltScene& scene_;
    Query query_;
    const bool are_whole_;
    const bool alone_;
    const bool may_have_hit_; // a ray, before its answer
    const Leaf scene_leaf_;   // the frame in which rays set out, and the box around its pages
    const LanesScene ahead_;
    std::atomic<uint64_t> invalid_{0};
    std::atomic<uint64_t> flagged_{0};
    std::atomic<uint64_t> retraced_{0};
    std::atomic<uint64_t> capped_{0};
};

} // namespace ovc

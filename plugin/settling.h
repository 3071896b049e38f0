// SPDX-License-Identifier: Apache-2.0
// Settling: which rays the kernel is asked about, and what double precision makes of its answers.
#pragma once

#include "core/hit_batch.h"
#include "core/parallel.h"
#include "kdtree/restart.h"
#include "plugin/candidates.h"
#include "plugin/exact_fallback.h"
#include "plugin/query.h"
#include "plugin/two_level.h"
#include "shaders/layout.h"

#include <atomic>
#include <cmath>
#include <limits>
#include <vector>

namespace ovc {

/// The part that is the same however rays come to their leaves. Its members may be called for
/// different rays at once; what it counted goes to the statistics with it.
template <class Query>
class TwoLevel::Settling {
protected:
    static constexpr size_t kGrain = 256; // rays a task

    Settling(TwoLevel& structure, const Query& query)
        : s_(structure),
          query_(query),
          box_(structure.scene_.level1.bounds.padded(structure.scene_.level1.padding)) {}
    ~Settling() {
        s_.statistics_.invalid_rays += invalid_;
        s_.statistics_.flagged += flagged_;
        s_.statistics_.retraced += retraced_;
        s_.statistics_.capped += capped_;
    }
    Settling(const Settling&) = delete;

    /// Whether the kernel is to be asked about ray i. Else it is answered now.
    bool begins(uint32_t i) {
        query_.set_miss(i);
        if (!query_.rays[i].valid()) {
            ++invalid_;
            return false;
        }
        const PreparedRay p = prepare(query_, i);
        // First: from where double cannot walk, rounding may carry a ray past the whole scene.
        if (!can_walk(s_.scene_.level1, p)) {
            decide_in_double(i, p);
            return false;
        }
        return !clip(p, box_, p.ray.t_min, p.ray.t_max).empty();
    }

    /// Ray i on its way: done with the cells up to t_from, of interest up to t_end. leaf: as
    /// Traveller::first_leaf.
    Traveller traveller(uint32_t i, double t_from, double t_end, uint32_t leaf) const {
        query_.count_pass(i);
        Ray rest = query_.rays[i];
        rest.t_max = t_end;
        return {rest, t_from, s_.scene_.number_to_skip(query_.skipped(i)),
                leaf | (Query::kAnyHit ? OVC_RAY_ANY_HIT : 0)};
    }

    /// Enters what the kernel found of the rays, and what is certain of it. begins(i, answer) is
    /// asked before: false: the answer is to be left alone. go_on(i, leaf, p, limit) is asked where
    /// later leaves may hold a hit before `limit`; false: it cannot say where. leaf: the answer's,
    /// its key where pages hang under links.
    template <class Begins, class GoOn>
    void take_in(std::span<const uint32_t> rays, std::span<const Answer> answers, Begins&& begins,
                 GoOn&& go_on) {
        if (!s_.keeps_on())
            return;
        HitBatch<size_t> certain; // of `answers`
        std::vector<uint32_t> in_doubt;
        const auto enter = [&](const Hit& hit, size_t j) {
            if (!enter_certain(rays[j], answers[j], hit, go_on))
                in_doubt.push_back(rays[j]);
        };
        const auto look = [&](size_t j) {
            if (!take_in_one(rays[j], answers[j], go_on))
                in_doubt.push_back(rays[j]);
        };
        for (size_t j = 0; j < rays.size(); ++j) {
            fetch_ahead(answers, j);
            if (!begins(rays[j], answers[j]))
                continue;
            if (!is_certain_hit(rays[j], answers[j])) {
                look(j);
                continue;
            }
            const TriangleId id = s_.scene_.seen(answers[j].prim, query_.skipped(rays[j]));
            certain.add(query_.rays[rays[j]], s_.scene_.soup.triangle(id), id, j);
            if (certain.full())
                certain.finish(enter, look);
        }
        certain.finish(enter, look);
        decide_in_double(in_doubt);
    }

    /// Fetches the triangle of one of the answers behind the j-th, which is to be taken in soon.
    void fetch_ahead(std::span<const Answer> answers, size_t j) const {
        constexpr size_t kAhead = 8;
        if (j + kAhead >= answers.size())
            return;
        const uint32_t prim = answers[j + kAhead].prim;
        if (prim >= OVC_MAX_TRIANGLES || Query::kAnyHit || !s_.options_.certify)
            return; // nobody looks at its corners
        const TriangleId id = s_.scene_.numbers.id(prim);
        __builtin_prefetch(s_.scene_.soup.chunks[id.mesh].address_of(id.prim));
    }

    /// Answers ray i for good, whatever it has met.
    void answer_in_double(uint32_t i) { arbitrate_ray(i, prepare(query_, i)); }

    TwoLevel& s_;
    Query query_;

private:
    /// Whether the answer names the nearest hit, and nothing is left to decide but t, u and v.
    bool is_certain_hit(uint32_t i, const Answer& answer) const {
        return !Query::kAnyHit && s_.options_.certify && answer.prim < OVC_MAX_TRIANGLES &&
               answer.rivals()[0] == OVC_NO_TRIANGLE && !query_.was_hit(i);
    }

    template <class GoOn>
    bool enter_certain(uint32_t i, const Answer& answer, const Hit& hit, GoOn&& go_on) {
        query_.set(i, hit);
        if (answer.leaf() == OVC_NO_LEAF)
            return true;
        const double beyond = std::nextafter(hit.t, std::numeric_limits<double>::max());
        return go_on(i, answer.leaf(), prepare(query_, i), beyond);
    }

    /// False: it is to be decided in double.
    template <class GoOn>
    bool take_in_one(uint32_t i, const Answer& answer, GoOn&& go_on) {
        const bool decided = answer.prim != OVC_FLAGGED && answer.prim != OVC_CAPPED;
        capped_ += answer.prim == OVC_CAPPED;
        return decided && (s_.options_.certify ? take_in_certified(i, answer, go_on)
                                               : take_in_fast(i, answer));
    }

    /// False where double does not find what the kernel was certain of, or go_on() says so.
    template <class GoOn>
    bool take_in_certified(uint32_t i, const Answer& answer, GoOn&& go_on) {
        const Candidates found{answer.prim, {answer.rivals()[0], answer.rivals()[1]}};
        if (found.is_miss())
            return true;
        if (Query::kAnyHit && found.is_certain_hit()) {
            query_.set(i, Hit{0, 0, 0, s_.scene_.numbers.id(found.certain)});
            return true;
        }
        const PreparedRay p = prepare(query_, i);
        Nearest nearest(p);
        if (query_.was_hit(i))
            s_.scene_.offer(nearest, query_.hit(i).id);
        if (!found.offer_to(nearest, s_.scene_, p.skip))
            return false;
        if (nearest.is_hit())
            query_.set(i, nearest);
        const bool in_scene = answer.leaf() == OVC_NO_LEAF; // linked pages: no other leaf is left
        const bool settled = in_scene || (Query::kAnyHit && nearest.is_hit()) ||
                             go_on(i, answer.leaf(), p, nearest.limit());
        if (settled && found.has_further()) // decide_in_double() counts the others
            count_flagged(i);
        return settled;
    }

    bool take_in_fast(uint32_t i, const Answer& answer) {
        if (answer.prim != OVC_MISS)
            query_.set(i, s_.scene_.twins.seen(s_.scene_.soup,
                                               {answer.t(), answer.u(), answer.v(),
                                                s_.scene_.numbers.id(answer.prim)},
                                               query_.skipped(i)));
        return true;
    }

    /// Some rays take a hundred times as long as most: asked before each whether it is in vain.
    void arbitrate_ray(uint32_t i, const PreparedRay& p) {
        if (!s_.keeps_on())
            return;
        query_.set(i, trace_exactly<Query::kAnyHit>(s_.scene_, p));
    }

    /// In parallel where there are many: each may take as long as thousands of others.
    void decide_in_double(std::span<const uint32_t> rays) {
        const auto decide = [&](size_t from, size_t to) {
            for (size_t j = from; j < to; ++j)
                decide_in_double(rays[j], prepare(query_, rays[j]));
        };
        if (rays.size() < 8)
            decide(0, rays.size());
        else
            parallel_for(rays.size(), 1, decide);
    }

    void decide_in_double(uint32_t i, const PreparedRay& p) {
        arbitrate_ray(i, p);
        count_flagged(i);
        ++retraced_;
    }

    void count_flagged(uint32_t i) {
        query_.flag(i);
        ++flagged_;
    }

    const Box box_; // of the scene; empty: no triangles
    std::atomic<uint64_t> invalid_{0};
    std::atomic<uint64_t> flagged_{0};
    std::atomic<uint64_t> retraced_{0};
    std::atomic<uint64_t> capped_{0};
};

} // namespace ovc

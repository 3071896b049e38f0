// SPDX-License-Identifier: Apache-2.0
#include "plugin/resolve/all_hits.h"

#include "core/system/parallel.h"
#include "plugin/resolve/gathered_hits.h"
#include "plugin/resolve/sifting.h"

#include <algorithm>
#include <cassert>
#include <numeric>
#include <vector>

namespace ovc {
namespace {

/// Hits of a ray that are found by passes: few, because each pass begins the ray anew, while the
/// walk on the CPU finds all that are left at once.
constexpr size_t kHitsByPasses = 4;
constexpr size_t kMaxRaysAtOnce = size_t(1) << 20; // some 200 bytes each

class AllHitsTracer {
public:
    AllHitsTracer(const Tracing& tracing, const TraceNearest& trace_nearest, const RaySpan& rays,
                  const Exclusions& without, const AllHits& all)
        : tracing_(tracing),
          trace_nearest_(trace_nearest),
          rays_(rays),
          without_(without),
          all_(all),
          left_(rays.size()),
          last_(rays.size(), kBeforeAll) {
        std::iota(left_.begin(), left_.end(), 0u);
        std::ranges::copy(without.after, last_.begin());
        std::ranges::fill(all.hits, Hit{});
        std::ranges::fill(all.counts, 0);
    }

    Result<Done> run() {
        size_t n = 0;
        for (; n < kHitsByPasses && !left_.empty() && !all_.has_enough(n); ++n) {
            tracing_.watch.begin_part(n, kHitsByPasses + 1);
            if (Result<Done> done = trace_next(n); !done)
                return done;
        }
        if (!left_.empty() && !all_.has_enough(n)) {
            tracing_.watch.begin_part(kHitsByPasses, kHitsByPasses + 1);
            return gather(n);
        }
        return Done{};
    }

private:
    /// Finds hit number n of all rays that have had one so far.
    Result<Done> trace_next(size_t n) {
        const size_t count = left_.size();
        std::vector<Ray> rays(count);
        std::vector<TriangleId> skip(without_.skip.empty() ? 0 : count);
        std::vector<Hit> after(count), hits(count);
        std::vector<uint32_t> masks(without_.sieves.masks.empty() ? 0 : count);
        std::vector<uint64_t> names(count);
        for (size_t j = 0; j < count; ++j) {
            const uint32_t i = left_[j];
            rays[j] = rays_[i];
            after[j] = last_[i];
            names[j] = without_.sieves[i].name;
            if (!skip.empty())
                skip[j] = without_.skip[i];
            if (!masks.empty())
                masks[j] = without_.sieves.masks[i];
        }
        Exclusions without(skip, after);
        assert(without_.sieves.filters.size() <= 1);
        without.sieves = {masks, without_.sieves.filters, names};
        if (Result<Done> done = trace_nearest_(rays, without, hits); !done)
            return done;
        size_t kept = 0;
        for (size_t j = 0; j < count; ++j)
            if (hits[j].is_hit()) {
                const uint32_t i = left_[j];
                all_.set(i, n, hits[j]);
                last_[i] = hits[j];
                left_[kept++] = i;
            }
        left_.resize(kept);
        return Done{};
    }

    /// Finds the hits from number n on of all rays that have had n.
    Result<Done> gather(size_t n) {
        constexpr size_t kRaysBetweenAsking = 4096;
        for (size_t first = 0; first < left_.size(); first += kRaysBetweenAsking) {
            if (Result<Done> asked = tracing_.watch.go_on(first, left_.size()); !asked)
                return asked;
            const size_t count = std::min(kRaysBetweenAsking, left_.size() - first);
            parallel_for(count, 1, [&](size_t from, size_t to) {
                for (size_t j = from; j < to && tracing_.watch.keeps_on(); ++j)
                    gather_one(left_[first + j], n);
            });
        }
        return tracing_.watch.unless_cancelled();
    }

    void gather_one(uint32_t i, size_t n) {
        Exclusion without = without_[i];
        without.after = HitPlace(last_[i]);
        if (!rays_[i].valid())
            return;
        const std::vector<Hit> hits = gathered_hits(tracing_.scene, PreparedRay(rays_[i], without));
        std::vector<uint8_t> counts(hits.size(), 1);
        if (!without_.sieves.pass_all())
            counts = counting_hits(tracing_.scene.soup, without_.sieves,
                                   std::vector<uint32_t>(hits.size(), i), hits);
        for (size_t j = 0; j < hits.size() && !all_.has_enough(n); ++j)
            if (counts[j])
                all_.set(i, n++, hits[j]);
    }

    const Tracing& tracing_;
    const TraceNearest& trace_nearest_;
    const RaySpan rays_;
    const Exclusions& without_;
    const AllHits& all_;
    std::vector<uint32_t> left_; // rays that may have more hits
    std::vector<Hit> last_;      // of each ray
};

} // namespace

Result<Done> trace_all_hits(const Tracing& tracing, const TraceNearest& trace_nearest,
                            const RaySpan& rays, const Exclusions& without, const AllHits& all) {
    assert(all.are_for(rays.size()) && without.are_for(rays.size()));
    for (size_t first = 0; first < rays.size(); first += kMaxRaysAtOnce) {
        const size_t count = std::min(kMaxRaysAtOnce, rays.size() - first);
        const AllHits part = all.part(first, count);
        const Exclusions of_part = without.subspan(first, count);
        if (Result<Done> done =
                AllHitsTracer(tracing, trace_nearest, rays.subspan(first, count), of_part, part)
                    .run();
            !done)
            return done;
    }
    return Done{};
}

} // namespace ovc

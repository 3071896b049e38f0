// SPDX-License-Identifier: Apache-2.0
// RoutedStream: cuts the stream into batches, each of which is a routed call.
#include "plugin/ranks/routed_stream.h"

#include "core/system/parallel.h"
#include "core/system/stopwatch.h"

#include <algorithm>
#include <numeric>

namespace ovc {

/// So many batches are under way: one is traced here, one elsewhere, one is on its way, and one is
/// there when another ends. More of them take more memory.
static constexpr size_t kBatches = 4;
/// A batch has so many rays a thread: with as many, messages and passes cost what their rays do.
static constexpr size_t kRaysAThread = size_t(7) << 9, kFewRays = size_t(7) << 10,
                        kMaxBatchRays = size_t(1) << 17;
/// Fewer rays wait for others, while there is something to do.
static constexpr size_t kMinBatchRays = size_t(1) << 12;

std::optional<std::vector<uint32_t>> dropped_hits(std::span<const uint32_t> rays,
                                                  const Sieves& sieves, std::span<const Hit> hits) {
    std::vector<uint32_t> out;
    for (size_t first = 0; first < rays.size();) {
        HitFilter* const filter = sieves[rays[first]].filter;
        std::vector<uint32_t> asked;
        std::vector<uint64_t> names;
        std::vector<Hit> found;
        for (; first < rays.size() && sieves[rays[first]].filter == filter; ++first)
            if (const uint32_t i = rays[first]; filter && hits[i].is_hit()) {
                asked.push_back(i);
                names.push_back(sieves[i].name);
                found.push_back(hits[i]);
            }
        std::vector<uint8_t> keep(asked.size(), 1);
        if (!asked.empty() && !filter->keep(names, found, keep))
            return std::nullopt;
        for (size_t i = 0; i < asked.size(); ++i)
            if (!keep[i])
                out.push_back(asked[i]);
    }
    return out;
}

/// Rays of one kind, and their answers.
struct RoutedStream::Batch {
    Batch(const Routing& ranks, RoutedCounts& counts) : call(ranks, counts) {}

    RoutedCall call;
    bool is_under_way = false;
    bool any_hit = false;
    Backlog taken;
    std::vector<Hit> hits; // those of rays that ask for any, too, where they have filters
    std::vector<uint8_t> occluded;
    std::vector<uint64_t> kept; // the tokens of the rays whose hits the filters kept

    StreamRays rays() const { return taken.last(taken.size()); }
};

RoutedStream::RoutedStream(const Routing& ranks, RoutedCounts& counts, StreamHost& host)
    : ranks_(ranks),
      counts_(counts),
      host_(host),
      max_rays_(std::clamp(kRaysAThread * thread_count(), kFewRays, kMaxBatchRays)) {
    for (size_t i = 0; i < kBatches; ++i)
        batches_.push_back(std::make_unique<Batch>(ranks, counts));
}

RoutedStream::~RoutedStream() = default;

void RoutedStream::push(const StreamRays& rays) {
    (rays.any_hit ? any_ : nearest_).push(rays);
    (rays.any_hit ? occlusion_rays_ : nearest_rays_) += rays.rays.size();
}

Result<Done> RoutedStream::run() {
    while (true) {
        if (const Result<Done> begun = begin_batches(); !begun)
            return begun;
        const std::vector<RoutedCall*> calls = under_way();
        if (calls.empty())
            return Done{};
        const auto done = std::ranges::find_if(
            batches_, [](const auto& b) { return b->is_under_way && b->call.is_done(); });
        const bool waits = done == batches_.end();
        if (const Result<Done> taken =
                take_answers(ranks_, counts_, calls, std::chrono::milliseconds(waits ? 50 : 0));
            !taken)
            return taken;
        if (!waits)
            if (const Result<Done> delivered = deliver(**done); !delivered)
                return delivered;
    }
}

std::vector<RoutedCall*> RoutedStream::under_way() const {
    std::vector<RoutedCall*> calls;
    for (const auto& batch : batches_)
        if (batch->is_under_way)
            calls.push_back(&batch->call);
    return calls;
}

/// Begins batches as long as there are places and rays for them.
Result<Done> RoutedStream::begin_batches() {
    for (const auto& batch : batches_) {
        if (batch->is_under_way)
            continue;
        if (has_more_ && std::max(nearest_.size(), any_.size()) < max_rays_) {
            const size_t before = nearest_.size() + any_.size();
            if (!on_host([&] { return host_.more(*this, max_rays_ - nearest_.size()); }))
                return stopped_by_host();
            has_more_ = nearest_.size() + any_.size() > before;
        }
        // Rays that ask for any hit have no children, so they make room.
        const bool any_hit = any_.size() >= std::min(nearest_.size(), max_rays_);
        Backlog& backlog = any_hit ? any_ : nearest_;
        if (backlog.size() == 0 ||
            (backlog.size() < kMinBatchRays && !under_way().empty() && !ranks_.is_idle()))
            return Done{};
        begin(*batch, backlog, any_hit);
    }
    return Done{};
}

void RoutedStream::begin(Batch& batch, Backlog& backlog, bool any_hit) {
    const size_t count = std::min(backlog.size(), max_rays_);
    backlog.move_last(count, batch.taken);
    const StreamRays rays = batch.rays();
    batch.any_hit = any_hit;
    batch.is_under_way = true;
    const bool wants_hits = !any_hit || !rays.filters.empty();
    batch.hits.resize(wants_hits ? count : 0);
    batch.occluded.resize(any_hit ? count : 0);
    Exclusions without(rays.skip, rays.after);
    without.sieves.masks = rays.masks;
    batch.call.begin({rays.rays, without, batch.hits,
                      wants_hits ? std::span<uint8_t>() : std::span<uint8_t>(batch.occluded)});
    while (batch.call.find_stops()) {
    }
}

template <class Call>
bool RoutedStream::on_host(Call&& call) {
    const Stopwatch watch;
    const bool goes_on = call();
    seconds_host_ += watch.seconds();
    return goes_on;
}

/// Hands a batch's answers to the host.
Result<Done> RoutedStream::deliver(Batch& batch) {
    batch.is_under_way = false;
    std::span<const uint64_t> tokens = batch.rays().tokens;
    if (!batch.rays().filters.empty()) {
        if (const Result<Done> done = send_dropped_on(batch); !done)
            return done;
        tokens = batch.kept;
        if (batch.any_hit) {
            batch.occluded.resize(batch.hits.size());
            std::ranges::transform(batch.hits, batch.occluded.begin(), &Hit::is_hit);
        }
    }
    const bool goes_on = tokens.empty() || on_host([&] {
                             return batch.any_hit ? host_.occlusions(*this, tokens, batch.occluded)
                                                  : host_.hits(*this, tokens, batch.hits);
                         });
    return goes_on ? Result<Done>(Done{}) : stopped_by_host();
}

/// Lets rays go on behind the hits that their filters drop. What is left are the tokens and hits of
/// the others.
Result<Done> RoutedStream::send_dropped_on(Batch& batch) {
    const StreamRays rays = batch.rays();
    std::vector<uint32_t> all(rays.rays.size());
    std::iota(all.begin(), all.end(), 0u);
    const auto dropped =
        dropped_hits(all, Sieves{rays.masks, rays.filters, rays.tokens}, batch.hits);
    if (!dropped)
        return Error{"the filter stopped the call", ErrorKind::Cancelled};
    Backlog& backlog = batch.any_hit ? any_ : nearest_;
    batch.kept.clear();
    size_t next = 0;
    for (uint32_t i = 0; i < all.size(); ++i) {
        if (next == dropped->size() || (*dropped)[next] != i) {
            batch.hits[batch.kept.size()] = batch.hits[i];
            batch.kept.push_back(rays.tokens[i]);
            continue;
        }
        ++next;
        StreamRays ray{batch.any_hit, rays.rays.subspan(i, 1), rays.skip.subspan(i, 1),
                       rays.tokens.subspan(i, 1), std::span(batch.hits).subspan(i, 1)};
        ray.masks = rays.masks.empty() ? rays.masks : rays.masks.subspan(i, 1);
        ray.filters = rays.filters.subspan(i, 1);
        backlog.push(ray);
    }
    batch.hits.resize(batch.kept.size());
    return Done{};
}

} // namespace ovc

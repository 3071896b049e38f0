// SPDX-License-Identifier: Apache-2.0
// Algorithm 6 from the host's side: it shades every answer when it comes, and the rays that this
// spawns join the stream at once.
#include "host/render/render_mixed.h"

#include "core/stream/reserve_sparingly.h"
#include "core/system/parallel.h"
#include "core/system/stopwatch.h"
#include "host/render/slots.h"
#include "host/shade/shading.h"

#include <algorithm>
#include <cassert>

namespace ovc {
namespace {

constexpr size_t kCopyGrain = 1024; // rays a task that only copies

/// The rays of one kind in the stream, until their answers come. A token holds the kind above and
/// the ray's slot below.
template <class Purpose>
class RaysUnderWay {
public:
    /// keeps_rays: whether the rays themselves are needed when their answers come.
    RaysUnderWay(uint64_t kind, bool any_hit, bool keeps_rays, const Sight& sight)
        : kind_(kind << 32), any_hit_(any_hit), keeps_rays_(keeps_rays), sight_(sight) {}

    bool has(uint64_t token) const { return (token & kKindBits) == kind_; }

    void push(RayStream& stream, const RayList<Purpose>& rays) {
        const std::vector<uint32_t> taken = slots_.take(rays.size());
        grow(purposes_);
        if (keeps_rays_)
            grow(rays_);
        tokens_.resize(rays.size());
        parallel_for(rays.size(), kCopyGrain, [&](size_t first, size_t last) {
            for (size_t i = first; i < last; ++i) {
                if (keeps_rays_)
                    rays_[taken[i]] = rays.rays[i];
                purposes_[taken[i]] = rays.purposes[i];
                tokens_[i] = kind_ | taken[i];
            }
        });
        const Sieves sieves = sight_.of(rays.purposes, masks_);
        stream.push({any_hit_, rays.rays, rays.skip, tokens_, {}, sieves.masks, sieves.filters});
    }

    /// Writes the rays that these tokens stand for, which are kept, and frees their slots.
    void take(std::span<const uint64_t> tokens, RayList<Purpose>& rays) {
        assert(keeps_rays_ || tokens.empty());
        rays.resize(tokens.size());
        parallel_for(tokens.size(), kCopyGrain, [&](size_t first, size_t last) {
            for (size_t i = first; i < last; ++i)
                rays.rays[i] = rays_[uint32_t(tokens[i])];
        });
        take(tokens, rays.purposes);
    }
    /// Does the same for their purposes alone.
    void take(std::span<const uint64_t> tokens, UnwrittenVector<Purpose>& purposes) {
        purposes.resize(tokens.size());
        parallel_for(tokens.size(), kCopyGrain, [&](size_t first, size_t last) {
            for (size_t i = first; i < last; ++i)
                purposes[i] = purposes_[uint32_t(tokens[i])];
        });
        for (const uint64_t token : tokens)
            slots_.give_back(uint32_t(token));
    }

private:
    static constexpr uint64_t kKindBits = ~uint64_t(0) << 32;

    /// Makes an item for each slot.
    template <class T>
    void grow(std::vector<T>& items) const {
        if (items.size() >= slots_.end())
            return;
        reserve_sparingly(items, slots_.end());
        items.resize(slots_.end());
    }

    const uint64_t kind_;
    const bool any_hit_, keeps_rays_;
    const Sight& sight_;
    Slots slots_;
    std::vector<Ray> rays_; // of each slot, where they are kept
    std::vector<Purpose> purposes_;
    std::vector<uint64_t> tokens_;
    std::vector<uint32_t> masks_;
};

class MixedRenderer final : public StreamHost {
public:
    explicit MixedRenderer(const RenderTask& task)
        : task_(task),
          shading_(task.integrator, task.film),
          paths_(0, /* any_hit= */ false, /* keeps_rays= */ true, task.sight),
          shadows_(1, /* any_hit= */ !task.integrator.light_may_pass(),
                   /* keeps_rays= */ task.integrator.light_may_pass(), task.sight) {}

    Result<RenderReport> render(Backend& backend) {
        const Stopwatch watch;
        const double traced_before = backend.statistics().seconds_trace;
        const Result<Done> done = backend.stream(*this);
        if (!done && done.error().kind != ErrorKind::Cancelled)
            return done.error();
        report_.complete = bool(done);
        // Some backends shade beside tracing and count their own time. The others do one after the
        // other.
        const double traced = backend.statistics().seconds_trace - traced_before;
        report_.seconds_trace = traced > 0 ? traced : watch.seconds() - report_.seconds_shade;
        return report_;
    }

    bool more(RayStream& stream, size_t wanted) override {
        const Stopwatch watch;
        const size_t count = size_t(std::min<uint64_t>(wanted, task_.camera.size() - begun_));
        task_.camera.make(begun_, count, spawned_.paths);
        begun_ += count;
        push_spawned(stream);
        report_.seconds_shade += watch.seconds();
        return true;
    }

    bool hits(RayStream& stream, std::span<const uint64_t> tokens,
              std::span<const Hit> hits) override {
        const Stopwatch watch;
        shade_paths(stream, selected(paths_, {tokens, hits}));
        pass_shadows(stream, selected(shadows_, {tokens, hits}));
        return go_on(watch);
    }

    bool occlusions(RayStream&, std::span<const uint64_t> tokens,
                    std::span<const uint8_t> occluded) override {
        const Stopwatch watch;
        shadows_.take(tokens, answered_shadows_.purposes);
        shading_.arrive(answered_shadows_.purposes, occluded);
        return go_on(watch);
    }

private:
    /// Answers to rays of one kind.
    struct Answers {
        std::span<const uint64_t> tokens;
        std::span<const Hit> hits;
    };

    void shade_paths(RayStream& stream, const Answers& paths) {
        paths_.take(paths.tokens, answered_paths_);
        for (size_t first = 0; first < paths.hits.size(); first += shading_.max_answers()) {
            shading_.shade(answered_paths_, paths.hits, first,
                           std::min(shading_.max_answers(), paths.hits.size() - first), spawned_);
            push_spawned(stream);
        }
    }

    /// Takes shadow rays through surfaces that light may pass, and pushes those that go on.
    void pass_shadows(RayStream& stream, const Answers& shadows) {
        shadows_.take(shadows.tokens, answered_shadows_);
        shading_.pass(answered_shadows_, shadows.hits);
        report_.rays.shadow += answered_shadows_.size();
        shadows_.push(stream, answered_shadows_);
    }

    /// Returns those of the answers that are to rays of this kind, copied where not all are.
    template <class Purpose>
    Answers selected(const RaysUnderWay<Purpose>& kind, const Answers& all) {
        const auto is_of_kind = [&](uint64_t token) { return kind.has(token); };
        if (std::ranges::all_of(all.tokens, is_of_kind))
            return all;
        tokens_.clear();
        hits_.clear();
        for (size_t i = 0; i < all.tokens.size(); ++i)
            if (is_of_kind(all.tokens[i])) {
                tokens_.push_back(all.tokens[i]);
                hits_.push_back(all.hits[i]);
            }
        return {tokens_, hits_};
    }

    void push_spawned(RayStream& stream) {
        for (const Path& path : spawned_.paths.purposes)
            report_.rays.count(path.kind);
        report_.rays.shadow += spawned_.shadows.size();
        paths_.push(stream, spawned_.paths);
        shadows_.push(stream, spawned_.shadows);
        spawned_.clear();
    }

    bool go_on(const Stopwatch& watch) {
        report_.seconds_shade += watch.seconds();
        report_.pixels_done = task_.film.pixels_done();
        return !task_.observe || task_.observe(report_);
    }

    const RenderTask& task_;
    Shading shading_;
    uint64_t begun_ = 0; // camera rays
    RaysUnderWay<Path> paths_;
    RaysUnderWay<Shadow> shadows_;
    RenderReport report_;
    // These buffers of one call are kept so that they are allocated once.
    Spawned spawned_;
    RayList<Path> answered_paths_;
    RayList<Shadow> answered_shadows_;
    std::vector<uint64_t> tokens_;
    std::vector<Hit> hits_;
};

} // namespace

Result<RenderReport> render_mixed(const RenderTask& task, Backend& backend) {
    return MixedRenderer(task).render(backend);
}

} // namespace ovc

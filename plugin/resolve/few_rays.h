// SPDX-License-Identifier: Apache-2.0
// Few rays are answered on the CPU: the kernel's walk there (gpu/walk/float_walk.h) names
// triangles, and exact arithmetic decides among them as it does after a pass.
#pragma once

#include "gpu/walk/float_walk.h"
#include "kdtree/restart.h"
#include "plugin/resolve/resolve.h"
#include "plugin/structure/structure.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <numeric>
#include <optional>
#include <span>
#include <vector>

namespace ovc {

/// Walks rays in the frame of a tree, that with this header among those of the scene's top-level
/// tree.
inline void walk_in_floats(const BuiltScene& scene, uint32_t header, std::span<const LocalRay> rays,
                           bool any_hit, Named* named) {
    const auto units_of = [](const void* pages, uint32_t page) {
        return (*static_cast<const std::vector<Page>*>(pages))[page].view().data();
    };
    const WalkedTree tree{scene.top.tree.view().data(), header, &scene.pages, units_of};
    float_walk()(tree, rays.data(), rays.size(), any_hit, named);
}

/// What a walk names, as Resolver::resolve() reads the answers of a pass.
template <size_t size>
struct WalkAnswers {
    std::array<Named, size> named;
    std::array<uint32_t, size> names; // as in Answers

    void set_names(size_t count) {
        for (size_t i = 0; i < count; ++i)
            names[i] = named[i].certain | (says_more(named[i]) ? OVC_SAYS_MORE : 0);
    }

    Answer operator[](size_t i) const {
        const Named& one = named[i];
        Answer answer{{OVC_NO_TRIANGLE, OVC_NO_TRIANGLE, OVC_NO_LEAF}, one.certain, OVC_NO_LEAF};
        if (one.certain == OVC_FLAGGED)
            answer.words[1] = std::bit_cast<uint32_t>(-HUGE_VALF); // no t is known
        else
            std::copy_n(one.further, std::min(one.count, 2u), answer.words.begin());
        if (one.count > 2)
            answer.listed = std::span(one.further, one.count);
        return answer;
    }

private:
    static bool says_more(const Named& one) { return one.count > 0 || one.certain == OVC_FLAGGED; }
};

/// Walks one ray in floats: through the whole scene or, where parts have frames of their own,
/// through each part that it comes to.
template <bool kAnyHit>
class OneRay {
public:
    /// ray: valid. The scene outlives this.
    OneRay(const BuiltScene& scene, const Ray& ray, const Exclusion& without)
        : scene_(scene),
          p_(ray, without),
          skip_(scene.number_to_skip(ray, without)),
          nearest_(scene.nearest_of(p_)) {}
    OneRay(const OneRay&) = delete;

    const PreparedRay& ray() const { return p_; }

    /// Returns the nearest hit, or with kAnyHit some hit; nothing where only doubles can tell.
    std::optional<Hit> answer() {
        if (!can_walk(scene_.level1, p_) || !walk())
            return std::nullopt;
        if (is_certain_)
            return kSomeHit;
        for (const FarTriangle& far : scene_.far.triangles)
            offer(far.number);
        return kAnyHit ? nearest_.unrounded_hit() : nearest_.hit();
    }

private:
    /// Returns whether the walks could tell what may be hit, all of which is offered then.
    bool walk() {
        const TopLevel& top = scene_.top;
        if (top.empty())
            return true;
        LocalTime unused;
        if (top.way_in)
            return take(0, 0, local_ray(*top.way_in, p_.ray, skip_, kAnyHit, unused));
        const Leaf scene = top.scene_in(scene_.level1.bounds);
        if (top.portals.empty())
            return take(0, 0, local_ray(scene, p_.ray, skip_, kAnyHit, unused));
        return p_.after.is_before_all() && walk_parts(scene);
    }

    bool walk_parts(const Leaf& scene) {
        bool told = true;
        const auto enter = [&](uint32_t number, RaySet) {
            const Portal& portal = scene_.top.portals[number];
            Ray ray = p_.ray;
            ray.t_max = nearest_.limit();
            LocalTime unused;
            told = take(portal.tree, portal.first_number,
                        local_ray(portal, ray, skip_behind(portal), kAnyHit, unused));
            return !told || is_certain_ || (kAnyHit && nearest_.is_hit());
        };
        const auto units_of = [&](uint32_t page) { return scene_.pages[page].view().data(); };
        walk_units(
            scene_.top.tree.view(), 0, units_of, 1, [&](uint32_t) { return walked_ray(scene, p_); },
            [&](uint32_t number, RaySet) { return offer(number) && kAnyHit; }, enter,
            [&](uint32_t, double) { return nearest_.limit(); });
        return told;
    }

    uint32_t skip_behind(const Portal& portal) const {
        const bool skips = skip_ != OVC_NO_TRIANGLE && skip_ >= portal.first_number;
        return skips ? skip_ - portal.first_number : OVC_NO_TRIANGLE;
    }

    /// Walks a tree, whose triangles count from `first`. Returns false where the walk cannot tell,
    /// or exact arithmetic does not confirm what it is certain of.
    bool take(uint32_t header, uint32_t first, const LocalRay& local) {
        Named named;
        walk_in_floats(scene_, header, std::span(&local, 1), kAnyHit, &named);
        if (named.certain == OVC_FLAGGED)
            return false;
        const bool hits = named.certain != OVC_MISS;
        is_certain_ = kAnyHit && hits && p_.after.is_before_all();
        if (is_certain_)
            return true;
        const bool confirmed = !hits || offer(named.certain + first);
        for (uint32_t i = 0; i < named.count; ++i)
            offer(named.further[i] + first);
        return confirmed;
    }

    bool offer(uint32_t number) { return scene_.offer(nearest_, p_, scene_.numbers.id(number)); }

    const BuiltScene& scene_;
    const PreparedRay p_;
    const uint32_t skip_;
    Nearest nearest_;
    bool is_certain_ = false; // of some hit, which need not be offered
};

/// Returns the nearest hit of a valid ray, or with kAnyHit some hit. Any thread.
template <bool kAnyHit>
Hit answer_one(const BuiltScene& scene, const Ray& ray, const Exclusion& without) {
    OneRay<kAnyHit> one(scene, ray, without);
    const std::optional<Hit> hit = one.answer();
    return hit ? *hit : trace_exactly<kAnyHit>(scene, one.ray());
}

/// Answers all rays of a resolver's query for good; there are few.
template <class Query>
class FewRays {
public:
    static constexpr size_t kMax = kMaxFewRays;

    FewRays(const BuiltScene& scene, Resolver<Query>& resolver)
        : scene_(scene), resolver_(resolver), frame_(lanes_frame(resolver.scene_leaf())) {}

    void answer() {
        const size_t count = resolver_.query().rays.size();
        assert(count <= kMax);
        std::array<uint32_t, kMax> all;
        std::iota(all.begin(), all.end(), 0u);
        resolver_.in_lanes(std::span(all).first(count),
                           [&](RayStates& states, std::span<const uint32_t> rays, size_t) {
                               const uint32_t begin = resolver_.begins(states, rays);
                               if (scene_.top.portals.empty())
                                   gather(states, rays, begin);
                               else
                                   walk_by_parts(rays, begin);
                           });
        if (scene_.top.portals.empty())
            walk_in_floats(scene_, 0, std::span(local_).first(count_), Query::kAnyHit,
                           answers_.named.data());
        answers_.set_names(count_);
        resolver_.resolve(
            std::span(rays_).first(count_), answers_, 0,
            [](uint32_t, const Answer&) { return true; }, [](uint32_t, uint32_t, double) {});
    }

private:
    /// Takes those of the rays that have a bit in `which`, to walk all of them by turns.
    void gather(const RayStates& states, std::span<const uint32_t> rays, uint32_t which) {
        const std::optional<Portal>& way_in = scene_.top.way_in;
        LocalRows rows;
        to_tree_frame(frame_, way_in ? &*way_in : nullptr, states, which, rows);
        for (; which != 0; which &= which - 1) {
            const int lane = std::countr_zero(which);
            local_[count_] = local_ray_in(rows, lane);
            rays_[count_++] = rays[size_t(lane)];
        }
    }

    /// Walks them one by one, and takes those for doubles that this does not answer.
    void walk_by_parts(std::span<const uint32_t> rays, uint32_t which) {
        for (; which != 0; which &= which - 1) {
            const uint32_t i = rays[size_t(std::countr_zero(which))];
            OneRay<Query::kAnyHit> one(scene_, resolver_.query().rays[i], resolver_.exclusion(i));
            if (const std::optional<Hit> hit = one.answer()) {
                resolver_.enter(i, *hit);
            } else {
                answers_.named[count_] = {OVC_FLAGGED, 0, {}};
                rays_[count_++] = i;
            }
        }
    }

    const BuiltScene& scene_;
    Resolver<Query>& resolver_;
    const LanesFrame frame_;
    size_t count_ = 0; // of the rays that were taken
    std::array<uint32_t, kMax> rays_;
    std::array<LocalRay, kMax> local_;
    WalkAnswers<kMax> answers_;
};

} // namespace ovc

// SPDX-License-Identifier: Apache-2.0
// Writes rays in the layout that the kernel reads.
#include "gpu/trace/sent_rays.h"

#include "core/system/parallel.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstring>
#include <numeric>
#include <type_traits>

namespace ovc {
namespace {

/// The type of the elements of a vector.
template <class Rays>
using RayOf = typename std::remove_cvref_t<Rays>::value_type;

template <class Rays>
constexpr bool is_world = std::is_same_v<RayOf<Rays>, RayState>;

LocalRay no_ray() {
    LocalRay none{};
    none.t_end = OVC_NO_RAY;
    return none;
}

void set_none(RayState& ray) {
    ray = {};
}
void set_none(LocalRay& ray) {
    ray = no_ray();
}
void set_none(ResumedRay& ray) {
    ray = {no_ray(), 0, {}};
}

void write(LocalRay& to, const LocalRay& ray, uint32_t) {
    to = ray;
}
void write(ResumedRay& to, const LocalRay& ray, uint32_t asks) {
    to = {ray, asks & ~OVC_RAY_ANY_HIT, {}};
}

} // namespace

RayState RayStates::state(int lane) const {
    const auto vector = [&](const auto& v) { return dvec3(v[0][lane], v[1][lane], v[2][lane]); };
    return {{vector(rays.org), rays.from[lane], vector(rays.dir), rays.t_max[lane]},
            {},
            skip[size_t(lane)],
            asks[size_t(lane)]};
}

LanesFrame lanes_frame(const Leaf& leaf) {
    LanesFrame frame;
    frame.box = LanesBox(leaf.box);
    for (int axis = 0; axis < 3; ++axis)
        frame.origin[axis] = leaf.frame.origin[axis];
    frame.scale = leaf.frame.scale;
    frame.max_reach = OVC_MAX_LEAF_SIZES;
    frame.no_ray = OVC_NO_RAY;
    frame.undecidable = OVC_UNDECIDABLE;
    return frame;
}

LocalRay local_ray_in(const LocalRows& local, int lane) {
    static_assert(sizeof(local.rows[0]) == sizeof(LocalRay) &&
                  offsetof(LocalRay, org) == LocalRows::kOrg * sizeof(float) &&
                  offsetof(LocalRay, t_end) == LocalRows::kEnd * sizeof(float) &&
                  offsetof(LocalRay, dir) == LocalRows::kDir * sizeof(float) &&
                  offsetof(LocalRay, asks) == LocalRows::kWord * sizeof(float));
    LocalRay ray;
    std::memcpy(static_cast<void*>(&ray), local.rows[lane], sizeof(ray));
    return ray;
}

void to_tree_frame(const LanesFrame& scene, const Portal* way_in, const RayStates& states,
                   uint32_t which, LocalRows& local) {
    if (!way_in) {
        std::array<uint32_t, RayLanes::kCount> words;
        for (size_t lane = 0; lane < words.size(); ++lane)
            words[lane] = std::min<uint32_t>(states.skip[lane], OVC_SKIPS_NONE) |
                          (states.asks[lane] & OVC_RAY_ANY_HIT);
        to_frame(scene, states.rays, words.data(), local);
        return;
    }
    for (; which != 0; which &= which - 1) {
        const int lane = std::countr_zero(which);
        const RayState state = states.state(lane);
        LocalTime unused;
        const LocalRay ray = local_ray(*way_in, state.ray, state.skip, state.any_hit(), unused);
        std::memcpy(local.rows[lane], &ray, sizeof(ray));
    }
}

void SentRays::reset(const RayForm& form, size_t rays) {
    form_ = form;
    if (form.kind == RayForm::Kind::World) {
        if (rays_.index() != 2)
            rays_.emplace<2>();
    } else {
        const size_t index = form.kind == RayForm::Kind::Local ? 0 : 1;
        if (rays_.index() != index)
            index == 0 ? void(rays_.emplace<0>()) : void(rays_.emplace<1>());
        frame_ = lanes_frame(*form.scene);
    }
    parted_.clear();
    all_any_hit_ = false;
    std::visit([&](auto& all) { all.resize(std::max(all.size(), whole_blocks(rays))); }, rays_);
    set_size(rays);
}

void SentRays::set_size(size_t rays) {
    size_ = rays;
    std::visit(
        [&](auto& all) {
            assert(all.size() >= whole_blocks(rays));
            for (size_t i = rays; i < whole_blocks(rays); ++i)
                set_none(all[i]);
        },
        rays_);
}

size_t SentRays::put(size_t at, const RayStates& states, uint32_t which) {
    const bool is_local = form_.kind != RayForm::Kind::World;
    LocalRows local;
    if (is_local)
        to_tree_frame(frame_, form_.way_in, states, which, local);
    // Most calls are made of this: eight rays as they are.
    auto* const rows = std::get_if<PagedVector<LocalRay>>(&rays_);
    if (rows && which == RayLanes::first(RayLanes::kCount)) {
        std::memcpy(static_cast<void*>(&(*rows)[at]), local.rows, sizeof(local.rows));
        return RayLanes::kCount;
    }
    size_t i = at;
    const auto put_one = [&](auto& all, int lane) {
        if constexpr (is_world<decltype(all)>)
            all[i] = states.state(lane);
        else
            write(all[i], local_ray_in(local, lane), states.asks[size_t(lane)]);
        ++i;
    };
    std::visit(
        [&](auto& all) {
            for (uint32_t lanes = which; lanes != 0; lanes &= lanes - 1)
                put_one(all, std::countr_zero(lanes));
        },
        rays_);
    return i - at;
}

void SentRays::close_holes(size_t block_rays, std::span<const size_t> counts) {
    std::vector<size_t> places(counts.size());
    std::exclusive_scan(counts.begin(), counts.end(), places.begin(), size_t(0));
    constexpr size_t kBlocksPerTask = 32;
    const auto close = [&](auto& all, auto& copy) {
        copy.resize(std::max(copy.size(), all.size()));
        parallel_for(counts.size(), kBlocksPerTask, [&](size_t first, size_t last) {
            for (size_t b = first; b < last; ++b)
                std::copy_n(all.begin() + ptrdiff_t(b * block_rays), counts[b],
                            copy.begin() + ptrdiff_t(places[b]));
        });
        all.swap(copy);
    };
    if (!counts.empty() && places.back() < (counts.size() - 1) * block_rays) {
        std::visit(
            [&](auto& all) {
                using All = std::decay_t<decltype(all)>;
                if (!std::holds_alternative<All>(other_rays_))
                    other_rays_.emplace<All>();
                close(all, std::get<All>(other_rays_));
            },
            rays_);
    }
    set_size(counts.empty() ? 0 : places.back() + counts.back());
}

/// Returns ray i in the frame of the scene or of the top-level tree.
LocalRay SentRays::local_ray_of(size_t i) const {
    if (const auto* local = std::get_if<PagedVector<LocalRay>>(&rays_))
        return (*local)[i];
    if (const auto* resumed = std::get_if<PagedVector<ResumedRay>>(&rays_))
        return (*resumed)[i].ray;
    LocalTime unused;
    return local_ray(*form_.scene, std::get<PagedVector<RayState>>(rays_)[i].ray, OVC_NO_TRIANGLE,
                     false, unused);
}

bool SentRays::are_coherent() const {
    return coherent(size_, [&](size_t i) { return local_ray_of(i); });
}

bool SentRays::part(size_t max_slots) {
    assert(parted_.empty());
    return std::visit(
        [&](auto& all) {
            if constexpr (is_world<decltype(all)>) {
                return false;
            } else {
                all.resize(whole_blocks(size_));
                auto parted = part_packets(all, size_, max_slots);
                if (parted)
                    parted_ = std::move(*parted);
                return parted.has_value();
            }
        },
        rays_);
}

void SentRays::unpart() {
    if (parted_.empty())
        return;
    std::visit(
        [&](auto& all) {
            for (const auto& [ray, slot] : parted_)
                all[ray] = all[slot];
        },
        rays_);
    parted_.clear();
    set_size(size_);
}

std::span<const std::byte> SentRays::bytes() const {
    return std::visit(
        [&](const auto& all) { return std::as_bytes(std::span(all).first(whole_blocks(slots()))); },
        rays_);
}

SentRays SentRays::first(size_t rays) const {
    assert(parted_.empty() && rays <= size_);
    SentRays some;
    some.reset(form_, rays);
    some.all_any_hit_ = all_any_hit_;
    std::visit(
        [&](const auto& all) {
            auto& copy = std::get<std::remove_cvref_t<decltype(all)>>(some.rays_);
            std::copy_n(all.begin(), rays, copy.begin());
        },
        rays_);
    return some;
}

SentRays send(const RayForm& form, std::span<const RayState> states) {
    SentRays sent;
    sent.reset(form, states.size());
    sent.set_all_any_hit(std::ranges::all_of(states, &RayState::any_hit));
    for (size_t i = 0; i < states.size(); i += RayLanes::kCount) {
        const size_t count = std::min<size_t>(RayLanes::kCount, states.size() - i);
        RayStates some;
        some.set(count, 0, [&](size_t lane) { return &states[i + lane].ray; });
        for (size_t lane = 0; lane < count; ++lane) {
            some.skip[lane] = states[i + lane].skip;
            some.asks[lane] = states[i + lane].asks;
        }
        sent.put(i, some, RayLanes::first(count));
    }
    return sent;
}

} // namespace ovc

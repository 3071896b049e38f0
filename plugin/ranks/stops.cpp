// SPDX-License-Identifier: Apache-2.0
// Tests rays with the boxes of each rank: first a packet with all of them, then each of its rays
// with those that are left, where these are of several ranks.
#include "plugin/ranks/stops.h"

#include <algorithm>
#include <cassert>
#include <limits>
#include <map>

namespace ovc {

StopFinder::StopFinder(std::span<const OwnedBox> boxes, uint32_t here) : here_(here) {
    std::map<uint32_t, std::vector<Box>> of_owner;
    for (const OwnedBox& box : boxes)
        of_owner[box.owner].push_back(box.box);
    for (const auto& [owner, all] : of_owner)
        parts_.push_back({owner, BoxLanes(all)});
    for (const Part& part : parts_)
        all_.push_back(&part);
}

void StopFinder::find(std::span<const Ray> rays, std::vector<Stop>& stops,
                      std::span<uint32_t> ends) const {
    assert(!rays.empty() && rays.size() <= kPacket && ends.size() == rays.size());
    thread_local std::vector<Part> entered; // by the packet, and of their boxes those that are
    thread_local std::vector<const Part*> parts;
    const RayPacket packet(rays);
    parts = all_;
    if (packet.is_bounded()) {
        parts.clear();
        entered.resize(parts_.size());
        double t = kNoEntry;
        for (size_t i = 0; i < parts_.size(); ++i) {
            t = std::min(t, parts_[i].boxes.enter(packet, entered[i].boxes));
            entered[i].owner = parts_[i].owner;
            if (!entered[i].boxes.empty())
                parts.push_back(&entered[i]);
        }
        // To trace a ray here in vain costs about what finding it out does, unlike sending it away.
        const bool are_here =
            std::ranges::all_of(parts, [&](const Part* part) { return rank_of(*part) == here_; });
        if (are_here) {
            for (uint32_t& end : ends) {
                if (!parts.empty())
                    stops.push_back({t, here_});
                end = uint32_t(stops.size());
            }
            return;
        }
    }
    for (size_t i = 0; i < rays.size(); ++i) {
        if (packet.is_bounded() || rays[i].valid())
            find(rays[i], parts, stops);
        else
            stops.push_back({-std::numeric_limits<double>::infinity(), here_});
        ends[i] = uint32_t(stops.size());
    }
}

void StopFinder::find(const Ray& ray, std::span<const Part* const> parts,
                      std::vector<Stop>& stops) const {
    const EnteringRay entering(ray);
    const size_t first = stops.size();
    const auto from = [&] { return stops.begin() + ptrdiff_t(first); };
    for (const Part* part : parts) {
        const double t = part->boxes.enter(entering);
        if (t == kNoEntry)
            continue;
        const auto same = std::find_if(
            from(), stops.end(), [&](const Stop& stop) { return stop.rank == rank_of(*part); });
        if (same != stops.end())
            same->t = std::min(same->t, t);
        else
            stops.push_back({t, rank_of(*part)});
    }
    if (stops.size() > first + 1)
        std::sort(from(), stops.end(), [](const Stop& a, const Stop& b) {
            return a.t < b.t || (a.t == b.t && a.rank < b.rank);
        });
}

uint32_t StopFinder::first_owner(const Ray& ray) const {
    if (!ray.valid())
        return kNone;
    const EnteringRay entering(ray);
    double min = kNoEntry;
    uint32_t first = kNone;
    for (const Part& part : parts_)
        if (part.owner != kEveryRank)
            if (const double t = part.boxes.enter(entering); t < min)
                min = t, first = part.owner;
    return first;
}

} // namespace ovc

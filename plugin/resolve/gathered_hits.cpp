// SPDX-License-Identifier: Apache-2.0
// The hits are found in any order, then sorted: doubles tell most pairs apart, and exact arithmetic
// the others.
#include "plugin/resolve/gathered_hits.h"

#include "core/exact/refined.h"
#include "kdtree/approach.h"
#include "plugin/fallback/scene_walk.h"
#include "plugin/resolve/sifting.h"

#include <algorithm>
#include <optional>

namespace ovc {
namespace {

/// Returns the numbers of all triangles that the ray may meet, each once.
std::vector<uint32_t> numbers_near(const BuiltScene& scene, const PreparedRay& p) {
    std::vector<uint32_t> numbers;
    const Nearest nothing(p);
    const Approach approach(p, scene.level1.bounds);
    const auto note = [&](uint32_t number) {
        numbers.push_back(number);
        return false;
    };
    walk_scene(scene, approach.ray(), note, [&](double) { return approach.limit(nothing); });
    // Leaves share triangles.
    std::ranges::sort(numbers);
    const auto repeated = std::ranges::unique(numbers);
    numbers.erase(repeated.begin(), repeated.end());
    return numbers;
}

class GatheredHits {
public:
    GatheredHits(const BuiltScene& scene, const PreparedRay& p) : scene_(scene), p_(p) {
        if (p.after.is_before_all())
            return;
        const bool is_named = scene.soup.has(p.after.id);
        const Triangle after = is_named ? scene.soup.triangle(p.after.id) : Triangle();
        behind_.emplace(p, is_named ? &after : nullptr);
    }

    /// Adds the hits of the triangle and of those that it stands for.
    void add_set(TriangleId smallest) {
        add(smallest);
        for (TriangleId last = smallest;;) {
            const TriangleId next = scene_.next_duplicate(smallest, last);
            if (next == smallest)
                return;
            add(next);
            last = next;
        }
    }

    std::vector<Hit> sorted() {
        std::vector<uint32_t> order(found_.size());
        for (uint32_t i = 0; i < order.size(); ++i)
            order[i] = i;
        std::ranges::sort(order, [&](uint32_t a, uint32_t b) { return comes_before(a, b); });
        std::vector<Hit> hits;
        hits.reserve(order.size());
        for (const uint32_t i : order) {
            const TriangleId id = found_[i].hit.id;
            hits.push_back(rounded_hit(p_, scene_.soup.triangle(id), id, found_[i].support));
        }
        return hits;
    }

private:
    void add(TriangleId id) {
        const Triangle triangle = scene_.soup.triangle(id);
        std::optional<Candidate> found = candidate(p_, triangle, id);
        if (found && (!behind_ || behind_->has(*found, triangle)))
            found_.push_back(*found);
    }

    /// Keeps what the comparison finds out about both.
    bool comes_before(uint32_t a, uint32_t b) {
        if (a == b)
            return false;
        Candidate& first = found_[a];
        if (const int by_t = first.compare_t(found_[b]); by_t != 0)
            return by_t < 0;
        ComparedHit other(found_[b], scene_.soup.triangle(found_[b].hit.id));
        const int order = other.order(p_, first, scene_.soup.triangle(first.hit.id));
        found_[b] = other.found;
        return order < 0;
    }

    const BuiltScene& scene_;
    const PreparedRay& p_;
    std::optional<Behind> behind_;
    std::vector<Candidate> found_;
};

} // namespace

std::vector<Hit> gathered_hits(const BuiltScene& scene, const PreparedRay& p) {
    GatheredHits gathered(scene, p);
    for (const uint32_t number : numbers_near(scene, p))
        gathered.add_set(scene.numbers.id(number));
    return gathered.sorted();
}

Hit first_counting_hit(const BuiltScene& scene, const PreparedRay& p, const RaySieve& sieve) {
    for (const Hit& hit : gathered_hits(scene, p))
        if (counts(scene.soup, sieve, hit))
            return hit;
    return {};
}

} // namespace ovc

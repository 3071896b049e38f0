// SPDX-License-Identifier: Apache-2.0
// Cuts the pages, in the order of the scene, into stretches, and deals these out by the rays that
// are expected in them.
#include "plugin/ranks/shares.h"

#include "core/system/parallel.h"
#include "plugin/ranks/box_entry.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <functional>
#include <numeric>
#include <random>

namespace ovc {
namespace {

constexpr size_t kMaxTests =
    20'000'000; // of a box and a ray of the sample: some tenths of a second

/// Returns rays between random points on the box's sides, of which more come by larger things.
std::vector<Ray> random_lines(const Box& box, size_t count) {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> uniform;
    const auto point = [&] {
        dvec3 p;
        for (int axis = 0; axis < 3; ++axis)
            p[axis] = box.lo[axis] + uniform(random) * (box.hi[axis] - box.lo[axis]);
        const int axis = int(random() % 3);
        p[axis] = random() % 2 ? box.lo[axis] : box.hi[axis];
        return p;
    };
    std::vector<Ray> rays(count);
    for (Ray& ray : rays) {
        ray.org = point();
        ray.dir = point() - ray.org;
    }
    return rays;
}

/// Pages that a ray comes by, in order: so many at most, for few rays go on behind them.
constexpr size_t kMaxOnWay = 6;
using Way = std::array<uint32_t, kMaxOnWay>; // kNone behind the last

/// Returns the pages on the way of each ray that comes by any.
std::vector<Way> ways_of(std::span<const PageBox> boxes, std::span<const Ray> rays) {
    std::vector<Way> ways;
    std::vector<std::pair<double, uint32_t>> entries;
    for (const Ray& ray : rays) {
        if (!ray.valid())
            continue;
        entries.clear();
        const EnteringRay entering(ray);
        for (const PageBox& box : boxes)
            if (const double t = entering.entry(box.box); t != kNoEntry)
                entries.push_back({t, box.page});
        if (entries.empty())
            continue;
        std::ranges::sort(entries);
        Way& way = ways.emplace_back();
        way.fill(kNone);
        for (size_t i = 0; i < std::min(entries.size(), kMaxOnWay); ++i)
            way[i] = entries[i].second;
    }
    return ways;
}

/// The bytes of pages, and the rays that are expected to come by them. Half of those that come to a
/// page are taken to end there, since the pages do not tell where.
class Pages {
public:
    Pages(const BuiltScene& scene, std::vector<Way> ways)
        : ways_(std::move(ways)), rays_(scene.pages.size()) {
        for (const Page& page : scene.pages)
            bytes_.push_back(page.bytes());
        for (const Way& way : ways_) {
            double left = 1;
            for (size_t i = 0; i < kMaxOnWay && way[i] != kNone; ++i, left /= 2)
                rays_[way[i]] += left;
        }
    }

    /// Returns owners of the pages that have none yet: these are cut into `stretches` for each
    /// rank, of equal parts of the bytes and of the rays, which weigh `by_rays` of the whole. They
    /// are dealt out by the rays in them.
    std::vector<uint32_t> deal(std::vector<uint32_t> owners, uint32_t ranks, uint32_t stretches,
                               double by_rays) const {
        std::vector<double> weights(owners.size());
        const double all_bytes = sum(bytes_, owners), all_rays = sum(rays_, owners);
        for (size_t i = 0; i < owners.size(); ++i)
            if (owners[i] != kEveryRank)
                weights[i] = (1 - by_rays) * double(bytes_[i]) / std::max(all_bytes, 1.0) +
                             by_rays * rays_[i] / std::max(all_rays, 1e-9);
        const size_t count = size_t(ranks) * stretches;
        const double all = sum(weights, owners);
        std::vector<double> rays(count);
        std::vector<size_t> stretch(owners.size());
        double before = 0;
        for (size_t i = 0; i < owners.size(); ++i) {
            if (owners[i] == kEveryRank)
                continue;
            const double middle = (before + weights[i] / 2) / std::max(all, 1e-300);
            stretch[i] = std::min(size_t(middle * double(count)), count - 1);
            rays[stretch[i]] += rays_[i];
            before += weights[i];
        }
        const std::vector<uint32_t> owner = dealt(rays, ranks, stretches);
        for (size_t i = 0; i < owners.size(); ++i)
            if (owners[i] != kEveryRank)
                owners[i] = owner[stretch[i]];
        return owners;
    }

    /// Gives the pages of the most rays a byte to every rank, while there is room.
    void give_popular_to_all(uint64_t room, std::vector<uint32_t>& owners) const {
        std::vector<uint32_t> order(owners.size());
        std::iota(order.begin(), order.end(), 0u);
        const auto rays_a_byte = [&](uint32_t page) { return rays_[page] / double(bytes_[page]); };
        std::ranges::stable_sort(order, std::greater(), rays_a_byte);
        for (const uint32_t page : order)
            if (owners[page] != kEveryRank && rays_[page] > 0 && bytes_[page] <= room) {
                room -= bytes_[page];
                owners[page] = kEveryRank;
            }
    }

    /// Returns the largest share of a rank in the bytes or in the rays, where 1 is the mean.
    double max_bytes(std::span<const uint32_t> owners, uint32_t ranks) const {
        return max_share(bytes_, owners, ranks);
    }
    double max_rays(std::span<const uint32_t> owners, uint32_t ranks) const {
        return max_share(rays_, owners, ranks);
    }
    /// Returns how many ranks a ray visits after its first one.
    double further_visits(std::span<const uint32_t> owners) const {
        double visits = 0;
        for (const Way& way : ways_) {
            double left = 1;
            for (size_t i = 0; i < kMaxOnWay && way[i] != kNone; ++i, left /= 2) {
                const auto same = [&](uint32_t page) { return owners[page] == owners[way[i]]; };
                if (i > 0 && owners[way[i]] != kEveryRank &&
                    std::none_of(way.begin(), way.begin() + ptrdiff_t(i), same))
                    visits += left;
            }
        }
        return visits / double(std::max<size_t>(ways_.size(), 1));
    }

private:
    template <class T>
    static double sum(const std::vector<T>& values, std::span<const uint32_t> owners) {
        double all = 0;
        for (size_t i = 0; i < owners.size(); ++i)
            all += owners[i] == kEveryRank ? 0 : double(values[i]);
        return all;
    }
    template <class T>
    static double max_share(const std::vector<T>& values, std::span<const uint32_t> owners,
                            uint32_t ranks) {
        std::vector<double> has(ranks);
        for (size_t i = 0; i < owners.size(); ++i)
            if (owners[i] != kEveryRank)
                has[owners[i]] += double(values[i]);
        const double all = sum(values, owners);
        return all > 0 ? *std::ranges::max_element(has) * ranks / all : 1;
    }

    /// Gives each rank so many stretches: that of the most rays to the rank of the fewest so far.
    static std::vector<uint32_t> dealt(std::span<const double> rays, uint32_t ranks,
                                       uint32_t stretches) {
        std::vector<uint32_t> order(rays.size()), owner(rays.size()), has(ranks);
        std::iota(order.begin(), order.end(), 0u);
        std::ranges::stable_sort(order, [&](uint32_t a, uint32_t b) { return rays[a] > rays[b]; });
        std::vector<double> load(ranks);
        for (const uint32_t s : order) {
            uint32_t min = kNone;
            for (uint32_t rank = 0; rank < ranks; ++rank)
                if (has[rank] < stretches && (min == kNone || load[rank] < load[min]))
                    min = rank;
            owner[s] = min;
            ++has[min];
            load[min] += rays[s];
        }
        return owner;
    }

    std::vector<Way> ways_;
    std::vector<uint64_t> bytes_;
    std::vector<double> rays_;
};

/// Tries long and short stretches, by bytes and by rays, and returns the owners with which a
/// picture should take least: the busiest rank's rays, and the visits from rank to rank, each of
/// which costs about what tracing one does. Ranks keep about the same bytes in any case.
std::vector<uint32_t> best_owners(const Pages& pages, const std::vector<uint32_t>& owners,
                                  uint32_t ranks) {
    constexpr double kMaxBytes = 1.15; // of the mean
    std::vector<uint32_t> best;
    double min_cost = 0;
    for (const uint32_t stretches : {4u, 2u, 1u})
        for (const double by_rays : {0.0, 0.25, 0.5, 0.75}) {
            std::vector<uint32_t> tried = pages.deal(owners, ranks, stretches, by_rays);
            const double over = std::max(pages.max_bytes(tried, ranks) - kMaxBytes, 0.0);
            const double cost =
                pages.max_rays(tried, ranks) + pages.further_visits(tried) + 1000 * over;
            if (best.empty() || cost < min_cost)
                best = std::move(tried), min_cost = cost;
        }
    return best;
}

} // namespace

/// Gives the pages of meshes that are placed several times to every rank, while there is room.
/// Returns the room that is left.
static uint64_t give_instances_to_all(const BuiltScene& scene, uint64_t room,
                                      std::vector<uint32_t>& owners) {
    std::vector<const SharedMesh*> meshes;
    for (const SharedMesh& mesh : scene.shared)
        if (mesh.places.size() > 1)
            meshes.push_back(&mesh);
    std::ranges::stable_sort(meshes, [](const SharedMesh* a, const SharedMesh* b) {
        return a->places.size() > b->places.size();
    });
    for (const SharedMesh* mesh : meshes) {
        const uint64_t bytes = mesh->scene.level2_bytes();
        if (bytes > room)
            continue;
        room -= bytes;
        std::fill_n(owners.begin() + mesh->first_page, mesh->scene.pages.size(), kEveryRank);
    }
    return room;
}

std::vector<uint32_t> share_out(const BuiltScene& scene, std::span<const PageBox> boxes,
                                const ShareOptions& options) {
    assert(options.ranks > 0);
    std::vector<uint32_t> owners(scene.pages.size(), 0);
    // E bytes everywhere of T in all leave (T - E) / N + E to each of N ranks: a part, and an N-th
    // of it, where E is T / (N (N - 1)).
    const uint64_t ranks = options.ranks;
    const uint64_t max_everywhere = ranks > 1 ? scene.level2_bytes() / (ranks * (ranks - 1)) : 0;
    const uint64_t room =
        give_instances_to_all(scene, std::min(options.everywhere_bytes, max_everywhere), owners);
    Box around;
    for (const PageBox& box : boxes)
        around.add(box.box);
    const size_t max_rays =
        std::clamp<size_t>(kMaxTests / std::max<size_t>(boxes.size(), 1), 64, 4096);
    std::vector<Ray> rays;
    if (options.sample.empty() && !around.empty())
        rays = random_lines(around, max_rays);
    const size_t step = std::max<size_t>(options.sample.size() / max_rays, 1);
    for (size_t i = 0; i < options.sample.size(); i += step)
        rays.push_back(options.sample[i]);
    const Pages pages(scene, ways_of(boxes, rays));
    pages.give_popular_to_all(room, owners);
    return best_owners(pages, owners, options.ranks);
}

} // namespace ovc

// SPDX-License-Identifier: Apache-2.0
// Cuts the pages, in the order of the scene, into stretches of equal bytes, and deals these out by
// the rays that are expected in them.
#include "plugin/ranks/shares.h"

#include "core/system/parallel.h"
#include "plugin/ranks/box_entry.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <numeric>
#include <random>

namespace ovc {
namespace {

constexpr uint32_t kStretches = 4; // that each rank gets
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

/// Returns how many of the rays are expected in each page. Half of those that come to a page are
/// taken to end there, since the pages do not tell where.
std::vector<double> expected_rays(std::span<const PageBox> boxes, size_t pages,
                                  std::span<const Ray> rays) {
    std::vector<double> expected(pages);
    std::vector<std::pair<double, uint32_t>> entries;
    for (const Ray& ray : rays) {
        if (!ray.valid())
            continue;
        entries.clear();
        const EnteringRay entering(ray);
        for (const PageBox& box : boxes)
            if (const double t = entering.entry(box.box); t != kNoEntry)
                entries.push_back({t, box.page});
        std::ranges::sort(entries);
        double left = 1;
        for (const auto& [t, page] : entries)
            expected[page] += left, left /= 2;
    }
    return expected;
}

/// Whose bytes and rays are dealt out.
struct Pages {
    std::vector<uint64_t> bytes;
    std::vector<double> rays;
};

/// Deals out the pages that have no owner yet.
void deal(const Pages& pages, uint32_t ranks, std::vector<uint32_t>& owners) {
    uint64_t all = 0;
    for (size_t i = 0; i < owners.size(); ++i)
        all += owners[i] == kEveryRank ? 0 : pages.bytes[i];
    const size_t count = size_t(ranks) * kStretches;
    std::vector<double> rays(count);
    std::vector<size_t> stretch(owners.size());
    uint64_t before = 0;
    for (size_t i = 0; i < owners.size(); ++i) {
        if (owners[i] == kEveryRank)
            continue;
        const double middle = double(before) + double(pages.bytes[i]) / 2;
        stretch[i] = std::min(size_t(middle / double(all) * double(count)), count - 1);
        rays[stretch[i]] += pages.rays[i];
        before += pages.bytes[i];
    }
    std::vector<uint32_t> order(count), owner(count), has(ranks);
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::stable_sort(order, [&](uint32_t a, uint32_t b) { return rays[a] > rays[b]; });
    std::vector<double> load(ranks);
    for (const uint32_t s : order) {
        uint32_t least = kNone;
        for (uint32_t rank = 0; rank < ranks; ++rank)
            if (has[rank] < kStretches && (least == kNone || load[rank] < load[least]))
                least = rank;
        owner[s] = least;
        ++has[least];
        load[least] += rays[s];
    }
    for (size_t i = 0; i < owners.size(); ++i)
        if (owners[i] != kEveryRank)
            owners[i] = owner[stretch[i]];
}

} // namespace

std::vector<PageBox> page_boxes(const BuiltScene& scene) {
    std::vector<PageBox> boxes;
    const auto around = [](const Level1& level1, const Leaf& leaf) {
        return leaf.box.padded(level1.padding + leaf.box.rounding());
    };
    for (size_t i = 0; i < scene.level1.leaves.size(); ++i)
        boxes.push_back({around(scene.level1, scene.level1.leaves[i]), uint32_t(i)});
    for (const SharedMesh& mesh : scene.shared)
        for (size_t i = 0; i < mesh.scene.level1.leaves.size(); ++i)
            for (const uint32_t place : mesh.places) {
                const Level1& level1 = mesh.scene.level1;
                // Leaves of a mesh at rest lie where it came to rest.
                const Box box = mesh.rest ? mesh.box : around(level1, level1.leaves[i]);
                boxes.push_back({placed_box(box, scene.soup.chunks[place].transform()),
                                 mesh.first_page + uint32_t(i)});
            }
    return boxes;
}

/// Gives the pages of meshes that are placed several times to every rank, while there is room.
static void give_to_all(const BuiltScene& scene, uint64_t room, std::vector<uint32_t>& owners) {
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
}

std::vector<uint32_t> share_out(const BuiltScene& scene, std::span<const PageBox> boxes,
                                const ShareOptions& options) {
    assert(options.ranks > 0);
    std::vector<uint32_t> owners(scene.pages.size(), 0);
    give_to_all(scene, options.everywhere_bytes, owners);
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
    Pages pages{{}, expected_rays(boxes, owners.size(), rays)};
    for (const Page& page : scene.pages)
        pages.bytes.push_back(page.bytes());
    deal(pages, options.ranks, owners);
    return owners;
}

} // namespace ovc

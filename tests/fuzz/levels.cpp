// SPDX-License-Identifier: Apache-2.0
// fuzz_levels: through the exact fallback, which walks level 1 and pages as the kernel does;
// mapped, and on a disk.
#include "tests/fuzz/levels.h"

#include "core/file/test_archive.h"
#include "kdtree/test_soups.h"
#include "plugin/build/level2.h"
#include "plugin/build/restored_levels.h"
#include "plugin/build/saved_levels.h"
#include "plugin/fallback/exact_fallback.h"
#include "plugin/leaf_store/leaf_store.h"
#include "tests/fuzz/require.h"

#include <algorithm>
#include <cstring>

namespace ovc {

BuiltScene build_for_test(const Soup& soup, const LeafLimits& limits) {
    BuiltScene scene(soup);
    scene.limits = limits;
    const Hittable hittable = take_hittable(scene);
    require(bool(build_levels(scene, hittable)));
    scene.top = build_top_level(scene.level1, scene.pages, scene.pages.size());
    return scene;
}

namespace {

/// A soup with duplicates, its saved levels, and rays to ask.
struct Subject {
    static constexpr LeafLimits kLimits{30, 1 << 20};

    Soup soup = test::random_soup(5, 120, 0.3);
    test::ArchiveMemory saved;
    std::vector<Ray> rays;

    Subject() {
        std::vector<vec3> corners(soup.chunks[0].corners().begin(), soup.chunks[0].corners().end());
        corners.insert(corners.end(), corners.begin(), corners.begin() + 30);
        soup.chunks[0] = Chunk::owning(soup.chunks[0].origin(), std::move(corners));
        require(save_levels(build_for_test(soup, kLimits), saved.sink()));
        rays = test::unpleasant_rays(soup, 9, 40);
    }
};

void trace(const Subject& subject, const BuiltScene& scene) {
    require(scene.pages.size() == scene.level1.leaves.size());
    for (const Ray& ray : subject.rays) {
        if (!ray.valid())
            continue;
        const PreparedRay prepared(ray);
        const Hit hit = trace_exactly</* kAnyHit= */ false>(scene, prepared);
        require(!hit.is_hit() || hit.id.prim < subject.soup.chunks[0].size());
        trace_exactly</* kAnyHit= */ true>(scene, prepared);
    }
}

/// Makes the checksums of pages right, as far as the archive says where these are.
void reseal_pages(test::ArchiveMemory& memory) {
    if (memory.size() < kPartAlignment)
        return;
    uint32_t version = 0;
    std::memcpy(&version, memory.data() + 16, sizeof(version));
    const auto archive = Archive::open(memory.bytes(), "ovc levels", version);
    if (!archive)
        return;
    const auto pages = archive->items<SavedPage>("pages");
    Bytes texels = archive->unchecked("texels");
    if (!pages)
        return;
    const auto first = reinterpret_cast<const std::byte*>(pages->data()) - memory.bytes().data();
    for (size_t i = 0; i < pages->size(); ++i) {
        SavedPage page = (*pages)[i];
        if (page.texels > texels.size() / sizeof(uvec4))
            break;
        page.checksum = checksum_of(texels.first(page.texels * sizeof(uvec4)));
        texels = texels.subspan(page.texels * sizeof(uvec4));
        std::memcpy(memory.data() + first + i * sizeof(SavedPage), &page, sizeof(page));
    }
    test::reseal(memory);
}

/// Opens the same bytes as levels on a disk, whose pages are read as rays come to them.
void trace_stored(const Subject& subject, const test::ArchiveMemory& memory) {
    const Bytes corners = bytes_of(subject.soup.chunks[0].corners());
    const auto read = [&](uint64_t offset, std::span<std::byte> to) {
        if (offset > memory.size() || to.size() > memory.size() - offset)
            return false;
        std::ranges::copy(memory.bytes().subspan(offset, to.size()), to.begin());
        return true;
    };
    const auto read_corners = [&](uint64_t first, uint64_t count, void* to) {
        std::memcpy(to, corners.data() + 36 * first, 36 * count);
        return true;
    };
    LeafStore store(64 << 20, read, memory.size());
    Soup soup;
    const uint32_t triangles = subject.soup.chunks[0].size();
    soup.chunks.push_back(Chunk::stored(subject.soup.chunks[0].origin(),
                                        store.add_mesh(triangles, false, read_corners), triangles));
    Result<BuiltScene> scene = open_stored_levels(store, soup);
    if (!scene) {
        require(!scene.error().message.empty());
        return;
    }
    scene->top = build_top_level(scene->level1, scene->pages, scene->pages.size());
    trace(subject, *scene);
}

} // namespace

void fuzz_levels(const uint8_t* data, size_t size) {
    static const Subject subject;
    if (size == 0)
        return;
    test::ArchiveMemory memory(subject.saved.bytes());
    test::damage(memory, {data + 1, size - 1});
    if (data[0] % 2) {
        test::reseal(memory);
        reseal_pages(memory);
    }
    trace_stored(subject, memory);
    auto found = restore_levels(memory.bytes(), subject.soup,
                                [](uint64_t, uint64_t) { return Subject::kLimits; });
    if (!found)
        require(!found.error().message.empty());
    if (!found || !*found)
        return;
    BuiltScene& scene = **found;
    scene.top = build_top_level(scene.level1, scene.pages, scene.pages.size());
    trace(subject, scene);
}

} // namespace ovc

// SPDX-License-Identifier: Apache-2.0
// Systems: chooses among them by their number in the ABI.
#include "plugin/thesis/system.h"

#include "core/system/parallel.h"
#include "core/text/format_text.h"
#include "gpu/page/page.h"
#include "plugin/thesis/grid.h"
#include "plugin/thesis/kd_texels.h"
#include "plugin/thesis/skip_bvh.h"
#include "shaders/layout.h"

#include <cassert>
#include <iterator>

namespace ovc::thesis {

const char* name_of(ovc_structure structure) {
    constexpr const char* names[] = {"two-level",  "single-texture", "multi-texture",   "gpu-grid",
                                     "gpu-kdtree", "skip-bvh",       "thesis-two-level"};
    assert(size_t(structure) < std::size(names));
    return names[structure];
}

/// Returns the product's page over the whole scene.
static Result<System> build_page_system(const Soup& soup, const Leaf& whole,
                                        BuildProgress* progress) {
    Page page = build_page(soup, whole, progress);
    if (page.units() >= OVC_MAX_PAGE_UNITS)
        return over_budget(
            format_text("a BVH of {} bytes is more than its nodes can name: {} bytes", page.bytes(),
                        uint64_t(OVC_MAX_PAGE_UNITS) * OVC_UNIT_BYTES));
    const uint32_t depth = stack_depth({&page, 1});
    const uint64_t units = page.units();
    return System{std::move(page.texels), whole.triangles.size(), depth, units};
}

Result<System> build_system(ovc_structure structure, const Soup& soup, const Leaf& whole,
                            BuildProgress* progress) {
    assert(!whole.triangles.empty());
    switch (structure) {
    case OVC_STRUCTURE_GPU_GRID:
        return build_grid(soup, whole, progress);
    case OVC_STRUCTURE_GPU_KD_TREE:
        return build_kd_texels(soup, whole, progress);
    case OVC_STRUCTURE_SKIP_BVH:
        return build_skip_bvh(soup, whole, progress);
    default:
        return build_page_system(soup, whole, progress);
    }
}

uint64_t work_of(ovc_structure structure, uint64_t triangles) {
    switch (structure) {
    case OVC_STRUCTURE_GPU_GRID:
    case OVC_STRUCTURE_GPU_KD_TREE:
        return triangles;
    case OVC_STRUCTURE_SKIP_BVH:
        return kShuffles * triangles;
    default:
        return 2 * triangles;
    }
}

uint64_t min_bytes(ovc_structure structure, uint64_t triangles) {
    const bool pairs =
        structure == OVC_STRUCTURE_SINGLE_TEXTURE || structure == OVC_STRUCTURE_MULTI_TEXTURE;
    // A pair is a unit, and four units have a node; in the others a triangle is three texels.
    return pairs ? triangles * OVC_UNIT_BYTES * 5 / 8 : triangles * 3 * sizeof(uvec4);
}

std::vector<LocalTriangle> local_triangles(const Soup& soup, const Leaf& whole) {
    std::vector<LocalTriangle> triangles(whole.triangles.size());
    parallel_for(triangles.size(), 4096, [&](size_t first, size_t last) {
        for (size_t i = first; i < last; ++i) {
            const Triangle world = soup.triangle(whole.triangles[i]);
            for (int k = 0; k < 3; ++k)
                triangles[i][k] = vec3(whole.frame.to_local(world[k]));
        }
    });
    return triangles;
}

void append(Texels& texels, const LocalTriangle& triangle, uint32_t id, uint32_t mark) {
    texels.push_back(texel(triangle[0], id | mark));
    texels.push_back(texel(triangle[1]));
    texels.push_back(texel(triangle[2]));
}

} // namespace ovc::thesis

// SPDX-License-Identifier: Apache-2.0
// Where triangles overlap, no plane parts them: they are parted in the order of a space-filling
// curve through their centres, by a sample.
#include "plugin/out_of_core/cell_parts.h"

#include "core/corner_hash.h"
#include "plugin/out_of_core/source_blocks.h"

#include <algorithm>
#include <cassert>
#include <compare>
#include <vector>

namespace ovc {
namespace {

/// A part is to hold a third of what can be built at once, and is known from so many triangles of
/// the sample, so that none holds more than can be built, but by a chance of 10^-9.
constexpr uint64_t kPartsAtOnce = 3;
constexpr uint64_t kDrawnOfPart = 64;

/// Puts the lowest 21 bits of x to every third bit.
uint64_t spread(uint64_t x) {
    x &= 0x1fffff;
    x = (x | x << 32) & 0x1f00000000ffff;
    x = (x | x << 16) & 0x1f0000ff0000ff;
    x = (x | x << 8) & 0x100f00f00f00f00f;
    x = (x | x << 4) & 0x10c30c30c30c30c3;
    return (x | x << 2) & 0x1249249249249249;
}

/// The place of a triangle in the order that parts are made in. Duplicates follow each other.
struct Key {
    uint64_t place;
    uint64_t hash;
    TriangleId name;

    auto operator<=>(const Key&) const = default;
};

class PartDealer {
public:
    PartDealer(const DealtCells& from, size_t cell, std::span<const SourceMesh> meshes)
        : from_(from),
          cell_(cell),
          meshes_(meshes),
          lo_(from.bounds(cell).lo),
          scale_(dvec3((1 << 21) - 1) / glm::max(from.bounds(cell).extent(), dvec3(1e-300))) {}

    /// Returns the first keys of all parts but the first.
    std::vector<Key> ends(size_t parts) const {
        const uint64_t rate = std::max<uint64_t>(from_.count(cell_) / (parts * kDrawnOfPart), 1);
        std::vector<Key> drawn;
        each([&](const Key& key, Bytes, const Triangle&) {
            if (mix(uint64_t(key.name.mesh) << 32 | key.name.prim) % rate == 0)
                drawn.push_back(key);
        });
        std::ranges::sort(drawn);
        std::vector<Key> found;
        for (size_t part = 1; part < parts && !drawn.empty(); ++part) {
            Key end = drawn[drawn.size() * part / parts];
            // Duplicates stay together, unless the part before has none but them.
            if (found.empty() || found.back().place != end.place || found.back().hash != end.hash)
                end.name = {0, 0};
            found.push_back(end);
        }
        return found;
    }

    void deal(std::span<const Key> ends, DealtCells& to, size_t first) const {
        each([&](const Key& key, Bytes corners, const Triangle& triangle) {
            const auto part = size_t(std::ranges::upper_bound(ends, key) - ends.begin());
            to.add(first + part, key.name, corners, bounds_of(triangle));
        });
    }

private:
    template <class Visit>
    void each(Visit&& visit) const {
        from_.for_each(cell_, [&](TriangleId name, Bytes corners) {
            const Triangle triangle = borrowed_chunk(meshes_[name.mesh], corners).triangle(0);
            visit(Key{place_of(triangle), triangle_hash(triangle), name}, corners, triangle);
        });
    }

    uint64_t place_of(const Triangle& triangle) const {
        const dvec3 at = glm::max((bounds_of(triangle).center() - lo_) * scale_, dvec3(0));
        return spread(uint64_t(at.x)) | spread(uint64_t(at.y)) << 1 | spread(uint64_t(at.z)) << 2;
    }

    const DealtCells& from_;
    const size_t cell_;
    const std::span<const SourceMesh> meshes_;
    const dvec3 lo_, scale_;
};

} // namespace

size_t parts_of_cell(uint64_t triangles, uint64_t max_triangles) {
    assert(max_triangles > 0);
    return triangles <= max_triangles ? 0 : size_t(triangles * kPartsAtOnce / max_triangles + 1);
}

void deal_to_parts(const DealtCells& from, size_t cell, std::span<const SourceMesh> meshes,
                   DealtCells& to, size_t first, size_t parts) {
    assert(parts > 0 && first + parts <= to.cells());
    const PartDealer dealer(from, cell, meshes);
    dealer.deal(dealer.ends(parts), to, first);
    for (size_t part = first; part < first + parts; ++part)
        to.flush(part);
}

} // namespace ovc

// SPDX-License-Identifier: Apache-2.0
// Numbering: names each triangle of a soup by one 32-bit number.
#pragma once

#include "core/soup.h"

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <vector>

namespace ovc {

/// Counts triangles in the order of their ids. The soup must have fewer than 2^32 of them.
class Numbering {
public:
    Numbering() = default;
    /// first: of the first triangle.
    explicit Numbering(const Soup& soup, uint32_t first = 0) : first_{first} { append(soup); }

    /// Numbers the triangles of chunks that the soup has got since. Those before keep theirs. Takes
    /// time in proportion to all chunks.
    void append(const Soup& soup) {
        first_.reserve(soup.chunks.size() + 1);
        for (size_t mesh = meshes(); mesh < soup.chunks.size(); ++mesh)
            first_.push_back(first_.back() + soup.chunks[mesh].size());
        find_stretches();
    }
    uint64_t meshes() const { return first_.size() - 1; }
    uint32_t first() const { return first_.front(); }
    /// Returns the number behind the last that is given, also to chunks that are empty now.
    uint64_t count() const { return first_.back(); }

    uint32_t of(TriangleId id) const {
        assert(id.mesh < meshes() && id.prim < first_[id.mesh + 1] - first_[id.mesh]);
        return first_[id.mesh] + id.prim;
    }

    TriangleId id(uint32_t number) const {
        assert(number < first_.back());
        if (first_.size() == 2)
            return {0, number - first_.front()};
        const uint32_t stretch = (number - first_.front()) >> stretch_bits_;
        const uint32_t mesh = mesh_of(number, mesh_at_[stretch], mesh_at_[stretch + 1]);
        return {mesh, number - first_[mesh]};
    }

private:
    /// Returns the last chunk, of these, that begins at or before the number: that one holds it,
    /// and empty ones may precede.
    uint32_t mesh_of(uint32_t number, uint32_t from, uint32_t to) const {
        const auto begin = first_.begin();
        return uint32_t(std::upper_bound(begin + from + 1, begin + to + 1, number) - begin) - 1;
    }

    void find_stretches() {
        mesh_at_.clear();
        if (meshes() < 2 || count() == first())
            return;
        const uint64_t numbers = count() - first();
        const uint64_t max_stretches = std::max(meshes(), kMinStretches);
        for (stretch_bits_ = 0; numbers >> stretch_bits_ > max_stretches;)
            ++stretch_bits_;
        const uint32_t last = uint32_t(meshes()) - 1;
        uint32_t mesh = 0;
        for (uint64_t number = first(); number < count(); number += uint64_t(1) << stretch_bits_) {
            while (mesh < last && first_[mesh + 1] <= number)
                ++mesh;
            mesh_at_.push_back(mesh);
        }
        mesh_at_.push_back(last);
    }

    std::vector<uint32_t> first_{0}; // of each chunk, and behind the last the count of all
    // Numbers are cut into stretches of 2^stretch_bits_, about as many as there are chunks, so that
    // id() looks at few of these. Where there are few chunks, so many stretches nearly always hold
    // one alone, and nothing is searched.
    static constexpr uint64_t kMinStretches = 1024;
    uint32_t stretch_bits_ = 0;
    std::vector<uint32_t> mesh_at_; // that holds the first number of a stretch; behind, the last
};

} // namespace ovc

// SPDX-License-Identifier: Apache-2.0
#include "importers/pov/shapes/implicit.h"

#include "core/system/parallel.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace ovc::pov {

namespace {

using Cell = std::array<int, 3>;
using FieldValue = std::function<double(const dvec3&)>;

/// The field's values at the corners of cubic cells. The outermost corners always count as outside.
class Samples {
public:
    /// Cells beyond the box on each side.
    static constexpr int kMargin = 2;

    Samples(const Field& field, const Box& box, int cells)
        : step_(std::max(max_component(box.extent()), 1e-12) / cells) {
        assert(cells > 0);
        const dvec3 center = box.center();
        for (int i = 0; i < 3; ++i) {
            const int wanted = int(std::ceil(box.extent()[i] / step_ - 1e-6));
            counts_[size_t(i)] = std::max(wanted, 1) + 2 * kMargin;
            origin_[i] = center[i] - 0.5 * step_ * counts_[size_t(i)];
        }
        values_.resize(size_t(counts_[0] + 1) * size_t(counts_[1] + 1) * size_t(counts_[2] + 1));
        fill(field);
    }

    const Cell& counts() const { return counts_; } // of cells
    double step() const { return step_; }
    dvec3 place(const Cell& c) const { return origin_ + step_ * dvec3(c[0], c[1], c[2]); }
    double at(const Cell& c) const { return values_[index(c)]; }
    bool is_inside(const Cell& c) const { return at(c) < 0; }
    size_t index(const Cell& c) const {
        return (size_t(c[2]) * size_t(counts_[1] + 1) + size_t(c[1])) * size_t(counts_[0] + 1) +
               size_t(c[0]);
    }
    /// Returns a function with the field's values in and around a cell.
    const FieldValue& value_near(const Cell& cell) const { return field_in_[block_of(cell)]; }
    bool is_outermost(const Cell& cell) const {
        for (size_t i = 0; i < 3; ++i)
            if (cell[i] == 0 || cell[i] == counts_[i] - 1)
                return true;
        return false;
    }

private:
    static constexpr int kBlock = 8;

    size_t block_of(const Cell& c) const {
        return (size_t(c[2] / kBlock) * size_t(blocks_[1]) + size_t(c[1] / kBlock)) *
                   size_t(blocks_[0]) +
               size_t(c[0] / kBlock);
    }

    void fill(const Field& field) {
        for (size_t i = 0; i < 3; ++i)
            blocks_[i] = counts_[i] / kBlock + 1;
        field_in_.resize(size_t(blocks_[0]) * size_t(blocks_[1]) * size_t(blocks_[2]));
        parallel_for(field_in_.size(), 1, [&](size_t first, size_t last) {
            for (size_t b = first; b < last; ++b) {
                const int i = int(b);
                fill_block(field, {i % blocks_[0] * kBlock, i / blocks_[0] % blocks_[1] * kBlock,
                                   i / blocks_[0] / blocks_[1] * kBlock});
            }
        });
    }

    void fill_block(const Field& field, const Cell& lo) {
        Cell hi;
        for (size_t i = 0; i < 3; ++i)
            hi[i] = std::min(lo[i] + kBlock - 1, counts_[i]);
        FieldValue& value = field_in_[block_of(lo)];
        // The block's cells reach a step farther, and corner_in() moves corners a little further.
        value = field.within ? field.within(Box{place(lo), place(hi)}.padded(1.5 * step_))
                             : field.value;
        Cell c;
        for (c[2] = lo[2]; c[2] <= hi[2]; ++c[2])
            for (c[1] = lo[1]; c[1] <= hi[1]; ++c[1])
                for (c[0] = lo[0]; c[0] <= hi[0]; ++c[0]) {
                    bool is_rim = false;
                    for (size_t i = 0; i < 3; ++i)
                        is_rim = is_rim || c[i] == 0 || c[i] == counts_[i];
                    const double v = is_rim ? 1 : value(place(c));
                    values_[index(c)] = std::isfinite(v) ? v : 1;
                }
    }

    double step_;
    dvec3 origin_;
    Cell counts_, blocks_{};
    std::vector<double> values_;
    std::vector<FieldValue> field_in_; // one for each block
};

dvec3 gradient(const FieldValue& field, const dvec3& p, double step) {
    dvec3 g;
    for (int i = 0; i < 3; ++i) {
        dvec3 h(0);
        h[i] = step;
        g[i] = (field(p + h) - field(p - h)) / (2 * step);
    }
    return g;
}

/// Returns a point of the surface in or near the cell. Where the search for one fails it is near
/// the middle of the points where the surface crosses the cell's edges.
Corner corner_in(const Samples& samples, const Cell& cell) {
    const FieldValue& field = samples.value_near(cell);
    dvec3 sum(0);
    int count = 0;
    for (int axis = 0; axis < 3; ++axis)
        for (int k = 0; k < 4; ++k) {
            Cell a = cell;
            a[size_t((axis + 1) % 3)] += k & 1;
            a[size_t((axis + 2) % 3)] += k >> 1;
            Cell b = a;
            ++b[size_t(axis)];
            if (samples.is_inside(a) == samples.is_inside(b))
                continue;
            const double va = samples.at(a), vb = samples.at(b);
            sum += glm::mix(samples.place(a), samples.place(b), va / (va - vb));
            ++count;
        }
    assert(count > 0);
    dvec3 p = sum / double(count);
    if (samples.is_outermost(cell))
        return {p, dvec3(0)};
    const dvec3 lo = samples.place(cell) - 0.25 * samples.step(),
                hi = samples.place(cell) + 1.25 * samples.step();
    const double fine = 1e-4 * samples.step();
    for (int turn = 0; turn < 4; ++turn) {
        const double value = field(p);
        const dvec3 g = gradient(field, p, fine);
        const double square = glm::dot(g, g);
        if (!(square > 0) || !std::isfinite(value / square))
            break;
        const dvec3 next = glm::clamp(p - value / square * g, lo, hi);
        // Where the field is far from a distance, a step may lead away from the surface.
        if (!(std::abs(field(next)) < std::abs(value)))
            break;
        p = next;
    }
    const dvec3 g = gradient(field, p, fine);
    const double length = glm::length(g);
    return {p, length > 0 && std::isfinite(length) ? g / length : dvec3(0)};
}

} // namespace

// Each cell that the surface crosses gets a corner, and each edge of the grid that it crosses a
// quad of the corners around. At each face of a cell the quads' edges cancel out: it is closed.
size_t cut_field(const Field& field, const Box& box, int cells, Facets& out) {
    if (box.empty() || !is_finite(box.extent()))
        return 0;
    const Samples samples(field, box, cells);
    const Cell& counts = samples.counts();
    std::vector<Cell> crossed;
    std::vector<int32_t> numbers(
        (size_t(counts[0]) + 1) * size_t(counts[1] + 1) * size_t(counts[2] + 1), -1);
    Cell c;
    for (c[2] = 0; c[2] < counts[2]; ++c[2])
        for (c[1] = 0; c[1] < counts[1]; ++c[1])
            for (c[0] = 0; c[0] < counts[0]; ++c[0]) {
                int inside = 0;
                for (int k = 0; k < 8; ++k)
                    inside +=
                        samples.is_inside({c[0] + (k & 1), c[1] + (k >> 1 & 1), c[2] + (k >> 2)});
                if (inside > 0 && inside < 8) {
                    numbers[samples.index(c)] = int32_t(crossed.size());
                    crossed.push_back(c);
                }
            }
    std::vector<Corner> corners(crossed.size());
    parallel_for(crossed.size(), 64, [&](size_t first, size_t last) {
        for (size_t i = first; i < last; ++i)
            corners[i] = corner_in(samples, crossed[i]);
    });
    Facets closing;
    for (const Cell& cell : crossed)
        for (size_t axis = 0; axis < 3; ++axis) {
            const size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
            Cell end = cell;
            ++end[axis];
            if (cell[u] == 0 || cell[v] == 0 || samples.is_inside(cell) == samples.is_inside(end))
                continue;
            const Corner* around[4];
            bool is_outermost = false;
            for (size_t i = 0; i < 4; ++i) {
                Cell at = cell;
                at[u] -= i == 1 || i == 2;
                at[v] -= i >= 2;
                assert(numbers[samples.index(at)] >= 0);
                around[i] = &corners[size_t(numbers[samples.index(at)])];
                is_outermost = is_outermost || samples.is_outermost(at);
            }
            if (!samples.is_inside(cell)) // the surface faces back along the axis
                std::swap(around[1], around[3]);
            (is_outermost ? closing : out).add_quad(*around[0], *around[1], *around[2], *around[3]);
        }
    const size_t shown = out.corners.size() / 3;
    out.corners.insert(out.corners.end(), closing.corners.begin(), closing.corners.end());
    return shown;
}

} // namespace ovc::pov

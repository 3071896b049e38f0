// SPDX-License-Identifier: Apache-2.0
// PageRates: estimates the bytes of pages before they are built, by pages of small clusters.
#pragma once

#include "core/build_progress.h"
#include "core/soup.h"
#include "plugin/plan/cubes.h"

#include <cstdint>
#include <span>
#include <vector>

namespace ovc {

/// Bytes of a page that do not grow with it: the header and the root.
inline constexpr uint64_t kPageStart = 128;
/// The max bytes of a page for each triangle: where no two are in a pair, there is a node above
/// every other triangle, and planes cut eight tenths of them because pairs may be loose but hardly
/// any is.
inline constexpr uint64_t kMaxBytesPerTriangle = 232;

/// Builds pages of some cubes, each with all the triangles that touch it.
class PageRates {
public:
    /// triangles: of the soup, at least those that touch the cubes. bounds: the box of the whole
    /// scene. one_frame: whether one frame suits it. This costs about a sixtieth of building all
    /// pages, and a look at every triangle, a unit of progress each.
    PageRates(const Soup& soup, std::span<const TriangleId> triangles, const Cubes& cubes,
              const Box& bounds, bool one_frame, BuildProgress* progress = nullptr);

    /// Returns the bytes a triangle, on average, in small cubes.
    double mean() const { return mean_; }
    /// Returns the same in pages of so many triangles. copies: as in LoosePairs.
    double mean_of(double triangles, double copies) const {
        return mean_ * with_cuts(triangles, copies);
    }
    /// Returns the same in `box`, by the cubes that lie in it; the average where none do.
    double within(const Box& box) const;
    /// Returns what the worst of many such boxes may take. Where no cube lies, a box may be worse
    /// than the average by as much as cubes differ.
    double worst_within(const Box& box) const;
    /// Returns the factor by which pages of so many triangles take more than the rates above tell,
    /// where they hold loose pairs: planes cut many of those in pages, but few in small cubes.
    /// copies: as in LoosePairs.
    double with_cuts(double triangles, double copies) const;

private:
    size_t cubes_in(const Box& box, double& sum) const;

    struct Cluster {
        dvec3 center;
        double rate;
    };
    std::vector<Cluster> clusters_;
    double mean_ = 0;
    double cut_in_small_ = 0; // triangles in units beyond one each, per triangle
    double cut_in_large_ = 0;
    double spread_ = 0; // standard deviation
};

} // namespace ovc

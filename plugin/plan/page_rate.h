// SPDX-License-Identifier: Apache-2.0
// What pages take a triangle, told before they are built: by pages of small clusters.
#pragma once

#include "core/build_progress.h"
#include "core/soup.h"

#include <cstdint>
#include <span>
#include <vector>

namespace ovc {

/// Bytes of a page that do not grow with it: the header and the root.
inline constexpr uint64_t kPageStart = 128;
/// No page takes more a triangle: no two in a pair, a node above every other triangle; and eight
/// tenths of them cut by planes where pairs were to be loose and hardly any is.
inline constexpr uint64_t kMaxBytesPerTriangle = 232;

/// Pages of some cubes, each with all the triangles that touch it. Cubes lie around triangles of a
/// sample, so where triangles are many there are many cubes.
class PageRates {
public:
    /// sample: of `triangles`, one in `rate`; not empty. bounds: of all. Costs about a sixtieth of
    /// building all pages, and a look at every triangle, a unit of progress each.
    PageRates(const Soup& soup, std::span<const TriangleId> triangles,
              std::span<const TriangleId> sample, uint32_t rate, const Box& bounds,
              BuildProgress* progress = nullptr);

    /// Bytes a triangle, on average, in small cubes.
    double mean() const { return mean_; }
    /// The same in pages of so many triangles.
    double mean_of(double triangles, double copies) const {
        return mean_ * with_cuts(triangles, copies);
    }
    /// The same in `box`, by the cubes that lie in it, the average and nothing else where none do.
    double within(const Box& box) const;
    /// What the worst of many such boxes may take: where no cube lies, one may be worse than the
    /// average by as much as cubes differ.
    double worst_within(const Box& box) const;
    /// By how much pages of so many triangles take more than all these, where they hold loose
    /// pairs: because planes cut many of those, but few in small cubes. copies: as in LoosePairs.
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

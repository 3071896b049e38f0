// SPDX-License-Identifier: Apache-2.0
// Region: a part of space that has an inside, by which a pattern tells its two colors apart.
#pragma once

#include "core/box.h"
#include "core/region/round_shape.h"

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace ovc {

/// The point where a line meets a triangle.
struct Crossing {
    double t, u, v;
    bool leaving; // the line comes from the triangle's inner side
};

/// Returns the meeting of the line `from` + t `way` with the triangle of three corners.
/// Based on: Moller and Trumbore 1997.
std::optional<Crossing> crossing(const dvec3* corners, const dvec3& from, const dvec3& way);

/// Returns whether the ray meets the box before `limit`. A way of 0 along an axis gives infinities,
/// and NaN for a ray in the plane of a side; the comparisons then count the box as met.
bool meets(const Box& box, const dvec3& from, const dvec3& inverse_way, double limit);

/// Triangles under a balanced tree of boxes: each node's triangles are halved, so that the boxes
/// alone make the tree. It is made for some thousand rays; a better one would not pay back its
/// building.
struct TriangleTree {
    std::vector<dvec3> corners; // 3 per triangle, in the order of the leaves
    std::vector<Box> boxes;     // of the nodes: node i has the children 2 i + 1 and 2 i + 2

    /// Sorts the triangles, whose corners are finite. Returns where each of them was before.
    std::vector<uint32_t> build(std::vector<dvec3> unsorted);
    /// Returns whether there are as many boxes as the triangles ask for.
    bool is_sound() const;

    /// Calls use(number) for the triangles of all leaves that the ray meets before `limit`, which
    /// `use` may lower.
    template <class Use>
    void for_each_near(const dvec3& origin, const dvec3& direction, const double& limit,
                       const Use& use) const;
};

/// A round shape, and the rows of the matrix that leads to its space.
struct PlacedRound {
    RoundShape shape;
    std::array<dvec4, 3> to_shape{};

    dvec3 there(const dvec3& v, double w) const {
        const dvec4 p(v, w);
        return {glm::dot(to_shape[0], p), glm::dot(to_shape[1], p), glm::dot(to_shape[2], p)};
    }
    bool operator==(const PlacedRound&) const = default;
};

/// The points where normal . p < distance.
struct HalfSpace {
    dvec3 normal{0, 1, 0};
    double distance = 0;

    bool operator==(const HalfSpace&) const = default;
};

/// A point is inside where it is inside of any part.
struct Region {
    TriangleTree triangles; // closed, counterclockwise seen from outside
    int32_t inverted = 0;   // how many of the closed surfaces have their inside outside
    std::vector<PlacedRound> rounds;
    std::vector<HalfSpace> half_spaces;

    bool contains(const dvec3& point) const;
    /// Returns the t > min_t at which the line `from` + t `way` first meets a surface of a part;
    /// infinity: nowhere.
    double first_crossing(const dvec3& from, const dvec3& way, double min_t) const;
    /// Boxes follow from corners.
    bool operator==(const Region& other) const {
        return triangles.corners == other.triangles.corners && inverted == other.inverted &&
               rounds == other.rounds && half_spaces == other.half_spaces;
    }
};

template <class Use>
void TriangleTree::for_each_near(const dvec3& origin, const dvec3& direction, const double& limit,
                                 const Use& use) const {
    if (boxes.empty())
        return;
    const dvec3 inverse_way = 1.0 / direction;
    struct Range {
        size_t node, first, last;
    };
    Range waiting[64]; // halving 2^32 triangles goes 32 deep
    size_t count = 0;
    waiting[count++] = {0, 0, corners.size() / 3};
    while (count > 0) {
        const Range at = waiting[--count];
        if (!meets(boxes[at.node], origin, inverse_way, limit))
            continue;
        const size_t child = 2 * at.node + 1;
        if (child >= boxes.size()) {
            for (size_t i = at.first; i < at.last; ++i)
                use(i);
            continue;
        }
        const size_t half = at.first + (at.last - at.first) / 2;
        waiting[count++] = {child + 1, half, at.last};
        waiting[count++] = {child, at.first, half};
    }
}

} // namespace ovc

// SPDX-License-Identifier: Apache-2.0
#include "core/region/region.h"

#include <algorithm>
#include <cassert>
#include <numeric>
#include <span>

namespace ovc {

namespace {

constexpr size_t kLeafTriangles = 4;

/// Returns how many nodes a tree over so many triangles has.
size_t node_count(size_t triangles) {
    if (triangles == 0)
        return 0;
    size_t nodes = 1;
    for (size_t leaves = 1; (triangles + leaves - 1) / leaves > kLeafTriangles; leaves *= 2)
        nodes = 2 * nodes + 1;
    return nodes;
}

/// Sorts `order`, a part of the triangles' numbers, under a node.
void build_node(TriangleTree& tree, std::span<const dvec3> corners, std::span<uint32_t> order,
                size_t node) {
    Box box;
    for (const uint32_t triangle : order)
        for (size_t i = 0; i < 3; ++i)
            box.add(corners[3 * size_t(triangle) + i]);
    tree.boxes[node] = box;
    const size_t child = 2 * node + 1;
    if (child >= tree.boxes.size())
        return;
    const int axis = major_axis(box.extent());
    const auto middle = [&](uint32_t triangle) {
        const dvec3* c = &corners[3 * size_t(triangle)];
        return c[0][axis] + c[1][axis] + c[2][axis];
    };
    const size_t half = order.size() / 2;
    std::nth_element(order.begin(), order.begin() + std::ptrdiff_t(half), order.end(),
                     [&](uint32_t a, uint32_t b) { return middle(a) < middle(b); });
    build_node(tree, corners, order.first(half), child);
    build_node(tree, corners, order.subspan(half), child + 1);
}

} // namespace

std::optional<Crossing> crossing(const dvec3* corners, const dvec3& from, const dvec3& way) {
    const dvec3 ab = corners[1] - corners[0], ac = corners[2] - corners[0];
    const dvec3 p = glm::cross(way, ac);
    const double determinant = glm::dot(ab, p);
    if (determinant == 0)
        return std::nullopt;
    const dvec3 s = from - corners[0];
    const dvec3 q = glm::cross(s, ab);
    const Crossing at{glm::dot(ac, q) / determinant, glm::dot(s, p) / determinant,
                      glm::dot(way, q) / determinant, determinant < 0};
    if (!(at.u >= 0 && at.v >= 0 && at.u + at.v <= 1))
        return std::nullopt;
    return at;
}

bool meets(const Box& box, const dvec3& from, const dvec3& inverse_way, double limit) {
    double first = 0, last = limit;
    for (int axis = 0; axis < 3; ++axis) {
        double a = (box.lo[axis] - from[axis]) * inverse_way[axis];
        double b = (box.hi[axis] - from[axis]) * inverse_way[axis];
        if (a > b)
            std::swap(a, b);
        first = a > first ? a : first;
        last = b < last ? b : last;
    }
    return !(first > last * (1 + 1e-12));
}

std::vector<uint32_t> TriangleTree::build(std::vector<dvec3> unsorted) {
    assert(unsorted.size() % 3 == 0);
    assert(
        std::all_of(unsorted.begin(), unsorted.end(), [](const dvec3& p) { return is_finite(p); }));
    std::vector<uint32_t> order(unsorted.size() / 3);
    std::iota(order.begin(), order.end(), 0u);
    boxes.resize(node_count(order.size()));
    if (!order.empty())
        build_node(*this, unsorted, order, 0);
    corners.clear();
    corners.reserve(unsorted.size());
    for (const uint32_t triangle : order)
        for (size_t i = 0; i < 3; ++i)
            corners.push_back(unsorted[3 * size_t(triangle) + i]);
    return order;
}

bool TriangleTree::is_sound() const {
    return corners.size() % 3 == 0 && boxes.size() == node_count(corners.size() / 3);
}

bool Region::contains(const dvec3& point) const {
    for (const HalfSpace& half : half_spaces)
        if (glm::dot(half.normal, point) < half.distance)
            return true;
    for (const PlacedRound& round : rounds)
        if (is_within(round.shape, round.there(point, 1)))
            return true;
    // No edge of a usual scene runs along this way.
    const dvec3 way = glm::normalize(dvec3(0.2718281828, 0.5772156649, 0.7853981634));
    int64_t surrounding = inverted; // surfaces that the ray leaves and has not entered
    triangles.for_each_near(point, way, std::numeric_limits<double>::infinity(),
                            [&](size_t triangle) {
                                const std::optional<Crossing> at =
                                    crossing(&triangles.corners[3 * triangle], point, way);
                                if (at && at->t > 0)
                                    surrounding += at->leaving ? 1 : -1;
                            });
    return surrounding > 0;
}

double Region::first_crossing(const dvec3& from, const dvec3& way, double min_t) const {
    double first = std::numeric_limits<double>::infinity();
    const auto meet = [&](double t) {
        if (t > min_t && t < first)
            first = t;
    };
    for (const HalfSpace& half : half_spaces)
        meet((half.distance - glm::dot(half.normal, from)) / glm::dot(half.normal, way));
    for (const PlacedRound& round : rounds)
        for_each_meeting(round.shape, round.there(from, 1), round.there(way, 0),
                         [&](const RoundMeeting& at) { meet(at.t); });
    triangles.for_each_near(from, way, first, [&](size_t triangle) {
        if (const auto at = crossing(&triangles.corners[3 * triangle], from, way))
            meet(at->t);
    });
    return first;
}

} // namespace ovc

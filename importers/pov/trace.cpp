// SPDX-License-Identifier: Apache-2.0
// Based on: Moller and Trumbore 1997, for the triangles. The tree halves the number of triangles:
// scenes trace some thousand rays, for which a better tree would not pay back its building.
#include "importers/pov/trace.h"

#include <algorithm>
#include <cassert>
#include <iterator>
#include <numeric>
#include <optional>

namespace ovc::pov {

namespace {

/// Nearer meetings do not count, so that a ray does not meet the surface that it starts on.
constexpr double kMinDistance = 1e-6;
constexpr uint32_t kLeafTriangles = 4;

struct Crossing {
    double t, u, v;
    bool leaving; // the ray comes from the triangle's inner side
};

std::optional<Crossing> crossing(const Corner* c, const dvec3& from, const dvec3& way) {
    const dvec3 ab = c[1].position - c[0].position, ac = c[2].position - c[0].position;
    const dvec3 p = glm::cross(way, ac);
    const double determinant = glm::dot(ab, p);
    if (determinant == 0)
        return std::nullopt;
    const dvec3 s = from - c[0].position;
    const dvec3 q = glm::cross(s, ab);
    const Crossing at{glm::dot(ac, q) / determinant, glm::dot(s, p) / determinant,
                      glm::dot(way, q) / determinant, determinant < 0};
    if (!(at.u >= 0 && at.v >= 0 && at.u + at.v <= 1))
        return std::nullopt;
    return at;
}

void meet_triangle(const Corner* c, const dvec3& from, const dvec3& way, Meeting& nearest) {
    const std::optional<Crossing> at = crossing(c, from, way);
    if (!at || !(at->t > kMinDistance && at->t < nearest.distance))
        return;
    nearest.distance = at->t;
    nearest.normal = (1 - at->u - at->v) * c[0].normal + at->u * c[1].normal + at->v * c[2].normal;
}

void meet_plane(const PlaneShape& plane, const dvec3& from, const dvec3& way, Meeting& nearest) {
    const double t = (plane.distance - glm::dot(plane.normal, from)) / glm::dot(plane.normal, way);
    if (t > kMinDistance && t < nearest.distance)
        nearest = {t, plane.normal};
}

void meet_exact(const ExactPart& part, const dvec3& from, const dvec3& way, Meeting& nearest) {
    const dvec3 there(part.to_shape * dvec4(from, 1)), along(part.to_shape * dvec4(way, 0));
    for_each_meeting(part.shape, there, along, [&](const ExactMeeting& at) {
        if (at.t > kMinDistance && at.t < nearest.distance)
            nearest = {at.t, glm::transpose(dmat3(part.to_shape)) * at.normal};
    });
}

/// Returns whether the ray meets the box before `limit`. A way of 0 along an axis gives infinities,
/// and NaN for a ray in the plane of a side; the comparisons then count the box as met.
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

} // namespace

TraceTarget::TraceTarget(CutObject object) : object_(std::move(object)) {
    assert(object_.facets.corners.size() % 3 == 0);
    assert(std::all_of(object_.facets.corners.begin(), object_.facets.corners.end(),
                       [](const Corner& corner) { return is_finite(corner.position); }));
    order_.resize(triangle_count());
    std::iota(order_.begin(), order_.end(), 0u);
    if (!order_.empty())
        build(0, uint32_t(order_.size()));
}

Box TraceTarget::box_of(uint32_t triangle) const {
    Box box;
    for (size_t i = 0; i < 3; ++i)
        box.add(object_.facets.corners[3 * size_t(triangle) + i].position);
    return box;
}

void TraceTarget::build(uint32_t first, uint32_t last) {
    assert(first < last && last <= order_.size());
    const size_t node = nodes_.size();
    nodes_.push_back({{}, first, last, 0});
    Box box;
    for (uint32_t i = first; i < last; ++i)
        box.add(box_of(order_[i]));
    nodes_[node].box = box;
    if (last - first <= kLeafTriangles)
        return;
    const int axis = major_axis(box.extent());
    const auto middle = [&](uint32_t triangle) {
        const Corner* c = &object_.facets.corners[3 * size_t(triangle)];
        return c[0].position[axis] + c[1].position[axis] + c[2].position[axis];
    };
    const uint32_t half = first + (last - first) / 2;
    std::nth_element(order_.begin() + first, order_.begin() + half, order_.begin() + last,
                     [&](uint32_t a, uint32_t b) { return middle(a) < middle(b); });
    build(first, half);
    nodes_[node].second = uint32_t(nodes_.size());
    build(half, last);
}

Meeting TraceTarget::first_meeting(const dvec3& origin, const dvec3& direction) const {
    Meeting nearest;
    for (const PlaneShape& plane : object_.planes)
        meet_plane(plane, origin, direction, nearest);
    for (const ExactPart& part : object_.exact)
        meet_exact(part, origin, direction, nearest);
    for_each_near(origin, direction, nearest.distance, [&](const Corner* corners) {
        meet_triangle(corners, origin, direction, nearest);
    });
    return nearest;
}

bool TraceTarget::contains(const dvec3& point) const {
    for (const PlaneShape& plane : object_.planes)
        if (glm::dot(plane.normal, point) < plane.distance)
            return true;
    for (const ExactPart& part : object_.exact)
        if (is_within(part.shape, dvec3(part.to_shape * dvec4(point, 1))))
            return true;
    // No edge of a usual scene runs along this way.
    const dvec3 way = glm::normalize(dvec3(0.2718281828, 0.5772156649, 0.7853981634));
    int surrounding = 0; // surfaces that the ray leaves and has not entered
    const double no_limit = std::numeric_limits<double>::infinity();
    for_each_near(point, way, no_limit, [&](const Corner* corners) {
        if (const std::optional<Crossing> at = crossing(corners, point, way); at && at->t > 0)
            surrounding += at->leaving ? 1 : -1;
    });
    return surrounding > 0;
}

template <class Use>
void TraceTarget::for_each_near(const dvec3& origin, const dvec3& direction, const double& limit,
                                const Use& use) const {
    if (nodes_.empty())
        return;
    const dvec3 inverse_way = 1.0 / direction;
    uint32_t waiting[64]; // halving 2^32 triangles goes 32 deep
    size_t count = 0;
    waiting[count++] = 0;
    while (count > 0) {
        const uint32_t at = waiting[--count];
        const Node& node = nodes_[at];
        if (!meets(node.box, origin, inverse_way, limit))
            continue;
        if (node.second) {
            assert(count + 2 <= std::size(waiting));
            waiting[count++] = node.second;
            waiting[count++] = at + 1;
            continue;
        }
        for (uint32_t i = node.first; i < node.last; ++i)
            use(&object_.facets.corners[3 * size_t(order_[i])]);
    }
}

} // namespace ovc::pov

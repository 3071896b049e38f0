// SPDX-License-Identifier: Apache-2.0
#include "importers/pov/trace.h"

#include <algorithm>

namespace ovc::pov {

namespace {

/// Nearer meetings do not count, so that a ray does not meet the surface that it starts on.
constexpr double kMinDistance = 1e-6;

void meet_plane(const HalfSpace& plane, const dvec3& from, const dvec3& way, Meeting& nearest) {
    const double t = (plane.distance - glm::dot(plane.normal, from)) / glm::dot(plane.normal, way);
    if (t > kMinDistance && t < nearest.distance)
        nearest = {t, plane.normal};
}

void meet_round(const PlacedRound& round, const dvec3& from, const dvec3& way, Meeting& nearest) {
    const auto back = [&](const dvec3& normal) {
        return normal.x * dvec3(round.to_shape[0]) + normal.y * dvec3(round.to_shape[1]) +
               normal.z * dvec3(round.to_shape[2]);
    };
    for_each_meeting(round.shape, round.there(from, 1), round.there(way, 0),
                     [&](const RoundMeeting& at) {
                         if (at.t > kMinDistance && at.t < nearest.distance)
                             nearest = {at.t, back(at.normal)};
                     });
}

} // namespace

TraceTarget::TraceTarget(CutObject object) {
    region_.inverted = object.inverted;
    region_.half_spaces = std::move(object.planes);
    region_.rounds = std::move(object.exact);
    const std::vector<Corner>& corners = object.facets.corners;
    std::vector<dvec3> positions(corners.size());
    std::transform(corners.begin(), corners.end(), positions.begin(),
                   [](const Corner& corner) { return corner.position; });
    normals_.reserve(corners.size());
    for (const uint32_t triangle : region_.triangles.build(std::move(positions)))
        for (size_t i = 0; i < 3; ++i)
            normals_.push_back(corners[3 * size_t(triangle) + i].normal);
}

Meeting TraceTarget::first_meeting(const dvec3& origin, const dvec3& direction) const {
    Meeting nearest;
    for (const HalfSpace& plane : region_.half_spaces)
        meet_plane(plane, origin, direction, nearest);
    for (const PlacedRound& round : region_.rounds)
        meet_round(round, origin, direction, nearest);
    const TriangleTree& tree = region_.triangles;
    tree.for_each_near(origin, direction, nearest.distance, [&](size_t triangle) {
        const std::optional<Crossing> at = crossing(&tree.corners[3 * triangle], origin, direction);
        if (!at || !(at->t > kMinDistance && at->t < nearest.distance))
            return;
        const dvec3* n = &normals_[3 * triangle];
        nearest = {at->t, (1 - at->u - at->v) * n[0] + at->u * n[1] + at->v * n[2]};
    });
    return nearest;
}

} // namespace ovc::pov

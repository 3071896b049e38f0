// SPDX-License-Identifier: Apache-2.0
// Portal: a place where a ray changes from the world to the frame of a part of the scene.
#pragma once

#include "core/box.h"
#include "core/exact/triangle.h"
#include "core/transform.h"
#include "kdtree/partition.h"
#include "shaders/layout.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace ovc {

struct Portal {
    dvec3 origin{0}; // the point of the world that lies at 0 in the frame
    std::array<dvec3, 3> rows{dvec3(1, 0, 0), dvec3(0, 1, 0),
                              dvec3(0, 0, 1)}; // local = rows (world - origin)
    Box box;                                   // of the part behind it, in the frame; floats
    Box bounds;                                // the same in the world
    uint32_t tree = 0;                         // the unit of the header of the part's tree
    uint32_t first_number = 0;                 // the part's triangle numbers count from here

    dvec3 to_local_direction(const dvec3& d) const {
        return {glm::dot(rows[0], d), glm::dot(rows[1], d), glm::dot(rows[2], d)};
    }
    dvec3 to_local(const dvec3& world) const { return to_local_direction(world - origin); }
    /// The max factor by which the map to the frame lengthens a vector, by its largest component.
    double stretch() const;
    /// Returns the same ray in the frame. Its t is that of the ray in the world.
    PreparedRay local_ray(const PreparedRay& p) const;
};

/// Returns the portal into the frame of the part that lies in `box`. transform: places both in the
/// world and has an inverse; null if they are in the world already. Error bound:
/// docs/design/numerics.md, "Frames".
Portal portal_into(const Frame& frame, const Box& box, const Transform* transform = nullptr);

inline constexpr uint64_t kPortalBytes = OVC_PORTAL_TEXELS * sizeof(uvec4);

/// The table of portals, as the kernel reads it (shaders/layout.h).
std::vector<uvec4> pack_portals(std::span<const Portal> portals);

} // namespace ovc

// SPDX-License-Identifier: Apache-2.0
// Embree's robust mode on the same rays, as a peer in reports. Where this program was built without
// Embree there is none.
#pragma once

#include "core/soup.h"

#include <memory>
#include <span>

namespace ovc {

/// A scene of Embree 3 in RTC_SCENE_FLAG_ROBUST. Embree has floats only: world positions and rays
/// are rounded to them.
class EmbreePeer {
public:
    virtual ~EmbreePeer() = default;
    /// hits: as many as rays; u and v stay 0. skip: empty, or a triangle for each ray that it does
    /// not see.
    virtual void intersect(std::span<const Ray> rays, std::span<const TriangleId> skip,
                           std::span<Hit> hits) const = 0;
};

/// Null where this program was built without Embree.
std::unique_ptr<EmbreePeer> make_embree_peer(const Soup& soup);

} // namespace ovc

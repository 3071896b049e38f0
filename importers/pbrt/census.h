// SPDX-License-Identifier: Apache-2.0
// The census counts what a world becomes once its instances are expanded, before any of it is.
#pragma once

#include "core/result.h"
#include "importers/pbrt/objects.h"

#include <algorithm>

namespace ovc::pbrt {

struct Census {
    uint64_t triangles = 0; // expanded; saturates
    uint64_t unique = 0;    // triangles in the file, also in objects that nothing places
    uint64_t instances = 0; // expanded: an instance in an object counts as often as that is placed
    std::vector<uint64_t> within; // expanded triangles of each object, its own instances' included
    std::vector<bool> shared;     // for each object, whether its instances share their corners
    uint64_t kept = 0;            // triangles whose corners the soup keeps

    bool shares_corners() const {
        return std::find(shared.begin(), shared.end(), true) != shared.end();
    }
};

Census take_census(const World& world);

/// Objects of fewer triangles are expanded, so that tiles which touch keep touching (assembly.h).
inline constexpr uint64_t kMinShared = 64;

/// Refuses a soup that keeps more than `max_triangles` triangles, has more than kMaxTriangles, or,
/// if it `is_held`, does not fit into the available memory.
Result<Done> check_census(const Census& census, uint64_t max_triangles, bool is_held);
/// Refuses a scene that cannot be converted in so much memory, as shared corners have to be.
Result<Done> check_conversion(const Census& census, uint64_t host_bytes);

} // namespace ovc::pbrt

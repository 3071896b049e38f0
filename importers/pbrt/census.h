// SPDX-License-Identifier: Apache-2.0
// Census: how much a world becomes once its instances are expanded, before any of it is.
#pragma once

#include "core/result.h"
#include "importers/pbrt/objects.h"

namespace ovc::pbrt {

struct Census {
    uint64_t triangles = 0; // expanded; saturates
    uint64_t unique = 0;    // as the file has them, those of objects that nothing places too
    uint64_t instances = 0; // expanded: an instance in an object counts as often as that is placed
    std::vector<uint64_t> within; // expanded triangles of each object, its own instances' included
    std::vector<bool> shared;     // of each object, whether its instances share their corners
    uint64_t kept = 0;            // triangles whose corners the soup keeps
};

Census take_census(const World& world);

/// Objects of fewer triangles are expanded: tiles that touch keep touching (assembly.h).
inline constexpr uint64_t kMinShared = 64;

/// Refuses more than `most` triangles to keep, and what does not fit into the memory that is free.
Result<Done> check_census(const Census& census, uint64_t most);

} // namespace ovc::pbrt

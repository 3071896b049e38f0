// SPDX-License-Identifier: Apache-2.0
// The generators behind the catalog, one per scene family. Sizes are in the catalog's range; the
// caller names the scene.
#pragma once

#include "core/scene.h"

#include <cstdint>

namespace ovc {

/// The size of plants-N that is `plants`.
inline constexpr double kPlantsDemoSize = 64;

Scene make_plants(uint32_t size);

} // namespace ovc

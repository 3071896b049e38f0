// SPDX-License-Identifier: Apache-2.0
// Reads density files (.df3), whose form POV-Ray's documentation gives (3.4.7.1.8.1).
#pragma once

#include "core/result.h"
#include "core/texture/texture.h"

#include <filesystem>

namespace ovc::pov {

Result<DensityGrid> read_density(const std::filesystem::path& path);

} // namespace ovc::pov

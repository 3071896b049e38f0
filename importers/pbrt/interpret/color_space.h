// SPDX-License-Identifier: Apache-2.0
// The color spaces that v4's ColorSpace names.
#pragma once

#include "core/vec.h"

#include <optional>
#include <string_view>

namespace ovc::pbrt {

/// Returns the matrix from the linear colors of a space to those of sRGB, which takes white to
/// white; nothing for a name that v4 does not know.
std::optional<dmat3> color_space_of(std::string_view name);

} // namespace ovc::pbrt

// SPDX-License-Identifier: Apache-2.0
// The corners of triangles.
#pragma once

#include <variant>
#include <vector>

namespace ovc::tachyon {

/// Three numbers a corner, three corners a triangle: floats where floats hold all of them, as they
/// do whatever a scene file says, or doubles.
using Corners = std::variant<std::vector<float>, std::vector<double>>;

} // namespace ovc::tachyon

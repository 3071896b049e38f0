// SPDX-License-Identifier: Apache-2.0
// Kernels for tests of compilers and drivers: few, but each two switches meet in all ways.
#pragma once

#include "gpu/gl/kernel.h"

#include <vector>

namespace ovc {

/// Returns kernels among which every two switches of ShaderConfig have every two values together,
/// except where no kernel may have both. Of switches that are numbers there are two values, small
/// and large.
std::vector<ShaderConfig> kernel_variants();

} // namespace ovc

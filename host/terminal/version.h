// SPDX-License-Identifier: Apache-2.0
// The version of the command, which is that of the ABI's header.
#pragma once

#include "plugin/overcast.h"

#include <fmt/format.h>

#include <string>

namespace ovc {

/// Returns the version in the form "0.1.0".
inline std::string version_text() {
    return fmt::format("{}.{}.{}", OVC_VERSION / 10000, OVC_VERSION / 100 % 100, OVC_VERSION % 100);
}

} // namespace ovc

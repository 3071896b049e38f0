// SPDX-License-Identifier: Apache-2.0
// Looks into a folder without std::filesystem's iterator, which ends the process where memory runs
// out within it (libstdc++ 12).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace ovc {

/// Returns the names in a folder, in any order; none where it cannot be read.
std::vector<std::string> names_in(const std::filesystem::path& folder);

} // namespace ovc

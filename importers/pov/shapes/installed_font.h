// SPDX-License-Identifier: Apache-2.0
// Finds fonts on this machine for scenes that name a font but do not come with its file.
#pragma once

#include <filesystem>
#include <string>

namespace ovc::pov {

/// Returns the installed font file of this name, regardless of upper and lower case. Without one it
/// returns a plain font that can stand in for it, or an empty path where no font is installed.
std::filesystem::path installed_font(const std::string& name);

} // namespace ovc::pov

// SPDX-License-Identifier: Apache-2.0
// The fonts of this machine, for scenes that name one which they do not bring along.
#pragma once

#include <filesystem>
#include <string>

namespace ovc::pov {

/// The installed font file of this name, in letters of any size; else a plain one that can stand in
/// for it; empty: no fonts are installed.
std::filesystem::path installed_font(const std::string& name);

} // namespace ovc::pov

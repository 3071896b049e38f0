// SPDX-License-Identifier: Apache-2.0
// The extents of a glTF file's data, and the shape of its tree of nodes.
#pragma once

#include <nlohmann/json.hpp>

#include <optional>
#include <string>

namespace ovc {

/// Returns a sentence on the first accessor or view whose data does not lie where it says, or node
/// that lies in itself; nothing for a sound file. Assimp 5 reads beyond its buffers for the former,
/// and takes a frame of the stack for each level of nodes.
std::optional<std::string> unsound_extent(const nlohmann::json& gltf);

} // namespace ovc

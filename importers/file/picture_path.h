// SPDX-License-Identifier: Apache-2.0
// A scene names the pictures of its textures; whoever renders opens them.
#pragma once

#include "core/scene.h"

#include <filesystem>
#include <string>
#include <string_view>

namespace ovc {

/// Returns the absolute path of a picture that a file in `folder` names: with / for \, and if there
/// is no such file, that of one of its name in the folder itself, where authors move them. It is
/// the first of these if there is neither.
std::string picture_path(const std::filesystem::path& folder, std::string_view name);

/// Returns the index of the picture in scene.pictures, where each lies once. asked_for_at: the
/// place that names it.
uint32_t add_picture(Scene& scene, const std::string& path, const std::string& asked_for_at);

/// Appends a texture; returns its index.
uint32_t add_texture(Scene& scene, Texture texture);

/// Returns a texture of one color.
Texture plain_texture(const vec3& color);

/// The placement by which textures are evaluated at points of the world.
inline PlacedTexture placed_in_world(uint32_t texture) {
    return {texture, {dvec4(1, 0, 0, 0), dvec4(0, 1, 0, 0), dvec4(0, 0, 1, 0)}};
}

} // namespace ovc

// SPDX-License-Identifier: Apache-2.0
// The textures of MTL: a statement such as "map_Kd -s 2 2 wood.png", and what it makes of a
// material.
#pragma once

#include "core/scene.h"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace ovc {

/// A texture statement. Its defaults are those of the format.
struct MtlTexture {
    std::string keyword; // "map_Kd"
    std::string file;
    uint64_t line = 0;
    dvec2 scale{1}, offset{0}; // -s, -o: the picture is asked at scale * uv + offset
    bool clamp = false;        // -clamp
    double base = 0, gain = 1; // -mm: of its values
    double bump = 1;           // -bm
    bool is_turbulent = false; // -t, which is not shown
    char channel = 0;          // -imfchan: r, g, b, m, l or z; 0: the statement's own
};

/// Parses what follows the keyword. Options may also stand behind the file's name, which may have
/// blanks in it. Options that do not change the picture's values or place are passed over.
MtlTexture parse_mtl_texture(std::string_view keyword, std::string_view rest, uint64_t line);

/// Returns whether add_mtl_texture() knows what to do with it.
bool is_shown(const MtlTexture& texture);

/// A material with what its textures need besides.
struct MtlMaterial {
    Material& material;
    std::optional<Cutout> cutout; // out: of map_d
};

/// Adds a texture to a material of the scene. library: the MTL file.
void add_mtl_texture(const MtlTexture& texture, const std::filesystem::path& library, Scene& scene,
                     MtlMaterial& to);

} // namespace ovc

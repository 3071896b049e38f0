// SPDX-License-Identifier: Apache-2.0
// The shader sources, embedded in the library by shaders/embed.cmake.
#pragma once

#include <span>
#include <string_view>

namespace ovc {

struct ShaderSource {
    std::string_view name; // "traverse.glsl"
    std::string_view text;
};

std::span<const ShaderSource> shader_sources();

} // namespace ovc

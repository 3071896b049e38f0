// SPDX-License-Identifier: Apache-2.0
// Adaptive antialiasing by POV-Ray's two methods, which take more samples only where colors differ.
// The tracing callback gets many points at once, so that batches stay large.
// Source: the documentation of POV-Ray 3.7, section 3.2.8, "Tracing Options".
#pragma once

#include "core/scene.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace ovc {

struct Antialias {
    enum class Method {
        /// Each pixel gets a sample in its middle. Where it differs from the pixel at its left or
        /// above it, both get depth x depth more.
        Supersample = 1,
        /// Samples lie at the corners of pixels. A square whose corners differ is quartered, until
        /// a quarter is 1 / 2^(depth - 1) of a pixel wide.
        Subdivide = 2
    };

    Method method = Method::Supersample;
    /// Colors differ where the differences of red, green and blue add up to this or more; 0 to 3.
    float threshold = 0.3f;
    uint32_t depth = 3; // 1 to kMaxAntialiasDepth
    /// How far the further samples may lie off their grid, in its cells: 0 to 1. The pseudo-random
    /// offsets are the same every time.
    float jitter = 1;

    bool operator==(const Antialias&) const = default;
};

inline constexpr uint32_t kMaxAntialiasDepth = 9;

/// Writes the light at each of the points of the picture, which are in pixels from (0, 0), its top
/// left corner. Returns false where it was stopped.
using TracePoints = std::function<bool(std::span<const dvec2> points, std::span<vec3> light)>;

/// Returns the colors of a picture's pixels, row by row from the top; nothing where tracing was
/// stopped. how.depth is from 1 to kMaxAntialiasDepth. gamma: Scene::gamma, by which colors are
/// compared as eyes do it.
std::optional<std::vector<vec3>> antialiased(const ImageSize& size, const Antialias& how,
                                             double gamma, const TracePoints& trace);

} // namespace ovc

// SPDX-License-Identifier: Apache-2.0
// Adaptive antialiasing, POV-Ray's two methods: more samples only where colors differ. Whoever
// traces is asked for many points at once, so that batches stay large.
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
        /// A sample in the middle of each pixel; depth x depth more in each that differs from the
        /// pixel at its left or above it, and in that one.
        Supersample = 1,
        /// Samples at the corners of pixels; what differs at its corners is quartered, until a
        /// quarter is 1 / 2^(depth - 1) of a pixel wide.
        Subdivide = 2
    };

    Method method = Method::Supersample;
    /// Colors differ where the differences of red, green and blue come to this; 0 to 3.
    float threshold = 0.3f;
    uint32_t depth = 3; // 1 to kMaxAntialiasDepth
    /// How far further samples may lie off their grid, in its cells, by chance that is the same
    /// every time: 0 to 1.
    float jitter = 1;

    bool operator==(const Antialias&) const = default;
};

inline constexpr uint32_t kMaxAntialiasDepth = 9;

/// Writes the light at each of the points of the picture: in pixels, from (0, 0), its top left
/// corner. False: it was stopped.
using TracePoints = std::function<bool(std::span<const dvec2> points, std::span<vec3> light)>;

/// The colors of a picture's pixels, row by row from the top; nothing where tracing was stopped.
/// gamma: of the scene (Scene::gamma): colors are compared as eyes do it.
std::optional<std::vector<vec3>> antialiased(const ImageSize& size, const Antialias& how,
                                             double gamma, const TracePoints& trace);

} // namespace ovc

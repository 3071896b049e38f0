// SPDX-License-Identifier: Apache-2.0
// Adaptive antialiasing by POV-Ray's two methods, which take more samples only where colors differ.
// The tracer gets many points at once, so that batches stay large.
// Source: the documentation of POV-Ray 3.7, section 3.2.8, "Tracing Options".
#pragma once

#include "core/scene.h"
#include "host/film/film.h"

#include <cstdint>
#include <span>

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

/// Traces the samples of a picture. Its functions return false where they were stopped.
class SampleTracer {
public:
    virtual ~SampleTracer() = default;

    /// Renders a ray through the middle of each pixel onto the film.
    virtual bool trace_middles(Film& film) = 0;
    /// Writes the mean light of points of the picture, which are in pixels from (0, 0), its top
    /// left corner: of the first points.size() / light.size() of them, the next, and so on.
    virtual bool trace_points(std::span<const dvec2> points, std::span<vec3> light) = 0;
};

/// Renders a picture onto a film of one sample a pixel. Returns false where tracing was stopped;
/// the film then has nothing to show. how.depth is from 1 to kMaxAntialiasDepth. gamma:
/// Scene::gamma, by which colors are compared as eyes do it.
bool antialias(const Antialias& how, double gamma, SampleTracer& tracer, Film& film);

} // namespace ovc

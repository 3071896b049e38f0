// SPDX-License-Identifier: Apache-2.0
// Integrator: what light a path brings to its pixel, and which rays go on from what it hit. Who
// traces those, and in which order, is the renderers' business (render_batched.h, render_mixed.h):
// the picture is the same.
#pragma once

#include "core/ray.h"
#include "core/vec.h"
#include "host/backend/ray_list.h"
#include "host/render/film.h"

#include <cstdint>
#include <span>

namespace ovc {

enum class RayKind : uint8_t { Camera, Reflection, Refraction, Bounce };

/// What a ray that looks for the nearest surface is for.
struct Path {
    uint32_t pixel;
    uint32_t sample; // of the pixel: which of its camera rays led here
    uint16_t depth;  // surfaces that it left on its way here
    RayKind kind;    // how it left the last one
    vec3 weight;     // what light at its end is worth to the pixel
    float density; // path tracing: with which its direction was chosen, by solid angle; 0: no other
                   // was possible
    float behind = 0; // path tracing: how far from the ray's origin, through panes that do not bend
                      // it, the direction was chosen
};

/// What a shadow ray is for. Its t = 1 is the light, or a point of it.
struct Shadow {
    uint32_t pixel;
    uint32_t light;  // which, for Integrator::pass()
    uint32_t passed; // surfaces behind it
    vec3 arriving;   // what the pixel gets if nothing is in the way
};

/// Rays that go on.
struct Spawned {
    RayList<Path> paths;
    RayList<Shadow> shadows;

    void clear() {
        paths.resize(0);
        shadows.resize(0);
    }
};

/// Stateless: all functions may be called from many threads at once.
class Integrator {
public:
    virtual ~Integrator() = default;

    /// Adds to the film what the paths see where their rays end, and appends to `spawned` what goes
    /// on from there: of one call side by side what is alike, so that neighbours go the same way.
    virtual void shade(std::span<const Ray> rays, std::span<const Path> paths,
                       std::span<const Hit> hits, Film& film, Spawned& spawned) const = 0;

    /// Whether light passes some surface. Then shadow rays look for the nearest one, and pass() is
    /// asked; otherwise whatever is in the way blocks the light.
    virtual bool light_may_pass() const = 0;

    /// A shadow ray has hit a surface. True: the ray goes on, moved behind it and dimmed by it.
    /// False: it ends here, and what arrives, perhaps 0, is in `shadow`.
    virtual bool pass(const Hit& hit, Ray& ray, Shadow& shadow) const = 0;
};

} // namespace ovc

// SPDX-License-Identifier: Apache-2.0
// LightSampler: a scene's lights for path tracing, from which one is chosen at random, the stronger
// the likelier: emitting triangles, and lights that are points or parallel.
#pragma once

#include "core/ray.h"
#include "core/scene.h"
#include "host/shade/shade.h"

#include <optional>
#include <vector>

namespace ovc {

/// Light that may arrive at a surface from one place.
struct Arriving {
    Ray ray;         // from the surface; t = 1 is there
    dvec3 towards;   // the same, of unit length
    vec3 light;      // irradiance at a right angle, or of an emitter its radiance; / `density`, or
                     // how likely the light was
    double density;  // of an emitter's place, by solid angle; 0: a light, which no ray hits
    uint32_t number; // of the light among Scene::lights; kNone: an emitter
};

class LightSampler {
public:
    /// The scene outlives it, and its lights are placed.
    explicit LightSampler(const Scene& scene);

    /// Whether there are any but emitters.
    bool has_lights() const { return has_lights_; }

    /// One of them. Nothing: it does not shine this way, or there is none. choice: in [0, 1); u: in
    /// [0, 1)^2.
    std::optional<Arriving> sample(const SurfacePoint& surface, double choice,
                                   const dvec2& u) const;

    /// With which sample() chooses this point of an emitter, by solid angle as seen from `distance`
    /// away; cosine: to the triangle's normal. 0: it is none.
    double density(TriangleId id, double distance, double cosine) const;

private:
    /// Of one mesh: its triangles' sums begin at `first`.
    struct Emitters {
        uint32_t mesh;
        size_t first;
        bool two_sided;
        vec3 radiance;
    };

    void add_lights(const dvec3& middle, double reach);
    void add_emitters(double reach);
    void share_with_the_weak();
    std::optional<Arriving> from_light(uint32_t number, const SurfacePoint& surface) const;
    std::optional<Arriving> from_emitter(const Emitters& emitters, size_t i,
                                         const SurfacePoint& surface, const dvec2& u) const;
    double chance(size_t i) const { return (sums_[i + 1] - sums_[i]) / sums_.back(); }

    const Scene& scene_;
    bool has_lights_ = false;
    std::vector<double> sums_{0};       // of the chances of lights, then of triangles
    std::vector<Emitters> emitters_;    // in the order of `first`
    std::vector<uint32_t> emitters_of_; // a mesh; kNone: it does not emit
};

} // namespace ovc

// SPDX-License-Identifier: Apache-2.0
// LightSampler chooses one of a scene's lights at random for path tracing, strong ones more often
// than weak ones. Lights are emitting triangles, points, parallel, or the pictures of a sky.
#pragma once

#include "core/ray.h"
#include "core/scene.h"
#include "host/shade/cutouts.h"
#include "host/shade/lights/sky_sampler.h"
#include "host/shade/shade.h"

#include <optional>
#include <vector>

namespace ovc {

/// Light that may arrive at a surface from one place.
struct Arriving {
    Ray ray;         // from the surface; t = 1 is that place, and t_max infinite for the sky
    dvec3 towards;   // the same direction, of unit length
    vec3 light;      // an emitter's radiance / `density`, or a light's irradiance at a right angle
                     // / its probability
    double density;  // of an emitter's place or the sky, by solid angle; 0: no scattered ray finds
                     // this light
    uint32_t number; // in Scene::lights; kNone: an emitter or the sky
};

class LightSampler {
public:
    /// The scene must outlive it, and its lights must be placed. up: of the background.
    /// with_cutouts: emitters have the holes that rays see.
    LightSampler(const Scene& scene, const vec3& up, bool with_cutouts = true);

    /// Returns whether there are other lights than emitters.
    bool has_lights() const { return has_lights_; }

    /// Returns the light of one place, chosen at random; nothing where it does not shine this way,
    /// or there is no light. choice: in [0, 1); u: in [0, 1)^2.
    std::optional<Arriving> sample(const SurfacePoint& surface, double choice,
                                   const dvec2& u) const;

    /// Returns the density with which sample() chooses this point of an emitter, by solid angle as
    /// seen from `distance` away; 0 where the triangle does not emit. cosine: to its normal.
    double density(TriangleId id, double distance, double cosine) const;

    /// Returns the density with which sample() chooses this direction of the sky, of unit length; 0
    /// where the sky has no picture.
    double sky_density(const dvec3& direction) const;

private:
    /// The emitting triangles of one mesh, whose sums begin at `first`.
    struct Emitters {
        uint32_t mesh;
        size_t first;
        bool two_sided;
        bool is_unseen; // by rays that surfaces scatter, so that only shadow rays find its light
        vec3 radiance;
        uint32_t map; // the texture that multiplies it; kNone: it is the same everywhere
    };

    void add_lights(const dvec3& middle, double reach);
    void add_emitters(double reach);
    double mean_of_map(const Emitters& emitters, uint32_t prim) const;
    vec3 radiance_at(const Emitters& emitters, TriangleId id, const dvec3& weights) const;
    void add_sky();
    void share_with_the_weak();
    std::optional<Arriving> from_light(uint32_t number, const SurfacePoint& surface) const;
    std::optional<Arriving> from_emitter(const Emitters& emitters, size_t i,
                                         const SurfacePoint& surface, const dvec2& u) const;
    std::optional<Arriving> from_sky(const SurfacePoint& surface, const dvec2& u) const;
    double chance(size_t i) const { return (sums_[i + 1] - sums_[i]) / sums_.back(); }

    const Scene& scene_;
    const vec3 up_;
    const Cutouts cutouts_;
    const bool with_cutouts_;
    const SkySampler sky_sampler_;
    bool has_lights_ = false;
    std::vector<double> sums_{0};    // running sums of the chances of lights, triangles and the sky
    size_t sky_ = SIZE_MAX;          // its place among them
    std::vector<Emitters> emitters_; // in the order of `first`
    std::vector<uint32_t> emitters_of_; // by mesh, an index of emitters_; kNone: it does not emit
};

} // namespace ovc

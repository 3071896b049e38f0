// SPDX-License-Identifier: Apache-2.0
// Bsdf says how a point of a surface scatters light, for path tracing. It never sends on more light
// than arrives.
#pragma once

#include "host/shade/shade.h"

#include <array>
#include <optional>

namespace ovc {

/// The share that a boundary reflects, by the cosine to its (micro)facet's normal.
struct Reflectance {
    enum class Curve : uint8_t { Constant, Schlick, Fresnel };

    Curve curve = Curve::Constant;
    vec3 head_on{0}; // Constant: the share at any angle. Fresnel: a factor
    double ior = 1;  // Fresnel: the index behind the boundary over that before it

    vec3 at(double cosine) const;
    vec3 mean() const; // over light from all directions
};

/// The way that light takes at a surface.
enum class Scattering : uint8_t { Diffuse, Glossy, Mirror, Through };

struct Scattered {
    Scattering way;
    dvec3 direction; // of unit length; 0 without density: see mirror_ray(), refracted_ray()
    vec3 weight;     // BSDF x cosine / the probability of the direction
    double density;  // by solid angle; 0 where a smooth surface leaves one direction
};

class Bsdf {
public:
    explicit Bsdf(const SurfacePoint& surface);

    /// Returns the radiance that the surface sends out by itself towards the viewer.
    vec3 emission() const { return emission_; }

    /// Returns whether it scatters light in all directions: then evaluate() is not always 0.
    bool scatters() const { return diffuse_ != vec3(0) || behind_ != vec3(0) || is_glossy_; }

    /// Returns BSDF x cosine for light from `towards` (of unit length) to the viewer, without light
    /// that is mirrored or let through by a smooth surface.
    vec3 evaluate(const dvec3& towards) const;

    /// Returns the density, by solid angle, with which sample() chooses this direction.
    double density(const dvec3& towards) const;

    /// Chooses a direction; returns nothing where the light ends here. choice: in [0, 1); u: in
    /// [0, 1)^2.
    std::optional<Scattered> sample(double choice, const dvec2& u) const;

    /// Returns the share of the flux that goes through. Radiance changes by the square of the index
    /// besides.
    vec3 through() const { return through_; }

    /// Returns about the share of light that it sends towards the viewer where light comes from all
    /// directions alike, at most 1. Mirrors and glass have what they reflect and let through.
    vec3 albedo() const;

    /// Returns whether light that goes through is not bent.
    bool is_straight() const { return is_straight_; }

private:
    void take_optics(const SurfacePoint& surface, const Optics& optics);
    void take_finish(const SurfacePoint& surface);
    double add_finish(const SurfacePoint& surface, const vec3& weight);
    void take_shares(const SurfacePoint& surface);
    void choose_probabilities();
    bool is_above(const dvec3& towards) const;
    bool is_below(const dvec3& towards) const;
    dvec3 local(const dvec3& direction) const;
    dvec3 world(const dvec3& direction) const;
    vec3 scattered(const dvec3& towards) const;
    double scattered_density(const dvec3& towards) const;
    vec3 transmitted(const dvec3& towards) const;
    double transmitted_density(const dvec3& towards) const;

    dvec3 tangent_, bitangent_, normal_, geometric_;
    dvec3 view_; // towards the viewer, in the frame of tangent_, bitangent_ and normal_
    vec3 diffuse_{0};
    vec3 behind_{0};                  // diffuse light to the other side
    double front_ = 1;                // the share of the chance of Diffuse that goes to this side
    std::optional<Reflectance> coat_; // above the diffuse ground
    vec3 coat_scale_{1};              // 1 / (1 - the coat's mean)
    bool is_glossy_ = false;
    Reflectance gloss_;
    double width_ = 0;
    vec3 mirror_{0};
    vec3 through_{0};
    vec3 frosted_{0}; // let through by facets, besides what the boundary of gloss_ reflects
    float bent_ = 1;  // the factor of radiance at the boundary
    bool is_straight_ = true;
    vec3 emission_{0};
    std::array<double, 4> chance_{}; // of each Scattering; they add up to 1, or all are 0
};

} // namespace ovc

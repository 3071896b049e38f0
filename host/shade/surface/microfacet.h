// SPDX-License-Identifier: Apache-2.0
// Microfacets with GGX's slopes, in a frame whose z axis is the normal. All directions are of unit
// length, and above the surface unless light is refracted towards them. Based on: Walter et al.
// 2007, "Microfacet Models for Refraction through Rough Surfaces" (GGX); Heitz 2014, "Understanding
// the Masking-Shadowing Function" (the height-correlated one); Dupuy and Benyoub 2023, "Sampling
// Visible GGX Normals with Spherical Caps".
#pragma once

#include "core/vec.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ovc {

struct Microfacets {
    double width; // alpha, above 0

    /// Returns the density of facets with this normal, by solid angle.
    double normals(const dvec3& half) const {
        const double a2 = width * width;
        const double k = (half.x * half.x + half.y * half.y) / a2 + half.z * half.z;
        return 1 / (std::numbers::pi * a2 * k * k);
    }

    /// Returns Smith's Lambda.
    double hidden(const dvec3& v) const {
        const double tan2 = (v.x * v.x + v.y * v.y) / (v.z * v.z);
        return 0.5 * (std::sqrt(1 + width * width * tan2) - 1);
    }

    /// Returns the BRDF x the cosine of `towards`, without Fresnel's share.
    double reflected(const dvec3& view, const dvec3& towards) const {
        const dvec3 half = glm::normalize(view + towards);
        return normals(half) / (4 * view.z * (1 + hidden(view) + hidden(towards)));
    }

    /// Returns the density, by solid angle, with which reflected_way() chooses `towards`.
    double density(const dvec3& view, const dvec3& towards) const {
        const dvec3 half = glm::normalize(view + towards);
        return normals(half) / (4 * view.z * (1 + hidden(view)));
    }

    /// Returns the normal of a random facet that is seen from `view`. u: in [0, 1)^2.
    dvec3 seen_facet(const dvec3& view, const dvec2& u) const {
        const dvec3 seen = glm::normalize(dvec3(width * view.x, width * view.y, view.z));
        const double z = (1 - u.y) * (1 + seen.z) - seen.z;
        const double r = std::sqrt(std::clamp(1 - z * z, 0.0, 1.0));
        const double phi = 2 * std::numbers::pi * u.x;
        const dvec3 cap = dvec3(r * std::cos(phi), r * std::sin(phi), z) + seen;
        return glm::normalize(dvec3(width * cap.x, width * cap.y, cap.z));
    }

    /// Mirrors `view` at such a facet. The result may lie below the surface.
    dvec3 reflected_way(const dvec3& view, const dvec2& u) const {
        const dvec3 half = seen_facet(view, u);
        return 2 * glm::dot(view, half) * half - view;
    }

    /// Returns the normal of the facets that refract light between `view` and `towards`, below
    /// which the index of refraction is `ior` (not 1) times that above.
    static dvec3 refracting_facet(const dvec3& view, const dvec3& towards, double ior) {
        const dvec3 half = glm::normalize(view + ior * towards);
        return half.z < 0 ? -half : half;
    }

    /// Returns the density, by the solid angle of `towards` below the surface, with which light is
    /// refracted at seen_facet(); 0 where no facet does.
    double refracted_density(const dvec3& view, const dvec3& towards, double ior) const {
        const dvec3 half = refracting_facet(view, towards, ior);
        const double in = glm::dot(view, half), out = -glm::dot(towards, half);
        if (!(in > 0) || !(out > 0))
            return 0;
        const double root = in / ior - out;
        return normals(half) * in * out / (view.z * (1 + hidden(view)) * root * root);
    }

    /// Returns the BSDF x the cosine of light refracted from `towards`, without Fresnel's share.
    double refracted(const dvec3& view, const dvec3& towards, double ior) const {
        return refracted_density(view, towards, ior) * (1 + hidden(view)) /
               (1 + hidden(view) + hidden(towards));
    }
};

} // namespace ovc

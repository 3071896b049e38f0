// SPDX-License-Identifier: Apache-2.0
// Microfacets with GGX's slopes, in a frame whose z axis is the normal. All directions are of unit
// length and above the surface. Based on: Walter et al. 2007, "Microfacet Models for Refraction
// through Rough Surfaces" (GGX); Heitz 2014, "Understanding the Masking-Shadowing Function" (the
// height-correlated one); Dupuy and Benyoub 2023, "Sampling Visible GGX Normals with Spherical
// Caps".
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

    /// Mirrors `view` at a random facet that is seen from there. The result may lie below the
    /// surface. u: in [0, 1)^2.
    dvec3 reflected_way(const dvec3& view, const dvec2& u) const {
        const dvec3 seen = glm::normalize(dvec3(width * view.x, width * view.y, view.z));
        const double z = (1 - u.y) * (1 + seen.z) - seen.z;
        const double r = std::sqrt(std::clamp(1 - z * z, 0.0, 1.0));
        const double phi = 2 * std::numbers::pi * u.x;
        const dvec3 cap = dvec3(r * std::cos(phi), r * std::sin(phi), z) + seen;
        const dvec3 half = glm::normalize(dvec3(width * cap.x, width * cap.y, cap.z));
        return 2 * glm::dot(view, half) * half - view;
    }
};

} // namespace ovc

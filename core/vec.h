// SPDX-License-Identifier: Apache-2.0
// Vectors: GLM, configured once. Nobody else includes <glm/…>.
#pragma once

#define GLM_FORCE_EXPLICIT_CTOR
#define GLM_FORCE_SILENT_WARNINGS
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <glm/vector_relational.hpp>

#include <cmath>

namespace ovc {

using glm::dmat3;
using glm::dmat4;
using glm::dvec2;
using glm::dvec3;
using glm::dvec4;
using glm::uvec4;
using glm::vec2;
using glm::vec3;
using glm::vec4;

/// True when no component is NaN or infinite.
template <class V>
bool is_finite(const V& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// The largest component of v.
template <class V>
auto max_component(const V& v) {
    return glm::max(v.x, glm::max(v.y, v.z));
}

/// The sum of the magnitudes of v's components.
template <class V>
auto sum_of_magnitudes(const V& v) {
    return glm::abs(v.x) + glm::abs(v.y) + glm::abs(v.z);
}

/// The axis (0, 1, 2) of the component of v that is largest in magnitude.
template <class V>
int major_axis(const V& v) {
    const V a = glm::abs(v);
    if (a.x >= a.y && a.x >= a.z)
        return 0;
    return a.y >= a.z ? 1 : 2;
}

} // namespace ovc

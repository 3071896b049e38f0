// SPDX-License-Identifier: Apache-2.0
// Takes matrices apart by polar decomposition, and turns by quaternions.
#include "importers/pbrt/interpret/motion.h"

#include "importers/pbrt/interpret/transform.h"

#include <glm/gtc/quaternion.hpp>

#include <cassert>
#include <optional>

namespace ovc::pbrt {
namespace {

struct Parts {
    dvec3 shift;
    glm::dquat rotation;
    dmat3 stretch; // before the rotation; it mirrors where the matrix does
};

/// Returns nothing for a matrix that has no such parts.
std::optional<Parts> taken_apart(const dmat4& m) {
    if (m[0].w != 0 || m[1].w != 0 || m[2].w != 0 || m[3].w != 1)
        return std::nullopt;
    const dmat3 linear(m);
    dmat3 rotation = linear;
    // Each step takes the mean of the matrix and its inverse transposed, which only a rotation, or
    // a mirrored one, equals; steps converge quadratically, once the scale is about 1.
    constexpr int kMaxSteps = 200;
    double change = 1;
    for (int step = 0; step < kMaxSteps && change > 1e-15; ++step) {
        const dmat3 next = 0.5 * (rotation + glm::transpose(glm::inverse(rotation)));
        change = 0;
        for (int i = 0; i < 3; ++i)
            change = glm::max(change, glm::length(next[i] - rotation[i]));
        rotation = next;
    }
    if (!(change < 1e-9))
        return std::nullopt; // NaN for a singular matrix
    if (glm::determinant(rotation) < 0)
        rotation = -rotation;
    return Parts{dvec3(m[3]), glm::normalize(glm::quat_cast(rotation)),
                 glm::transpose(rotation) * linear};
}

template <class T>
T mixed(const T& a, const T& b, double part) {
    return (1 - part) * a + part * b;
}

} // namespace

dmat4 between(const dmat4& start, const dmat4& end, double time) {
    assert(time >= 0 && time <= 1);
    if (time == 0 || start == end)
        return start;
    if (time == 1)
        return end;
    const std::optional<Parts> a = taken_apart(start), b = taken_apart(end);
    if (!a || !b)
        return mixed(start, end, time);
    const dmat3 linear = glm::mat3_cast(glm::slerp(a->rotation, b->rotation, time)) *
                         mixed(a->stretch, b->stretch, time);
    dmat4 m(linear);
    m[3] = glm::dvec4(mixed(a->shift, b->shift, time), 1);
    return m;
}

} // namespace ovc::pbrt

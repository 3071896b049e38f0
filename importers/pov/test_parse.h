// SPDX-License-Identifier: Apache-2.0
// The tests of POV-Ray's scene language share these readers of scenes and values.
#pragma once

#include "importers/readers.h"
#include "importers/test_files.h"

#include <gtest/gtest.h>

#include <string>

namespace ovc {

inline Result<Scene> parsed_scene(const std::string& text) {
    return parse_pov(text, "x.pov", {});
}

/// Returns an expression's value, which the upper corner of a box tells.
inline dvec3 value_of(const std::string& expression, const std::string& before = "") {
    const Result<Scene> scene =
        parsed_scene(before + "\nbox { -1e6, (" + expression + ") * <1, 1, 1> }");
    if (!scene) {
        ADD_FAILURE() << scene.error().message;
        return dvec3(0);
    }
    dvec3 hi(-1e9);
    for (const Triangle& t : triangles_of(scene))
        for (const dvec3& corner : t)
            hi = glm::max(hi, corner);
    return hi;
}

#define EXPECT_VALUE(expected, ...)                                                                \
    do {                                                                                           \
        const dvec3 found_value = value_of(__VA_ARGS__), expected_value(expected);                 \
        EXPECT_LT(glm::length(found_value - expected_value),                                       \
                  1e-7 * (1 + glm::length(expected_value)))                                        \
            << found_value.x << " " << found_value.y << " " << found_value.z;                      \
    } while (false)

} // namespace ovc

// SPDX-License-Identifier: Apache-2.0
// What a scene consists of and what it needs: for `overcast info`, and for framing.
#pragma once

#include "core/box.h"
#include "core/scene.h"

#include <cstdint>
#include <string>
#include <vector>

namespace ovc {

/// What rendering the scene takes; what is not needed is neither stored nor sent anywhere.
struct Needs {
    bool vertex_normals = false;
    bool texture_coordinates = false; // no material of ours has textures
    bool reflection = false;
    bool refraction = false;
    bool shadows = true;
};

/// Something a renderer commonly keeps and this scene goes without.
struct LeftOut {
    std::string what;
    uint64_t bytes; // what it would take in host memory
};

struct SceneSummary {
    uint64_t triangles = 0;
    uint64_t meshes = 0;
    Dropped dropped;
    Box bounds; // of the triangles that can be hit
    Needs needs;
    std::vector<LeftOut> left_out;
};

SceneSummary summarize(const Scene& scene);

/// SceneSummary::bounds alone.
Box hittable_bounds(const Soup& soup);

} // namespace ovc

// SPDX-License-Identifier: Apache-2.0
// The parts and the needs of a scene: for `overcast info`, and for framing.
#pragma once

#include "core/box.h"
#include "core/result.h"
#include "core/scene.h"
#include "importers/scratch/triangle_store.h"

#include <cstdint>
#include <string>
#include <vector>

namespace ovc {

/// The needs of rendering the scene; anything else is neither stored nor sent anywhere.
struct Needs {
    bool vertex_normals = false;
    bool texture_coordinates = false; // no material of ours has textures
    bool reflection = false;
    bool refraction = false;
    bool shadows = true;
    bool several_leaves = true; // rays walk from leaf to leaf, and wait for some
    bool certified = true;      // answers are proven, or resolved in double
};

/// The user's part, which the scene itself does not have.
struct Query {
    bool shadows = true;
    bool certified = true;
    uint64_t leaves = 2; // of level 1, as far as known
};

/// Something that a scene's file has and the scene goes without, or that rendering does not do.
struct LeftOut {
    std::string what;
    uint64_t bytes; // what it would take in host memory; 0: time, and code of the kernel
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
/// Does the same for a scene whose meshes are empty and whose triangles lie in the store. Error:
/// the disk fails.
Result<SceneSummary> summarize(const Scene& scene, const TriangleStore& store);

/// By its meshes and materials alone, whose triangles are not looked at.
Needs needs_of(const Scene& scene, const Query& query = {});

/// All that is not needed, with what it would take.
std::vector<LeftOut> left_out_of(const Scene& scene, const Needs& needs);

/// Returns "not drawn as its author meant: SENTENCE (COUNT); …", without a line end; empty where
/// everything is.
std::string omissions_text(const std::vector<Omission>& omissions);

/// In one line: "vertex normals (1.0 KiB), reflection rays".
std::string left_out_text(const std::vector<LeftOut>& left_out);

/// SceneSummary::bounds alone.
Box hittable_bounds(const Soup& soup);

} // namespace ovc

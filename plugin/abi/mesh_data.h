// SPDX-License-Identifier: Apache-2.0
// What the host hands in as a mesh or a transform, checked and copied. All functions throw a
// Failure that names the field for anything wrong.
#pragma once

#include "core/transform.h"
#include "core/vec.h"
#include "plugin/overcast.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace ovc {

/// Returns the struct with its stride filled in. Indices are not checked yet.
ovc_mesh checked(const ovc_mesh* given);

/// Returns the number of triangles of a checked mesh.
uint64_t triangles_of(const ovc_mesh& mesh);

/// Whether the positions, floats or doubles, lie one after the other as corners do.
bool is_packed(const ovc_mesh& mesh);

/// Returns three corners for each triangle of a checked mesh whose positions are floats.
std::vector<vec3> copied_corners(const ovc_mesh& mesh);
/// Does the same where they are doubles.
std::vector<dvec3> copied_double_corners(const ovc_mesh& mesh);

/// Returns the transform of twelve numbers; nothing for null. field: its name in messages.
std::optional<Transform> transform_of(const char* field, const double* given);

} // namespace ovc

// SPDX-License-Identifier: Apache-2.0
// Test scenes as code. The same name gives the same triangles, bit for bit, on any machine.
#pragma once

#include "core/file/triangle_sink.h"
#include "core/result.h"
#include "testscenes/camera_path.h"

#include <span>
#include <string>
#include <string_view>

namespace ovc {

struct CatalogEntry {
    std::string_view name;        // "plants", or "NAME-N" if the scene takes a size
    std::string_view description; // one line, with its triangle count
    uint32_t frames = 0;          // the frames of its camera path, or 0 if it has none
    bool takes_model = false;     // whether it can show a user's model
    bool moves = false;           // whether it moves with the clock
    bool streams = false;         // whether stream_test_scene() makes it
};

/// Returns all scenes, for `overcast scenes` and for suggestions.
std::span<const CatalogEntry> catalog();

/// Returns whether `name` names a scene of the catalog. Its size may be out of range.
bool is_test_scene(std::string_view name);

/// Returns the entry of such a name.
const CatalogEntry& test_scene_entry(std::string_view name);

/// Builds the scene. model: shown instead of the generated model and scaled to fit, or null. clock:
/// from 0 to 1, for scenes that move. Errors: an unknown name (the nearest one is suggested), a
/// size out of range, a model for a scene that takes none, or a model without a triangle to hit.
Result<Scene> make_test_scene(std::string_view name, const Soup* model = nullptr, double clock = 0);

/// Hands the triangles of a scene that streams to the sink, and returns the rest of it, whose
/// meshes are empty; of more sizes than make_test_scene() makes. Errors: a size out of range; of
/// the kind Cancelled where the sink wants no more.
Result<Scene> stream_test_scene(std::string_view name, TriangleSink& sink);

/// Returns the camera path of the scene. Errors: those of make_test_scene(), or a scene without a
/// path.
Result<CameraPath> test_scene_path(std::string_view name);

} // namespace ovc

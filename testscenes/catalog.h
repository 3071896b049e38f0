// SPDX-License-Identifier: Apache-2.0
// Test scenes as code: a name in, a Scene out. The same name gives the same triangles, bit for bit,
// on any machine.
#pragma once

#include "core/result.h"
#include "testscenes/camera_path.h"

#include <span>
#include <string>
#include <string_view>

namespace ovc {

struct CatalogEntry {
    std::string_view name;        // "plants"; "NAME-N" where the entry takes a size
    std::string_view description; // one line, with its triangle count
    uint32_t frames = 0;          // of its camera path; 0: it has none
    bool takes_model = false;     // shows a model of the user's instead of its own
    bool moves = false;           // with the clock
};

/// All scenes, for `overcast scenes` and for suggestions.
std::span<const CatalogEntry> catalog();

/// True when `name` names a scene of the catalog, its size perhaps out of range.
bool is_test_scene(std::string_view name);

/// The entry of such a name.
const CatalogEntry& test_scene_entry(std::string_view name);

/// Builds the scene. model: what it shows instead of its generated model, scaled to fit; null:
/// none. clock: from 0 to 1, for scenes that move. Error: an unknown name (the nearest one is
/// suggested), a size out of range, a model for a scene that takes none or without a triangle to
/// hit.
Result<Scene> make_test_scene(std::string_view name, const Soup* model = nullptr, double clock = 0);

/// The camera path of the scene. Error: as of make_test_scene(), or the scene has none.
Result<CameraPath> test_scene_path(std::string_view name);

} // namespace ovc

// SPDX-License-Identifier: Apache-2.0
// Test scenes as code: a name in, a Scene out. The same name gives the same triangles, bit for bit,
// on any machine.
#pragma once

#include "core/result.h"
#include "core/scene.h"

#include <span>
#include <string>
#include <string_view>

namespace ovc {

struct CatalogEntry {
    std::string_view name;        // "plants"; "NAME-N" where the entry takes a size
    std::string_view description; // one line, with its triangle count
};

/// All scenes, for `overcast scenes` and for suggestions.
std::span<const CatalogEntry> catalog();

/// True when `name` names a scene of the catalog, its size perhaps out of range.
bool is_test_scene(std::string_view name);

/// Builds the scene. Error: an unknown name (the nearest one is suggested) or a size out of range.
Result<Scene> make_test_scene(std::string_view name);

} // namespace ovc

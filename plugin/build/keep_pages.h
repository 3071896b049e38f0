// SPDX-License-Identifier: Apache-2.0
// keep_pages(): leaves in a scene the pages of one rank, where several ranks share them out.
#pragma once

#include "plugin/build/built_scene.h"

#include <cstdint>
#include <vector>

namespace ovc {

/// Whether each of BuiltScene::pages stays.
using PagesKept = std::vector<bool>;

/// Drops all other pages of the scene, and the leaves that they belong to. The scene has its pages
/// (gather_pages()), and no top-level tree yet. Afterwards it can be traced, but neither saved nor
/// updated: rays meet what is left, and the triangles keep their names.
void keep_pages(BuiltScene& scene, const PagesKept& kept);

} // namespace ovc

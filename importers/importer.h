// SPDX-License-Identifier: Apache-2.0
// Importers: a file in, a Scene out; and back, for `overcast convert`.
#pragma once

#include "core/result.h"
#include "core/scene.h"
#include "core/system/log.h"
#include "importers/file/files_read.h"

#include <filesystem>
#include <string>
#include <vector>

namespace ovc {

/// What a scene of instances may become where nothing else is said: 3.6 GB of soup.
inline constexpr uint64_t kDefaultMostTriangles = 100'000'000;

/// What ImportOptions::tolerance may be: from what a sphere of 1e5 triangles has to an octagon's.
inline constexpr double kMinTolerance = 1e-4, kMaxTolerance = 0.5;

struct ImportOptions {
    LogSink log; // warnings: what a file asks for and Overcast leaves out, one per kind
    /// Scene descriptions (.pbrt): what is unknown, missing or unusable is an error, not a warning.
    bool strict = false;
    /// Scene descriptions: more triangles than this, instances expanded, are refused before they
    /// are made.
    uint64_t max_triangles = kDefaultMostTriangles;
    /// Scene descriptions: how far a triangle may lie off the round shape it stands for, in the
    /// shape's radii; from kMinTolerance to kMaxTolerance. Nothing: what the reader has found
    /// good.
    std::optional<double> tolerance = {};
    /// Of a .pbrt file with several worlds: which, from 1.
    uint64_t world = 1;
    /// Of the picture to come, where that is known: scenes of POV-Ray may ask for it.
    std::optional<ImageSize> size = {};
    /// Of scenes of POV-Ray, until they name one themselves: the version of the language.
    std::optional<double> pov_version = {};
    /// Receives every file that is read or looked for in vain; null: nobody asks.
    FilesRead* files = nullptr;
};

/// Reads a scene. The reader is chosen by the extension, a trailing .gz taken off first; any case.
/// A compressed file is recognised by its contents, whatever its name. Never throws on bad input:
/// the Error is one sentence with file, line or byte, what was found, what was expected. Memory is
/// bounded by what the file holds, not by what it claims. Polygons are cut into triangles in file
/// order; a degenerate or non-finite triangle is kept (it is counted and dropped when a structure
/// is built), so that prim numbers follow the file.
Result<Scene> load(const std::filesystem::path& path, const ImportOptions& options = {});

/// Writes the triangles of `scene` as .ply (one mesh, binary little endian, double positions where
/// float would move them) or .obj (an object per mesh); normals and materials are not written.
/// Corners that agree in every bit become one vertex. load() gives back the same triangles bit for
/// bit where floats hold them; where only doubles do, offsets are rounded to floats anew, and .obj
/// keeps the digits but load() takes them for floats unless they are far from 0. Or all of the
/// scene as .ovc (scene_file.h), which comes back as it is. A file that exists is replaced only
/// once the new one is complete; what is written is removed where it cannot be.
Result<Done> save(const Scene& scene, const std::filesystem::path& path);

/// The extensions load() reads with readers of ours, without the dot ("ply", "obj"); Assimp's are
/// not listed.
std::vector<std::string> own_extensions();

} // namespace ovc

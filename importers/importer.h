// SPDX-License-Identifier: Apache-2.0
// Importers read files into scenes, and write scenes to files for `overcast convert`.
#pragma once

#include "core/file/triangle_sink.h"
#include "core/moment.h"
#include "core/result.h"
#include "core/scene.h"
#include "core/system/log.h"
#include "importers/file/files_read.h"

#include <filesystem>
#include <string>
#include <vector>

namespace ovc {

/// The max triangles of one mesh: prims are numbered in 32 bits, and kNone stands for no prim.
inline constexpr uint64_t kMaxTriangles = 0xfffffffe;

/// The default of ImportOptions::max_triangles: 3.6 GB of soup.
inline constexpr uint64_t kDefaultMaxTriangles = 100'000'000;

/// The range of ImportOptions::tolerance: at the min a sphere has 1e5 triangles, at the max a
/// circle is an octagon.
inline constexpr double kMinTolerance = 1e-4, kMaxTolerance = 0.5;

/// The sink for the triangles of a scene that is not to be held in memory.
struct Streaming {
    TriangleSink& sink;
    uint64_t host_bytes;               // that reading may take
    std::filesystem::path folder = {}; // for scratch files
};

struct ImportOptions {
    LogSink log; // receives one warning per kind of thing that Overcast leaves out of a file
    /// Makes anything unknown, missing or unusable in a .pbrt, and anything that is not drawn as
    /// its author meant in a .pov, an error instead of a warning.
    bool strict = false;
    /// The max triangles of a scene description. The reader refuses more before it makes them;
    /// pbrt/census.h says how it counts instances.
    uint64_t max_triangles = kDefaultMaxTriangles;
    /// How far a triangle of a scene description may lie off the round shape it stands for, in the
    /// shape's radii, from kMinTolerance to kMaxTolerance. Each reader has a default of its own.
    std::optional<double> tolerance = {};
    /// The world to read of a .pbrt file that has several, from 1.
    uint64_t world = 1;
    /// The moment that the scene is to be of: those of POV-Ray and PBRT may move.
    Moment moment = {};
    /// The size of the picture to come, if it is known: scenes of POV-Ray may ask for it.
    std::optional<ImageSize> size = {};
    /// The version of POV-Ray's language that a scene is in until it names one itself.
    std::optional<double> pov_version = {};
    /// Keeps texture coordinates in MeshInfo::uv. Only .ply has them so far.
    bool texture_coordinates = false;
    /// The budget of host memory for an .ovc file, whose triangles and what was built of them stay
    /// on the disk (Scene::on_disk); 0: all of it is to be in memory.
    uint64_t host_bytes = 0;
    /// Receives every file that is read or looked for in vain; may be null.
    FilesRead* files = nullptr;
    /// Not null: the triangles go to its sink, and the scene that comes back has empty meshes. For
    /// files that streams() names alone. A scene that places meshes more than once comes back whole
    /// instead, and the sink gets nothing, if it can be converted in so much memory. Error of the
    /// kind Cancelled: the sink wants no more.
    const Streaming* streaming = nullptr;
};

/// Returns whether the file's triangles can go to a sink, as far as the name tells: .ply, .obj and
/// .pbrt can.
bool streams(const std::filesystem::path& path);

/// Reads a scene. The extension chooses the reader, in any case and after a trailing .gz is taken
/// off. A compressed file is recognised by its contents, whatever its name. Never throws on bad
/// input: the Error is one sentence with file, line or byte, what was found, what was expected.
/// Memory is bounded by what the file holds, not by what it claims. Assimp reads in a process of
/// its own, so that its crashes are errors too. Polygons are cut into triangles in file order; a
/// degenerate or non-finite triangle is kept (it is counted and dropped when a structure is built),
/// so that prim numbers follow the file.
Result<Scene> load(const std::filesystem::path& path, const ImportOptions& options = {});

/// Writes the triangles of `scene` as .ply (one mesh, binary little endian, double positions where
/// float would move them) or .obj (an object per mesh); normals and materials are not written.
/// Corners that agree in every bit become one vertex. load() gives back the same triangles bit for
/// bit where floats hold them; where only doubles do, offsets are rounded to floats anew, and .obj
/// keeps the digits but load() takes them for floats unless they are far from 0. An .ovc file
/// (scene_file.h) holds all of the scene, which comes back as it is. A file that exists is replaced
/// only once the new one is complete; on an error the unfinished file is removed.
Result<Done> save(const Scene& scene, const std::filesystem::path& path);

/// Returns whether load() may give other scenes for other moments, as far as the name tells.
bool may_move(const std::filesystem::path& path);

} // namespace ovc

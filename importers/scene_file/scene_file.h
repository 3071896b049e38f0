// SPDX-License-Identifier: Apache-2.0
// The scene file, .ovc, holds everything of core/scene.h and the levels that the plugin has built
// of it, and is mapped into memory. It is a cache for this version on this kind of machine.
#pragma once

#include "core/file/archive.h"
#include "importers/file/files_read.h"
#include "importers/file/output_file.h"
#include "importers/importer.h"
#include "importers/scratch/triangle_store.h"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace ovc {

/// The request and the files that a scene was made from, and the warnings they led to.
struct Provenance {
    std::string request;          // in the caller's words
    std::vector<FileStamp> files; // read, or looked for in vain
    std::vector<std::string> warnings;

    /// Returns the first file that is not as it was; null if all are.
    const FileStamp* changed_file() const;
};

struct SceneFile {
    Scene scene; // its chunks and Scene::saved lie in Scene::files
    Provenance from;
};

/// Writes the scene's levels, which come back as Scene::saved.
using SaveLevels = std::function<Result<Done>(const ByteSink&)>;

/// Writes the scene to `path`, which is replaced only once the new file is complete. save_levels
/// may be empty.
Result<Done> write_scene_file(const Scene& scene, const Provenance& from,
                              const SaveLevels& save_levels, const std::filesystem::path& path);

/// Does the same for a scene whose meshes are empty and whose triangles lie in the store.
Result<Done> write_scene_file(const Scene& scene, const TriangleStore& store,
                              const Provenance& from, const SaveLevels& save_levels,
                              const std::filesystem::path& path);

/// Writes the file of a scene in memory, without levels, to a sink. Returns false where the sink
/// wanted no more.
bool write_scene(const Scene& scene, const Provenance& from, const ByteSink& sink);

/// The front of a scene file is everything but the levels. It lies in an unfinished file until they
/// are written behind it, perhaps by a later run of the program.
struct SceneFront {
    struct Mesh {
        dvec3 origin{0};
        uint64_t triangles = 0;
        uint64_t offset = 0; // of its corners in the file
    };
    std::vector<ArchivePart> parts; // which identify it
    std::vector<Mesh> meshes;
    Provenance from;
};

/// Writes the front of the file that write_scene_file() would write, and returns its parts.
Result<std::vector<ArchivePart>> write_front(const Scene& scene, const TriangleStore& store,
                                             const Provenance& from, OutputFile& out);

/// Reads what a front says of its meshes. Error: it is damaged, or cannot be read. The sentence
/// begins with the path.
Result<SceneFront> open_front(const std::filesystem::path& path, std::vector<ArchivePart> parts);

/// Reads the large parts of a front that an earlier run has written, to check them. Errors are as
/// above.
Result<Done> check_front(const std::filesystem::path& path, const SceneFront& front);

/// Returns where a front ends, and the levels begin.
uint64_t end_of(const SceneFront& front);

/// Writes the levels to `out`, which goes on behind the front, and commits it.
Result<Done> finish_scene_file(const SceneFront& front, const SaveLevels& save_levels,
                               OutputFile& out);

/// Returns how many bytes write_scene_file() would write of a scene in memory whose levels take so
/// many, within some for the names of files and warnings; of one on a disk, what its file has.
uint64_t scene_file_bytes(const Scene& scene, uint64_t levels_bytes);
/// Does the same for a scene whose meshes are empty and whose triangles lie in the store.
uint64_t scene_file_bytes(const Scene& scene, const TriangleStore& store, uint64_t levels_bytes);

/// Returns how much of a budget of host memory shading takes for itself, where it reads the file of
/// such a scene.
uint64_t bytes_for_shading(const Scene& scene, const TriangleStore& store, uint64_t host_bytes);

/// Returns a checksum of everything that a picture of the scene depends on, and of its names. It is
/// the same whether a scene file was read or opened.
uint64_t checksum_of(const Scene& scene);

/// Reads a scene file and checks everything except the levels, which the plugin checks, so that it
/// returns a sound scene. An Error tells of damage, another version or no such file; its sentence
/// begins with the path.
Result<SceneFile> read_scene_file(const std::filesystem::path& path);

/// Does the same, but leaves corners, normals, texture coordinates and levels on the disk,
/// unchecked (Scene::on_disk). host_bytes: the budget of host memory for reading them. Error:
/// besides, the file holds no levels.
Result<SceneFile> open_scene_file(const std::filesystem::path& path, uint64_t host_bytes);

} // namespace ovc

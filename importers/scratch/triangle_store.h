// SPDX-License-Identifier: Apache-2.0
// TriangleStore keeps the triangles of a scene in scratch files instead of memory.
#pragma once

#include "core/file/triangle_sink.h"
#include "importers/scratch/scratch_file.h"

#include <cstdint>
#include <vector>

namespace ovc {

/// It takes a scene's triangles once; from then on they may be read in any order. A mesh that is
/// left and gone on with takes 16 bytes of memory each time.
class TriangleStore final : public TriangleSink {
public:
    /// Error: as ScratchFile::create().
    static Result<TriangleStore> create(const std::filesystem::path& folder);

    void begin_mesh() override;
    void go_on_with(size_t mesh) override;
    void drop_normals(size_t mesh) override;
    bool add_corners(std::span<const vec3> corners) override;
    bool add_normals(std::span<const vec3> normals) override;
    /// Call this once all is added. Error: the disk is full, or fails.
    Result<Done> finish();

    size_t meshes() const { return corners_.meshes.size(); }
    uint64_t corners(size_t mesh) const { return corners_.meshes[mesh].items; }
    uint64_t normals(size_t mesh) const { return normals_.meshes[mesh].items; }
    uint64_t triangles() const { return corners_.items / 3; }

    /// Reads corners of a mesh from its corner `first` on. Any number of threads may call this.
    /// Returns false where the disk fails; error() then says why.
    bool read_corners(size_t mesh, uint64_t first, std::span<vec3> corners) const;
    /// Does the same with normals.
    bool read_normals(size_t mesh, uint64_t first, std::span<vec3> normals) const;

    /// Passes all corners, or all normals, to a sink, mesh by mesh. Error: the disk fails.
    Result<Done> write_corners(const ByteSink& sink) const { return write(corners_, sink); }
    Result<Done> write_normals(const ByteSink& sink) const { return write(normals_, sink); }

    std::optional<Error> error() const;

private:
    /// Items of a mesh that lie one behind the other in the file, up to the next run of the mesh.
    struct Run {
        uint64_t before; // items of the mesh before these
        uint64_t at;     // the place of the first in the file
    };
    struct Mesh {
        uint64_t items = 0;
        std::vector<Run> runs{};
    };
    /// Items of all meshes, in the order in which they came.
    struct Items {
        mutable ScratchFile file; // reading notes failures
        uint64_t items = 0;
        std::vector<vec3> waiting{}; // the last of them, not in the file yet
        std::vector<Mesh> meshes{};
    };

    TriangleStore(ScratchFile corners, ScratchFile normals)
        : corners_{std::move(corners)}, normals_{std::move(normals)} {}

    bool add(Items& to, std::span<const vec3> items) const;
    static bool flush(Items& items);
    static bool read(const Items& items, const Mesh& mesh, uint64_t first, std::span<vec3> to);
    static Result<Done> write(const Items& items, const ByteSink& sink);

    Items corners_;
    Items normals_;
    size_t mesh_ = 0; // that is being added to
};

} // namespace ovc

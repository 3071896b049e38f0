// SPDX-License-Identifier: Apache-2.0
// TriangleStore keeps the triangles of a scene in scratch files instead of memory.
#pragma once

#include "core/file/triangle_sink.h"
#include "importers/file/scratch_file.h"

#include <cstdint>
#include <vector>

namespace ovc {

/// It takes a scene's triangles once, front to back; from then on they may be read in any order.
class TriangleStore final : public TriangleSink {
public:
    /// Error: as ScratchFile::create().
    static Result<TriangleStore> create(const std::filesystem::path& folder);

    void begin_mesh() override { meshes_.push_back({corners_.items, normals_.items}); }
    bool add_corners(std::span<const vec3> corners) override;
    bool add_normals(std::span<const vec3> normals) override;
    /// Call this once all is added. Error: the disk is full, or fails.
    Result<Done> finish();

    size_t meshes() const { return meshes_.size(); }
    uint64_t corners(size_t mesh) const { return end(mesh).corners - meshes_[mesh].corners; }
    uint64_t normals(size_t mesh) const { return end(mesh).normals - meshes_[mesh].normals; }
    uint64_t triangles() const { return corners_.items / 3; }

    /// Reads corners of a mesh from its corner `first` on. Any number of threads may call this.
    /// Returns false where the disk fails; error() then says why.
    bool read_corners(size_t mesh, uint64_t first, std::span<vec3> corners) const;

    /// Passes all corners, or all normals, to a sink, in order. Error: the disk fails.
    Result<Done> write_corners(const ByteSink& sink) const { return write(corners_, sink); }
    Result<Done> write_normals(const ByteSink& sink) const { return write(normals_, sink); }

    std::optional<Error> error() const;

private:
    /// Items one behind the other in a file.
    struct Items {
        mutable ScratchFile file; // reading notes failures
        uint64_t items = 0;
        std::vector<vec3> waiting{}; // the last of them, not in the file yet
    };
    /// The items before those of a mesh.
    struct Begin {
        uint64_t corners = 0;
        uint64_t normals = 0;
    };

    TriangleStore(ScratchFile corners, ScratchFile normals)
        : corners_{std::move(corners)}, normals_{std::move(normals)} {}

    Begin end(size_t mesh) const {
        return mesh + 1 < meshes_.size() ? meshes_[mesh + 1]
                                         : Begin{corners_.items, normals_.items};
    }
    static bool add(Items& to, std::span<const vec3> items);
    static bool flush(Items& items);
    static Result<Done> write(const Items& items, const ByteSink& sink);

    Items corners_;
    Items normals_;
    std::vector<Begin> meshes_;
};

} // namespace ovc

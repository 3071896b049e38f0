// SPDX-License-Identifier: Apache-2.0
// MeshOutput puts meshes into a scene; where it streams, their triangles go to a sink instead.
#pragma once

#include "core/scene.h"
#include "importers/importer.h"
#include "importers/pbrt/look/exposure.h"

#include <utility>

namespace ovc::pbrt {

class MeshOutput {
public:
    /// triangles: of all meshes to come. streaming: null where the scene holds them.
    MeshOutput(Scene& scene, uint64_t triangles, const Streaming* streaming)
        : scene_(scene), streaming_(streaming), meter_(scene, triangles) {}

    Scene& scene() { return scene_; }
    bool is_wanted() const { return is_wanted_; }
    /// Returns the exposure of all triangles that were added.
    float exposure() const { return streaming_ ? meter_.exposure() : fitting_exposure(scene_); }

    uint32_t add_mesh(std::string name, uint32_t material, Chunk chunk, std::vector<vec3> normals) {
        if (!streaming_)
            return scene_.add_mesh(std::move(name), material, std::move(chunk), std::move(normals));
        const uint32_t mesh = begin_mesh(std::move(name), material, chunk.origin());
        add(chunk, normals);
        return mesh;
    }

    /// Begins a mesh whose triangles are streamed.
    uint32_t begin_mesh(std::string name, uint32_t material, const dvec3& origin) {
        streaming_->sink.begin_mesh();
        return scene_.add_mesh(std::move(name), material, Chunk::owning(origin, {}));
    }

    /// Adds the next triangles of the mesh, and their normals, to the stream.
    void add(const Chunk& part, std::span<const vec3> normals) {
        meter_.add(part, scene_.materials[scene_.meshes.back().material]);
        is_wanted_ = is_wanted_ && streaming_->sink.add_corners(part.corners()) &&
                     (normals.empty() || streaming_->sink.add_normals(normals));
    }

private:
    Scene& scene_;
    const Streaming* streaming_;
    ExposureMeter meter_;
    bool is_wanted_ = true; // by the sink
};

} // namespace ovc::pbrt

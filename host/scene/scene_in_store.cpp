// SPDX-License-Identifier: Apache-2.0
// SceneInStore: files and the test scene without an end stream, each through a sink.
#include "host/scene/scene_in_store.h"

#include "importers/importer.h"
#include "testscenes/catalog.h"

#include <fmt/format.h>

namespace ovc {

bool SceneInStore::has_normals() const {
    for (size_t m = 0; m < store.meshes(); ++m)
        if (store.normals(m) > 0)
            return true;
    return false;
}

Result<Done> check_streams(const SceneArguments& arguments) {
    if (arguments.scenes.size() > 1 || !arguments.model.empty())
        return Error{"--host-memory goes with one input alone"};
    const std::string& source = arguments.scenes.front();
    if (is_test_scene(source) ? test_scene_entry(source).streams : streams(source))
        return Done{};
    return Error{fmt::format("--host-memory goes with inputs that stream, .ply, .obj, .pbrt and "
                             "the test scene landscape-N; found '{}'",
                             source)};
}

static Result<Scene> stream(const SceneArguments& source, const Streaming& streaming,
                            const LogSink& log, FilesRead* files) {
    if (is_test_scene(source.scenes.front()))
        return stream_test_scene(source.scenes.front(), streaming.sink);
    ImportOptions options = import_options(source, log, files);
    options.streaming = &streaming;
    if (source.max_triangles.empty())
        options.max_triangles = kMaxTriangles;
    return load(source.scenes.front(), options);
}

Result<SceneInStore> stream_scene(const SceneArguments& source, uint64_t host_bytes,
                                  const std::filesystem::path& folder, const LogSink& log,
                                  FilesRead* files) {
    Result<TriangleStore> store = TriangleStore::create(folder);
    if (!store)
        return store.error();
    Result<Scene> scene = stream(source, {*store, host_bytes, folder}, log, files);
    if (const Result<Done> stored = store->finish(); !stored)
        return stored.error(); // reading ends where the store fails
    if (!scene)
        return scene.error();
    return SceneInStore{std::move(*scene), std::move(*store)};
}

StreamedTriangles triangles_in(const Scene& scene, const TriangleStore& store) {
    StreamedTriangles triangles;
    for (size_t m = 0; m < store.meshes(); ++m)
        triangles.meshes.push_back({scene.soup.chunks[m].origin(), store.corners(m) / 3});
    triangles.read = [&](uint32_t mesh, uint64_t first, std::span<vec3> corners) {
        return store.read_corners(mesh, 3 * first, corners);
    };
    triangles.error = [&] { return store.error(); };
    return triangles;
}

} // namespace ovc

// SPDX-License-Identifier: Apache-2.0
// The functions that the plugin reads, writes and keeps steps with.
#include "host/backend/streamed_levels.h"

#include "host/backend/plugin_config.h"
#include "host/backend/plugin_loader.h"
#include "host/terminal/terminal_line.h"

#include <fmt/format.h>

#include <atomic>
#include <vector>

namespace ovc {
namespace {

/// The user pointer of the plugin's functions.
struct Streams {
    const StreamedTriangles& triangles;
    const char* work; // for the terminal
    TerminalLine line;
    ScratchFile* scratch = nullptr; // of a build, like the next
    const ByteSink* sink = nullptr;
    const KeptLevels* kept = nullptr;
    std::atomic<uint64_t> read_bytes{0};
    std::atomic<uint64_t> written_bytes{0};

    static int tell(void* user, double done, const char* stage) {
        Streams& self = *static_cast<Streams*>(user);
        self.line.show(fmt::format("{}: {:3.0f} %, {}; {} read, {} written", self.work, 100 * done,
                                   stage, human_bytes(self.read_bytes),
                                   human_bytes(self.written_bytes)));
        return 0; // Ctrl-C ends the program at once
    }

    static int read_corners(void* user, uint32_t mesh, uint64_t first, uint64_t count, void* to) {
        Streams& self = *static_cast<Streams*>(user);
        const std::span corners(static_cast<vec3*>(to), size_t(3 * count));
        self.read_bytes += corners.size_bytes();
        return self.triangles.read(mesh, first, corners) ? 0 : 1;
    }
    static int write_scratch(void* user, uint64_t offset, const void* bytes, size_t size) {
        Streams& self = *static_cast<Streams*>(user);
        self.written_bytes += size;
        return self.scratch->write(offset, {static_cast<const std::byte*>(bytes), size}) ? 0 : 1;
    }
    static int read_scratch(void* user, uint64_t offset, void* bytes, size_t size) {
        Streams& self = *static_cast<Streams*>(user);
        self.read_bytes += size;
        return self.scratch->read(offset, {static_cast<std::byte*>(bytes), size}) ? 0 : 1;
    }
    static int write(void* user, const void* bytes, size_t size) {
        Streams& self = *static_cast<Streams*>(user);
        self.written_bytes += size;
        return (*self.sink)({static_cast<const std::byte*>(bytes), size}) ? 0 : 1;
    }
    static int keep_step(void* user, const void* bytes, size_t size) {
        const KeptLevels& kept = *static_cast<Streams*>(user)->kept;
        const Bytes step(static_cast<const std::byte*>(bytes), size);
        return kept.flush() && kept.steps.keep(step) ? 0 : 1;
    }
    static int read_written(void* user, uint64_t offset, void* bytes, size_t size) {
        Streams& self = *static_cast<Streams*>(user);
        self.read_bytes += size;
        return self.kept->read_written(offset, {static_cast<std::byte*>(bytes), size}) ? 0 : 1;
    }

    /// Returns why one of these has failed; the plugin only knows that it has.
    std::optional<Error> error() const {
        std::optional<Error> failed = triangles.error();
        if (!failed && scratch)
            failed = scratch->error();
        return failed || !kept ? failed : kept->steps.error();
    }
};

std::vector<ovc_streamed_mesh> meshes_of(const StreamedTriangles& triangles) {
    std::vector<ovc_streamed_mesh> meshes;
    for (const StreamedTriangles::Mesh& mesh : triangles.meshes)
        meshes.push_back({{mesh.origin.x, mesh.origin.y, mesh.origin.z}, mesh.triangles, 0, 0});
    return meshes;
}

std::vector<ovc_kept_step> steps_of(const KeptLevels* kept) {
    std::vector<ovc_kept_step> steps;
    if (kept)
        for (const std::vector<std::byte>& step : kept->steps.steps().subspan(kept->first))
            steps.push_back({step.data(), step.size()});
    return steps;
}

Result<PluginDevice> open_device(const BackendOptions& options, const LogSink& log) {
    if (structure_of(options.kind) != OVC_STRUCTURE_TWO_LEVEL ||
        options.kind == BackendKind::CpuKdTree || options.kind == BackendKind::Embree)
        return Error{"--host-memory is for two-level, which alone can be saved"};
    const Result<const ovc_api*> api = load_plugin();
    if (!api)
        return api.error();
    return PluginDevice::open(*api, options.device, log);
}

/// A device of the plugin, and how it is to be used.
struct OpenedDevice {
    PluginDevice device;
    ovc_scene_config config;
};

Result<OpenedDevice> open_configured(const BackendOptions& options, const LogSink& log) {
    Result<PluginDevice> device = open_device(options, log);
    if (!device)
        return device.error();
    const Result<ovc_device_info> info = device->describe();
    if (!info)
        return info.error();
    const Result<ovc_scene_config> config = config_of(options, *info, log);
    if (!config)
        return config.error();
    return OpenedDevice{std::move(*device), *config};
}

/// Returns the scene as far as planning asks for it. meshes: of the streams' triangles.
ovc_streamed_scene scene_of(Streams& streams, std::span<const ovc_streamed_mesh> meshes,
                            uint64_t host_bytes) {
    ovc_streamed_scene scene{};
    scene.struct_size = sizeof(scene);
    scene.host_memory_bytes = host_bytes;
    scene.meshes = meshes.data();
    scene.mesh_count = uint32_t(meshes.size());
    scene.user = &streams;
    scene.read_corners = Streams::read_corners;
    return scene;
}

/// Returns the result of a call of the plugin, or why a function that it called has failed.
template <class T>
Result<T> explained(Result<T> result, const Streams& streams) {
    const std::optional<Error> failed = streams.error();
    return result || !failed ? std::move(result) : Result<T>(*failed);
}

} // namespace

Result<Done> save_streamed_levels(const StreamedTriangles& triangles, uint64_t host_bytes,
                                  ScratchFile& scratch, const BackendOptions& options,
                                  const LogSink& log, const ByteSink& sink,
                                  const KeptLevels* kept) {
    Result<OpenedDevice> opened = open_configured(options, log);
    if (!opened)
        return opened.error();
    Streams streams{triangles, "building", TerminalLine(options.watching == BuildWatching::Shown),
                    &scratch,  &sink,      kept};
    opened->config.progress = Streams::tell;
    opened->config.progress_user = &streams;
    const std::vector<ovc_streamed_mesh> meshes = meshes_of(triangles);
    const std::vector<ovc_kept_step> steps = steps_of(kept);
    ovc_streamed_scene scene = scene_of(streams, meshes, host_bytes);
    scene.write_scratch = Streams::write_scratch;
    scene.read_scratch = Streams::read_scratch;
    scene.write = Streams::write;
    if (kept) {
        scene.keep_step = Streams::keep_step;
        scene.kept = steps.data();
        scene.kept_count = steps.size();
        scene.read_written = Streams::read_written;
    }
    return explained(opened->device.save_streamed(opened->config, scene), streams);
}

Result<ovc_plan> plan_streamed_levels(const StreamedTriangles& triangles, uint64_t host_bytes,
                                      const BackendOptions& options, const LogSink& log) {
    Result<OpenedDevice> opened = open_configured(options, log);
    if (!opened)
        return opened.error();
    Streams streams{triangles, "planning", TerminalLine(options.watching == BuildWatching::Shown)};
    opened->config.progress = Streams::tell;
    opened->config.progress_user = &streams;
    const std::vector<ovc_streamed_mesh> meshes = meshes_of(triangles);
    return explained(
        opened->device.plan_streamed(opened->config, scene_of(streams, meshes, host_bytes)),
        streams);
}

} // namespace ovc

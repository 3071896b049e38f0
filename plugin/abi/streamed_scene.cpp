// SPDX-License-Identifier: Apache-2.0
// save_streamed and plan_streamed: check their arguments, and make a source and scratch space of
// the host's functions.
#include "core/text/format_text.h"
#include "plugin/abi/config.h"
#include "plugin/abi/device_call.h"
#include "plugin/abi/scene.h"
#include "plugin/abi/scene_call.h"
#include "plugin/abi/struct_size.h"

#include <cmath>
#include <cstddef>
#include <vector>

namespace ovc {
namespace {

/// Calls a function of the host's, and throws Cancelled where it says so.
template <class Function, class... Arguments>
void call_host(Function function, Arguments... arguments) {
    const HostFunction mark;
    if (function(arguments...) != 0)
        throw Cancelled();
}

/// The size of ovc_streamed_scene in headers that know of no steps.
constexpr size_t kBeforeSteps = offsetof(ovc_streamed_scene, keep_step);

class HostSource final : public TriangleSource {
public:
    explicit HostSource(const ovc_streamed_scene& host) : host_(host) {
        for (uint32_t m = 0; m < host.mesh_count; ++m) {
            const ovc_streamed_mesh& mesh = host.meshes[m];
            meshes_.push_back({{mesh.origin[0], mesh.origin[1], mesh.origin[2]},
                               mesh.triangle_count,
                               mesh.has_doubles == 1});
        }
    }

    std::span<const SourceMesh> meshes() const override { return meshes_; }
    void read(uint32_t mesh, uint64_t first, std::span<std::byte> corners) override {
        call_host(host_.read_corners, host_.user, mesh, first,
                  uint64_t(corners.size() / meshes_[mesh].triangle_bytes()),
                  static_cast<void*>(corners.data()));
    }

private:
    const ovc_streamed_scene& host_;
    std::vector<SourceMesh> meshes_;
};

class HostScratch final : public ScratchSpace {
public:
    explicit HostScratch(const ovc_streamed_scene& host) : host_(host) {}

    void write(uint64_t offset, Bytes bytes) override {
        call_host(host_.write_scratch, host_.user, offset, static_cast<const void*>(bytes.data()),
                  bytes.size());
    }
    void read(uint64_t offset, std::span<std::byte> bytes) override {
        call_host(host_.read_scratch, host_.user, offset, static_cast<void*>(bytes.data()),
                  bytes.size());
    }

private:
    const ovc_streamed_scene& host_;
};

class HostSteps final : public StepKeeper {
public:
    explicit HostSteps(const ovc_streamed_scene& host) : host_(host) {
        for (size_t i = 0; i < host.kept_count; ++i)
            kept_.emplace_back(static_cast<const std::byte*>(host.kept[i].bytes),
                               host.kept[i].size);
    }

    std::span<const Bytes> kept() const override { return kept_; }
    void keep(Bytes step) override {
        call_host(host_.keep_step, host_.user, static_cast<const void*>(step.data()), step.size());
    }
    void read_written(uint64_t offset, std::span<std::byte> to) override {
        call_host(host_.read_written, host_.user, offset, static_cast<void*>(to.data()), to.size());
    }

private:
    const ovc_streamed_scene& host_;
    std::vector<Bytes> kept_;
};

/// Checks what planning needs.
ovc_streamed_scene checked(const ovc_streamed_scene* given, const char* call) {
    if (!given)
        invalid(format_text("{}: scene is NULL", call));
    const ovc_streamed_scene scene = whole("ovc_streamed_scene", given, kBeforeSteps);
    if (scene.reserved)
        invalid("ovc_streamed_scene.reserved is not 0");
    if (!scene.read_corners)
        invalid("ovc_streamed_scene.read_corners is NULL");
    if (scene.mesh_count && !scene.meshes)
        invalid("ovc_streamed_scene.meshes is NULL, but mesh_count is not 0");
    for (uint32_t m = 0; m < scene.mesh_count; ++m) {
        const ovc_streamed_mesh& mesh = scene.meshes[m];
        if (mesh.has_doubles > 1 || mesh.reserved)
            invalid(format_text("ovc_streamed_scene.meshes[{}]: has_doubles or reserved has bits "
                                "that this version does not know",
                                m));
        if (mesh.triangle_count >= kNone)
            invalid(format_text("a mesh holds fewer than {} triangles, not {}; split it", kNone,
                                mesh.triangle_count));
        for (const double coordinate : mesh.origin)
            if (!std::isfinite(coordinate))
                invalid(format_text("ovc_streamed_scene.meshes[{}].origin is not finite", m));
    }
    return scene;
}

/// Checks what building needs besides.
void check_functions(const ovc_streamed_scene& scene) {
    if (!scene.write_scratch || !scene.read_scratch || !scene.write)
        invalid("ovc_streamed_scene: a function is NULL");
    if (scene.kept_count && (!scene.kept || !scene.keep_step || !scene.read_written))
        invalid("ovc_streamed_scene: kept, keep_step or read_written is NULL, but kept_count is "
                "not 0");
}

uint64_t host_bytes_of(const ovc_streamed_scene& scene) {
    return scene.host_memory_bytes ? scene.host_memory_bytes : ~uint64_t(0) / 2;
}

} // namespace

ovc_result save_streamed(ovc_device device, const ovc_scene_config* config,
                         const ovc_streamed_scene* given) {
    return on_device(device, "save_streamed", [&] {
        const ovc_scene_config asked = checked_config(config);
        check_config(asked, device->gl->info());
        const ovc_streamed_scene scene = checked(given, "save_streamed");
        check_functions(scene);
        HostSource source(scene);
        HostScratch scratch(scene);
        HostSteps steps(scene);
        const ByteSink sink = [&](Bytes bytes) {
            const HostFunction mark;
            return scene.write(scene.user, bytes.data(), bytes.size()) == 0;
        };
        const LoopThreads::Scope threads(device->loops);
        with_progress(asked, "save_streamed", [&](BuildProgress* progress) {
            check(save_structure(
                {source, scratch, host_bytes_of(scene), scene.keep_step ? &steps : nullptr},
                {*device->gl, asked, device->log, progress}, sink));
            if (progress)
                progress->finish(); // the last chance to be cancelled
        });
    });
}

ovc_result plan_streamed(ovc_device device, const ovc_scene_config* config,
                         const ovc_streamed_scene* given, ovc_plan* plan) {
    return on_device(device, "plan_streamed", [&] {
        const ovc_scene_config asked = checked_config(config);
        check_config(asked, device->gl->info());
        const ovc_streamed_scene scene = checked(given, "plan_streamed");
        HostSource source(scene);
        const LoopThreads::Scope threads(device->loops);
        tell_plan(plan, asked, "plan_streamed", [&](BuildProgress* progress) {
            return plan_streamed_structure(source, host_bytes_of(scene),
                                           {*device->gl, asked, device->log, progress});
        });
    });
}

} // namespace ovc

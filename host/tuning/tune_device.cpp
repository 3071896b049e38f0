// SPDX-License-Identifier: Apache-2.0
#include "host/tuning/tune_device.h"

#include "host/backend/backend.h"
#include "host/backend/device_opening.h"
#include "host/bench/ray_sets.h"
#include "host/scene/scene_source.h"

#include <array>

namespace ovc {
namespace {

constexpr std::array kScenes{"knot", "far-terrain", "fractal"}; // one frame, few, many
constexpr uint32_t kSide = 512;                                 // pixels

} // namespace

Result<Done> tune_device(const std::string& device,
                         const std::function<void(const std::string&)>& tell) {
    BackendOptions options;
    options.kind = BackendKind::TwoLevel;
    options.device = device;
    prepare_process(options); // what is kept is for renderers of the same width alone
    for (const char* name : kScenes) {
        Result<Scene> scene = open_scene(name, LogSink());
        if (!scene)
            return scene.error();
        const Camera camera = own_or_framing_camera(*scene, kSide, kSide);
        options.kernel_variant = "default";
        const Result<std::unique_ptr<Backend>> reference =
            make_backend(scene->soup, options, LogSink());
        if (!reference)
            return reference.error();
        const auto sets = make_ray_sets(*scene, camera, kSide, kSide, **reference);
        if (!sets)
            return sets.error();
        tell(std::string("scene ") + name);
        options.kernel_variant = "measure";
        const Result<std::unique_ptr<Backend>> measured =
            make_backend(scene->soup, options, [&](LogLevel, const std::string& message) {
                if (message.starts_with("kernel variant"))
                    tell(message);
            });
        if (!measured)
            return measured.error();
        for (const RaySet& set : *sets)
            if (const auto answered = answers_of(set, **measured); !answered)
                return answered.error();
    }
    return Done{};
}

} // namespace ovc

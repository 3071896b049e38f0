// SPDX-License-Identifier: Apache-2.0
// The structures of libovercast-thesis.so.
#include "plugin/failure.h"
#include "plugin/structure.h"
#include "plugin/thesis/comparison.h"

#include <fmt/format.h>

namespace ovc {
namespace {

[[noreturn]] void refuse(std::string message) {
    throw Failure{OVC_ERROR_INVALID_ARGUMENT, std::move(message)};
}

} // namespace

void check_config(const ovc_scene_config& config, const DeviceInfo&) {
    if (config.structure == OVC_STRUCTURE_TWO_LEVEL)
        refuse("ovc_scene_config.structure is 0, two-level, which libovercast.so has; this library "
               "has 1 to 5");
    const char* name = thesis::name_of(ovc_structure(config.structure));
    if (config.kernel == OVC_KERNEL_COMPUTE)
        refuse(fmt::format("{} has no compute kernel", name));
    if (config.leaf_triangles)
        refuse(fmt::format("{} has no leaves: leaf_triangles is {}, expected 0", name,
                           config.leaf_triangles));
    if (config.leaves && config.structure != OVC_STRUCTURE_MULTI_TEXTURE)
        refuse(fmt::format("{} has no leaves: leaves is {}, expected 0", name, config.leaves));
    if (config.leaves > thesis::kMostTextures)
        refuse(fmt::format("multi-texture: leaves is {}, expected at most {} textures",
                           config.leaves, thesis::kMostTextures));
}

Result<ovc_plan> plan_structure(const Soup&, const DeviceInfo&, const ovc_scene_config& config,
                                BuildProgress*) {
    refuse(fmt::format("plan: what {} takes is known only once it is built; two-level "
                       "(libovercast.so) can tell before",
                       thesis::name_of(ovc_structure(config.structure))));
}

Result<std::unique_ptr<Structure>> make_structure(const Soup& soup, GlThread& gl,
                                                  const ovc_scene_config& config,
                                                  const LogSink& log, BuildProgress* progress) {
    thesis::RunnerOptions options;
    options.structure = ovc_structure(config.structure);
    options.budget_bytes =
        config.gpu_memory_bytes ? config.gpu_memory_bytes : gl.info().default_budget_bytes();
    options.textures = std::max(config.leaves, 1u);
    options.certify = config.precision != OVC_PRECISION_FAST;
    return thesis::Comparison::build(soup, gl, options, log, progress);
}

} // namespace ovc

// SPDX-License-Identifier: Apache-2.0
// Checks configurations for libovercast-thesis.so, and makes its structures.
#include "core/text/format_text.h"
#include "plugin/structure/failure.h"
#include "plugin/structure/structure.h"
#include "plugin/thesis/comparison.h"
#include "plugin/thesis/queued/queued_two_level.h"

#include <cassert>

namespace ovc {
namespace {

[[noreturn]] void refuse(std::string message) {
    throw Failure{OVC_ERROR_INVALID_ARGUMENT, std::move(message)};
}

Result<std::unique_ptr<Structure>> make_queued(const Soup& soup, GlThread& gl,
                                               const ovc_scene_config& config, const LogSink& log,
                                               BuildProgress* progress) {
    const thesis::QueuedOptions options = {config.gpu_memory_bytes,
                                           config.leaf_triangles,
                                           config.leaves,
                                           config.precision != OVC_PRECISION_FAST,
                                           ovc_level1(config.level1),
                                           ovc_level1_build(config.level1_build)};
    auto scene = thesis::build_queued_scene(soup, gl, options, log, progress);
    if (!scene)
        return scene.error();
    return std::unique_ptr<Structure>(std::make_unique<thesis::QueuedTwoLevel>(std::move(*scene)));
}

} // namespace

void check_config(const ovc_scene_config& config, const DeviceInfo& device) {
    if (config.structure == OVC_STRUCTURE_TWO_LEVEL)
        refuse("ovc_scene_config.structure is 0, two-level, which libovercast.so has; this library "
               "has 1 to 6");
    const char* name = thesis::name_of(ovc_structure(config.structure));
    if (device.shared_budget_bytes)
        refuse(format_text("{} shares no budget: ovc_device_config.gpu_memory_bytes is {}, "
                           "expected 0",
                           name, device.shared_budget_bytes));
    if (config.host_memory_bytes)
        refuse(format_text("{} is not saved, so that it cannot be read: host_memory_bytes is {}, "
                           "expected 0",
                           name, config.host_memory_bytes));
    if (config.tell_active)
        refuse(format_text("{} does not tell which pages are active", name));
    if (config.communicator || config.ranks_own || config.rank_timeout != 0 || config.sample)
        refuse(format_text("{} is one process's: communicator, ranks_own, rank_timeout and sample "
                           "are for libovercast-mpi.so, expected 0",
                           name));
    if (config.kernel == OVC_KERNEL_COMPUTE)
        refuse(format_text("{} has no compute kernel", name));
    if (config.kernel_variant)
        refuse(format_text("{} has one kernel: kernel_variant is '{}', expected NULL", name,
                           config.kernel_variant));
    if (config.structure == OVC_STRUCTURE_THESIS_TWO_LEVEL) {
        if (config.level1 == OVC_LEVEL1_GRID && config.level1_build != OVC_LEVEL1_BUILD_TOP_DOWN)
            refuse(format_text("{}: a grid is built top-down; it has no leaves to merge", name));
        if (config.gpu_memory_bytes)
            if (const auto plan = thesis::LeafPasses::plan_memory(config.gpu_memory_bytes, device);
                !plan)
                throw Failure{OVC_ERROR_OUT_OF_BUDGET, plan.error().message};
        return;
    }
    if (config.level1 || config.level1_build)
        refuse(format_text("{} has no level 1: level1 is {} and level1_build {}, expected 0", name,
                           config.level1, config.level1_build));
    if (config.leaf_triangles)
        refuse(format_text("{} has no leaves: leaf_triangles is {}, expected 0", name,
                           config.leaf_triangles));
    if (config.leaves && config.structure != OVC_STRUCTURE_MULTI_TEXTURE)
        refuse(format_text("{} has no leaves: leaves is {}, expected 0", name, config.leaves));
    if (config.leaves > thesis::kMaxTextures)
        refuse(format_text("multi-texture: leaves is {}, expected at most {} textures",
                           config.leaves, thesis::kMaxTextures));
}

Result<ovc_plan> plan_structure(const Soup&, const BuildRequest& request, LeafStore*) {
    refuse(format_text("plan: what {} takes is known only once it is built; two-level "
                       "(libovercast.so) can tell before",
                       thesis::name_of(ovc_structure(request.config.structure))));
}

Result<Done> save_structure(const StreamedScene&, const BuildRequest&, const ByteSink&) {
    refuse("save_streamed: only two-level (libovercast.so) can be saved");
}

Result<ovc_plan> plan_streamed_structure(TriangleSource&, uint64_t, const BuildRequest&) {
    refuse("plan_streamed: only two-level (libovercast.so) can be saved");
}

Result<std::unique_ptr<Structure>> make_structure(const Soup& soup, const BuildRequest& request,
                                                  [[maybe_unused]] LeafStore* store) {
    assert(!store);
    const ovc_scene_config& config = request.config;
    if (config.structure == OVC_STRUCTURE_THESIS_TWO_LEVEL)
        return make_queued(soup, request.gl, config, request.log, request.progress);
    thesis::RunnerOptions options;
    options.structure = ovc_structure(config.structure);
    options.budget_bytes = config.gpu_memory_bytes ? config.gpu_memory_bytes
                                                   : request.gl.info().default_budget_bytes();
    options.textures = std::max(config.leaves, 1u);
    options.certify = config.precision != OVC_PRECISION_FAST;
    return thesis::Comparison::build(soup, request.gl, options, request.log, request.progress);
}

} // namespace ovc

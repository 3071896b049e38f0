// SPDX-License-Identifier: Apache-2.0
// The structure of libovercast.so: two-level, and what it counts in the words of the ABI.
#include "plugin/failure.h"
#include "plugin/forecast.h"
#include "plugin/structure.h"
#include "plugin/two_level.h"

#include <fmt/format.h>

namespace ovc {

void check_config(const ovc_scene_config& config, const DeviceInfo& device) {
    if (config.structure != OVC_STRUCTURE_TWO_LEVEL)
        throw Failure{
            OVC_ERROR_INVALID_ARGUMENT,
            fmt::format("ovc_scene_config.structure is {}; this library has two-level (0) "
                        "alone, libovercast-thesis.so has the others",
                        config.structure)};
    if (config.level1 || config.level1_build)
        throw Failure{OVC_ERROR_INVALID_ARGUMENT,
                      "ovc_scene_config.level1 and level1_build mean nothing to two-level, whose "
                      "level 1 is a KD-tree: expected 0"};
    if (config.gpu_memory_bytes)
        if (const auto plan = plan_memory(config.gpu_memory_bytes, device); !plan)
            throw Failure{OVC_ERROR_OUT_OF_BUDGET, plan.error().message};
}

static TwoLevelOptions options_of(const ovc_scene_config& config) {
    return {config.gpu_memory_bytes,
            config.leaf_triangles,
            config.leaves,
            config.precision != OVC_PRECISION_FAST,
            config.kernel != OVC_KERNEL_FRAGMENT,
            config.tell_active == 1};
}

static Bytes saved_in(const ovc_scene_config& config) {
    return {static_cast<const std::byte*>(config.saved), size_t(config.saved_bytes)};
}

Result<std::unique_ptr<Structure>> make_structure(const Soup& soup, GlThread& gl,
                                                  const ovc_scene_config& config,
                                                  const LogSink& log, BuildProgress* progress) {
    TwoLevelOptions options = options_of(config);
    options.saved = saved_in(config);
    Result<std::unique_ptr<TwoLevel>> built = TwoLevel::build(soup, gl, options, log, progress);
    if (!built)
        return built.error();
    return std::unique_ptr<Structure>(std::move(*built));
}

Result<ovc_plan> plan_structure(const Soup& soup, const DeviceInfo& device,
                                const ovc_scene_config& config, BuildProgress* progress) {
    const TwoLevelOptions options = options_of(config);
    const Result<Forecast> told = forecast(soup, options, device, progress);
    if (!told)
        return told.error();
    const MemoryPlan memory = *plan_memory(budget_of(options, device), device);
    ovc_plan plan{};
    plan.struct_size = sizeof(plan);
    plan.triangles = soup.triangle_count();
    plan.hittable = told->triangles;
    plan.leaves = told->leaves;
    plan.leaf_references = told->references;
    plan.level2_bytes = told->level2_bytes;
    plan.largest_page_bytes = told->largest_page_bytes;
    plan.gpu_budget_bytes = memory.budget_bytes;
    plan.smallest_budget_bytes = told->smallest_budget_bytes;
    plan.ray_bytes = memory.ray_bytes();
    plan.level1_bytes = told->level1_bytes;
    plan.pool_bytes = told->pool_bytes;
    plan.resident_pages = told->resident_pages;
    plan.host_bytes = told->host_bytes;
    plan.batch_rays = memory.batch_rays;
    plan.fits = told->fits;
    return plan;
}

ovc_statistics TwoLevel::report() const {
    const TraceStatistics& s = statistics_;
    ovc_statistics told = {sizeof(ovc_statistics),
                           scene_.soup.triangle_count(),
                           scene_.dropped.not_finite,
                           scene_.dropped.degenerate,
                           scene_.twins.count(),
                           scene_.level1.leaves.size(),
                           scene_.level1.reference_count(),
                           scene_.level2_bytes(),
                           scene_.largest_page_bytes(),
                           plan().budget_bytes,
                           s.peak_bytes,
                           s.passes,
                           s.pages_in,
                           s.bytes_in,
                           s.nearest_rays,
                           s.occlusion_rays,
                           s.invalid_rays,
                           s.ray_visits,
                           s.flagged,
                           s.retraced,
                           s.capped,
                           scene_.seconds_level1,
                           scene_.seconds_level2,
                           s.seconds_trace,
                           s.seconds_kernel,
                           scene_.host_bytes(),
                           s.queues,
                           s.queued_rays,
                           s.longest_queue,
                           scene_.from_saved,
                           s.seconds_pass,
                           passes_.gpu_bytes()};
    told.stragglers = s.stragglers;
    return told;
}

} // namespace ovc

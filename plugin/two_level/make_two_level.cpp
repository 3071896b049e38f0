// SPDX-License-Identifier: Apache-2.0
// Two-level behind the ABI: its options from a config, and what it counts in the words of the ABI.
#include "plugin/two_level/make_two_level.h"

#include "core/text/format_text.h"
#include "plugin/plan/forecast.h"
#include "plugin/structure/failure.h"
#include "plugin/two_level/two_level.h"

namespace ovc {

/// Returns what the config says of the kernel's variant, which `given` receives if that is one.
static Result<VariantChoice> variant_choice(const ovc_scene_config& config, KernelVariant& given) {
    const std::string_view name = config.kernel_variant ? config.kernel_variant : "auto";
    if (name == "default" || (name == "auto" && config.kernel != OVC_KERNEL_AUTO))
        return VariantChoice::Default;
    if (name == "auto")
        return VariantChoice::Measured;
    if (name == "measure")
        return VariantChoice::Thorough;
    const Result<KernelVariant> variant = parse_variant(name);
    if (!variant)
        return variant.error();
    given = *variant;
    return VariantChoice::Given;
}

static void check_variant(const ovc_scene_config& config) {
    KernelVariant variant;
    const Result<VariantChoice> choice = variant_choice(config, variant);
    if (!choice)
        throw Failure{OVC_ERROR_INVALID_ARGUMENT,
                      "ovc_scene_config.kernel_variant: " + choice.error().message};
    if (config.kernel != OVC_KERNEL_AUTO && *choice != VariantChoice::Default)
        throw Failure{OVC_ERROR_INVALID_ARGUMENT,
                      format_text("ovc_scene_config.kernel is {}, expected 0: kernel_variant '{}' "
                                  "says which kernel it is",
                                  config.kernel, config.kernel_variant)};
}

void check_two_level(const ovc_scene_config& config, const DeviceInfo& device) {
    if (config.structure != OVC_STRUCTURE_TWO_LEVEL)
        throw Failure{
            OVC_ERROR_INVALID_ARGUMENT,
            format_text("ovc_scene_config.structure is {}; this library has two-level (0) "
                        "alone, libovercast-thesis.so has the others",
                        config.structure)};
    if (config.level1 || config.level1_build)
        throw Failure{OVC_ERROR_INVALID_ARGUMENT,
                      "ovc_scene_config.level1 and level1_build mean nothing to two-level, whose "
                      "level 1 is a KD-tree: expected 0"};
    check_variant(config);
    if (device.shared_budget_bytes && config.gpu_memory_bytes > device.shared_budget_bytes)
        throw Failure{OVC_ERROR_INVALID_ARGUMENT,
                      format_text("ovc_scene_config.gpu_memory_bytes is {}, but the scenes of the "
                                  "device share {}",
                                  config.gpu_memory_bytes, device.shared_budget_bytes)};
    if (config.gpu_memory_bytes)
        if (const auto plan = plan_memory(config.gpu_memory_bytes, device); !plan)
            throw Failure{OVC_ERROR_OUT_OF_BUDGET, plan.error().message};
}

TwoLevelOptions two_level_options(const ovc_scene_config& config) {
    TwoLevelOptions options{config.gpu_memory_bytes,
                            config.leaf_triangles,
                            config.leaves,
                            config.precision != OVC_PRECISION_FAST,
                            config.kernel != OVC_KERNEL_FRAGMENT,
                            config.tell_active == 1,
                            config.kernel != OVC_KERNEL_AUTO};
    options.saved = {static_cast<const std::byte*>(config.saved), size_t(config.saved_bytes)};
    if (const auto choice = variant_choice(config, options.given_variant))
        options.variant = *choice;
    return options;
}

Result<ovc_plan> plan_two_level(const Soup& soup, const DeviceInfo& device,
                                const ovc_scene_config& config, BuildProgress* progress,
                                LeafStore* store) {
    TwoLevelOptions options = two_level_options(config);
    options.store = store;
    return forecast(soup, options, device, progress);
}

ovc_statistics TwoLevel::report() const {
    ovc_statistics told = statistics_;
    told.triangles = scene_.soup.triangle_count();
    told.dropped_not_finite = scene_.dropped.not_finite;
    told.dropped_degenerate = scene_.dropped.degenerate;
    told.twins = scene_.duplicate_count();
    told.leaves = scene_.pages.size();
    told.leaf_references = scene_.reference_count();
    told.level2_bytes = scene_.level2_bytes();
    told.largest_page_bytes = scene_.largest_page_bytes();
    told.gpu_budget_bytes = plan().budget_bytes;
    told.seconds_level1 = scene_.seconds_level1;
    told.seconds_level2 = scene_.seconds_level2;
    for (const SharedMesh& mesh : scene_.shared) {
        told.seconds_level1 += mesh.scene.seconds_level1;
        told.seconds_level2 += mesh.scene.seconds_level2;
    }
    told.host_bytes = scene_.host_bytes();
    told.unique_triangles = scene_.unique_triangles();
    for (const SharedMesh& mesh : scene_.shared)
        told.instances += mesh.instances();
    told.top_level_bytes = scene_.top.tree.bytes() + scene_.top.table_bytes();
    told.from_saved = scene_.from_saved;
    told.gpu_bytes = passes_.gpu_bytes();
    if (scene_.store) {
        const LeafStore::Counts store = scene_.store->counts();
        told.host_budget_bytes = store.budget_bytes;
        told.host_budget_peak_bytes = store.peak_bytes;
        told.disk_reads = store.reads;
        told.disk_bytes = store.read_bytes;
        told.disk_hits = store.hits;
        told.disk_misses = store.misses;
        told.disk_ahead = store.ahead;
    }
    return told;
}

} // namespace ovc

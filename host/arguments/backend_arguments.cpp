// SPDX-License-Identifier: Apache-2.0
// --backend, --gpu-memory, --host-memory, --leaf-triangles, --leaves, --device, --precision,
// --kernel, --kernel-variant, --ranks-own, --rank-timeout, --level1, --level1-build.
#include "host/arguments/backend_arguments.h"
#include "core/text/suggestion.h"
#include "host/arguments/arguments.h"
#include "host/ranks/ranks.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace ovc {

/// In the order of ovc_ranks_own.
static constexpr std::string_view kRanksOwn[] = {"auto", "share", "all"};
static constexpr std::string_view kPrecisions[] = {"certified", "fast"};
static constexpr std::string_view kKernels[] = {"auto", "fragment", "compute"};
static constexpr std::string_view kLevels1[] = {"kd", "grid", "bvh"};
static constexpr std::string_view kLevel1Builds[] = {"top-down", "bottom-up"};
/// In the order of BackendKind.
static constexpr std::string_view kBackends[] = {
    "auto",          "two-level", "cpu-kdtree", "embree",   "single-texture",
    "multi-texture", "gpu-grid",  "gpu-kdtree", "skip-bvh", "thesis-two-level"};

Result<BackendKind> parse_backend(std::string_view name) {
    const auto known = std::find(std::begin(kBackends), std::end(kBackends), name);
    if (known != std::end(kBackends))
        return BackendKind(known - std::begin(kBackends));
    return Error{fmt::format("no backend is called '{}'; there are {}{}", name,
                             fmt::join(kBackends, ", "), did_you_mean(name, kBackends))};
}

void BackendArguments::add_to(CLI::App& app, const char* host_memory_help) {
    const char* group = "Tracing";
    app.add_option(
           "--backend", backend,
           "auto, two-level (the GPU), cpu-kdtree (the CPU, double precision) or embree (the "
           "CPU, float32, Embree's robust mode); for comparison, the whole scene in GPU memory: "
           "single-texture, multi-texture, gpu-grid, gpu-kdtree, skip-bvh; or leaf by leaf from "
           "the "
           "CPU: thesis-two-level")
        ->group(group)
        ->type_name(choice_names(kBackends));
    app.add_option(
           "--gpu-memory", gpu_memory,
           "Max GPU memory: 256M, 1.5GiB, or 50% of what the device has free; default: seven "
           "eighths of that")
        ->group(group)
        ->type_name("SIZE");
    app.add_option("--host-memory", host_memory, host_memory_help)->group(group)->type_name("SIZE");
    CLI::Option* per_leaf = app.add_option("--leaf-triangles", leaf_triangles,
                                           "Max triangles of a level-1 leaf; default: a tenth "
                                           "of the scene's, or all where one leaf fits the "
                                           "budget and is faster")
                                ->group(group)
                                ->type_name("N");
    app.add_option("--leaves", leaves, "Instead: about so many level-1 leaves")
        ->group(group)
        ->type_name("N")
        ->excludes(per_leaf);
    app.add_option("--device", device,
                   "A number or a part of a name from `overcast devices`; default: the first GPU, "
                   "else the software renderer")
        ->group(group)
        ->type_name("NAME");
    app.add_option("--precision", precision,
                   "certified (the default: the exact answer, in doubles) or fast (float32's own)")
        ->group(group)
        ->type_name(choice_names(kPrecisions));
    app.add_option("--kernel", kernel, "auto, fragment or compute; they answer alike")
        ->group(group)
        ->type_name(choice_names(kKernels));
    app.add_option("--kernel-variant", kernel_variant,
                   "How the kernel works: auto (the fastest that was measured on the device), "
                   "default, measure, or a variant that `overcast devices --tune` lists")
        ->group(group)
        ->type_name("NAME");
    add_ranks_own(app, ranks_own)->group(group);
    app.add_option("--rank-timeout", rank_timeout,
                   "Under mpirun, a rank that gives no word for so long is lost, and the job ends; "
                   "default: 60")
        ->group(group)
        ->type_name("SECONDS");
    app.add_option("--level1", level1, "Level 1 of thesis-two-level: kd (the default), grid or bvh")
        ->group(group)
        ->type_name(choice_names(kLevels1));
    app.add_option("--level1-build", level1_build,
                   "Its leaves: cut top-down (the default), or merged bottom-up; not for a grid")
        ->group(group)
        ->type_name(choice_names(kLevel1Builds));
}

/// An error where an option says nothing to the backend that was chosen.
Result<Done> BackendArguments::check_meaning(BackendKind kind) const {
    if (kind == BackendKind::CpuKdTree || kind == BackendKind::Embree)
        for (const auto& [option, value] : {std::pair{"--gpu-memory", &gpu_memory},
                                            {"--host-memory", &host_memory},
                                            {"--leaf-triangles", &leaf_triangles},
                                            {"--leaves", &leaves},
                                            {"--device", &device},
                                            {"--precision", &precision},
                                            {"--kernel", &kernel},
                                            {"--kernel-variant", &kernel_variant}})
            if (!value->empty())
                return Error{fmt::format("{} means nothing to the backend {}, which uses no GPU",
                                         option, backend)};
    if (structure_of(kind) != OVC_STRUCTURE_TWO_LEVEL && !host_memory.empty())
        return Error{fmt::format("--host-memory means nothing to the backend {}; two-level has it",
                                 backend)};
    if (structure_of(kind) != OVC_STRUCTURE_TWO_LEVEL && !kernel_variant.empty())
        return Error{fmt::format(
            "--kernel-variant means nothing to the backend {}; two-level has it", backend)};
    if (kind != BackendKind::ThesisTwoLevel)
        for (const auto& [option, value] :
             {std::pair{"--level1", &level1}, {"--level1-build", &level1_build}})
            if (!value->empty())
                return Error{
                    fmt::format("{} means nothing to the backend {}; thesis-two-level has it",
                                option, backend)};
    return Done{};
}

Result<Done> check_ranks(const char* option, std::string_view text) {
    if (text.empty() || Ranks::has_starter())
        return Done{};
    return Error{fmt::format("{} is for several processes, which this is not: mpirun -n 4 overcast "
                             "starts four",
                             option)};
}

Result<ovc_ranks_own> parse_ranks_own(std::string_view text) {
    const Result<size_t> own = parse_choice("--ranks-own", text, kRanksOwn);
    if (!own)
        return own.error();
    const Result<Done> fine = check_ranks("--ranks-own", text);
    return fine ? Result<ovc_ranks_own>(ovc_ranks_own(*own)) : fine.error();
}

CLI::Option* add_ranks_own(CLI::App& app, std::string& text) {
    return app
        .add_option("--ranks-own", text,
                    "Under mpirun, which leaves each rank has: auto (all where they fit, else a "
                    "share), share or all")
        ->type_name(choice_names(kRanksOwn));
}

Result<Done> BackendArguments::resolve_ranks(BackendOptions& options) const {
    const Result<ovc_ranks_own> own = parse_ranks_own(ranks_own);
    if (!own)
        return own.error();
    options.ranks_own = *own;
    OptionReader reader;
    reader.real("--rank-timeout", rank_timeout, 0.1, 1e6, options.rank_timeout);
    return reader.done() ? check_ranks("--rank-timeout", rank_timeout) : reader.done();
}

Result<BackendOptions> BackendArguments::resolve() const {
    BackendOptions options;
    const Result<BackendKind> kind = parse_backend(backend);
    if (!kind)
        return kind.error();
    options.kind = *kind;
    if (const Result<Done> fine = check_meaning(options.kind); !fine)
        return fine.error();
    if (!gpu_memory.empty()) {
        const Result<MemorySize> size = parse_memory_size(gpu_memory);
        if (!size)
            return Error{"--gpu-memory: " + size.error().message};
        options.gpu_memory = *size;
    }
    OptionReader reader;
    reader.read("--host-memory", host_memory, options.host_bytes, parse_bytes);
    reader.count("--leaf-triangles", leaf_triangles, 1, 0xffffffffu, options.leaf_triangles);
    reader.count("--leaves", leaves, 1, 1000000, options.leaves);
    reader.choice("--precision", precision, kPrecisions, options.precision);
    reader.choice("--kernel", kernel, kKernels, options.kernel);
    reader.choice("--level1", level1, kLevels1, options.level1);
    reader.choice("--level1-build", level1_build, kLevel1Builds, options.level1_build);
    if (!reader.done())
        return reader.done().error();
    options.device = device;
    options.kernel_variant = kernel_variant;
    if (const Result<Done> fine = resolve_ranks(options); !fine)
        return fine.error();
    return options;
}

} // namespace ovc

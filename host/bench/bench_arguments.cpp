// SPDX-License-Identifier: Apache-2.0
// Parses and checks the scenes, contenders, sizes and sweeps that a user asks for.
#include "host/bench/bench_arguments.h"

#include "core/text/suggestion.h"
#include "host/arguments/backend_arguments.h"
#include "host/arguments/memory_size.h"
#include "host/bench/workload.h"
#include "host/output/output.h"
#include "testscenes/catalog.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace ovc {

static constexpr const char* kDefaultScene = "knot";
/// In a sweep "all" is the device's default budget, which is enough for most scenes.
static constexpr std::string_view kAll = "all";
static constexpr std::string_view kAuto = "auto";

/// In the order of false and true for InstancesChoice::baked.
static constexpr std::array<std::string_view, 2> kInstances = {"shared", "baked"};

/// In the order of SweepOver.
static constexpr std::array<std::string_view, 5> kSweeps = {"rays", "triangles", "instances",
                                                            "leaves", "budget"};

/// In the order of PicturesBy.
static constexpr std::array<std::string_view, 2> kPictures = {"samples", "tolerance"};
/// The reference takes four times as many samples, and more would exceed a picture's limit.
static constexpr uint64_t kMaxPictureSamples = 1024, kDefaultSamples = 64;

static constexpr std::array<std::string_view, 8> kWorkloads = {
    "primary",       "shadow",       "diffuse",       "edges",
    "primary-small", "shadow-small", "diffuse-small", "frame"};

void BenchWords::add_to(CLI::App& app) {
    app.add_option("SCENE", scenes,
                   fmt::format("Files or test scenes' names; default: {}", kDefaultScene));
    add_modes_to(app);
    add_settings_to(app);
}

void BenchWords::add_modes_to(CLI::App& app) {
    CLI::Option* table = app.add_flag(
        "--bars", bars,
        "Instead: the table of what is promised, measured over SCENE, a mesh file or a test scene");
    app.add_flag("--scene-alone", scene_alone,
                 "With --bars: only the lines about SCENE, without those about test scenes")
        ->needs(table);
    CLI::Option* race = app.add_flag("--programs", programs,
                                     "Instead: overcast render, povray and tachyon on SCENE, a "
                                     "mesh file, from file to PNG")
                            ->excludes(table);
    app.add_option("--sweep", sweep, "Instead: what the plugin's work costs as it grows")
        ->type_name(choice_names(kSweeps))
        ->excludes(table)
        ->excludes(race);
    app.add_option(
           "--pictures", pictures,
           "Instead: what whole pictures cost and how wrong they are, by samples a pixel of "
           "SCENE's triangles, or by the tolerance of round shapes; beside povray and "
           "tachyon")
        ->type_name(choice_names(kPictures))
        ->excludes(table)
        ->excludes(race)
        ->excludes(app.get_option("--sweep"));
}

void BenchWords::add_settings_to(CLI::App& app) {
    app.add_option(
           "--most", most,
           "The last row of --sweep rays, triangles, instances or leaves has at most so many; "
           "of --pictures samples: 64")
        ->type_name("N");
    app.add_option("--workloads", workloads,
                   fmt::format("Which of {}; small: in calls of {} rays; default: primary, shadow, "
                               "diffuse, frame",
                               fmt::join(kWorkloads, ", "), kSmallCallRays))
        ->type_name("NAME,...");
    app.add_flag(
        "--float-rays", float_rays,
        "Rays rounded to floats, so that contenders that take floats answer the same rays");
    app.add_option("--only", only,
                   fmt::format("Contenders, or the first words of their names; default: all but "
                               "the thesis- ones of {}",
                               fmt::join(contender_names(), ", ")))
        ->type_name("NAME,...");
    app.add_option("--size", size,
                   "Pixels, and with them rays; default: 1024x1024; of --programs 512x512, of "
                   "--pictures 256x256")
        ->type_name("WxH");
    app.add_option("--repeats", repeats,
                   "Timed calls of each; default: 5. With --bars three times as many where a call "
                   "takes hundredths of a second")
        ->type_name("N");
    add_sweeps_to(app);
    app.add_option("--device", device, "A number or a part of a name from `overcast devices`")
        ->type_name("NAME");
    app.add_option(
           "--kernel-variant", kernel_variant,
           "A variant that `overcast devices --tune` lists, for the contenders whose kernel, "
           "fragment or compute, it is")
        ->type_name("NAME");
    add_ranks_own(app, ranks_own);
    app.add_option("--json", json,
                   "Also write what was measured as JSON (docs/benchmarks.md); -: to standard "
                   "output, instead of the tables")
        ->type_name("FILE|-");
}

void BenchWords::add_sweeps_to(CLI::App& app) {
    app.add_option("--leaves", leaves,
                   "The plugin with about so many level-1 leaves, or auto, a row for each")
        ->type_name("N,...");
    app.add_option("--instances", instances,
                   "The plugin with instances that share pages, or that are baked: triangles of "
                   "their own; a row for each")
        ->type_name("shared,baked");
    CLI::Option* memory =
        app.add_option("--gpu-memory", gpu_memory,
                       "The plugin with so much GPU memory (12M, 50% of the device's, all), a row "
                       "for each")
            ->type_name("SIZE,...");
    app.add_option("--resident", resident,
                   "Instead: a share of the bytes of all pages of the scene (30%, all)")
        ->type_name("SHARE,...")
        ->excludes(memory);
    app.add_option(
           "--host-memory", host_memory,
           "All contenders together with so much host memory, 2G, for scenes in .ovc; those "
           "that hold a scene in memory are left out")
        ->type_name("SIZE");
}

Result<std::vector<std::string>> parse_list(std::string_view option, std::string_view text) {
    std::vector<std::string> items;
    for (;;) {
        const size_t comma = text.find(',');
        items.emplace_back(text.substr(0, comma));
        if (items.back().empty())
            return Error{fmt::format("{} has an empty item in its list", option)};
        if (comma == std::string_view::npos)
            return items;
        text.remove_prefix(comma + 1);
    }
}

/// Returns a choice for each item of the list, or the default alone where there is no list.
template <class Choice, class Parse>
static Result<std::vector<Choice>> parse_sweep(std::string_view option, std::string_view text,
                                               const Parse& parse) {
    if (text.empty())
        return std::vector<Choice>(1);
    const Result<std::vector<std::string>> items = parse_list(option, text);
    if (!items)
        return items.error();
    std::vector<Choice> choices;
    for (const std::string& item : *items) {
        const Result<Choice> choice = parse(item);
        if (!choice)
            return choice.error();
        for (const Choice& earlier : choices)
            if (earlier.words == item)
                return Error{fmt::format("{} has '{}' twice", option, item)};
        choices.push_back(*choice);
    }
    return choices;
}

Result<std::vector<LeavesChoice>> parse_leaves_sweep(std::string_view text) {
    return parse_sweep<LeavesChoice>(
        "--leaves", text, [](const std::string& item) -> Result<LeavesChoice> {
            if (item == kAuto)
                return LeavesChoice{0, item};
            const Result<uint64_t> leaves = parse_count("--leaves", item, 1, 1000000);
            if (!leaves)
                return leaves.error();
            return LeavesChoice{uint32_t(*leaves), item};
        });
}

Result<std::vector<InstancesChoice>> parse_instances_sweep(std::string_view text) {
    return parse_sweep<InstancesChoice>(
        "--instances", text, [](const std::string& item) -> Result<InstancesChoice> {
            const Result<size_t> choice = parse_choice("--instances", item, kInstances);
            return choice ? InstancesChoice{*choice == 1, item}
                          : Result<InstancesChoice>(choice.error());
        });
}

Result<std::vector<BudgetChoice>> parse_memory_sweep(std::string_view text) {
    return parse_sweep<BudgetChoice>(
        "--gpu-memory", text, [](const std::string& item) -> Result<BudgetChoice> {
            if (item == kAll)
                return BudgetChoice{{}, 0, item};
            const Result<MemorySize> memory = parse_memory_size(item);
            if (!memory)
                return Error{"--gpu-memory: " + memory.error().message};
            return BudgetChoice{*memory, 0, item};
        });
}

Result<std::vector<BudgetChoice>> parse_resident_sweep(std::string_view text) {
    return parse_sweep<BudgetChoice>(
        "--resident", text, [](const std::string& item) -> Result<BudgetChoice> {
            if (item == kAll)
                return BudgetChoice{{}, 0, item};
            const Result<MemorySize> memory = parse_memory_size(item);
            if (!memory || !(memory->share > 0))
                return Error{
                    fmt::format("--resident needs a share such as 30%, or all, not '{}'", item)};
            return BudgetChoice{{}, memory->share, item};
        });
}

static Result<std::vector<Contender>> contenders_of(const BenchWords& words) {
    std::vector<std::string> only;
    if (!words.only.empty()) {
        Result<std::vector<std::string>> names = parse_list("--only", words.only);
        if (!names)
            return names.error();
        only = std::move(*names);
    }
    const Result<std::vector<LeavesChoice>> leaves = parse_leaves_sweep(words.leaves);
    if (!leaves)
        return leaves.error();
    const Result<std::vector<BudgetChoice>> budgets = words.resident.empty()
                                                          ? parse_memory_sweep(words.gpu_memory)
                                                          : parse_resident_sweep(words.resident);
    if (!budgets)
        return budgets.error();
    const Result<std::vector<InstancesChoice>> instances = parse_instances_sweep(words.instances);
    if (!instances)
        return instances.error();
    return choose_contenders(only, *leaves, *budgets, *instances);
}

static Result<std::vector<std::string>> workloads_of(const std::string& words) {
    if (words.empty())
        return std::vector<std::string>();
    Result<std::vector<std::string>> names = parse_list("--workloads", words);
    if (!names)
        return names;
    for (const std::string& name : *names)
        if (std::ranges::find(kWorkloads, name) == kWorkloads.end())
            return Error{fmt::format("--workloads: there is no workload '{}'; there are {}{}", name,
                                     fmt::join(kWorkloads, ", "), did_you_mean(name, kWorkloads))};
    return names;
}

/// Checks that the file for JSON can be written and is not one of the scenes.
static Result<Done> check_json(const BenchJob& job) {
    if (job.json.empty() || job.json == "-")
        return Done{};
    if (const Result<Done> fine = check_writable("JSON", job.json); !fine)
        return fine;
    std::vector<NamedFile> files = {{"JSON", job.json}};
    for (const std::string& scene : job.scenes)
        if (!is_test_scene(scene)) {
            files.resize(1); // scenes are not compared with each other: one may come twice
            files.push_back({"input", scene});
            if (const Result<Done> fine = check_distinct(files); !fine)
                return fine;
        }
    return Done{};
}

static Result<Done> understand_sweep(const BenchWords& words, BenchJob& job) {
    const Result<size_t> sweep = parse_choice("--sweep", words.sweep, kSweeps);
    if (!sweep)
        return sweep.error();
    job.sweep = SweepOver(*sweep);
    if (words.scenes.size() > 1)
        return Error{"--sweep takes one scene"};
    if (job.sweep == SweepOver::Triangles && !words.scenes.empty())
        return Error{"--sweep triangles takes no scene: it has spheres of its own"};
    if (job.sweep == SweepOver::Instances && !words.scenes.empty())
        return Error{"--sweep instances takes no scene: it has fractals of its own"};
    return Done{};
}

static Result<Done> understand_pictures(const BenchWords& words, BenchJob& job) {
    const Result<size_t> pictures = parse_choice("--pictures", words.pictures, kPictures);
    if (!pictures)
        return pictures.error();
    job.pictures = PicturesBy(*pictures);
    if (words.scenes.size() > 1)
        return Error{"--pictures takes one scene"};
    if (job.pictures == PicturesBy::Tolerance && !words.scenes.empty())
        return Error{"--pictures tolerance takes no scene: it has round shapes of its own"};
    return Done{};
}

static bool takes_most(const BenchWords& words, BenchKind kind) {
    return (kind == BenchKind::Sweep && words.sweep != kSweeps.back()) ||
           (kind == BenchKind::Pictures && words.pictures == kPictures[0]);
}

/// Returns the option that asks for a table other than that of contenders.
static const char* table_option(const BenchWords& words) {
    return words.bars               ? "--bars"
           : words.programs         ? "--programs"
           : words.pictures.empty() ? "--sweep"
                                    : "--pictures";
}

/// Refuses the options of contenders beside the option of another table.
static Result<Done> check_contender_words(const BenchWords& words, const char* option) {
    // Whole programs choose their device themselves.
    const bool any_device = words.programs || words.pictures == kPictures[0];
    for (const auto& [name, is_given] :
         {std::pair("--only", !words.only.empty()), std::pair("--leaves", !words.leaves.empty()),
          std::pair("--instances", !words.instances.empty()),
          std::pair("--workloads", !words.workloads.empty()),
          std::pair("--float-rays", words.float_rays),
          std::pair("--gpu-memory", !words.gpu_memory.empty()),
          std::pair("--host-memory", !words.host_memory.empty()),
          std::pair("--resident", !words.resident.empty()),
          std::pair("--kernel-variant", !words.kernel_variant.empty()),
          std::pair("--ranks-own", !words.ranks_own.empty()),
          std::pair("--device", any_device && !words.device.empty())})
        if (is_given)
            return Error{
                fmt::format("{} chooses what is measured itself, without {}", option, name)};
    return Done{};
}

/// Finds out which kind is asked for, and refuses options that belong to another kind.
static Result<Done> understand_kind(const BenchWords& words, BenchJob& job) {
    job.kind = words.bars                ? BenchKind::Bars
               : words.programs          ? BenchKind::Programs
               : !words.sweep.empty()    ? BenchKind::Sweep
               : !words.pictures.empty() ? BenchKind::Pictures
                                         : BenchKind::Contenders;
    if (!words.most.empty() && !takes_most(words, job.kind))
        return Error{
            "--most goes with --sweep rays, triangles, instances or leaves, and --pictures "
            "samples"};
    if (job.kind == BenchKind::Contenders)
        return Done{};
    const char* const option = table_option(words);
    if (const Result<Done> fine = check_contender_words(words, option); !fine)
        return fine;
    if (job.kind == BenchKind::Sweep)
        return understand_sweep(words, job);
    if (job.kind == BenchKind::Pictures)
        return understand_pictures(words, job);
    if (words.scenes.size() != 1 ||
        (!std::filesystem::is_regular_file(words.scenes[0]) && !is_test_scene(words.scenes[0])))
        return Error{fmt::format("{} needs one mesh file, such as the Stanford dragon's, or a test "
                                 "scene",
                                 option)};
    return Done{};
}

/// Gives the variant to the contenders whose kernel it is a variant of.
static Result<Done> set_kernel_variant(const std::string& variant, BenchJob& job) {
    if (variant.empty())
        return Done{};
    const ovc_kernel kernel =
        variant.starts_with("fragment") ? OVC_KERNEL_FRAGMENT : OVC_KERNEL_COMPUTE;
    bool any = false;
    for (Contender& contender : job.contenders)
        if (contender.kind == ContenderKind::TwoLevel && contender.kernel == kernel) {
            contender.kernel_variant = variant;
            any = true;
        }
    if (any)
        return Done{};
    return Error{fmt::format("--kernel-variant {}: none of the contenders has that kernel; "
                             "--only certified-compute has compute",
                             variant)};
}

/// Keeps the contenders that work within a budget of host memory.
static Result<Done> keep_to_host_memory(const BenchWords& words, BenchJob& job) {
    if (words.host_memory.empty())
        return Done{};
    const Result<uint64_t> bytes = parse_bytes("--host-memory", words.host_memory);
    if (!bytes)
        return bytes.error();
    job.host_bytes = *bytes;
    if (!words.leaves.empty())
        return Error{"--leaves means nothing with --host-memory: the leaves of an .ovc file are "
                     "built already"};
    if (!words.instances.empty())
        return Error{"--instances means nothing with --host-memory: the leaves of an .ovc file are "
                     "built already"};
    for (const std::string& scene : job.scenes)
        if (std::filesystem::path(scene).extension() != ".ovc")
            return Error{fmt::format("--host-memory goes with .ovc files, which overcast convert "
                                     "makes; found '{}'",
                                     scene)};
    const auto beyond =
        std::stable_partition(job.contenders.begin(), job.contenders.end(),
                              [](const Contender& c) { return c.kind == ContenderKind::TwoLevel; });
    job.beyond.assign(beyond, job.contenders.end());
    job.contenders.erase(beyond, job.contenders.end());
    if (job.contenders.empty())
        return Error{"--only: none of these keeps to --host-memory; certified and fast do"};
    return Done{};
}

Result<BenchJob> understand_bench(const BenchWords& words) {
    BenchJob job;
    if (const Result<Done> fine = understand_kind(words, job); !fine)
        return fine.error();
    job.scenes = words.scenes.empty() ? std::vector<std::string>{kDefaultScene} : words.scenes;
    job.scene_alone = words.scene_alone;
    job.device = words.device;
    const Result<ovc_ranks_own> own = parse_ranks_own(words.ranks_own);
    if (!own)
        return own.error();
    job.ranks_own = *own;
    job.json = words.json;
    const std::string size_words = !words.size.empty()               ? words.size
                                   : job.kind == BenchKind::Programs ? "512x512"
                                   : job.kind == BenchKind::Pictures ? "256x256"
                                                                     : "1024x1024";
    const Result<ImageSize> size = parse_size("--size", size_words);
    if (!size)
        return size.error();
    job.size = *size;
    const bool draws_squares = job.kind != BenchKind::Contenders && job.kind != BenchKind::Sweep;
    if (draws_squares && size->width != size->height)
        return Error{fmt::format("{} draws squares, such as 256x256, not {}", table_option(words),
                                 size_words)};
    if (job.kind == BenchKind::Pictures)
        job.most = kDefaultSamples;
    OptionReader options;
    options.count("--repeats", words.repeats, 1, 1000, job.repeats);
    options.count("--most", words.most, 1,
                  job.kind == BenchKind::Pictures ? kMaxPictureSamples : 1'000'000'000, job.most);
    if (!options.done())
        return options.done().error();
    Result<std::vector<std::string>> workloads = workloads_of(words.workloads);
    if (!workloads)
        return workloads.error();
    job.workloads = std::move(*workloads);
    job.float_rays = words.float_rays;
    Result<std::vector<Contender>> contenders = contenders_of(words);
    if (!contenders)
        return contenders.error();
    job.contenders = std::move(*contenders);
    if (const Result<Done> fine = set_kernel_variant(words.kernel_variant, job); !fine)
        return fine.error();
    if (const Result<Done> fine = keep_to_host_memory(words, job); !fine)
        return fine.error();
    if (const Result<Done> fine = check_json(job); !fine)
        return fine.error();
    return job;
}

} // namespace ovc

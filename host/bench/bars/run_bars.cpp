// SPDX-License-Identifier: Apache-2.0
// Does the runs behind the table, one after the other. Import comes first, because its child
// process needs a parent that has run no parallel loop yet.
#include "host/bench/bars/run_bars.h"

#include "host/bench/programs/run_program.h"
#include "host/bench/programs/scratch_folder.h"
#include "host/bench/ratios/ratios.h"
#include "host/scene/scene_source.h"
#include "host/terminal/terminal_line.h"
#include "testscenes/catalog.h"

#include <fmt/format.h>

#include <utility>

namespace ovc {

namespace {

constexpr uint32_t kImports = 9;
// Calls of hundredths of a second are repeated so many times as often, because medians of five of
// them lie a tenth apart where others use the machine as well.
constexpr uint32_t kOfShortCalls = 3;
constexpr const char* kSoup = "soup-500";
constexpr const char* kArchitecture = "powerplant-400000";
constexpr const char* kBeyondMemory = "dragons-10";

/// The promises on the mesh, against Embree's robust mode and the CPU KD-tree in float.
constexpr PromiseOfSets kKernel = {{{1.25, 1.6}, {1.35, 1.6}, {1.05, 1.6}}};
constexpr PromiseOfSets kKernelOfKdTree = {{{2.5, 3}, {4, 5}, {4, 6}}};
constexpr PromiseOfSets kCall = {{{0.85, 1.1}, {1.1, 1.4}, {0.85, 1.1}}};
/// Against Embree's high quality.
constexpr PromiseOfSets kHighQuality = {{{0.7, 1}, {0.7, 1}, {0.7, 1}}};
/// On scenes of other kinds, against Embree's robust mode.
constexpr PromiseOfSets kCallOfScenes = {{{0.8, 1.1}, {1, 1.1}, {0.8, 1.1}}};
constexpr PromiseOfSets kKernelOfScenes = {{{1, 1.2}, {1, 1.2}, {0.9, 1.2}}};
constexpr PromiseOfSets kKernelOfPlants = {{{1.1, 1.3}, {1, 1.3}, {1, 1.3}}};
struct PromisedScene {
    const char* name;
    const PromiseOfSets* kernel; // null: nothing is promised of it
};
constexpr PromisedScene kScenes[] = {
    {"plants-5", &kKernelOfPlants},    {"dragons-2", &kKernelOfScenes},
    {"far-terrain", &kKernelOfScenes}, {"city", nullptr},
    {kArchitecture, nullptr},          {"sphere-9", nullptr}};

Contender two_level(std::string_view name, ovc_precision precision) {
    return {.name = name, .kind = ContenderKind::TwoLevel, .precision = precision};
}

Contender embree(std::string_view name, EmbreeMode mode) {
    return {.name = name, .kind = ContenderKind::Embree, .embree = mode};
}

const Contender kCertifiedBar = two_level("certified", OVC_PRECISION_CERTIFIED);

bool has_embree() {
    return bool(make_embree_backend(Soup{}, EmbreeMode::Medium));
}

Result<Done> convert(const std::string& from, const std::string& to) {
    const Result<double> done =
        run_program(std::vector<std::string>{"/proc/self/exe", "convert", from, to});
    return done ? Result<Done>(Done{}) : done.error();
}

/// Returns the mesh's path; a test scene is first written to a file in the folder.
Result<std::string> as_file(const std::string& mesh, const ScratchFolder& folder) {
    if (!is_test_scene(mesh))
        return mesh;
    const std::string path = folder.path() / "given.ply";
    const Result<Done> made = convert(mesh, path);
    return made ? Result<std::string>(path) : made.error();
}

class BarsRun {
public:
    BarsRun(const BarsJob& job, const BenchSurroundings& around)
        : job_(job),
          around_(around),
          large_{job.size, job.size},
          small_{(job.size + 1) / 2, (job.size + 1) / 2} {}

    Result<BarsResult> run() {
        using Step = Result<Done> (BarsRun::*)();
        const std::pair<Step, bool> steps[] = {{&BarsRun::import, true},
                                               {&BarsRun::kernels, true},
                                               {&BarsRun::edges, true},
                                               {&BarsRun::small_calls, true},
                                               {&BarsRun::high_quality, false},
                                               {&BarsRun::leaves, true},
                                               {&BarsRun::leaves_of_scenes, true},
                                               {&BarsRun::scenes, false},
                                               {&BarsRun::budget, false},
                                               {&BarsRun::build, true},
                                               {&BarsRun::programs, true},
                                               {&BarsRun::rest, true}};
        for (const auto& [step, is_about_mesh] : steps) {
            if (job_.scene_alone && !is_about_mesh)
                continue;
            if (around_.stop())
                break;
            if (const Result<Done> done = (this->*step)(); !done)
                return done.error();
        }
        result_.complete = !around_.stop();
        around_.progress.clear();
        return std::move(result_);
    }

private:
    void add(std::vector<Bar> bars) {
        for (Bar& bar : bars)
            result_.bars.push_back(std::move(bar));
    }

    /// Measures the file as given, and as OBJ and binary PLY, which `overcast convert` makes of it.
    Result<Done> import() {
        const Result<ScratchFolder> folder = ScratchFolder::make();
        if (!folder)
            return folder.error();
        std::vector<std::pair<std::string, std::string>> files = {{"the mesh as given", job_.mesh}};
        for (const char* suffix : {"obj", "ply"}) {
            const std::string path = folder->path() / (std::string("mesh.") + suffix);
            around_.progress.show("converting to " + path);
            if (const Result<Done> done = convert(job_.mesh, path); !done)
                return done.error();
            files.push_back({suffix[0] == 'o' ? "OBJ" : "binary PLY", path});
        }
        std::vector<std::pair<std::string, ImportCost>> costs;
        for (const auto& [name, path] : files) {
            around_.progress.show("reading " + path);
            const Result<ImportCost> cost = measure_import(path, kImports);
            if (!cost)
                return cost.error();
            costs.push_back({name, *cost});
        }
        import_bars_ = import_bars(costs);
        return Done{};
    }

    Result<const BenchResult*> bench(std::string scene, Asked asked,
                                     std::vector<Contender> contenders, uint32_t repeats,
                                     bool first_is_reference = false) {
        SceneBench job;
        job.scene = std::move(scene);
        if (job.scene == kBeyondMemory)
            job.model = job_.mesh;
        job.asked = asked;
        job.repeats = repeats;
        job.contenders = std::move(contenders);
        job.device = job_.device;
        job.first_is_reference = first_is_reference;
        Result<BenchResult> result = bench_scene(job, around_);
        if (!result)
            return result.error();
        if (const std::string wrong = wrong_answers(*result); !wrong.empty())
            return Error{wrong};
        result_.scenes.push_back(std::move(*result));
        return &result_.scenes.back();
    }

    Result<Done> kernels() {
        std::vector<Contender> contenders = {
            kCertifiedBar,
            two_level("fast", OVC_PRECISION_FAST),
            {.name = "cpu-float-kdtree", .kind = ContenderKind::FloatKdTree}};
        if (has_embree())
            contenders.push_back(embree("embree-robust", EmbreeMode::Robust));
        const Result<const BenchResult*> r =
            bench(job_.mesh, {.size = large_}, contenders, kOfShortCalls * job_.repeats);
        if (!r)
            return r.error();
        add(kernel_bars(**r, "mesh", "embree-robust", kKernel));
        add(kernel_bars(**r, "mesh", "cpu-float-kdtree", kKernelOfKdTree));
        add(call_bars(**r, "mesh", "embree-robust", kCall));
        add({certify_bar(**r)});
        bytes_bars_.push_back(bytes_bar(**r, "mesh", 52, 44));
        return Done{};
    }

    /// Rays that are aimed at sides and corners, which exact arithmetic decides.
    Result<Done> edges() {
        const Asked asked{.only = {"primary", "edges"}, .size = small_};
        const Result<const BenchResult*> r = bench(job_.mesh, asked, {kCertifiedBar}, job_.repeats);
        if (!r)
            return r.error();
        add({edges_bar(**r)});
        return Done{};
    }

    /// Asks the same rays in many small calls and in one.
    Result<Done> small_calls() {
        Asked asked{.size = large_};
        for (const std::string set : kRaySetNames)
            asked.only.insert(asked.only.end(), {set, set + kSmall});
        const Result<const BenchResult*> r = bench(job_.mesh, asked, {kCertifiedBar}, job_.repeats);
        if (!r)
            return r.error();
        add(small_calls_bars(**r));
        return Done{};
    }

    Result<Done> high_quality() {
        std::vector<Contender> contenders = {kCertifiedBar};
        if (has_embree())
            contenders.push_back(embree("embree-high", EmbreeMode::High));
        for (const auto& [scene, repeats] :
             {std::pair(kSoup, job_.repeats), {kArchitecture, kOfShortCalls * job_.repeats}}) {
            const Result<const BenchResult*> r =
                bench(scene, {.size = small_, .frame = false}, contenders, repeats);
            if (!r)
                return r.error();
            add(kernel_bars(**r, scene, "embree-high", kHighQuality));
            if (scene == kSoup)
                bytes_bars_.push_back(bytes_bar(**r, "soup", 96, 80));
        }
        return Done{};
    }

    Result<Done> leaves() {
        std::vector<Contender> contenders;
        for (const uint32_t leaves : {1, 8, 32, 128}) {
            contenders.push_back(kCertifiedBar);
            contenders.back().leaves = {leaves, std::to_string(leaves)};
        }
        const Result<const BenchResult*> r = bench(job_.mesh, {.size = large_, .frame = false},
                                                   contenders, kOfShortCalls * job_.repeats, true);
        if (!r)
            return r.error();
        add(leaves_bars(**r));
        return Done{};
    }

    /// Many leaves must be cheap on scenes of every kind, not only on one mesh.
    Result<Done> leaves_of_scenes() {
        std::vector<Contender> contenders;
        for (const uint32_t leaves : {1, 14, 136}) {
            contenders.push_back(kCertifiedBar);
            contenders.back().leaves = {leaves, std::to_string(leaves)};
        }
        std::vector<std::string> scenes = {job_.mesh};
        if (!job_.scene_alone)
            scenes.insert(scenes.end(), {"plants-2", kArchitecture, "city", "dragons-2"});
        for (const std::string& scene : scenes) {
            if (around_.stop())
                break;
            const Result<const BenchResult*> r =
                bench(scene, {.size = large_, .frame = false}, contenders, job_.repeats, true);
            if (!r)
                return r.error();
            add(leaves_of_scene_bars(**r, scene == job_.mesh ? "mesh" : scene));
        }
        return Done{};
    }

    /// A bar of one mesh must hold on scenes of every kind as well, in the leaves that the plugin
    /// chooses itself.
    Result<Done> scenes() {
        std::vector<Contender> contenders = {kCertifiedBar};
        if (has_embree())
            contenders.push_back(embree("embree-robust", EmbreeMode::Robust));
        for (const PromisedScene& scene : kScenes) {
            if (around_.stop())
                break;
            const Result<const BenchResult*> r = bench(scene.name, {.size = small_, .frame = false},
                                                       contenders, kOfShortCalls * job_.repeats);
            if (!r)
                return r.error();
            if (scene.kernel)
                add(kernel_bars(**r, scene.name, "embree-robust", *scene.kernel));
            add(call_bars(**r, scene.name, "embree-robust", kCallOfScenes));
        }
        return Done{};
    }

    Result<Done> budget() {
        std::vector<Contender> contenders(2, kCertifiedBar);
        contenders[0].budget.words = "all";
        contenders[1].budget.words = "30%";
        contenders[1].budget.pages_share = 0.3;
        const Result<const BenchResult*> r = bench(
            kBeyondMemory, {.size = large_, .ray_sets = false}, contenders, job_.repeats, true);
        if (!r)
            return r.error();
        add({budget_bar(**r)});
        return Done{};
    }

    /// Builds both levels and Embree's tree of medium quality in turn.
    Result<Done> build() {
        Bar bar{"build of both levels against embree-medium",
                Better::Less,
                1.2,
                0.9,
                {},
                "times as long, the mesh"};
        if (!has_embree()) {
            add({skipped_bar(bar.what, "this program was built without Embree")});
            return Done{};
        }
        const Result<Scene> scene = open_scene(job_.mesh, around_.log);
        if (!scene)
            return scene.error();
        ContenderBuilder builder(scene->soup, nullptr, 0, job_.device, around_.log);
        std::vector<double> ours, theirs;
        around_.progress.show("building the mesh");
        for (uint32_t i = 0; i < job_.repeats && !around_.stop(); ++i)
            for (const auto& [contender, seconds] :
                 {std::pair(kCertifiedBar, &ours),
                  std::pair(embree("embree-medium", EmbreeMode::Medium), &theirs)}) {
                const Result<std::unique_ptr<Backend>> backend = builder.build(contender);
                if (!backend)
                    return backend.error();
                const ovc_statistics s = (*backend)->statistics();
                seconds->push_back(s.seconds_level1 + s.seconds_level2);
            }
        bar.take(paired_ratio(ours, theirs));
        add({bar});
        return Done{};
    }

    Result<Done> programs() {
        Result<ProgramsResult> r = run_programs(job_.mesh, small_.width, job_.repeats, around_);
        if (!r)
            return r.error();
        add(program_bars(*r));
        result_.programs = std::move(*r);
        return Done{};
    }

    /// Adds the lines that were measured on the way, and those that tests check instead.
    Result<Done> rest() {
        add(bytes_bars_);
        add(import_bars_);
        add({peak_bar(result_.scenes)});
        add({skipped_bar("leaks of closed meshes", "a test: ctest -R Leaks; longer: overcast "
                                                   "report --only leaks --rays 1e8"),
             skipped_bar("wrong ids against exact arithmetic",
                         "tests: ctest -R Stability, ctest -R EqualsBruteForce; here no certified "
                         "answer was unlike double precision's")});
        return Done{};
    }

    const BarsJob& job_;
    const BenchSurroundings& around_;
    const ImageSize large_, small_;
    BarsResult result_;
    std::vector<Bar> import_bars_, bytes_bars_;
};

} // namespace

Result<BarsResult> run_bars(const BarsJob& job, const BenchSurroundings& around) {
    const Result<ScratchFolder> folder = ScratchFolder::make();
    if (!folder)
        return folder.error();
    Result<std::string> mesh = as_file(job.mesh, *folder);
    if (!mesh)
        return mesh.error();
    BarsJob of_file = job;
    of_file.mesh = std::move(*mesh);
    return BarsRun(of_file, around).run();
}

Result<ProgramsResult> run_programs(const std::string& mesh, uint32_t size, uint32_t runs,
                                    const BenchSurroundings& around) {
    const Result<ScratchFolder> folder = ScratchFolder::make();
    if (!folder)
        return folder.error();
    const Result<std::string> file = as_file(mesh, *folder);
    if (!file)
        return file.error();
    around.progress.show("whole programs");
    const Result<Scene> scene = open_scene(*file, around.log);
    if (!scene)
        return scene.error();
    Result<ProgramsResult> result =
        race_programs(*file, scene->soup, size, runs, folder->path(), around.stop);
    around.progress.clear();
    return result;
}

} // namespace ovc

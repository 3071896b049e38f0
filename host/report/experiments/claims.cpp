// SPDX-License-Identifier: Apache-2.0
// The table of claims, in the order of the documents, and how each is measured.
#include "host/report/experiments/claims.h"

#include "core/system/parallel.h"

#include <fmt/format.h>

#include <algorithm>

namespace ovc {

const Json& ClaimResults::of(std::string_view key) const {
    static const Json nothing;
    for (const RawResult& raw : results_)
        if (raw.run.key == key)
            return raw.result;
    return nothing;
}

const Json& ClaimResults::bar(std::string_view line) const {
    static const Json nothing;
    if (const Json& bars = of("bars"); bars.is_object())
        for (const Json& one : bars["bars"])
            if (one["line"] == line)
                return one;
    return nothing;
}

namespace {

using Measure = std::function<Json(const ClaimResults&)>;

constexpr double kMiB = 1 << 20, kGiB = 1 << 30;

Measure measured_by_bar(const char* line) {
    return [=](const ClaimResults& results) {
        const Json& bar = results.bar(line);
        return bar.is_null() ? Json(nullptr) : bar["measured"];
    };
}

/// Takes a number from the JSON of a run, in units of `unit`.
Measure number_of(const char* run, const char* pointer, double unit = 1) {
    return [=](const ClaimResults& results) -> Json {
        const Json::json_pointer at(pointer);
        const Json& json = results.of(run);
        return json.contains(at) ? Json(json[at].get<double>() / unit) : Json(nullptr);
    };
}

/// Sums up a key of the measurements of certified contenders, over all scenes of the bars.
double certified_sum(const Json& bars, const char* key) {
    double sum = 0;
    for (const Json& scene : bars["scenes"])
        for (const Json& one : scene["measurements"])
            if (one["contender"].get<std::string>().starts_with("certified"))
                sum += one[key].get<double>();
    return sum;
}

double grid_sum(const Json& grid, const char* key) {
    double sum = 0;
    for (const Json& one : grid["cases"])
        sum += one["certified"][key].get<double>();
    return sum;
}

/// Counts certified answers that differ from double precision's, in bars and grid together.
Json wrong_answers(const ClaimResults& results) {
    const Json &bars = results.of("bars"), &grid = results.of("grid");
    if (bars.is_null() || grid.is_null())
        return nullptr;
    return certified_sum(bars, "differ") + grid_sum(grid, "wrong");
}

Json leaks(const ClaimResults& results) {
    const Json& grid = results.of("grid");
    return grid.is_null() ? Json(nullptr) : Json(grid_sum(grid, "leaks"));
}

/// Returns the percentage of flagged answers in a frame of the mesh.
Json decided_in_doubles(const ClaimResults& results) {
    if (const Json& bars = results.of("bars"); bars.is_object() && !bars["scenes"].empty())
        for (const Json& one : bars["scenes"][0]["measurements"])
            if (one["contender"] == "certified" && one["workload"] == "frame")
                return 100 * one["flagged"].get<double>() / one["rays"].get<double>();
    return nullptr;
}

/// Counts pixels that differ between the frame under a budget of 30 % and the one with all memory.
Json pixels_under_a_budget(const ClaimResults& results) {
    double pixels = 0;
    bool any = false;
    if (const Json& bars = results.of("bars"); bars.is_object())
        for (const Json& scene : bars["scenes"])
            for (const Json& one : scene["measurements"])
                if (one["contender"].get<std::string>().ends_with("budget 30%")) {
                    pixels += one["differ"].get<double>();
                    any = true;
                }
    return any ? Json(pixels) : Json(nullptr);
}

Json rays_of_the_demo(const ClaimResults& results) {
    const Json& stats = results.of("demo");
    if (stats.is_null())
        return nullptr;
    double rays = 0;
    for (const Json& of_a_kind : stats["rays"])
        rays += of_a_kind.get<double>();
    return 1e-6 * rays;
}

Measure seconds_of_program(const char* name) {
    return [=](const ClaimResults& results) -> Json {
        const Json& bars = results.of("bars");
        if (bars.is_null() || bars["programs"].is_null())
            return nullptr;
        for (const Json& one : bars["programs"]["programs"])
            if (one["name"] == name && !one["wall_seconds"].empty()) {
                std::vector<double> seconds = one["wall_seconds"];
                std::ranges::nth_element(seconds,
                                         seconds.begin() + std::ptrdiff_t(seconds.size() / 2));
                return seconds[seconds.size() / 2];
            }
        return nullptr;
    };
}

/// Divides mixed's number by batched's, for dragonball under a budget.
Measure mixed_to_batched(const char* pointer) {
    return [=](const ClaimResults& results) -> Json {
        const Json mixed = number_of("passes-mixed", pointer)(results),
                   batched = number_of("passes-batched", pointer)(results);
        if (mixed.is_null() || batched.is_null())
            return nullptr;
        return mixed.get<double>() / batched.get<double>();
    };
}

/// Returns the percentage of all cores' time that was used, from the first ray to the last.
Json cores_used(const ClaimResults& results) {
    const Json& stats = results.of("cores");
    if (stats.is_null())
        return nullptr;
    return 100 * stats["time"]["cpu"].get<double>() /
           (double(thread_count()) * stats["time"]["render"].get<double>());
}

constexpr const char* kReadme = "README.md";
constexpr const char* kPerformance = "docs/guide/performance.md";
constexpr const char* kBenchmarks = "docs/benchmarks.md";
constexpr ClaimBar kNone = {true, 0};

/// Adds the claims of one section.
class SectionClaims {
public:
    SectionClaims(std::vector<Claim>& claims, const char* document, const char* heading)
        : claims_(claims), document_(document), heading_(heading) {}

    SectionClaims& held(const char* what, const char* says, const char* by) {
        return measured(what, says, {}, {}, by);
    }
    SectionClaims& measured(const char* what, const char* says, Measure measure,
                            std::optional<ClaimBar> bar = {}, const char* held_by = "") {
        claims_.push_back({document_, heading_, what, says, std::move(measure), bar, held_by});
        return *this;
    }

private:
    std::vector<Claim>& claims_;
    const char *document_, *heading_;
};

void add_readme(std::vector<Claim>& claims) {
    SectionClaims(claims, kReadme, "")
        .measured("plants", "7,121,524 triangles", number_of("demo", "/triangles"))
        .measured("7,121,524 triangles,", "347 MiB of GPU structures",
                  number_of("demo", "/level2_bytes", kMiB))
        .measured("347 MiB of GPU structures traced", "within 86 MiB",
                  number_of("demo", "/gpu_peak_bytes", kMiB), ClaimBar{true, 86})
        .measured("renders it at 1280×720 with", "1.7 million rays", rays_of_the_demo);
    SectionClaims(claims, kPerformance, "In renderers you have")
        .held("Debian's tachyon, unmodified", "the same picture", "ctest -R TachyonHost");
    SectionClaims(claims, kPerformance, "What it promises")
        .measured("So a hit names", "the nearest triangle of all", wrong_answers, kNone)
        .held("what it cannot prove, the CPU decides, as", "exact arithmetic on the same doubles",
              "ctest -R Stability.TheReferenceIsExact")
        .held("its t, u and v are", "the exact values, each rounded once to the nearest double",
              "ctest -R ExactOracle")
        .held("the same bits whatever the budget, the leaf size,", "the kernel or the driver",
              "ctest -R Invariance")
        .held(
            "a million rays each at the Stanford bunny and dragon, Embree's robust mode differs on",
            "4 and 27", "ctest -R EmbreeParity")
        .measured("gpu_peak_bytes", "never exceeds it",
                  measured_by_bar("peak GPU bytes over the budget"), kNone, "ctest -R Invariance")
        .held("a budget too small is refused with", "the smallest that works",
              "ctest -R Abi.ABudgetTooSmall")
        .held("Bad input", "gets one sentence and exit code 1, and nothing is written",
              "ctest -R CommandLine.BadInput");
    SectionClaims(claims, kPerformance, "Measured")
        .measured("Stanford dragon, 871,414 triangles, 512², shadows, file to PNG", "0.68 s",
                  seconds_of_program("overcast"))
        .measured("povray on the same mesh", "4.90 s", seconds_of_program("povray"))
        .measured("tachyon", "1.99 s", seconds_of_program("tachyon"))
        .measured("certified against fast float32, dragon 1024², whole frame", "0.93 × the time",
                  measured_by_bar("frame, certified against fast"), ClaimBar{true, 1.25})
        .measured("certified against fast float32, dragon 1024², whole frame",
                  "0.10 % of answers decided in double precision", decided_in_doubles,
                  ClaimBar{true, 1})
        .measured("plants with a quarter of the GPU memory against all of it", "the same picture",
                  pixels_under_a_budget, kNone, "ctest -R Invariance")
        .measured("the same picture", "0.4 GiB moved", number_of("demo", "/bytes_in", kGiB));
    SectionClaims(claims, kPerformance, "Limits, today")
        .held("single rays, from any number of threads,", "are as fast as a tree on the CPU",
              "single_rays_cost DRAGON --threads 256");
}

/// Adds the table's figures at 512 bits, which the command chooses. The bars themselves come from
/// the results of `overcast bench --bars`.
void add_bars(std::vector<Claim>& claims) {
    static constexpr std::pair<const char*, const char*> lines[] = {
        {"kernel against embree-robust, mesh: primary", "1.34"},
        {"kernel against embree-robust, mesh: shadow", "1.46"},
        {"kernel against embree-robust, mesh: diffuse", "1.08"},
        {"kernel against cpu-float-kdtree, mesh: primary", "3.46"},
        {"kernel against cpu-float-kdtree, mesh: shadow", "4.55"},
        {"kernel against cpu-float-kdtree, mesh: diffuse", "4.36"},
        {"frame, certified against fast", "1.01"},
        {"kernel against embree-high, soup-500: primary", "1.39"},
        {"kernel against embree-high, soup-500: shadow", "1.30"},
        {"kernel against embree-high, soup-500: diffuse", "1.20"},
        {"kernel against embree-high, powerplant-400000: primary", "1.06"},
        {"kernel against embree-high, powerplant-400000: shadow", "0.88"},
        {"kernel against embree-high, powerplant-400000: diffuse", "0.78"},
        {"8 leaves against one, all resident", "1.00"},
        {"32 leaves against one, all resident", "0.99"},
        {"128 leaves against one, all resident", "1.00"},
        {"kernel in 14 leaves against one, mesh", "1.02"},
        {"kernel in 136 leaves against one, mesh", "1.04"},
        {"kernel in 14 leaves against one, plants-2", "1.10"},
        {"kernel in 136 leaves against one, plants-2", "1.16"},
        {"kernel in 14 leaves against one, powerplant-400000", "1.02"},
        {"kernel in 136 leaves against one, powerplant-400000", "1.10"},
        {"kernel in 14 leaves against one, city", "1.04"},
        {"kernel in 136 leaves against one, city", "1.03"},
        {"kernel in 14 leaves against one, dragons-2", "1.08"},
        {"kernel in 136 leaves against one, dragons-2", "1.18"},
        {"kernel against embree-robust, plants-5: primary", "1.07"},
        {"kernel against embree-robust, plants-5: shadow", "1.26"},
        {"kernel against embree-robust, plants-5: diffuse", "0.92"},
        {"budget of 30 % against all resident, dragons-10, frame with shadows", "1.35"},
        {"build of both levels against embree-medium", "1.48"},
        {"overcast render against povray, from file to PNG", "7.37"},
        {"overcast render against tachyon, from file to PNG", "2.94"},
        {"level-2 bytes a triangle, mesh", "46"},
        {"level-2 bytes a triangle, soup", "91"},
        {"import: peak memory over the soup's", "1.46"},
        {"import: binary PLY, MB a CPU second", "443"},
        {"peak GPU bytes over the budget", "0.00"}};
    SectionClaims bars(claims, kBenchmarks, "The bars");
    for (const auto& [line, says] : lines)
        bars.measured(line, says, measured_by_bar(line));
    bars.measured("leaks of closed meshes", "a test", leaks, kNone, "ctest -R Leaks")
        .measured("wrong ids against exact arithmetic", "a test", wrong_answers, kNone,
                  "ctest -R Stability");
}

void add_benchmarks(std::vector<Claim>& claims) {
    SectionClaims(claims, kBenchmarks, "Whole programs")
        .measured("overcast", "0.60", seconds_of_program("overcast"))
        .measured("povray", "4.34", seconds_of_program("povray"))
        .measured("tachyon", "1.71", seconds_of_program("tachyon"));
    SectionClaims(claims, kBenchmarks, "As work grows")
        .held("The last row is", "the exponent k of the power law", "the section scale");
    SectionClaims(claims, kBenchmarks, "Time against the error of pictures")
        .held("a sphere, a cone and a torus as triangles", "at tolerances of 0.1 to 0.0001 radii",
              "ctest -R Pictures.OfRoundShapes");
    SectionClaims(claims, kBenchmarks, "Where the time goes, and what the budget costs")
        .measured("The pictures are", "identical under every budget", pixels_under_a_budget, kNone,
                  "ctest -R Invariance")
        .measured("Peak GPU bytes", "never exceed the budget",
                  measured_by_bar("peak GPU bytes over the budget"), kNone)
        .measured("dragonball", "0.28", mixed_to_batched("/passes"))
        .measured("Under a budget mixed", "moves less than batched", mixed_to_batched("/bytes_in"),
                  ClaimBar{true, 1})
        .measured("At most", "0.7 times batched's passes were asked", mixed_to_batched("/passes"),
                  ClaimBar{true, 0.7});
    SectionClaims(claims, kBenchmarks, "Tracing and shading beside each other")
        .measured("glass", "84 %", cores_used);
    SectionClaims(claims, kBenchmarks, "Triangles that are there twice")
        .held("Allowed is", "1.5 of the whole program and of tracing",
              "python3 host/bench/doubles.py");
    SectionClaims(claims, kBenchmarks, "Far-reaching triangles")
        .held("a frame of its own", "the kernel tests it in doubles there",
              "ctest -R FarTriangles");
    SectionClaims(claims, kBenchmarks, "Instances")
        .held("The pictures have", "the same pixels", "ctest -R Instances");
    SectionClaims(claims, kBenchmarks, "Updates")
        .held("commits of random updates", "the same bits as brute force", "ctest -R Updates");
    SectionClaims(claims, kBenchmarks, "What is not asked for")
        .held("the mean of both orders", "at most 0.9 % slower",
              "paired_calls BEFORE.so AFTER.so dragon.ply");
    SectionClaims(claims, kBenchmarks, "Leaves that are cut out")
        .held("holds that", "the same leaves are hit", "ctest -R CutoutPictures");
    SectionClaims(claims, kBenchmarks, "Single rays")
        .held("intersect1, 256 threads", "0.81", "single_rays_cost DRAGON --threads 256");
    SectionClaims(claims, kBenchmarks, "The plan")
        .held("holds the figures", "to 10 % on more scenes", "ctest -R Plan");
    SectionClaims(claims, kBenchmarks, "Conversion under a budget")
        .held("memory were those of the PLY file,", "bit for bit", "ctest -R ConvertUnderABudget");
    SectionClaims(claims, kBenchmarks, "Rendering under a budget")
        .held("All pictures of a scene are", "the same bits", "ctest -R ConvertUnderABudget");
    SectionClaims(claims, kBenchmarks, "Import")
        .measured("dragon, binary PLY", "406",
                  measured_by_bar("import: binary PLY, MB a CPU second"), {},
                  "importers/measure.py")
        .held("Of 178 odd PLY and OBJ files", "164 are read", "ctest -R RealFiles");
}

} // namespace

std::vector<Claim> claims() {
    std::vector<Claim> all;
    add_readme(all);
    add_bars(all);
    add_benchmarks(all);
    return all;
}

} // namespace ovc

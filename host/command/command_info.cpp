// SPDX-License-Identifier: Apache-2.0
// overcast info: what a scene consists of, for a person or as JSON.
#include "core/text/printable.h"
#include "host/arguments/arguments.h"
#include "host/arguments/backend_arguments.h"
#include "host/arguments/log_arguments.h"
#include "host/arguments/memory_size.h"
#include "host/backend/device_opening.h"
#include "host/backend/streamed_levels.h"
#include "host/command/command.h"
#include "host/scene/scene_in_store.h"
#include "host/scene/scene_source.h"
#include "host/scene/scene_summary.h"
#include "host/terminal/interrupt.h"
#include "importers/scene_file/scene_file.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <set>

namespace ovc {

using Json = nlohmann::ordered_json;

static constexpr const char* kInfoExamples = R"(Examples:
  overcast info dragon.ply
  overcast info plants --json | jq .triangles
  overcast info dragons-10 --gpu-memory 128M
      how many leaves, how much level 2, and how much of it fits at once
  overcast info scan.ply --host-memory 2G
      the file that overcast convert would make, and what tracing it would take)";

static Json as_json(const dvec3& v) {
    return {v.x, v.y, v.z};
}
/// Returns the shortest decimal that reads back as this float. As a double, 0.8f would be printed
/// as 0.800000011920929.
static Json as_json(float value) {
    return std::stod(fmt::format("{}", value));
}

static Json as_json(const vec3& v) {
    return {as_json(v.x), as_json(v.y), as_json(v.z)};
}

static Json materials_json(const Scene& scene) {
    Json list = Json::array();
    for (const Material& material : scene.materials)
        list.push_back({{"name", material.name},
                        {"color", as_json(material.color)},
                        {"mirror", as_json(material.mirror)},
                        {"transmission", as_json(material.transmission)},
                        {"filter", as_json(material.filter)},
                        {"ior", material.ior}});
    return list;
}

/// The memory that a scene takes, of each kind.
struct Takes {
    uint64_t file = 0; // as .ovc
    uint64_t host = 0;
    uint64_t gpu = 0;
};

static Takes takes_of(const Scene& scene, const ovc_plan& plan) {
    Takes takes{scene_file_bytes(scene, plan.saved_bytes), plan.host_bytes,
                plan.ray_bytes + plan.level1_bytes + plan.pool_bytes};
    std::set<Chunk::MeshKey> counted; // instances share the corners of their mesh
    for (const Chunk& chunk : scene.soup.chunks)
        if (!chunk.stored_corners() && counted.insert(chunk.mesh_key()).second)
            takes.host +=
                bytes_of(chunk.corners()).size() + bytes_of(chunk.double_corners()).size();
    for (const MeshInfo& mesh : scene.meshes)
        takes.host += mesh.normals.size() * sizeof(vec3) + mesh.uv.size() * sizeof(vec2);
    return takes;
}

/// The same of the file that a scene in scratch files is converted to, within so many bytes of host
/// memory.
static Takes takes_of(const SceneInStore& read, const ovc_plan& plan, uint64_t host_bytes) {
    const uint64_t shading = bytes_for_shading(read.scene, read.store, host_bytes);
    return {scene_file_bytes(read.scene, read.store, plan.saved_bytes),
            std::min(host_bytes, plan.host_bytes + shading),
            plan.ray_bytes + plan.level1_bytes + plan.pool_bytes};
}

/// All that the command tells of a scene.
struct SceneInfo {
    const Scene& scene;
    SceneSummary summary;
    Result<ovc_plan> plan;
    Takes takes; // where there is a plan
};

/// Returns null where there is no plan. docs/reference/stats.md says what the keys mean.
static Json plan_json(const SceneInfo& told) {
    const Result<ovc_plan>& plan = told.plan;
    if (!plan)
        return nullptr;
    const Takes& takes = told.takes;
    return {{"leaves", plan->leaves},
            {"leaf_references", plan->leaf_references},
            {"level2_bytes", plan->level2_bytes},
            {"largest_page_bytes", plan->largest_page_bytes},
            {"gpu_budget_bytes", plan->gpu_budget_bytes},
            {"smallest_budget_bytes", plan->smallest_budget_bytes},
            {"fits", plan->fits != 0},
            {"ray_bytes", plan->ray_bytes},
            {"batch_rays", plan->batch_rays},
            {"level1_bytes", plan->level1_bytes},
            {"pool_bytes", plan->pool_bytes},
            {"resident_pages", plan->resident_pages},
            {"sweep_bytes", plan->level2_bytes},
            {"host_bytes", plan->host_bytes},
            {"saved_bytes", plan->saved_bytes},
            {"smallest_host_bytes", plan->smallest_host_bytes},
            {"takes", {{"file", takes.file}, {"host", takes.host}, {"gpu", takes.gpu}}},
            {"seconds", plan->seconds}};
}

static std::string plan_text(const SceneInfo& told) {
    if (!told.plan)
        return fmt::format("  plan       none: {}\n", told.plan.error().message);
    const ovc_plan& p = *told.plan;
    std::string text =
        fmt::format("  plan       {} leaves, {} of level 2, {} the largest page, {} on the host\n",
                    human_count(p.leaves), human_bytes(p.level2_bytes),
                    human_bytes(p.largest_page_bytes), human_bytes(p.host_bytes));
    if (!p.fits)
        return text + fmt::format("  budget     {} is too small: about {} is the smallest that "
                                  "works\n",
                                  human_bytes(p.gpu_budget_bytes),
                                  human_bytes(p.smallest_budget_bytes));
    text += fmt::format("  budget     {}: {} for rays, {} for portals, {} for pages; {} would do\n",
                        human_bytes(p.gpu_budget_bytes), human_bytes(p.ray_bytes),
                        human_bytes(p.level1_bytes), human_bytes(p.pool_bytes),
                        human_bytes(p.smallest_budget_bytes));
    const Takes& takes = told.takes;
    text += fmt::format("  takes      {} as a scene file, {} of host memory, {} of GPU memory\n",
                        human_bytes(takes.file), human_bytes(takes.host), human_bytes(takes.gpu));
    if (p.smallest_host_bytes > 0)
        text += fmt::format("  host       {} would do\n", human_bytes(p.smallest_host_bytes));
    if (p.resident_pages == p.leaves)
        return text + "  pages      all fit at once: each is moved once\n";
    return text + fmt::format("  pages      {} of {} fit at once; to move every page once is {}\n",
                              human_count(p.resident_pages), human_count(p.leaves),
                              human_bytes(p.level2_bytes));
}

static std::string info_json(const SceneInfo& told) {
    const Scene& scene = told.scene;
    const SceneSummary& s = told.summary;
    Json left_out = Json::array();
    for (const LeftOut& item : s.left_out)
        left_out.push_back({{"what", item.what}, {"bytes", item.bytes}});
    const Instancing instancing = scene.instancing.value_or(Instancing{s.triangles, 0});
    Json document = {
        {"triangles", s.triangles},
        {"unique_triangles", instancing.unique_triangles},
        {"instances", instancing.instances},
        {"dropped", {{"not_finite", s.dropped.not_finite}, {"degenerate", s.dropped.degenerate}}},
        {"bounds", nullptr},
        {"meshes", s.meshes},
        {"materials", materials_json(scene)},
        {"lights", scene.lights.size()},
        {"camera", scene.camera.has_value()},
        {"needs",
         {{"vertex_normals", s.needs.vertex_normals},
          {"texture_coordinates", s.needs.texture_coordinates},
          {"reflection", s.needs.reflection},
          {"refraction", s.needs.refraction},
          {"shadows", s.needs.shadows},
          {"several_leaves", s.needs.several_leaves},
          {"certified", s.needs.certified}}},
        {"left_out", left_out},
        {"plan", plan_json(told)}};
    if (!s.bounds.empty())
        document["bounds"] = {{"min", as_json(s.bounds.lo)}, {"max", as_json(s.bounds.hi)}};
    return document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

static std::string needs_text(const Needs& needs) {
    std::vector<std::string_view> names;
    const std::pair<bool, std::string_view> all[] = {
        {needs.vertex_normals, "vertex normals"},
        {needs.texture_coordinates, "texture coordinates"},
        {needs.reflection, "reflection"},
        {needs.refraction, "refraction"},
        {needs.shadows, "shadows"},
        {needs.several_leaves, "several leaves"},
        {needs.certified, "certified answers"}};
    for (const auto& [needed, name] : all)
        if (needed)
            names.push_back(name);
    return fmt::format("{}", fmt::join(names, ", "));
}

static std::string lights_text(const Scene& scene) {
    if (!scene.lights.empty())
        return fmt::format("{}", scene.lights.size());
    return scene.may_add_light ? "none; render adds one" : "none";
}

static std::string info_text(const std::string& source, const SceneInfo& told) {
    const Scene& scene = told.scene;
    const SceneSummary& s = told.summary;
    std::string text =
        fmt::format("  scene      {}\n  triangles  {} in {} mesh{}\n", printable(source),
                    human_count(s.triangles), human_count(s.meshes), s.meshes == 1 ? "" : "es");
    if (scene.instancing && scene.instancing->instances > 0)
        text += fmt::format("  instances  {} of {} unique triangles\n",
                            human_count(scene.instancing->instances),
                            human_count(scene.instancing->unique_triangles));
    if (s.dropped.total() > 0)
        text += fmt::format("  dropped    {} ({} not finite, {} without area)\n",
                            human_count(s.dropped.total()), human_count(s.dropped.not_finite),
                            human_count(s.dropped.degenerate));
    if (s.bounds.empty())
        text += "  bounds     none: nothing here can be hit\n";
    else
        text += fmt::format("  bounds     {:.6g} {:.6g} {:.6g} to {:.6g} {:.6g} {:.6g}\n",
                            s.bounds.lo.x, s.bounds.lo.y, s.bounds.lo.z, s.bounds.hi.x,
                            s.bounds.hi.y, s.bounds.hi.z);
    text +=
        fmt::format("  materials  {}\n  lights     {}\n  camera     {}\n", scene.materials.size(),
                    lights_text(scene), scene.camera ? "given" : "none; render frames the scene");
    text += fmt::format("  needs      {}\n  left out   {}\n", needs_text(s.needs),
                        left_out_text(s.left_out));
    return text + plan_text(told);
}

/// Returns the folder for scratch files, which may be larger than the memory that /tmp often is.
static std::filesystem::path scratch_folder() {
    const char* const named = std::getenv("TMPDIR");
    return named && *named ? named : "/var/tmp";
}

namespace {

class Info final : public Subcommand {
public:
    void add_to(CLI::App& app) override {
        app.description("Says what a scene consists of, what it needs, what is left out of it, "
                        "and, before anything is built, how it would be traced.");
        source_.add_to(app);
        backend_.add_to(app,
                        "For an .ovc file, or one that convert reads with it: the most host memory "
                        "to use, 2G, besides what the program and the driver take; the plan is "
                        "that of tracing within it. Triangles that are converted wait in TMPDIR");
        app.add_flag("--json", json_, "As JSON, for a program");
        log_.add_to(app);
        app.footer(kInfoExamples);
    }

    Result<int> run() override {
        if (const Result<Done> fine = source_.check(); !fine)
            return fine.error();
        const Result<LogLevel> level = log_.resolve();
        if (!level)
            return level.error();
        Result<BackendOptions> options = backend_.resolve();
        if (!options)
            return options.error();
        const LogSink log = standard_error_log(*level);
        prepare_process(*options);
        if (options->host_bytes > 0 && !source_.is_one_scene_file())
            return tell_streamed(*options, log);
        source_.host_bytes = options->host_bytes;
        const Result<Scene> scene = open_scene(source_, log);
        return scene ? tell(*scene, std::move(*options), log) : Result<int>(scene.error());
    }

private:
    /// Tells of a scene in memory, or in a scene file.
    Result<int> tell(const Scene& scene, BackendOptions options, const LogSink& log) const {
        options.on_disk = scene.on_disk.get();
        SceneInfo told{scene, summarize(scene), ovc_plan{}, {}};
        if (scene.on_disk)
            if (const auto read = scene.on_disk->checked<Done>(Done{}); !read)
                return read.error();
        told.plan = make_plan(scene.soup, options, log);
        if (told.plan)
            told.takes = takes_of(scene, *told.plan);
        print(std::move(told), options.precision, /* has_normals= */ false);
        return kExitOk;
    }

    /// Tells of a scene that streams, and of the scene file that it would be converted to.
    Result<int> tell_streamed(BackendOptions options, const LogSink& log) const {
        if (const Result<Done> fine = check_streams(source_); !fine)
            return fine.error();
        const Result<SceneInStore> read =
            stream_scene(source_, options.host_bytes, scratch_folder(), log);
        if (!read)
            return read.error();
        if (read->is_held())
            return tell(read->scene, std::move(options), log);
        Result<SceneSummary> summary = summarize(read->scene, read->store);
        if (!summary)
            return summary.error();
        options.watching = BuildWatching::Shown;
        SceneInfo told{read->scene,
                       std::move(*summary),
                       plan_streamed_levels(triangles_in(read->scene, read->store),
                                            options.host_bytes, options, log),
                       {}};
        if (told.plan)
            told.takes = takes_of(*read, *told.plan, options.host_bytes);
        print(std::move(told), options.precision, read->has_normals());
        return kExitOk;
    }

    void print(SceneInfo told, ovc_precision precision, bool has_normals) const {
        SceneSummary& summary = told.summary;
        summary.needs =
            needs_of(told.scene, {/* shadows= */ true, precision == OVC_PRECISION_CERTIFIED,
                                  told.plan ? told.plan->leaves : 2});
        summary.needs.vertex_normals |= has_normals;
        summary.left_out = left_out_of(told.scene, summary.needs);
        fmt::print("{}", json_ ? info_json(told) : info_text(source_.name(), told));
    }

    SceneArguments source_;
    BackendArguments backend_;
    bool json_ = false;
    LogArguments log_;
};

} // namespace

std::unique_ptr<Subcommand> make_info() {
    return std::make_unique<Info>();
}

} // namespace ovc

// SPDX-License-Identifier: Apache-2.0
// overcast info: what a scene consists of, for a person or as JSON.
#include "core/text/printable.h"
#include "host/arguments/arguments.h"
#include "host/arguments/backend_arguments.h"
#include "host/arguments/log_arguments.h"
#include "host/arguments/memory_size.h"
#include "host/command/command.h"
#include "host/scene/scene_source.h"
#include "host/scene/scene_summary.h"
#include "host/terminal/interrupt.h"
#include "importers/scene_file.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cstdio>
#include <set>

namespace ovc {

using Json = nlohmann::ordered_json;

static constexpr const char* kInfoExamples = R"(Examples:
  overcast info dragon.ply
  overcast info plants --json | jq .triangles
  overcast info dragons-10 --gpu-memory 128M
      how many leaves, how much level 2, and how much of it fits at once)";

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

/// What a scene takes of each kind of memory.
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

/// Returns null where there is no plan. docs/reference/stats.md says what the keys mean.
static Json plan_json(const Scene& scene, const Result<ovc_plan>& plan) {
    if (!plan)
        return nullptr;
    const Takes takes = takes_of(scene, *plan);
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

static std::string plan_text(const Scene& scene, const Result<ovc_plan>& plan) {
    if (!plan)
        return fmt::format("  plan       none: {}\n", plan.error().message);
    const ovc_plan& p = *plan;
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
    const Takes takes = takes_of(scene, p);
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

static std::string info_json(const Scene& scene, const SceneSummary& s,
                             const Result<ovc_plan>& plan) {
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
        {"plan", plan_json(scene, plan)}};
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

static std::string info_text(const std::string& source, const Scene& scene, const SceneSummary& s,
                             const Result<ovc_plan>& plan) {
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
    return text + plan_text(scene, plan);
}

namespace {

class Info final : public Subcommand {
public:
    void add_to(CLI::App& app) override {
        app.description("Says what a scene consists of, what it needs, what is left out of it, "
                        "and, before anything is built, how it would be traced.");
        source_.add_to(app);
        backend_.add_to(app);
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
        source_.host_bytes = options->host_bytes;
        const Result<Scene> scene = open_scene(source_, log);
        if (!scene)
            return scene.error();
        options->on_disk = scene->on_disk.get();
        SceneSummary summary = summarize(*scene);
        if (scene->on_disk)
            if (const auto read = scene->on_disk->checked<Done>(Done{}); !read)
                return read.error();
        const Result<ovc_plan> plan = make_plan(scene->soup, *options, log);
        summary.needs =
            needs_of(*scene, {/* shadows= */ true, options->precision == OVC_PRECISION_CERTIFIED,
                              plan ? plan->leaves : 2});
        summary.left_out = left_out_of(*scene, summary.needs);
        fmt::print("{}", json_ ? info_json(*scene, summary, plan)
                               : info_text(source_.name(), *scene, summary, plan));
        return kExitOk;
    }

private:
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

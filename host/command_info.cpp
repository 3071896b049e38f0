// SPDX-License-Identifier: Apache-2.0
// overcast info: what a scene consists of, for a person or as JSON.
#include "host/arguments.h"
#include "host/command.h"
#include "host/interrupt.h"
#include "host/memory_size.h"
#include "host/scene_source.h"
#include "host/scene_summary.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cstdio>

namespace ovc {

using Json = nlohmann::ordered_json;

static constexpr const char* kExamples = R"(Examples:
  overcast info dragon.ply
  overcast info plants --json | jq .triangles)";

static Json as_json(const dvec3& v) {
    return {v.x, v.y, v.z};
}
/// The shortest decimal that is this float: as a double 0.8f would be 0.800000011920929.
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

static std::string info_json(const Scene& scene, const SceneSummary& s) {
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
          {"shadows", s.needs.shadows}}},
        {"left_out", left_out}};
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
        {needs.shadows, "shadows"}};
    for (const auto& [needed, name] : all)
        if (needed)
            names.push_back(name);
    return fmt::format("{}", fmt::join(names, ", "));
}

static std::string left_out_text(const std::vector<LeftOut>& left_out) {
    std::vector<std::string> items;
    for (const LeftOut& item : left_out)
        items.push_back(item.bytes ? fmt::format("{} ({})", item.what, human_bytes(item.bytes))
                                   : item.what);
    return fmt::format("{}", fmt::join(items, ", "));
}

static std::string info_text(const std::string& source, const Scene& scene, const SceneSummary& s) {
    std::string text =
        fmt::format("  scene      {}\n  triangles  {} in {} mesh{}\n", source,
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
    text += fmt::format(
        "  materials  {}\n  lights     {}\n  camera     {}\n", scene.materials.size(),
        scene.lights.empty() ? "none; render adds one" : fmt::format("{}", scene.lights.size()),
        scene.camera ? "given" : "none; render frames the scene");
    text += fmt::format("  needs      {}\n  left out   {}\n", needs_text(s.needs),
                        left_out_text(s.left_out));
    return text;
}

Result<int> run_info(const Arguments& arguments) {
    CLI::App app{"Says what a scene consists of, what it needs, and what is left out of it.",
                 "overcast info"};
    SceneArguments source;
    bool json = false;
    source.add_to(app);
    app.add_flag("--json", json, "As JSON, for a program");
    app.footer(kExamples);
    const Result<Parsed> parsed = parse_arguments(app, arguments);
    if (!parsed)
        return parsed.error();
    if (*parsed == Parsed::HelpShown)
        return kExitOk;

    if (const Result<Done> fine = source.check(); !fine)
        return fine.error();
    const Result<Scene> scene = open_scene(source, standard_error_log(/* chatty= */ false));
    if (!scene)
        return scene.error();
    const SceneSummary summary = summarize(*scene);
    fmt::print("{}", json ? info_json(*scene, summary) : info_text(source.scene, *scene, summary));
    return kExitOk;
}

} // namespace ovc

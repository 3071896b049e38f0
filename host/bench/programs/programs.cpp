// SPDX-License-Identifier: Apache-2.0
// Writes the same mesh, camera and light in three programs' languages, and times each program.
#include "host/bench/programs/programs.h"

#include "core/system/parallel.h"
#include "host/arguments/memory_size.h"
#include "host/bench/programs/run_program.h"
#include "host/bench/ratios/ratios.h"
#include "host/output/output.h"
#include "host/scene/scene_summary.h"
#include "host/terminal/text_table.h"
#include "importers/mesh/unique_vertices.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cassert>
#include <cmath>
#include <iterator>
#include <numbers>

namespace ovc {

static std::string comma_list(const dvec3& v) {
    return fmt::format("{},{},{}", v.x, v.y, v.z);
}

Result<ProgramShot> shot_of(const Box& bounds, uint32_t size) {
    if (bounds.empty())
        return Error{"there is nothing to draw: the scene has no triangles"};
    const dvec3 center = 0.5 * (bounds.lo + bounds.hi);
    const double extent = max_component(bounds.hi - bounds.lo);
    return ProgramShot{center + extent * dvec3(0.3, 0.4, 1.6), center, 40,
                       center + extent * dvec3(-1, 2, 2), size};
}

std::string povray_scene(const Soup& soup, const ProgramShot& shot) {
    UniqueVertices unique;
    std::vector<uint32_t> corners;
    for (const Chunk& chunk : soup.chunks)
        for (const vec3& corner : chunk.corners())
            corners.push_back(unique.add(chunk.origin() + dvec3(corner)));
    std::string text;
    const auto out = std::back_inserter(text);
    // A negative `right` makes POV-Ray's coordinates right-handed, as ours are.
    fmt::format_to(out,
                   "#version 3.7;\nglobal_settings {{ assumed_gamma 1 }}\n"
                   "camera {{ location <{}> right -x*image_width/image_height look_at <{}> "
                   "angle {} }}\n"
                   "light_source {{ <{}> rgb 1 }}\nbackground {{ rgb 0.5 }}\n"
                   "mesh2 {{\nvertex_vectors {{\n{}",
                   comma_list(shot.eye), comma_list(shot.target), shot.fov_degrees,
                   comma_list(shot.light), unique.vertices().size());
    for (const dvec3& v : unique.vertices())
        fmt::format_to(out, ",\n<{},{},{}>", float(v.x), float(v.y), float(v.z));
    fmt::format_to(out, "\n}}\nface_indices {{\n{}", corners.size() / 3);
    for (size_t i = 0; i < corners.size(); i += 3)
        fmt::format_to(out, ",\n<{},{},{}>", corners[i], corners[i + 1], corners[i + 2]);
    fmt::format_to(out, "\n}}\npigment {{ rgb 0.8 }}\nfinish {{ ambient 0 diffuse 1 }}\n}}\n");
    return text;
}

std::string tachyon_scene(const Soup& soup, const ProgramShot& shot) {
    const auto words = [](const dvec3& v) { return fmt::format("{} {} {}", v.x, v.y, v.z); };
    // Tachyon's coordinates are left-handed; negating z makes ours left-handed too.
    const auto mirrored = [](dvec3 v) { return dvec3(v.x, v.y, -v.z); };
    // Its rays go through the upper right corners of pixels, so a frustum that is moved by half a
    // pixel sends them through the middles.
    const double half = std::tan(shot.fov_degrees * std::numbers::pi / 360);
    const double half_pixel = half / shot.size;
    std::string text;
    const auto out = std::back_inserter(text);
    fmt::format_to(
        out,
        "BEGIN_SCENE\nRESOLUTION {0} {0}\n"
        "CAMERA PROJECTION PERSPECTIVE ZOOM 1 ASPECTRATIO 1 ANTIALIASING 0 RAYDEPTH 2 "
        "CENTER {1} VIEWDIR {2} UPDIR 0 1 0 FRUSTUM {3} {4} {3} {4} END_CAMERA\n"
        "BACKGROUND 0.5 0.5 0.5\n"
        "LIGHT CENTER {5} RAD 0.001 COLOR 1 1 1\n"
        "TEXDEF plain AMBIENT 0 DIFFUSE 0.8 SPECULAR 0 OPACITY 1 COLOR 1 1 1 TEXFUNC 0\n",
        shot.size, words(mirrored(shot.eye)),
        words(mirrored(glm::normalize(shot.target - shot.eye))), -half - half_pixel,
        half - half_pixel, words(mirrored(shot.light)));
    for (const Chunk& chunk : soup.chunks)
        for (uint32_t prim = 0; prim < chunk.size(); ++prim) {
            fmt::format_to(out, "TRI");
            for (int i = 0; i < 3; ++i) {
                const vec3 v(mirrored(chunk.triangle(prim)[size_t(i)]));
                fmt::format_to(out, " V{} {} {} {}", i, v.x, v.y, v.z);
            }
            fmt::format_to(out, " plain\n");
        }
    text += "END_SCENE\n";
    return text;
}

namespace {

struct Racer {
    ProgramTimes times;
    std::vector<std::string> command;
    bool there;
};

Racer overcast(const std::string& mesh, const ProgramShot& shot,
               const std::filesystem::path& folder) {
    const std::string camera =
        fmt::format("{},{},{}", comma_list(shot.eye), comma_list(shot.target), shot.fov_degrees);
    return {{"overcast", "the mesh as given", {}, std::filesystem::file_size(mesh)},
            {"/proc/self/exe", "render", mesh, "--size", fmt::format("{0}x{0}", shot.size),
             "--camera=" + camera, "--light=" + comma_list(shot.light), "--quiet", "-o",
             folder / "overcast.png"},
            true};
}

Result<Racer> povray(const Soup& soup, const ProgramShot& shot,
                     const std::filesystem::path& folder) {
    const std::string scene = folder / "mesh.pov";
    Racer racer{{"povray", "mesh2 text", {}, 0},
                {"povray", "+I" + scene, "+O" + std::string(folder / "povray.png"),
                 fmt::format("+W{}", shot.size), fmt::format("+H{}", shot.size), "-A", "-D", "-GA",
                 fmt::format("+WT{}", thread_count())},
                is_installed("povray")};
    if (!racer.there)
        return racer;
    const std::string text = povray_scene(soup, shot);
    racer.times.bytes_read = text.size();
    const Result<Done> saved = save_text(text, scene);
    return saved ? Result<Racer>(std::move(racer)) : saved.error();
}

Result<Racer> tachyon(const Soup& soup, const ProgramShot& shot,
                      const std::filesystem::path& folder) {
    const std::string scene = folder / "mesh.dat";
    Racer racer{{"tachyon", "TRI text", {}, 0},
                {"tachyon", scene, "-numthreads", fmt::format("{}", thread_count()), "-fullshade",
                 "-res", fmt::format("{}", shot.size), fmt::format("{}", shot.size), "-format",
                 "PNG", "-o", folder / "tachyon.png"},
                is_installed("tachyon")};
    if (!racer.there)
        return racer;
    const std::string text = tachyon_scene(soup, shot);
    racer.times.bytes_read = text.size();
    const Result<Done> saved = save_text(text, scene);
    return saved ? Result<Racer>(std::move(racer)) : saved.error();
}

} // namespace

Result<ProgramsResult> race_programs(const std::string& mesh, const Soup& soup, uint32_t size,
                                     uint32_t runs, const std::filesystem::path& folder,
                                     const StopRequest& stop) {
    const Result<ProgramShot> shot = shot_of(hittable_bounds(soup), size);
    if (!shot)
        return shot.error();
    std::vector<Racer> racers = {overcast(mesh, *shot, folder)};
    for (const auto& make : {povray, tachyon}) {
        Result<Racer> racer = make(soup, *shot, folder);
        if (!racer)
            return racer.error();
        racers.push_back(std::move(*racer));
    }
    ProgramsResult result{mesh, soup.triangle_count(), size, {}, true};
    for (uint32_t run = 0; run <= runs && result.complete; ++run)
        for (Racer& racer : racers) {
            if (!racer.there)
                continue;
            result.complete = !stop();
            if (!result.complete)
                break;
            const Result<double> seconds = run_program(racer.command);
            result.complete = !stop(); // Ctrl-C ends the program as well, which is no failure
            if (!result.complete)
                break;
            if (!seconds)
                return seconds.error();
            if (run > 0)
                racer.times.seconds.push_back(*seconds);
        }
    for (Racer& racer : racers)
        result.programs.push_back(std::move(racer.times));
    return result;
}

std::optional<PairedRatio> times_as_fast(const ProgramsResult& result, std::string_view program) {
    assert(!result.programs.empty());
    const std::vector<double>& ours = result.programs.front().seconds;
    for (const ProgramTimes& p : result.programs)
        if (p.name == program && !p.seconds.empty() && !ours.empty())
            return paired_ratio(p.seconds, ours);
    return {};
}

std::string programs_table(const ProgramsResult& r) {
    std::vector<TextRow> rows = {{"program", "reads", "bytes", "s", "min", "max", "overcast is"}};
    for (const ProgramTimes& p : r.programs) {
        if (p.seconds.empty()) {
            rows.push_back({p.name, "not installed", "-", "-", "-", "-", "-"});
            continue;
        }
        const Spread s = spread_of(p.seconds);
        rows.push_back(
            {p.name, p.reads, human_bytes(p.bytes_read), fmt::format("{:.2f}", s.median),
             fmt::format("{:.2f}", s.min), fmt::format("{:.2f}", s.max),
             fmt::format("{:.1f} x", times_as_fast(r, p.name).value_or(PairedRatio{}).median)});
    }
    return fmt::format("{}: {} triangles, from file to PNG of {} x {}, one light with shadows, {} "
                       "threads, {} runs in turn\n\n{}",
                       r.mesh, human_count(r.triangles), r.size, r.size, thread_count(),
                       r.programs.front().seconds.size(), markdown_table(rows));
}

std::string programs_json(const ProgramsResult& r) {
    using nlohmann::ordered_json;
    ordered_json programs = ordered_json::array();
    for (const ProgramTimes& p : r.programs) {
        const std::optional<PairedRatio> ratio = times_as_fast(r, p.name);
        programs.push_back({{"name", p.name},
                            {"reads", p.reads},
                            {"bytes_read", p.bytes_read},
                            {"wall_seconds", p.seconds},
                            {"overcast_times_as_fast",
                             ratio ? ordered_json(ratio->median) : ordered_json(nullptr)}});
    }
    const ordered_json document = {{"mesh", r.mesh},
                                   {"triangles", r.triangles},
                                   {"size", r.size},
                                   {"complete", r.complete},
                                   {"programs", programs}};
    return document.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

} // namespace ovc

// SPDX-License-Identifier: Apache-2.0
// Reads one scene file at several tolerances, traces it and draws it.
#include "host/bench/pictures/tessellation.h"

#include "core/system/stopwatch.h"
#include "host/arguments/memory_size.h"
#include "host/bench/pictures/picture_text.h"
#include "host/bench/programs/run_program.h"
#include "host/bench/programs/scratch_folder.h"
#include "host/bench/ratios/ratios.h"
#include "host/camera/camera.h"
#include "host/output/output.h"
#include "host/scene/scene_source.h"
#include "host/terminal/terminal_line.h"
#include "host/terminal/text_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace ovc {

namespace {

/// In radii: the coarsest is a polygon of 12 sides, the finest what the readers allow.
constexpr double kTolerances[] = {0.1, 0.03, 0.01, 0.003, 0.001, 0.0003, 0.0001};
constexpr double kFar = 1000; // lengths; the scene has 20

double relative(double t, double right) {
    return std::abs(t - right) / std::abs(right);
}

class TessellationSweep {
public:
    TessellationSweep(const TessellationJob& job, const BenchSurroundings& around,
                      std::filesystem::path folder)
        : job_(job), around_(around), folder_(std::move(folder)), shapes_(example_shapes()) {
        result_.size = job.size;
        for (const ExactShape& shape : shapes_)
            result_.shapes.push_back(shape.name);
        for (const double tolerance : kTolerances)
            result_.rows.push_back({.tolerance = tolerance});
        result_.rows.emplace_back();
    }

    Result<Tessellation> run() {
        if (const Result<Done> saved = save_text(povray_scene(shapes_), file()); !saved)
            return saved.error();
        if (const Result<Done> done = draw(); !done)
            return done.error();
        for (uint32_t run = 1; run <= job_.runs; ++run)
            for (TessellationRow& row : result_.rows) {
                if (around_.stop())
                    return std::move(result_);
                around_.progress.show(fmt::format("{}, {} of {}", row.name(), run, job_.runs));
                if (const Result<Done> done = measure(row); !done)
                    return done.error();
            }
        result_.complete = !around_.stop();
        around_.progress.clear();
        return std::move(result_);
    }

private:
    std::filesystem::path file() const { return folder_ / "shapes.pov"; }

    Result<Done> measure(TessellationRow& row) {
        ImportOptions options{around_.log};
        options.size = ImageSize{job_.size, job_.size};
        options.tolerance = row.tolerance;
        const Stopwatch watch;
        const Result<Scene> scene = load(file(), options);
        if (!scene)
            return scene.error();
        row.import_seconds.push_back(watch.seconds());
        row.triangles = scene->soup.triangle_count();
        BackendOptions asked;
        asked.kind = BackendKind::TwoLevel;
        asked.device = job_.device;
        const Result<std::unique_ptr<Backend>> backend =
            make_backend(scene->soup, asked, around_.log);
        if (!backend)
            return backend.error();
        const ovc_statistics built = (*backend)->statistics();
        row.build_seconds.push_back(built.seconds_level1 + built.seconds_level2);
        row.page_bytes = built.level2_bytes;
        return trace(*scene, **backend, row);
    }

    Result<Done> trace(const Scene& scene, Backend& backend, TessellationRow& row) {
        const RaySet set = make_primary_set(*scene.camera, job_.size, job_.size);
        result_.rays = set.rays.size();
        std::vector<Hit> hits(set.rays.size());
        if (const Result<Done> done = backend.intersect(set.rays, {}, hits); !done)
            return done; // the first call is not timed, because it compiles the kernel
        const Stopwatch watch;
        if (const Result<Done> done = backend.intersect(set.rays, {}, hits); !done)
            return done;
        row.call_seconds.push_back(watch.seconds());
        if (right_.empty()) // the camera is the same at all tolerances
            right_ = first_hits(shapes_, set.rays, kFar);
        row.error = shape_error(shapes_, set.rays, hits, right_);
        return Done{};
    }

    Result<Done> draw() {
        result_.has_povray = is_installed("povray");
        if (!result_.has_povray)
            return Done{};
        std::vector<PictureChoice> choices;
        for (const TessellationRow& row : result_.rows) {
            std::vector<std::string> words;
            if (row.tolerance)
                words = {"--tolerance", fmt::format("{}", *row.tolerance)};
            if (!job_.device.empty())
                words.insert(words.end(), {"--device", job_.device});
            choices.push_back(overcast_picture(row.name(), file(), job_.size, words,
                                               folder_ / std::to_string(choices.size())));
        }
        const PictureChoice povray =
            povray_picture("povray", file(), job_.size, /* depth= */ 1, folder_ / "povray");
        choices.push_back(povray);
        around_.progress.show("pictures");
        Result<PictureRace> race = race_pictures(povray, choices, job_.runs, around_.stop);
        if (!race)
            return race.error();
        result_.pictures = std::move(*race);
        return Done{};
    }

    const TessellationJob& job_;
    const BenchSurroundings& around_;
    const std::filesystem::path folder_;
    const std::vector<ExactShape> shapes_;
    std::vector<double> right_; // t of the camera's rays on the exact shapes
    Tessellation result_;
};

Json row_json(const Tessellation& r, size_t i) {
    const TessellationRow& row = r.rows[i];
    Json json = {{"choice", row.name()},
                 {"tolerance", row.tolerance ? Json(*row.tolerance) : Json(nullptr)},
                 {"triangles", row.triangles},
                 {"page_bytes", row.page_bytes},
                 {"import_seconds", spread_of(row.import_seconds).median},
                 {"build_seconds", spread_of(row.build_seconds).median},
                 {"call_seconds", spread_of(row.call_seconds).median},
                 {"rms_distance", row.error.rms_distance},
                 {"t_error_largest", row.error.largest_t},
                 {"t_error_rms", row.error.rms_t},
                 {"unlike", row.error.unlike},
                 {"largest_distance", Json::object()},
                 {"picture", i < r.pictures.choices.size() ? picture_json(r.pictures.choices[i])
                                                           : Json(nullptr)}};
    for (size_t s = 0; s < row.error.largest_distance.size(); ++s)
        json["largest_distance"][r.shapes[s]] = row.error.largest_distance[s];
    return json;
}

} // namespace

std::string TessellationRow::name() const {
    return tolerance ? fmt::format("tolerance {}", *tolerance) : "the reader's own";
}

ShapeError shape_error(std::span<const ExactShape> shapes, std::span<const Ray> rays,
                       std::span<const Hit> hits, std::span<const double> right) {
    assert(rays.size() == hits.size() && rays.size() == right.size());
    ShapeError error;
    error.largest_distance.resize(shapes.size());
    double squares_distance = 0, squares_t = 0;
    uint64_t hit = 0, both = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
        error.unlike += hits[i].is_hit() != std::isfinite(right[i]);
        if (!hits[i].is_hit())
            continue;
        const dvec3 at = rays[i].org + hits[i].t * rays[i].dir;
        size_t nearest = 0;
        for (size_t s = 1; s < shapes.size(); ++s)
            if (std::abs(shapes[s].distance(at)) < std::abs(shapes[nearest].distance(at)))
                nearest = s;
        const double off = std::abs(shapes[nearest].distance(at)) / shapes[nearest].radius;
        error.largest_distance[nearest] = std::max(error.largest_distance[nearest], off);
        squares_distance += off * off;
        ++hit;
        if (!std::isfinite(right[i]))
            continue;
        const double off_t = relative(hits[i].t, right[i]);
        error.largest_t = std::max(error.largest_t, off_t);
        squares_t += off_t * off_t;
        ++both;
    }
    error.rms_distance = hit ? std::sqrt(squares_distance / double(hit)) : 0;
    error.rms_t = both ? std::sqrt(squares_t / double(both)) : 0;
    return error;
}

Result<Tessellation> run_tessellation(const TessellationJob& job, const BenchSurroundings& around) {
    const Result<ScratchFolder> folder = ScratchFolder::make();
    return folder ? TessellationSweep(job, around, folder->path()).run() : folder.error();
}

std::string tessellation_table(const Tessellation& r) {
    std::vector<TextRow> rows = {{"in radii", "triangles", "pages MB", "import s", "build s",
                                  "call s", "t error, RMS", "t error, largest", "unlike"}};
    for (const std::string& shape : r.shapes)
        rows[0].push_back("off the " + shape);
    for (const TessellationRow& row : r.rows) {
        if (row.call_seconds.empty())
            continue; // the run was stopped before this row
        rows.push_back({row.name(), human_count(row.triangles),
                        fmt::format("{:.2f}", 1e-6 * double(row.page_bytes)),
                        fmt::format("{:.3f}", spread_of(row.import_seconds).median),
                        fmt::format("{:.3f}", spread_of(row.build_seconds).median),
                        fmt::format("{:.4f}", spread_of(row.call_seconds).median),
                        fmt::format("{:.2g}", row.error.rms_t),
                        fmt::format("{:.2g}", row.error.largest_t), human_count(row.error.unlike)});
        for (const double off : row.error.largest_distance)
            rows.back().push_back(fmt::format("{:.2g}", off));
    }
    std::string text =
        fmt::format("Round shapes as triangles, certified, {} camera rays: off the exact shapes\n\n"
                    "{}\n",
                    human_count(r.rays), markdown_table(rows));
    if (!r.has_povray)
        return text + "povray is not installed: no picture is compared with its own.\n";
    return text + fmt::format("Pictures of {} x {}, off povray's of the exact shapes\n\n{}", r.size,
                              r.size, picture_table(r.pictures));
}

std::string tessellation_json(const Tessellation& r) {
    Json rows = Json::array();
    for (size_t i = 0; i < r.rows.size(); ++i)
        if (!r.rows[i].call_seconds.empty())
            rows.push_back(row_json(r, i));
    const Json document = {{"shapes", r.shapes},
                           {"size", r.size},
                           {"rays", r.rays},
                           {"complete", r.complete},
                           {"rows", rows},
                           {"povray", r.pictures.choices.empty()
                                          ? Json(nullptr)
                                          : picture_json(r.pictures.choices.back())}};
    return json_text(document);
}

} // namespace ovc

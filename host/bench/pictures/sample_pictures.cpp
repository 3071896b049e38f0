// SPDX-License-Identifier: Apache-2.0
// Gives the same triangles, camera and light to three programs, with growing samples a pixel.
#include "host/bench/pictures/sample_pictures.h"

#include "core/system/parallel.h"
#include "host/arguments/memory_size.h"
#include "host/bench/contender.h"
#include "host/bench/pictures/picture_text.h"
#include "host/bench/programs/programs.h"
#include "host/bench/programs/run_program.h"
#include "host/bench/programs/scratch_folder.h"
#include "host/output/output.h"
#include "host/scene/scene_source.h"
#include "host/scene/scene_summary.h"
#include "host/terminal/terminal_line.h"

#include <fmt/format.h>

namespace ovc {

namespace {

namespace fs = std::filesystem;

/// A setting of overcast.
struct Setting {
    const char* name;
    std::vector<std::string> words;
};

std::vector<Setting> settings() {
    std::vector<Setting> all = {{"certified", {}},
                                {"fast", {"--precision", "fast"}},
                                {"cpu-kdtree", {"--backend", "cpu-kdtree"}}};
    if (has_embree())
        all.push_back({"embree", {"--backend", "embree"}});
    return all;
}

std::vector<std::string> sampled(std::vector<std::string> words, uint32_t samples) {
    words.insert(words.end(), {"--samples", std::to_string(samples)});
    return words;
}

PictureChoice tachyon_picture(const std::string& name, const fs::path& scene, uint32_t size,
                              uint32_t samples, const fs::path& stem) {
    const fs::path picture = stem.string() + ".ppm";
    return {name,
            {"tachyon", scene, "-numthreads", fmt::format("{}", thread_count()), "-fullshade",
             "-res", std::to_string(size), std::to_string(size), "-aasamples",
             std::to_string(samples - 1), // Tachyon adds them to the one through the middle
             "-format", "PPM48", "-o", picture},
            picture,
            {}};
}

class Pictures {
public:
    Pictures(const SamplePicturesJob& job, fs::path folder)
        : job_(job), folder_(std::move(folder)) {
        result_.scene = job.scene;
        result_.size = job.size;
        result_.reference_samples = 4 * job.most;
    }

    Result<SamplePictures> run(const Soup& soup, const BenchSurroundings& around) {
        result_.triangles = soup.triangle_count();
        if (const Result<Done> written = write_scenes(soup); !written)
            return written.error();
        for (const Setting& setting : settings())
            for (uint32_t samples = 1; samples <= job_.most; samples *= 4)
                add(setting.name, samples, [&](const std::string& name, const fs::path& stem) {
                    return overcast_picture(name, pov(), job_.size, sampled(setting.words, samples),
                                            stem);
                });
        add_others();
        const PictureChoice reference = overcast_picture(
            "the reference", pov(), job_.size,
            sampled({"--backend", "cpu-kdtree"}, result_.reference_samples), folder_ / "reference");
        around.progress.show(fmt::format("{}: {} pictures", job_.scene, choices_.size()));
        Result<PictureRace> race = race_pictures(reference, choices_, job_.runs, around.stop);
        around.progress.clear();
        if (!race)
            return race.error();
        result_.race = std::move(*race);
        return std::move(result_);
    }

private:
    fs::path pov() const { return folder_ / "mesh.pov"; }
    fs::path dat() const { return folder_ / "mesh.dat"; }

    Result<Done> write_scenes(const Soup& soup) {
        const Result<ProgramShot> shot = shot_of(hittable_bounds(soup), job_.size);
        if (!shot)
            return shot.error();
        if (const Result<Done> saved = save_text(povray_scene(soup, *shot), pov()); !saved)
            return saved;
        return save_text(tachyon_scene(soup, *shot), dat());
    }

    template <class Make>
    void add(const std::string& program, uint32_t samples, const Make& make) {
        const std::string name =
            fmt::format("{}, {} {}", program, samples, samples == 1 ? "sample" : "samples");
        choices_.push_back(make(name, folder_ / fmt::format("{}-{}", program, samples)));
        result_.choices.push_back({program, samples});
    }

    void add_others() {
        for (const char* program : {"povray", "tachyon"})
            if (!is_installed(program))
                result_.not_installed.push_back(program);
        if (is_installed("povray"))
            for (uint32_t depth = 1; depth * depth <= job_.most; depth *= 2)
                add("povray", depth * depth, [&](const std::string& name, const fs::path& stem) {
                    return povray_picture(name, pov(), job_.size, depth, stem);
                });
        if (is_installed("tachyon"))
            for (uint32_t samples = 1; samples <= job_.most; samples *= 4)
                add("tachyon", samples, [&](const std::string& name, const fs::path& stem) {
                    return tachyon_picture(name, dat(), job_.size, samples, stem);
                });
    }

    const SamplePicturesJob& job_;
    const fs::path folder_;
    std::vector<PictureChoice> choices_;
    SamplePictures result_;
};

} // namespace

Result<SamplePictures> run_sample_pictures(const SamplePicturesJob& job,
                                           const BenchSurroundings& around) {
    const Result<ScratchFolder> folder = ScratchFolder::make();
    if (!folder)
        return folder.error();
    around.progress.show("reading " + job.scene);
    const Result<Scene> scene = open_scene(job.scene, around.log);
    if (!scene)
        return scene.error();
    return Pictures(job, folder->path()).run(scene->soup, around);
}

std::string sample_pictures_table(const SamplePictures& r) {
    return fmt::format("{}: {} triangles, from file to picture of {} x {}, one light with shadows; "
                       "the error is to cpu-kdtree with {} samples a pixel\n\n{}{}",
                       r.scene, human_count(r.triangles), r.size, r.size, r.reference_samples,
                       picture_table(r.race), not_installed_text(r.not_installed));
}

std::string sample_pictures_json(const SamplePictures& r) {
    Json choices = Json::array();
    for (size_t i = 0; i < r.choices.size(); ++i) {
        Json choice = {{"choice", r.race.choices[i].name},
                       {"program", r.choices[i].program},
                       {"samples", r.choices[i].samples}};
        choice.update(picture_json(r.race.choices[i]));
        choices.push_back(std::move(choice));
    }
    const Json document = {{"scene", r.scene},
                           {"triangles", r.triangles},
                           {"size", r.size},
                           {"reference_samples", r.reference_samples},
                           {"not_installed", r.not_installed},
                           {"complete", r.race.complete},
                           {"choices", choices}};
    return json_text(document);
}

} // namespace ovc

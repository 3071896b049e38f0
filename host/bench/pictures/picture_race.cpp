// SPDX-License-Identifier: Apache-2.0
// Runs processes one after the other, and reads and compares the pictures that they write.
#include "host/bench/pictures/picture_race.h"

#include "core/system/parallel.h"
#include "host/bench/programs/run_program.h"
#include "host/diff/channels.h"
#include "importers/pov/pictures/picture.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <fstream>
#include <limits>

namespace ovc {

namespace {

Result<Image> read_linear_exr(const std::filesystem::path& path) {
    const Result<Channels> channels = read_channels(path);
    if (!channels)
        return channels.error();
    Image image(channels->width, channels->height);
    constexpr const char* names[] = {"R", "G", "B"};
    for (int c = 0; c < 3; ++c) {
        const Layer* layer = channels->find(names[c]);
        if (!layer)
            return Error{fmt::format("{} has no channel {}", path.string(), names[c])};
        for (size_t i = 0; i < image.pixels.size(); ++i)
            image.pixels[i][c] = std::bit_cast<float>(layer->values[i]);
    }
    return image;
}

Result<Image> read_linear_codes(const std::filesystem::path& path) {
    const Result<Picture> picture = pov::read_picture(path);
    if (!picture)
        return picture.error();
    Image image(picture->width, picture->height);
    for (size_t i = 0; i < image.pixels.size(); ++i)
        for (int c = 0; c < 3; ++c)
            image.pixels[i][c] = float(picture->pixels[i][size_t(c)]) / 65535;
    return image;
}

/// Runs one process; a program that fails is an error.
Result<ProgramEnd> run_once(const PictureChoice& choice, const StopRequest& stop) {
    Result<ProgramEnd> end =
        watch_program(choice.command, std::numeric_limits<double>::infinity(), stop);
    if (end && !end->stopped && end->exit_code != 0)
        return Error{fmt::format("{} failed: {}", choice.name, end->said)};
    return end;
}

void read_stats(const PictureChoice& choice, PictureCost& cost) {
    if (choice.stats.empty())
        return;
    std::ifstream file(choice.stats);
    const auto stats = nlohmann::json::parse(file, nullptr, /* allow_exceptions= */ false);
    if (!stats.is_object())
        return;
    cost.host_peak_bytes = stats.value("host_peak_bytes", uint64_t(0));
    cost.gpu_peak_bytes = stats.value("gpu_peak_bytes", uint64_t(0));
    cost.bytes_in = stats.value("bytes_in", uint64_t(0));
}

Result<double> rmse_of(const PictureChoice& choice, const Image& reference) {
    const Result<Image> image = read_linear_picture(choice.picture);
    if (!image)
        return image.error();
    if (image->width != reference.width || image->height != reference.height)
        return Error{fmt::format("{} drew {} x {} pixels, expected {} x {}", choice.name,
                                 image->width, image->height, reference.width, reference.height)};
    return color_rmse(*image, reference);
}

} // namespace

Result<Image> read_linear_picture(const std::filesystem::path& path) {
    return path.extension() == ".exr" ? read_linear_exr(path) : read_linear_codes(path);
}

double color_rmse(const Image& a, const Image& b) {
    assert(a.width == b.width && a.height == b.height);
    double sum = 0;
    for (size_t i = 0; i < a.pixels.size(); ++i) {
        const dvec3 off = dvec3(a.pixels[i]) - dvec3(b.pixels[i]);
        sum += glm::dot(off, off);
    }
    return std::sqrt(sum / (3 * double(std::max<size_t>(1, a.pixels.size()))));
}

Result<PictureRace> race_pictures(const PictureChoice& reference,
                                  std::span<const PictureChoice> choices, uint32_t runs,
                                  const StopRequest& stop) {
    PictureRace race;
    for (const PictureChoice& choice : choices)
        race.choices.push_back({.name = choice.name});
    const Result<ProgramEnd> drawn = run_once(reference, stop);
    if (!drawn)
        return drawn.error();
    if (drawn->stopped)
        return race;
    const Result<Image> right = read_linear_picture(reference.picture);
    if (!right)
        return right.error();
    for (uint32_t run = 0; run < runs; ++run)
        for (size_t i = 0; i < choices.size(); ++i) {
            const Result<ProgramEnd> end = run_once(choices[i], stop);
            if (!end)
                return end.error();
            if (end->stopped)
                return race;
            PictureCost& cost = race.choices[i];
            cost.seconds.push_back(end->seconds);
            cost.cpu_seconds.push_back(end->cpu_seconds);
            if (run > 0)
                continue; // later runs draw the same picture again
            read_stats(choices[i], cost);
            const Result<double> rmse = rmse_of(choices[i], *right);
            if (!rmse)
                return rmse.error();
            cost.rmse = *rmse;
        }
    race.complete = true;
    return race;
}

PictureChoice overcast_picture(const std::string& name, const std::filesystem::path& scene,
                               uint32_t size, const std::vector<std::string>& words,
                               const std::filesystem::path& stem) {
    PictureChoice choice{name, {}, stem.string() + ".exr", stem.string() + ".json"};
    choice.command = {"/proc/self/exe", "render", scene, "--size", fmt::format("{0}x{0}", size)};
    choice.command.insert(choice.command.end(), words.begin(), words.end());
    choice.command.insert(choice.command.end(),
                          {"--quiet", "--stats", choice.stats, "-o", choice.picture});
    return choice;
}

PictureChoice povray_picture(const std::string& name, const std::filesystem::path& scene,
                             uint32_t size, uint32_t depth, const std::filesystem::path& stem) {
    PictureChoice choice{name, {}, stem.string() + ".ppm", {}};
    choice.command = {"povray",
                      "+I" + scene.string(),
                      "+O" + choice.picture.string(),
                      fmt::format("+W{}", size),
                      fmt::format("+H{}", size),
                      "+FP16",
                      "File_Gamma=1.0",
                      "-D",
                      "-GA",
                      fmt::format("+WT{}", thread_count())};
    if (depth == 1)
        choice.command.push_back("-A");
    else // a pixel that differs at all from a neighbour gets all rays, on a grid
        choice.command.insert(choice.command.end(),
                              {"+A0.0", "+AM1", fmt::format("+R{}", depth), "-J"});
    return choice;
}

} // namespace ovc

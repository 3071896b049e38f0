// SPDX-License-Identifier: Apache-2.0
// An unfinished film is an archive of the pixels that are done and of the light that they got.
#include "host/film/unfinished.h"

#include "core/file/archive.h"
#include "core/file/mapped_file.h"
#include "importers/file/output_file.h"

#include <fmt/format.h>

#include <array>
#include <vector>

namespace ovc {

static constexpr std::string_view kKind = "ovc film";
static constexpr uint32_t kVersion = 1;

static std::string beside(const std::string& output, const std::string& extension) {
    std::filesystem::path path(output);
    path.replace_extension("unfinished" + extension);
    return path.string();
}

std::string unfinished_picture(const std::string& output) {
    return beside(output, std::filesystem::path(output).extension());
}

std::string unfinished_film(const std::string& output) {
    return beside(output, ".film");
}

/// The numbers that must be equal for a film to continue.
using FilmShape = std::array<uint64_t, 4>;

static FilmShape shape_of(const Film& film, uint64_t picture) {
    return {picture, film.width(), film.height(), film.samples()};
}

Result<Done> save_film(const Film& film, uint64_t picture, const std::filesystem::path& path) {
    Result<OutputFile> out = OutputFile::create(path);
    if (!out)
        return out.error();
    std::vector<uint32_t> pixels;
    std::vector<Film::Sums> sums;
    const uint32_t count = film.width() * film.height();
    for (uint32_t pixel = 0; pixel < count; ++pixel)
        if (film.done(pixel)) {
            pixels.push_back(pixel);
            sums.push_back(film.sums(pixel));
        }
    ArchiveWriter writer(out->sink(), kKind, kVersion);
    const FilmShape shape = shape_of(film, picture);
    writer.part<uint64_t>("shape", shape);
    writer.part<uint32_t>("pixels", pixels);
    writer.part<Film::Sums>("sums", sums);
    writer.finish();
    return out->commit();
}

/// Restores the film. The Error's text continues a sentence that begins with the file's name.
static Result<Done> restore(const Archive& archive, uint64_t picture, Film& film) {
    const auto shape = archive.items<uint64_t>("shape", FilmShape().size());
    if (!shape)
        return shape.error();
    const auto pixels = archive.items<uint32_t>("pixels");
    if (!pixels)
        return pixels.error();
    const auto sums = archive.items<Film::Sums>("sums", pixels->size());
    if (!sums)
        return sums.error();
    const FilmShape wanted = shape_of(film, picture);
    if (!std::equal(wanted.begin(), wanted.end(), shape->begin()))
        return Error{"is of another scene, camera, size or other options"};
    const uint32_t count = film.width() * film.height();
    if (std::any_of(pixels->begin(), pixels->end(), [&](uint32_t pixel) { return pixel >= count; }))
        return Error{"is damaged: it has pixels outside of the picture"};
    for (size_t i = 0; i < pixels->size(); ++i)
        film.restore((*pixels)[i], (*sums)[i]);
    return Done{};
}

Result<Done> load_film(const std::filesystem::path& path, uint64_t picture, Film& film) {
    const Result<MappedFile> file = MappedFile::open(path);
    if (!file)
        return file.error();
    const Result<Archive> archive = Archive::open(file->bytes(), kKind, kVersion);
    const Result<Done> restored =
        archive ? restore(*archive, picture, film) : Result<Done>(archive.error());
    if (!restored)
        return Error{
            fmt::format("{}: the unfinished picture {}; without --continue it is begun anew",
                        path.string(), restored.error().message)};
    return Done{};
}

} // namespace ovc

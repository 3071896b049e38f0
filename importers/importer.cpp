// SPDX-License-Identifier: Apache-2.0
// load() and save() choose a reader or writer by the file's extension.
#include "importers/importer.h"

#include "core/text/lower_case.h"
#include "core/text/suggestion.h"
#include "importers/readers.h"
#include "importers/scene_file/read_apart.h"
#include "importers/scene_file/sound_textures.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <new>

namespace ovc {

namespace {

struct Format {
    std::string_view extension;
    Result<Scene> (*read)(const std::filesystem::path&, const ImportOptions&);
    Result<Done> (*write)(const Scene&, const std::filesystem::path&); // null: only read
    bool may_move = false;
    bool streams = false;
};

constexpr Format kFormats[] = {{"obj", read_obj, write_obj, false, true},
                               {"ovc", read_ovc, write_ovc},
                               {"pbrt", read_pbrt, nullptr, true, true},
                               {"ply", read_ply, write_ply, false, true},
                               {"pov", read_pov, nullptr, true}};

const Format* format_of(std::string_view extension) {
    for (const Format& format : kFormats)
        if (format.extension == extension)
            return &format;
    return nullptr;
}

std::string lower_name(const std::filesystem::path& path) {
    return lower_case(path.filename().string());
}

/// Returns the extension without the dot: "ply".
std::string extension_of(const std::string& name) {
    const size_t dot = name.rfind('.');
    return dot == name.npos ? "" : name.substr(dot + 1);
}

std::string without_gz(std::string name) {
    if (name.ends_with(".gz"))
        name.resize(name.size() - 3);
    return name;
}

Error unknown_extension(const std::filesystem::path& path, const std::string& extension,
                        bool to_write) {
    std::vector<std::string_view> known;
    for (const Format& format : kFormats)
        if (!to_write || format.write)
            known.push_back(format.extension);
    const std::string_view meant = extension.empty() ? "" : nearest(extension, known);
    const std::string guess = meant.empty() ? "" : fmt::format("; did you mean .{}?", meant);
    return {
        fmt::format("{}: found {}, expected .{}{}{}", path.string(),
                    extension.empty() ? "no extension" : fmt::format("extension .{}", extension),
                    fmt::join(known, ", ."),
                    to_write ? "" : " or one that Assimp reads, such as .stl, .off, .glb", guess)};
}

} // namespace

static Result<Scene> read(const std::filesystem::path& path, const ImportOptions& options) {
    const std::string extension = extension_of(without_gz(lower_name(path)));
    if (const Format* format = format_of(extension))
        return format->read(path, options);
    std::error_code ec;
    if (!std::filesystem::exists(path, ec))
        return Error{fmt::format("{}: no such file{}", path.string(), did_you_mean_file(path))};
    if (!extension.empty() && assimp_reads(extension))
        return read_apart(read_assimp, "Assimp", path, options);
    return unknown_extension(path, extension, /* to_write= */ false);
}

Result<Scene> load(const std::filesystem::path& path, const ImportOptions& options) try {
    Result<Scene> scene = read(path, options);
    if (scene && !has_sound_textures(*scene))
        return Error{fmt::format("{}: the textures cannot be evaluated: they have no meaning, lie "
                                 "more than {} deep in each other, or take more than {} steps for "
                                 "one color",
                                 path.string(), kMaxTextureDepth, uint64_t(kMaxTextureSteps))};
    return scene;
} catch (const std::bad_alloc&) {
    return Error{fmt::format("{}: found a model larger than the memory", path.string())};
}

bool may_move(const std::filesystem::path& path) {
    const Format* format = format_of(extension_of(without_gz(lower_name(path))));
    return format && format->may_move;
}

bool streams(const std::filesystem::path& path) {
    const Format* format = format_of(extension_of(without_gz(lower_name(path))));
    return format && format->streams;
}

Result<Done> save(const Scene& scene, const std::filesystem::path& path) {
    const std::string extension = extension_of(lower_name(path));
    const Format* format = format_of(extension);
    if (!format || !format->write)
        return unknown_extension(path, extension, /* to_write= */ true);
    return format->write(scene, path);
}

} // namespace ovc

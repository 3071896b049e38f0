// SPDX-License-Identifier: Apache-2.0
// Finds files by name and reads their text.
#include "importers/pov/words/files.h"

#include "core/text/lower_case.h"
#include "importers/file/source.h"

#include <algorithm>
#include <optional>

namespace ovc::pov {

namespace fs = std::filesystem;

/// Debian's povray-includes and POV-Ray's own build install the include files here.
static constexpr const char* kLibraries[] = {
    "/usr/share/povray-3.7/include", "/usr/share/povray/include",
    "/usr/local/share/povray-3.7/include", "/usr/local/share/povray-3.8/include"};

/// Returns the entry of `folder` that is called `name`, regardless of upper and lower case.
static std::optional<fs::path> entry_like(const fs::path& folder, const fs::path& name) {
    std::error_code ec;
    if (name == ".." || fs::exists(folder / name, ec))
        return folder / name;
    const std::string wanted = lower_case(name.string());
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, ec))
        if (lower_case(entry.path().filename().string()) == wanted)
            return entry.path();
    return std::nullopt;
}

static std::optional<fs::path> file_like(const fs::path& folder, const fs::path& name) {
    fs::path at = folder.empty() ? "." : folder;
    for (const fs::path& part : name) {
        const std::optional<fs::path> next = entry_like(at, part);
        if (!next)
            return std::nullopt;
        at = *next;
    }
    std::error_code ec;
    return fs::is_regular_file(at, ec) ? std::optional(at) : std::nullopt;
}

fs::path find_file(std::string name, std::string_view extension,
                   const std::vector<std::string>& folders, FilesRead* files) {
    std::replace(name.begin(), name.end(), '\\', '/');
    if (name.empty() || name.find('\0') != name.npos)
        return {};
    std::vector<fs::path> paths = {name};
    if (!paths[0].has_extension() && !extension.empty())
        paths.push_back(name + std::string(extension));
    std::vector<fs::path> places(folders.begin(), folders.end());
    places.insert(places.end(), std::begin(kLibraries), std::end(kLibraries));
    std::error_code ec;
    for (const fs::path& path : paths)
        for (const fs::path& place : places) { // an absolute `path` replaces `place`
            note(files, place / path);
            if (fs::is_regular_file(place / path, ec))
                return place / path;
        }
    for (const fs::path& path : paths)
        for (const fs::path& place : places)
            if (!path.is_absolute())
                if (const std::optional<fs::path> file = file_like(place, path))
                    return *file;
    return {};
}

Result<std::string> read_text(const fs::path& path, FilesRead* files) {
    Result<Source> source = Source::open(path, files, Source::Empty::Fine);
    if (!source)
        return source.error();
    std::string text;
    while (const std::optional<std::string_view> line = source->line()) {
        text += *line;
        text += '\n';
    }
    if (source->is_damaged())
        return source->error("");
    return text;
}

} // namespace ovc::pov

// SPDX-License-Identifier: Apache-2.0
#include "importers/pov/shapes/installed_font.h"

#include "core/text/lower_case.h"
#include "importers/pov/words/files.h"

#include <map>

namespace ovc::pov {

namespace fs = std::filesystem;

/// The Filesystem Hierarchy Standard names these folders for fonts.
static constexpr const char* kFolders[] = {"/usr/share/fonts", "/usr/local/share/fonts"};

/// Plain fonts, without and with serifs. POV-Ray's own come first, because its scenes expect them.
static constexpr const char* kSans[] = {"cyrvetic.ttf", "DejaVuSans.ttf",
                                        "LiberationSans-Regular.ttf"};
static constexpr const char* kSerif[] = {"timrom.ttf", "DejaVuSerif.ttf",
                                         "LiberationSerif-Regular.ttf"};

/// Returns all installed font files by their names in lower case.
static const std::map<std::string, fs::path>& installed() {
    static const std::map<std::string, fs::path> fonts = [] {
        std::map<std::string, fs::path> found;
        for (const char* folder : kFolders) {
            std::error_code ec;
            const auto skip = fs::directory_options::skip_permission_denied;
            for (fs::recursive_directory_iterator at(folder, skip, ec), end; !ec && at != end;
                 at.increment(ec)) {
                const std::string extension = lower_case(at->path().extension().string());
                if (extension == ".ttf" || extension == ".otf")
                    found.try_emplace(lower_case(at->path().filename().string()), at->path());
            }
        }
        return found;
    }();
    return fonts;
}

static bool has_serifs(const std::string& name) {
    return name.starts_with("tim") || name.find("serif") != name.npos ||
           name.find("roman") != name.npos;
}

fs::path installed_font(const std::string& name) {
    const std::string wanted = lower_case(fs::path(name).filename().string());
    const std::map<std::string, fs::path>& fonts = installed();
    if (const auto same = fonts.find(wanted); same != fonts.end())
        return same->second;
    for (const char* substitute : has_serifs(wanted) ? kSerif : kSans) {
        if (const fs::path povs = find_file(substitute, "", {}); !povs.empty())
            return povs;
        if (const auto at = fonts.find(lower_case(substitute)); at != fonts.end())
            return at->second;
    }
    return fonts.empty() ? fs::path() : fonts.begin()->second;
}

} // namespace ovc::pov

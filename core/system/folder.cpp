// SPDX-License-Identifier: Apache-2.0
// Names in a folder, as the system lists them.
#include "core/system/folder.h"

#include <dirent.h>

#include <memory>
#include <string_view>

namespace ovc {

std::vector<std::string> names_in(const std::filesystem::path& folder) {
    struct Close {
        void operator()(DIR* open) const { closedir(open); }
    };
    const std::unique_ptr<DIR, Close> open(opendir(folder.c_str()));
    std::vector<std::string> names;
    while (const dirent* const entry = open ? readdir(open.get()) : nullptr) {
        const std::string_view name = entry->d_name;
        if (name != "." && name != "..")
            names.emplace_back(name);
    }
    return names;
}

} // namespace ovc

// SPDX-License-Identifier: Apache-2.0
#include "importers/file/picture_path.h"

#include <algorithm>
#include <system_error>

namespace ovc {

namespace fs = std::filesystem;

std::string picture_path(const fs::path& folder, std::string_view name) {
    std::string plain(name);
    std::replace(plain.begin(), plain.end(), '\\', '/');
    std::error_code error;
    const fs::path as_named = fs::absolute(folder / plain, error).lexically_normal();
    const fs::path beside =
        fs::absolute(folder / fs::path(plain).filename(), error).lexically_normal();
    return (!fs::exists(as_named, error) && fs::exists(beside, error) ? beside : as_named).string();
}

uint32_t add_picture(Scene& scene, const std::string& path, const std::string& asked_for_at) {
    const auto at = std::find_if(scene.pictures.begin(), scene.pictures.end(),
                                 [&](const PictureFile& p) { return p.file == path; });
    if (at != scene.pictures.end())
        return uint32_t(at - scene.pictures.begin());
    scene.pictures.push_back({path, asked_for_at, {}});
    return uint32_t(scene.pictures.size() - 1);
}

uint32_t add_texture(Scene& scene, Texture texture) {
    scene.textures.push_back(std::move(texture));
    return uint32_t(scene.textures.size() - 1);
}

Texture plain_texture(const vec3& color) {
    return {{}, {{0, {color}, kNoTexture}}};
}

} // namespace ovc

// SPDX-License-Identifier: Apache-2.0
#include "importers/mesh/obj/obj_materials.h"

#include "importers/file/source.h"
#include "importers/file/text.h"
#include "importers/mesh/clear_optics.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace ovc {

static bool emits(const LibraryMaterial& read) {
    return read.emission != vec3(0) || std::ranges::any_of(read.shown, [](const MtlTexture& t) {
               return t.keyword == "map_ke";
           });
}

/// Optics have no mirror beside glass.
static bool can_shine(const Material& material) {
    return material.transmission == 0 || material.mirror == 0;
}

/// Lets a surface send out light. emission: Ke, which multiplies map_Ke, unless it
/// is black: programs write 0 0 0 where a picture is meant to stand alone.
static void let_shine(const vec3& emission, Material& material) {
    Optics& optics = material.optics.emplace(clear_optics(material));
    if (material.mirror > 0) {
        optics.boundary = Optics::Boundary::Mirror;
        optics.reflection = vec3(material.mirror);
    }
    optics.emission = emission == vec3(0) ? vec3(1) : emission;
    optics.two_sided = true; // faces have no back
}

Result<Done> ObjMaterials::read_libraries(std::string_view names, bool has_uv, const Warn& warn) {
    const std::string_view rest = trimmed(without_comment(names));
    for (const std::string_view name : {names, rest})
        if (name.find('\\') == name.npos && read_library(name, has_uv))
            return libraries_done_;
    std::string name;
    bool any = false;
    for (size_t i = 0; i <= rest.size(); ++i) {
        if (i < rest.size() && rest[i] == '\\' && i + 1 < rest.size() && rest[i + 1] == ' ') {
            name += rest[++i];
        } else if (i < rest.size() && !is_blank(rest[i])) {
            name += rest[i] == '\\' ? '/' : rest[i];
        } else if (!name.empty()) {
            any = read_library(name, has_uv) || any;
            name.clear();
        }
    }
    if (!any)
        warn("mtllib",
             fmt::format("no material library {}: its materials become grey", quoted(rest)));
    return libraries_done_;
}

bool ObjMaterials::read_library(std::string_view name, bool has_uv) {
    const std::filesystem::path path = path_.parent_path() / std::string(name);
    if (libraries_.contains(path.string()))
        return true;
    Result<Source> source = Source::open(path, files_read_);
    if (!source)
        return false;
    auto materials = read_mtl(*source, path, log_);
    if (!materials) {
        libraries_done_ = materials.error();
        return true;
    }
    any_textures_ = any_textures_ || std::ranges::any_of(*materials, [](const LibraryMaterial& m) {
                        return !m.shown.empty();
                    });
    // Those that were passed over once are not read again, and their indices would not fit.
    keeps_uv_ = any_textures_ && (keeps_uv_ || !has_uv);
    libraries_.insert(path.string());
    for (LibraryMaterial& read : *materials) {
        const std::string& called = read.material.name;
        const auto [at, is_new] = numbers_.try_emplace(called, uint32_t(materials_.size()));
        if (is_new)
            materials_.emplace_back();
        else if (materials_[at->second].missing_at == 0)
            continue; // the first definition counts
        materials_[at->second] = std::move(read);
    }
    return true;
}

uint32_t ObjMaterials::find(std::string_view name, uint64_t line) {
    if (!numbers_.contains(std::string(name)))
        name = trimmed(without_comment(name));
    const auto [at, is_new] = numbers_.try_emplace(std::string(name), uint32_t(materials_.size()));
    if (is_new) {
        materials_.push_back({Material{std::string(name)}});
        materials_.back().missing_at = line;
    }
    return at->second;
}

void ObjMaterials::say_left_out(const std::vector<bool>& used, const Source& source) const {
    std::vector<std::string> textures, emitters;
    for (size_t m = 0; m < materials_.size(); ++m) {
        if (!used[m])
            continue;
        for (const std::string& texture : materials_[m].textures)
            if (std::find(textures.begin(), textures.end(), texture) == textures.end())
                textures.push_back(texture);
        if (emits(materials_[m]) && !can_shine(materials_[m].material))
            emitters.push_back(ovc::quoted(materials_[m].material.name));
    }
    const auto warn_of = [&](const std::string& sentence) {
        say(log_, LogLevel::Warning, source.error(sentence).message);
    };
    const auto missing = std::ranges::find_if(
        materials_, [](const LibraryMaterial& m) { return m.missing_at != 0; });
    if (missing != materials_.end())
        say(log_, LogLevel::Warning,
            source
                .error_at_line(missing->missing_at,
                               fmt::format("no material {}: it becomes grey, and so do others that "
                                           "are missing",
                                           ovc::quoted(missing->material.name)))
                .message);
    if (!textures.empty())
        warn_of(fmt::format("{} of its materials left out: {}", counted(textures.size(), "texture"),
                            listed(textures)));
    if (!emitters.empty())
        warn_of(fmt::format("light from {} (Ke) left out: {}", counted(emitters.size(), "material"),
                            listed(emitters)));
}

std::vector<uint32_t> ObjMaterials::add_to(Scene& scene, const std::vector<bool>& used) const {
    std::vector<uint32_t> cutouts(materials_.size(), kNone);
    for (size_t m = 0; m < materials_.size(); ++m) {
        const LibraryMaterial& read = materials_[m];
        Material& material = scene.materials.emplace_back(read.material);
        MtlMaterial to{material, {}};
        for (const MtlTexture& texture : read.shown)
            if (used[m])
                add_mtl_texture(texture, read.library, scene, to);
        if (used[m] && emits(read) && can_shine(material))
            let_shine(read.emission, material);
        if (to.cutout) {
            cutouts[m] = uint32_t(scene.cutouts.size());
            scene.cutouts.push_back(*to.cutout);
        }
    }
    return cutouts;
}

} // namespace ovc

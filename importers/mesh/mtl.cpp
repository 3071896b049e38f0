// SPDX-License-Identifier: Apache-2.0
// The reader of MTL understands newmtl, Kd, Ks, Tf, d, Tr, Ni, illum and the textures of
// mtl_textures.h.
// Based on: Wavefront, "MTL material format", version 4.2 (1995).
#include "importers/mesh/mtl.h"

#include "importers/file/source.h"
#include "importers/file/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <optional>

namespace ovc {

namespace {

/// "Kd 0.5" is a grey, as the format says. Returns nothing for "Kd spectral …" and "Kd xyz …".
std::optional<vec3> parse_color(std::string_view text) {
    vec3 color(0);
    int count = 0;
    for (; count < 3; ++count) {
        const std::string_view word = next_word(text);
        if (word.empty() && count == 1)
            return vec3(color.x);
        const auto value = parse_float(word);
        if (!value || !std::isfinite(*value))
            return std::nullopt;
        color[count] = *value;
    }
    return glm::clamp(color, vec3(0), vec3(1));
}

/// Models from 3 up reflect; 9 only lets light through, and 10 only casts shadows.
bool reflects(int illumination) {
    return illumination >= 3 && illumination < 9;
}

bool refracts(int illumination) {
    return illumination == 6 || illumination == 7;
}

/// Light passes through in models 4, 6, 7 and 9; 6 and 7 bend it as well.
bool transmits(int illumination) {
    return illumination == 4 || refracts(illumination) || illumination == 9;
}

struct Entry {
    LibraryMaterial read;
    vec3 specular{0};
    std::optional<vec3> filter;
    std::optional<float> dissolve, transparency; // d, where 1 is opaque; Tr, where 1 is clear
    double ior = 1;
    int illumination = 0;

    /// Returns the share of the unmirrored light that passes through. Programs write Tr both ways
    /// round, so d has the last word. The format scales by Tf alone; today's programs leave that
    /// out and write d.
    float through() const {
        const bool stated = dissolve || transparency;
        const float opaque = dissolve ? *dissolve : 1 - transparency.value_or(0);
        if (opaque < 1)
            return std::min(1 - opaque, 1.0f);
        return filter || !stated ? 1.0f : 0.0f;
    }

    void finish() {
        const float mean = (specular.x + specular.y + specular.z) / 3;
        Material& material = read.material;
        material.mirror = reflects(illumination) ? mean : 0;
        if (!transmits(illumination))
            return;
        material.transmission = (1 - material.mirror) * through();
        assert(material.transmission >= 0 && material.transmission <= 1);
        material.filter = filter.value_or(vec3(1));
        if (refracts(illumination) && is_usable_ior(ior))
            material.ior = ior;
    }
};

std::optional<float> parse_share(std::string_view text) {
    const auto value = parse_float(next_word(text));
    return value && std::isfinite(*value) ? std::optional(*value) : std::nullopt;
}

/// map_aat begins like a texture but only switches antialiasing.
bool is_texture(std::string_view keyword) {
    return (keyword.starts_with("map_") && keyword != "map_aat") || keyword == "bump" ||
           keyword == "disp" || keyword == "decal" || keyword == "refl" || keyword == "norm";
}

void note_texture(std::string_view keyword, std::string_view rest, uint64_t line,
                  LibraryMaterial& of) {
    if (keyword == "Ke")
        of.emits = parse_color(rest).value_or(vec3(0)) != vec3(0);
    if (!is_texture(keyword))
        return;
    const MtlTexture texture = parse_mtl_texture(keyword, rest, line);
    if (is_shown(texture)) {
        of.shown.push_back(texture);
        return;
    }
    std::string item = fmt::format("{} {}", keyword, ovc::quoted(texture.file));
    if (std::find(of.textures.begin(), of.textures.end(), item) == of.textures.end())
        of.textures.push_back(std::move(item));
}

void read_line(std::string_view keyword, std::string_view rest, Entry& entry) {
    if (keyword == "Kd")
        entry.read.material.color = parse_color(rest).value_or(entry.read.material.color);
    else if (keyword == "Ks")
        entry.specular = parse_color(rest).value_or(entry.specular);
    else if (keyword == "Tf")
        entry.filter = parse_color(rest);
    else if (keyword == "d")
        entry.dissolve = parse_share(rest);
    else if (keyword == "Tr")
        entry.transparency = parse_share(rest);
    else if (keyword == "Ni")
        entry.ior = parse_double(next_word(rest)).value_or(1);
    else if (keyword == "illum")
        entry.illumination = parse_number<int>(next_word(rest)).value_or(0);
}

} // namespace

Result<std::vector<LibraryMaterial>> read_mtl(const std::filesystem::path& path, FilesRead* files) {
    Result<Source> source = Source::open(path, files);
    if (!source)
        return source.error();
    std::vector<Entry> entries;
    while (const auto line = source->line()) {
        std::string_view rest = without_comment(*line);
        const std::string_view keyword = next_word(rest);
        if (keyword == "newmtl") {
            entries.push_back({{Material{std::string(trimmed(rest))}}});
        } else if (!entries.empty()) {
            read_line(keyword, rest, entries.back());
            note_texture(keyword, rest, source->line_number(), entries.back().read);
        }
    }
    if (source->is_damaged())
        return source->error("");
    std::vector<LibraryMaterial> materials;
    for (Entry& entry : entries) {
        entry.finish();
        entry.read.library = path;
        materials.push_back(std::move(entry.read));
    }
    return materials;
}

} // namespace ovc

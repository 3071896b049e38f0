// SPDX-License-Identifier: Apache-2.0
// MTL: newmtl, Kd, Ks, illum.
#include "importers/mtl.h"

#include "importers/source.h"
#include "importers/text.h"

namespace ovc {

namespace {

/// "Kd 0.5" is a grey, as the format says; "Kd spectral …" and "Kd xyz …" leave the color as it
/// was.
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

/// 3 and up reflect; 10 only casts shadows.
bool reflects(int illumination) {
    return illumination >= 3 && illumination < 10;
}

struct Entry {
    Material material;
    vec3 specular{0};
    int illumination = 0;
};

void read_line(std::string_view keyword, std::string_view rest, Entry& entry) {
    if (keyword == "Kd")
        entry.material.color = parse_color(rest).value_or(entry.material.color);
    else if (keyword == "Ks")
        entry.specular = parse_color(rest).value_or(entry.specular);
    else if (keyword == "illum")
        entry.illumination = parse_number<int>(next_word(rest)).value_or(0);
}

} // namespace

Result<std::vector<Material>> read_mtl(const std::filesystem::path& path) {
    Result<Source> source = Source::open(path);
    if (!source)
        return source.error();
    std::vector<Entry> entries;
    while (const auto line = source->line()) {
        std::string_view rest = *line;
        const std::string_view keyword = next_word(rest);
        if (keyword == "newmtl")
            entries.push_back({Material{std::string(trimmed(rest))}});
        else if (!entries.empty())
            read_line(keyword, rest, entries.back());
    }
    if (source->is_damaged())
        return source->error("");
    std::vector<Material> materials;
    for (Entry& entry : entries) {
        const float mean = (entry.specular.x + entry.specular.y + entry.specular.z) / 3;
        entry.material.mirror = reflects(entry.illumination) ? mean : 0;
        materials.push_back(std::move(entry.material));
    }
    return materials;
}

} // namespace ovc

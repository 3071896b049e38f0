// SPDX-License-Identifier: Apache-2.0
// The reader of MTL understands newmtl, Kd, Ks, Ke, Tf, d, Tr, Ni, illum and the textures of
// mtl_textures.h.
// Based on: Wavefront, "MTL material format", version 4.2 (1995).
#include "importers/mesh/obj/mtl.h"

#include "importers/file/source.h"
#include "importers/file/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>
#include <set>

namespace ovc {

namespace {

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

    /// Returns the share of the unmirrored light that passes through glass. Programs write Tr both
    /// ways round, so d has the last word. The format scales by Tf alone; today's programs leave
    /// that out and write d.
    float through_glass() const {
        const bool stated = dissolve || transparency;
        const float opaque = dissolve ? *dissolve : 1 - transparency.value_or(0);
        if (opaque < 1)
            return std::min(1 - opaque, 1.0f);
        return filter || !stated ? 1.0f : 0.0f;
    }

    /// Returns the share that d lets through in all models. Programs that write Tr alone mean an
    /// opaque surface by 1.
    float dissolved() const {
        if (dissolve)
            return std::clamp(1 - *dissolve, 0.0f, 1.0f);
        return transparency && *transparency < 1 ? std::max(*transparency, 0.0f) : 0.0f;
    }

    void finish() {
        const float mean = (specular.x + specular.y + specular.z) / 3;
        Material& material = read.material;
        material.mirror = reflects(illumination) ? mean : 0;
        const bool is_glass = transmits(illumination);
        material.transmission = (1 - material.mirror) * (is_glass ? through_glass() : dissolved());
        assert(material.transmission >= 0 && material.transmission <= 1);
        if (!is_glass)
            return;
        material.filter = filter.value_or(vec3(1));
        if (refracts(illumination) && is_usable_ior(ior))
            material.ior = ior;
    }
};

/// map_aat begins like a texture but only switches antialiasing.
bool is_texture(std::string_view keyword) {
    return (keyword.starts_with("map_") && keyword != "map_aat") || keyword == "bump" ||
           keyword == "disp" || keyword == "decal" || keyword == "refl" || keyword == "norm";
}

/// Statements of the format that mean nothing here.
bool is_ignored(std::string_view keyword) {
    constexpr std::string_view kIgnored[] = {"Ka", "Ns", "map_aat", "sharpness"};
    return std::ranges::find(kIgnored, keyword) != std::end(kIgnored);
}

class MtlReader {
public:
    MtlReader(Source& source, const LogSink& log) : source_(source), log_(log) {}

    Result<std::vector<Entry>> read() {
        while (const auto line = source_.line()) {
            std::string_view rest = without_comment(*line);
            const std::string_view keyword = next_word(rest);
            if (keyword == "newmtl")
                entries_.push_back({{Material{std::string(trimmed(rest))}}});
            else if (!entries_.empty() && !keyword.empty())
                read_line(keyword, rest, entries_.back());
            if (error_)
                return *error_;
        }
        if (source_.is_damaged())
            return source_.error("");
        return std::move(entries_);
    }

private:
    void read_line(std::string_view keyword, std::string_view rest, Entry& entry) {
        Material& material = entry.read.material;
        if (keyword == "Kd")
            material.color = color(keyword, rest).value_or(material.color);
        else if (keyword == "Ks")
            entry.specular = color(keyword, rest).value_or(entry.specular);
        else if (keyword == "Tf")
            entry.filter = color(keyword, rest);
        else if (keyword == "Ke")
            entry.read.emission = numbers(keyword, rest).value_or(vec3(0));
        else if (keyword == "d")
            entry.dissolve = dissolve(rest);
        else if (keyword == "Tr")
            entry.transparency = float(number(keyword, rest));
        else if (keyword == "Ni")
            entry.ior = number(keyword, rest);
        else if (keyword == "illum")
            entry.illumination = int(std::clamp(number(keyword, rest), 0.0, 100.0));
        else if (is_texture(keyword))
            read_texture(keyword, rest, entry.read);
        else if (!is_ignored(keyword))
            leave_out(std::string(keyword), fmt::format("statements {}", ovc::quoted(keyword)));
    }

    /// "Kd 0.5" is a grey, as the format says. Returns nothing for "Kd spectral …" and "Kd xyz …".
    std::optional<vec3> numbers(std::string_view keyword, std::string_view rest) {
        std::string_view behind = rest;
        if (const std::string_view word = next_word(behind); word == "spectral" || word == "xyz") {
            leave_out(std::string(word), fmt::format("colors {}", ovc::quoted(word)));
            return std::nullopt;
        }
        vec3 color(float(number(keyword, rest)));
        if (!trimmed(rest).empty())
            for (const int i : {1, 2})
                color[i] = float(number(keyword, rest));
        return glm::max(color, vec3(0));
    }

    std::optional<vec3> color(std::string_view keyword, std::string_view rest) {
        const std::optional<vec3> any = numbers(keyword, rest);
        return any ? std::optional(glm::min(*any, vec3(1))) : std::nullopt;
    }

    void read_texture(std::string_view keyword, std::string_view rest, LibraryMaterial& of) {
        const MtlTexture texture = parse_mtl_texture(keyword, rest, source_.line_number());
        if (texture.is_turbulent)
            leave_out("-t", "the option '-t'");
        if (is_shown(texture)) {
            of.shown.push_back(texture);
            return;
        }
        std::string item = fmt::format("{} {}", keyword, ovc::quoted(texture.file));
        if (std::find(of.textures.begin(), of.textures.end(), item) == of.textures.end())
            of.textures.push_back(std::move(item));
    }

    /// "d -halo 0.5" asks for what d does, less in the middle.
    float dissolve(std::string_view rest) {
        std::string_view behind = rest;
        if (next_word(behind) != "-halo")
            return float(number("d", rest));
        leave_out("-halo", "the option '-halo'");
        return float(number("d", behind));
    }

    /// Takes a number off the text.
    double number(std::string_view keyword, std::string_view& text) {
        const std::string_view word = next_word(text);
        const auto value = parse_double(word);
        if (value && std::isfinite(*value))
            return *value;
        if (!error_)
            error_ = source_.error_at_line(
                fmt::format("found {}, expected a number of {}", found(word), keyword));
        return 0;
    }

    /// Says it at the first call with this kind only.
    void leave_out(const std::string& kind, std::string_view what) {
        if (warned_.insert(kind).second)
            say(log_, LogLevel::Warning,
                source_.error_at_line(fmt::format("{} left out", what)).message);
    }

    Source& source_;
    const LogSink& log_;
    std::vector<Entry> entries_;
    std::set<std::string> warned_;
    std::optional<Error> error_;
};

} // namespace

Result<std::vector<LibraryMaterial>> read_mtl(Source& source, const std::filesystem::path& path,
                                              const LogSink& log) {
    Result<std::vector<Entry>> entries = MtlReader(source, log).read();
    if (!entries)
        return entries.error();
    std::vector<LibraryMaterial> materials;
    for (Entry& entry : *entries) {
        entry.finish();
        entry.read.library = path;
        materials.push_back(std::move(entry.read));
    }
    return materials;
}

} // namespace ovc

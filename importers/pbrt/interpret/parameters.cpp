// SPDX-License-Identifier: Apache-2.0
// Parameters::read() reads the declarations of v1 to v4: one value, or a list in brackets.
#include "importers/pbrt/interpret/parameters.h"

#include "importers/file/source.h"
#include "importers/file/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ovc::pbrt {

namespace {

struct TypeName {
    std::string_view name;
    Kind kind;
};

constexpr TypeName kTypes[] = {
    {"integer", Kind::Integer},   {"float", Kind::Float},     {"bool", Kind::Bool},
    {"point", Kind::Point3},      {"point2", Kind::Point2},   {"point3", Kind::Point3},
    {"vector", Kind::Vector3},    {"vector2", Kind::Vector2}, {"vector3", Kind::Vector3},
    {"normal", Kind::Normal},     {"normal3", Kind::Normal},  {"color", Kind::Rgb},
    {"rgb", Kind::Rgb},           {"xyz", Kind::Xyz},         {"blackbody", Kind::Blackbody},
    {"spectrum", Kind::Spectrum}, {"string", Kind::String},   {"texture", Kind::Texture}};

/// The max number of values that a spectrum's file may have.
constexpr size_t kMaxSpectrumValues = 100'000;

/// Returns the pairs of wavelength and value that a file holds, with comments behind '#'; nothing
/// if it holds anything else.
std::vector<double> samples_in(const std::filesystem::path& path, FilesRead* files) {
    Result<Source> file = Source::open(path, files);
    std::vector<double> samples;
    while (const auto line = file ? file->line() : std::nullopt) {
        std::string_view rest = line->substr(0, line->find('#'));
        for (std::string_view word = next_word(rest); !word.empty(); word = next_word(rest)) {
            const auto number = parse_double(word);
            if (!number || !std::isfinite(*number) || samples.size() >= kMaxSpectrumValues)
                return {};
            samples.push_back(*number);
        }
    }
    if (samples.size() % 2 != 0 || (file && file->is_damaged()))
        return {};
    return samples;
}

const TypeName* type_of(std::string_view name) {
    for (const TypeName& type : kTypes)
        if (type.name == name)
            return &type;
    return nullptr;
}

} // namespace

bool Parameters::read(Tokens& tokens, Diagnostics& diagnostics) {
    for (;;) {
        // An Include may stand between two parameters, or before the first.
        if (!tokens.next())
            return false;
        if (tokens.token().kind == TokenKind::Word && tokens.token().text == "Include") {
            if (!tokens.include_next(/* marks_its_end= */ false))
                return false;
            continue;
        }
        if (tokens.token().kind != TokenKind::Text) {
            tokens.again();
            return true;
        }
        Parameter parameter{Kind::Float, {}, {}, {}, tokens.token().place};
        std::string_view rest = tokens.token().text;
        const std::string type(next_word(rest));
        parameter.name = trimmed(rest);
        if (parameter.name.empty())
            return diagnostics.fail(parameter.place,
                                    fmt::format("found {}, expected a parameter such as \"float "
                                                "radius\"",
                                                described(tokens.token())));
        const TypeName* known = type_of(type);
        if (known)
            parameter.kind = known->kind;
        else
            diagnostics.missing("type " + type, parameter.place,
                                fmt::format("parameters of type {} left out", ovc::quoted(type)));
        if (!read_values(tokens, diagnostics, parameter))
            return false;
        if (known && (known->kind == Kind::Rgb || known->kind == Kind::Xyz) &&
            (parameter.numbers.size() % 3 != 0 || parameter.numbers.empty()) &&
            parameter.numbers.size() != 1)
            return diagnostics.fail(parameter.place,
                                    fmt::format("found {} of {}, expected 3",
                                                counted(parameter.numbers.size(), "value"),
                                                ovc::quoted(parameter.name)));
        if (known)
            list_.push_back(std::move(parameter));
        if (diagnostics.failed())
            return false;
    }
}

bool Parameters::read_values(Tokens& tokens, Diagnostics& diagnostics, Parameter& parameter) {
    if (!tokens.next())
        return false;
    const bool in_brackets = tokens.token().kind == TokenKind::Open;
    const Place begin = tokens.token().place;
    if (in_brackets && !tokens.next())
        return false;
    for (;;) {
        const Token& token = tokens.token();
        const bool is_word = token.kind == TokenKind::Word;
        const bool is_truth = is_word && (token.text == "true" || token.text == "false");
        if (token.kind == TokenKind::Number) {
            if (parameter.kind == Kind::Integer && token.number != std::floor(token.number))
                return diagnostics.fail(token.place,
                                        fmt::format("found {} among the values of {}, expected "
                                                    "integers",
                                                    token.number, ovc::quoted(parameter.name)));
            parameter.numbers.push_back(token.number);
        } else if (token.kind == TokenKind::Text || is_truth) {
            if (parameter.kind == Kind::Bool && token.text != "true" && token.text != "false")
                return diagnostics.fail(token.place,
                                        fmt::format("found {} as {}, expected true or false",
                                                    described(token), ovc::quoted(parameter.name)));
            if (parameter.kind == Kind::Bool)
                parameter.numbers.push_back(token.text == "true");
            else
                parameter.strings.push_back(token.text);
        } else if (is_word && in_brackets && token.text == "Include") {
            if (!tokens.include_next(/* marks_its_end= */ false))
                return false;
        } else if (token.kind == TokenKind::Close && in_brackets) {
            break;
        } else if (in_brackets && token.kind == TokenKind::End) {
            return diagnostics.fail(begin, fmt::format("found the list of {} without its ']'",
                                                       ovc::quoted(parameter.name)));
        } else {
            return diagnostics.fail(token.place,
                                    fmt::format("found {}, expected a value of {}",
                                                described(token), ovc::quoted(parameter.name)));
        }
        if (!in_brackets)
            break;
        if (!tokens.next())
            return false;
    }
    if (parameter.kind == Kind::Spectrum && !parameter.strings.empty())
        if (const auto path = tokens.find(parameter.strings[0]))
            parameter.numbers = samples_in(*path, tokens.files_read());
    const bool is_text = parameter.kind == Kind::String || parameter.kind == Kind::Texture;
    if (is_text ? !parameter.numbers.empty()
                : parameter.kind != Kind::Spectrum && !parameter.strings.empty())
        diagnostics.missing("values of " + parameter.name, parameter.place,
                            fmt::format("found {} among the values of {}, which are {}",
                                        is_text ? "numbers" : "strings",
                                        ovc::quoted(parameter.name),
                                        is_text ? "strings" : "numbers"));
    return !diagnostics.failed();
}

void Parameters::take_colors_through(const dmat3& colors) {
    if (colors == dmat3(1))
        return;
    for (Parameter& p : list_)
        for (size_t i = 0; p.kind == Kind::Rgb && i + 3 <= p.numbers.size(); i += 3) {
            const dvec3 color = colors * dvec3(p.numbers[i], p.numbers[i + 1], p.numbers[i + 2]);
            for (int c = 0; c < 3; ++c)
                p.numbers[i + size_t(c)] = std::max(color[c], 0.0);
        }
}

const Parameter* Parameters::find(std::string_view name) const {
    for (auto p = list_.rbegin(); p != list_.rend(); ++p)
        if (p->name == name) {
            p->asked = true;
            return &*p;
        }
    return nullptr;
}

const Parameter* Parameters::find(std::string_view name, std::initializer_list<Kind> kinds) const {
    for (auto p = list_.rbegin(); p != list_.rend(); ++p)
        if (p->name == name && std::find(kinds.begin(), kinds.end(), p->kind) != kinds.end()) {
            p->asked = true;
            return &*p;
        }
    return nullptr;
}

const Parameter* Parameters::find_one(std::string_view name,
                                      std::initializer_list<Kind> kinds) const {
    const Parameter* const p = find(name, kinds);
    if (p)
        p->wants = 1;
    return p;
}

double Parameters::number(std::string_view name, double otherwise) const {
    const Parameter* p = find_one(name, {Kind::Float, Kind::Integer});
    return p && !p->numbers.empty() ? p->numbers[0] : otherwise;
}

bool Parameters::flag(std::string_view name, bool otherwise) const {
    const Parameter* p = find_one(name, {Kind::Bool});
    return p && !p->numbers.empty() ? p->numbers[0] != 0 : otherwise;
}

std::string Parameters::text(std::string_view name, std::string_view otherwise) const {
    const Parameter* p = find_one(name, {Kind::String});
    return std::string(p && !p->strings.empty() ? std::string_view(p->strings[0]) : otherwise);
}

std::span<const double> Parameters::numbers(std::string_view name,
                                            std::initializer_list<Kind> kinds) const {
    const Parameter* p = find(name, kinds);
    return p ? std::span<const double>(p->numbers) : std::span<const double>();
}

std::vector<double> Parameters::take(std::string_view name, std::initializer_list<Kind> kinds) {
    const Parameter* p = find(name, kinds);
    if (!p)
        return {};
    std::vector<double> taken = std::move(list_[size_t(p - list_.data())].numbers);
    return taken;
}

dvec3 Parameters::point(std::string_view name, const dvec3& otherwise) const {
    const Parameter* const p = find(name, {Kind::Point3, Kind::Vector3, Kind::Normal});
    if (!p)
        return otherwise;
    p->wants = 3;
    return p->numbers.size() >= 3 ? dvec3(p->numbers[0], p->numbers[1], p->numbers[2]) : otherwise;
}

} // namespace ovc::pbrt

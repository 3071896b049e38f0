// SPDX-License-Identifier: Apache-2.0
// Tables of the language's functions and constants, each in one row.
#include "importers/pov/values/builtin.h"

#include "core/texture/noise/noise.h"
#include "importers/file/text.h"
#include "importers/pov/values/builtin_object.h"
#include "importers/pov/values/transform.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <charconv>
#include <cmath>
#include <ctime>
#include <numbers>
#include <unordered_map>

namespace ovc::pov {

namespace {

constexpr double kDegree = std::numbers::pi / 180;

Number call_float_function(Reader& reader, const Token& token) {
    assert(find_float_function(token.name->text));
    const FloatFunction& function = *find_float_function(token.name->text);
    reader.expect('(', token.name->text);
    double values[2] = {parse_float(reader), 0};
    int count = 1;
    for (; reader.take(','); ++count) {
        values[1] = parse_float(reader);
        if (function.count < 0)
            values[0] = function.call(values);
    }
    reader.expect(')', token.name->text);
    if (function.count < 0)
        return Number::of(values[0]);
    if (count != function.count)
        reader.fail(token.place, fmt::format("found {} arguments to {}, expected {}", count,
                                             token.name->text, function.count));
    const double result = function.call(values);
    if (!std::isfinite(result))
        reader.fail(token.place,
                    fmt::format("found {} of {}, which is no number", token.name->text, values[0]));
    return Number::of(result);
}

/// Reads the arguments, in parentheses, of a function of vectors.
template <size_t N>
std::array<dvec3, N> vectors(Reader& reader, const Token& token) {
    std::array<dvec3, N> values;
    reader.expect('(', token.name->text);
    for (size_t i = 0; i < N; ++i) {
        if (i > 0)
            reader.expect(',', "an argument of " + token.name->text);
        values[i] = parse_vector(reader);
    }
    reader.expect(')', token.name->text);
    return values;
}

Number vnormalize(Reader& reader, const Token& token) {
    const dvec3 v = vectors<1>(reader, token)[0];
    const double length = glm::length(v);
    return Number::of(length > 0 ? v / length : dvec3(0));
}

Number vaxis_rotate(Reader& reader, const Token& token) {
    reader.expect('(', token.name->text);
    const dvec3 v = parse_vector(reader);
    reader.take_comma();
    const dvec3 axis = parse_vector(reader);
    reader.take_comma();
    const double angle = parse_float(reader);
    reader.expect(')', token.name->text);
    return Number::of(dvec3(rotation_about(axis, angle * kDegree) * dvec4(v, 0)));
}

Number seed(Reader& reader, const Token& token) {
    reader.expect('(', token.name->text);
    const double value = parse_float(reader);
    reader.expect(')', token.name->text);
    if (reader.random_streams.size() >= 10'000'000)
        reader.fail(token.place, "found more than 10,000,000 streams of random numbers");
    reader.changed();
    reader.random_streams.push_back(uint32_t(int64_t(std::clamp(value, -9e15, 9e15))));
    return Number::of(double(reader.random_streams.size() - 1));
}

/// Gives the same numbers as POV-Ray 3.7's generator.
Number rand(Reader& reader, const Token& token) {
    reader.expect('(', token.name->text);
    const double stream = parse_float(reader);
    reader.expect(')', token.name->text);
    if (!(stream >= 0 && stream < double(reader.random_streams.size())))
        reader.fail(token.place, fmt::format("found rand of {}, which no seed() gave", stream));
    reader.changed();
    uint32_t& state = reader.random_streams[size_t(stream)];
    state = state * 1812433253u + 12345u;
    return Number::of(state * (1 / 4294967295.0));
}

Number select_one(Reader& reader, const Token& token) {
    reader.expect('(', token.name->text);
    const double sign = parse_float(reader);
    std::vector<Number> choices;
    while (reader.take(','))
        choices.push_back(parse_number(reader));
    reader.expect(')', token.name->text);
    if (choices.size() != 2 && choices.size() != 3)
        reader.fail(token.place, fmt::format("found {} arguments to select, expected 3 or 4",
                                             choices.size() + 1));
    return sign < 0 ? choices[0] : sign == 0 ? choices[1] : choices.back();
}

/// Reads defined(NAME), whose name need not be declared.
Number defined(Reader& reader, const Token& token) {
    reader.expect('(', token.name->text);
    const Token name = reader.next();
    reader.expect(')', token.name->text);
    const Slot* slot = name.kind == TokenKind::Name ? reader.find(name.name) : nullptr;
    return Number::of(slot && !std::holds_alternative<std::monostate>(slot->value));
}

/// Reads `(` and the name of an array, which its variable owns.
const Array& parse_array(Reader& reader, const Token& token) {
    reader.expect('(', token.name->text);
    const Token name = reader.next();
    const auto* array = named<Array>(reader, name);
    if (!array)
        reader.fail(name.place,
                    fmt::format("found {}, expected the name of an array", found(name)));
    return *array;
}

/// Returns what the picture's moment says, and notes that the scene has asked.
Number of_moment(Reader& reader, double number) {
    reader.moves = true;
    return Number::of(number);
}

Number dimensions(Reader& reader, const Token& token) {
    const double count = double(parse_array(reader, token).sizes.size());
    reader.expect(')', token.name->text);
    return Number::of(count);
}

Number dimension_size(Reader& reader, const Token& token) {
    const std::vector<size_t> sizes = parse_array(reader, token).sizes;
    reader.take_comma();
    const int which = parse_int(reader, 1, int(sizes.size()), "the dimension of an array");
    reader.expect(')', token.name->text);
    return Number::of(double(sizes[size_t(which - 1)]));
}

template <class Of>
Number of_text(Reader& reader, const Token& token, Of of) {
    reader.expect('(', token.name->text);
    const std::string text = parse_text(reader);
    const Number n = of(text);
    reader.expect(')', token.name->text);
    return n;
}

Number strcmp(Reader& reader, const Token& token) {
    reader.expect('(', token.name->text);
    const std::string a = parse_text(reader);
    reader.take_comma();
    const std::string b = parse_text(reader);
    reader.expect(')', token.name->text);
    return Number::of(a < b ? -1 : a > b ? 1 : 0);
}

/// Reads `(lambda, omega, octaves, point)`.
Number vturbulence(Reader& reader, const Token& token) {
    reader.expect('(', token.name->text);
    Octaves octaves;
    octaves.lambda = parse_float(reader);
    reader.take_comma();
    octaves.omega = parse_float(reader);
    reader.take_comma();
    octaves.count = uint64_t(parse_int(reader, 1, int(kMaxOctaves), "octaves"));
    reader.take_comma();
    const dvec3 at = parse_vector(reader);
    reader.expect(')', token.name->text);
    return Number::of(turbulence(at, octaves));
}

template <int X, int Y, int Z>
Number axis(Reader&, const Token&) {
    return Number::of(dvec3(X, Y, Z));
}

/// Returns the number that the text begins with, as povray does; 0 where it begins with none.
double number_at_start(std::string_view text) {
    text = trimmed(text);
    if (text.starts_with('+'))
        text.remove_prefix(1);
    double value = 0;
    std::from_chars(text.data(), text.data() + text.size(), value);
    return value;
}

const std::unordered_map<std::string_view, Builtin> kBuiltins = {
    {"x", axis<1, 0, 0>},
    {"y", axis<0, 1, 0>},
    {"z", axis<0, 0, 1>},
    {"u",
     [](Reader&, const Token&) {
         return Number{{1, 0}, 2};
     }},
    {"v",
     [](Reader&, const Token&) {
         return Number{{0, 1}, 2};
     }},
    {"t",
     [](Reader&, const Token&) {
         return Number{{0, 0, 0, 1}, 4};
     }},
    {"pi", [](Reader&, const Token&) { return Number::of(std::numbers::pi); }},
    {"tau", [](Reader&, const Token&) { return Number::of(2 * std::numbers::pi); }},
    {"true", [](Reader&, const Token&) { return Number::of(1); }},
    {"yes", [](Reader&, const Token&) { return Number::of(1); }},
    {"on", [](Reader&, const Token&) { return Number::of(1); }},
    {"false", [](Reader&, const Token&) { return Number::of(0); }},
    {"no", [](Reader&, const Token&) { return Number::of(0); }},
    {"off", [](Reader&, const Token&) { return Number::of(0); }},
    {"version", [](Reader& r, const Token&) { return Number::of(r.version); }},
    {"clock", [](Reader& r, const Token&) { return of_moment(r, r.moment.clock); }},
    {"clock_delta", [](Reader& r, const Token&) { return of_moment(r, r.moment.clock_step()); }},
    {"clock_on", [](Reader& r, const Token&) { return of_moment(r, r.moment.in_sequence); }},
    {"initial_clock", [](Reader&, const Token&) { return Number::of(0); }},
    {"final_clock", [](Reader& r, const Token&) { return of_moment(r, r.moment.in_sequence); }},
    {"frame_number", [](Reader& r, const Token&) { return of_moment(r, r.moment.frame); }},
    {"initial_frame", [](Reader& r, const Token&) { return of_moment(r, r.moment.first); }},
    {"final_frame", [](Reader& r, const Token&) { return of_moment(r, r.moment.last); }},
    {"now", [](Reader&, const Token&) { return Number::of(0); }},
    {"image_width", [](Reader& r, const Token&) { return Number::of(r.picture.width); }},
    {"image_height", [](Reader& r, const Token&) { return Number::of(r.picture.height); }},
    {"vlength",
     [](Reader& r, const Token& t) { return Number::of(glm::length(vectors<1>(r, t)[0])); }},
    {"vdot",
     [](Reader& r, const Token& t) {
         const auto v = vectors<2>(r, t);
         return Number::of(glm::dot(v[0], v[1]));
     }},
    {"vcross",
     [](Reader& r, const Token& t) {
         const auto v = vectors<2>(r, t);
         return Number::of(glm::cross(v[0], v[1]));
     }},
    {"vrotate",
     [](Reader& r, const Token& t) {
         const auto v = vectors<2>(r, t);
         return Number::of(dvec3(rotation(v[1]) * dvec4(v[0], 0)));
     }},
    {"vnormalize", vnormalize},
    {"vaxis_rotate", vaxis_rotate},
    {"seed", seed},
    {"rand", rand},
    {"select", select_one},
    {"defined", defined},
    {"dimensions", dimensions},
    {"dimension_size", dimension_size},
    {"strcmp", strcmp},
    {"strlen",
     [](Reader& r, const Token& t) {
         return of_text(r, t, [](const std::string& s) { return Number::of(double(s.size())); });
     }},
    {"asc",
     [](Reader& r, const Token& t) {
         return of_text(r, t, [](const std::string& s) {
             return Number::of(s.empty() ? 0.0 : double(uint8_t(s[0])));
         });
     }},
    {"val",
     [](Reader& r, const Token& t) {
         return of_text(r, t, [](const std::string& s) { return Number::of(number_at_start(s)); });
     }},
    {"file_exists",
     [](Reader& r, const Token& t) {
         return of_text(r, t, [&r](const std::string& s) {
             return Number::of(r.written(s) || !r.find_file(s, "").empty() ? 1.0 : 0.0);
         });
     }},
    {"min_extent", parse_extent},
    {"max_extent", parse_extent},
    {"trace", parse_trace},
    {"inside", parse_inside},
    {"vturbulence", vturbulence}};

/// A loop of concat() could otherwise fill the memory.
constexpr size_t kLongestText = size_t(1) << 20;

std::string number_text(double value, int length, int precision) {
    const bool zeros = length < 0;
    const int width = std::min(std::abs(length), 1000);
    const int digits = precision < 0 ? 6 : std::min(precision, 300);
    return zeros ? fmt::format("{:0{}.{}f}", value, width, digits)
                 : fmt::format("{:{}.{}f}", value, width, digits);
}

int parse_small(Reader& reader) {
    return parse_int(reader, -1000, 1000, "a length");
}

std::string str(Reader& reader) {
    reader.expect('(', "str");
    const double value = parse_float(reader);
    reader.take_comma();
    const int length = parse_small(reader);
    reader.take_comma();
    const int precision = parse_small(reader);
    reader.expect(')', "str");
    return number_text(value, length, precision);
}

std::string vstr(Reader& reader) {
    reader.expect('(', "vstr");
    const int count = parse_int(reader, 2, 5, "the number of components");
    reader.take_comma();
    const Number v = resized(reader, parse_number(reader), count);
    reader.take_comma();
    const std::string separator = parse_text(reader);
    reader.take_comma();
    const int length = parse_small(reader);
    reader.take_comma();
    const int precision = parse_small(reader);
    reader.expect(')', "vstr");
    std::string text;
    for (int i = 0; i < count; ++i)
        text += (i > 0 ? separator : "") + number_text(v.v[size_t(i)], length, precision);
    return text;
}

std::string concat(Reader& reader) {
    reader.expect('(', "concat");
    std::string text;
    do {
        text += parse_text(reader);
        if (text.size() > kLongestText)
            reader.fail(reader.place(), "found a text longer than a million letters");
    } while (reader.take(','));
    reader.expect(')', "concat");
    return text;
}

std::string substr(Reader& reader) {
    reader.expect('(', "substr");
    const std::string text = parse_text(reader);
    reader.take_comma();
    const int first = parse_int(reader, 1, int(text.size()), "the first letter of substr");
    reader.take_comma();
    const int count = parse_int(reader, 0, int(kLongestText), "the letters of substr");
    reader.expect(')', "substr");
    return text.substr(size_t(first - 1), size_t(count));
}

template <char From, char To>
std::string changed(Reader& reader) {
    reader.expect('(', "strlwr or strupr");
    std::string text = parse_text(reader);
    reader.expect(')', "a text");
    for (char& c : text)
        if (c >= From && c <= From + 25)
            c = char(c - From + To);
    return text;
}

/// Reads days since the year 2000, perhaps with a format of strftime, and returns their date at
/// Greenwich.
std::string datetime(Reader& reader) {
    constexpr double kMaxDays = 1e9; // for which a year is an int
    constexpr std::time_t kYear2000 = 946684800;
    reader.expect('(', "datetime");
    const double days = parse_float(reader);
    const std::string format =
        reader.take(',') ? parse_text(reader) : std::string("%Y-%m-%d %H:%M:%SZ");
    const Place place = reader.place();
    reader.expect(')', "datetime");
    if (!(std::abs(days) <= kMaxDays))
        reader.fail(place, fmt::format("found a date {} days after the year 2000", days));
    const std::time_t seconds = kYear2000 + std::time_t(std::floor(86400 * days + 0.5));
    std::tm parts{};
    std::array<char, 1024> text{};
    gmtime_r(&seconds, &parts);
    // The point in front tells a date without letters from one that is too long.
    const size_t length = std::strftime(text.data(), text.size(), ("." + format).c_str(), &parts);
    if (length == 0)
        reader.fail(place, fmt::format("found a date of more than {} letters", text.size() - 2));
    return {text.data() + 1, length - 1};
}

const std::unordered_map<std::string_view, TextFunction> kTextFunctions = {
    {"str", str},
    {"vstr", vstr},
    {"concat", concat},
    {"substr", substr},
    {"strlwr", changed<'A', 'a'>},
    {"strupr", changed<'a', 'A'>},
    {"chr",
     [](Reader& r) {
         r.expect('(', "chr");
         const int code = parse_int(r, 0, 0x10ffff, "the code of a letter");
         r.expect(')', "chr");
         return std::string(1, code < 256 ? char(code) : '?');
     }},
    {"datetime", datetime}};

} // namespace

const FloatFunction* find_float_function(std::string_view word) {
    const std::span<const FloatFunction> all = float_functions();
    const auto at = std::lower_bound(
        all.begin(), all.end(), word,
        [](const FloatFunction& function, std::string_view name) { return function.name < name; });
    return at == all.end() || at->name != word ? nullptr : &*at;
}

Builtin find_builtin(std::string_view word) {
    if (find_float_function(word))
        return call_float_function;
    const auto at = kBuiltins.find(word);
    return at == kBuiltins.end() ? nullptr : at->second;
}

TextFunction find_text_function(std::string_view word) {
    const auto at = kTextFunctions.find(word);
    return at == kTextFunctions.end() ? nullptr : at->second;
}

} // namespace ovc::pov

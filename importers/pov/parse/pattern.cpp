// SPDX-License-Identifier: Apache-2.0
#include "importers/pov/parse/pattern.h"

#include "core/texture/fractal.h"
#include "core/texture/pattern.h"
#include "core/texture/tiles/tiling.h"
#include "importers/file/text.h"
#include "importers/pov/parse/parse_object.h"
#include "importers/pov/parse/texture.h"
#include "importers/pov/pictures/density.h"
#include "importers/pov/pictures/image_map.h"
#include "importers/pov/texture_table.h"
#include "importers/pov/values/builtin_object.h"
#include "importers/pov/values/function.h"
#include "importers/pov/values/transform.h"
#include "importers/pov/words/block.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>

namespace ovc::pov {

namespace {

using Kind = Pattern::Kind;
using Wave = Pattern::Wave;

struct KindAndWave {
    Kind kind;
    Wave wave = Wave::Ramp;
};

const std::unordered_map<std::string_view, KindAndWave> kPatterns = {
    {"agate", {Kind::Agate}},
    {"aoi", {Kind::AngleOfIncidence}},
    {"average", {Kind::Average}},
    {"boxed", {Kind::Boxed}},
    {"bozo", {Kind::Bozo}},
    {"bumps", {Kind::Bozo}},
    {"cells", {Kind::Cells}},
    {"crackle", {Kind::Crackle}},
    {"cylindrical", {Kind::Cylindrical}},
    {"density_file", {Kind::Density}},
    {"dents", {Kind::Dents}},
    {"facets", {Kind::Crackle}},
    {"function", {Kind::Function}},
    {"gradient", {Kind::Gradient}},
    {"granite", {Kind::Granite}},
    {"image_pattern", {Kind::Function}},
    {"julia", {Kind::Fractal}},
    {"leopard", {Kind::Leopard}},
    {"magnet", {Kind::Fractal}},
    {"mandel", {Kind::Fractal}},
    {"marble", {Kind::Marble, Wave::Triangular}},
    {"onion", {Kind::Onion}},
    {"pigment_pattern", {Kind::Function}},
    {"planar", {Kind::Planar}},
    {"quilted", {Kind::Quilted}},
    {"radial", {Kind::Radial}},
    {"ripples", {Kind::Ripples}},
    {"slope", {Kind::Slope}},
    {"spherical", {Kind::Spherical}},
    {"spiral1", {Kind::Spiral1, Wave::Triangular}},
    {"spiral2", {Kind::Spiral2, Wave::Triangular}},
    {"spotted", {Kind::Bozo}},
    {"tiling", {Kind::Tiling}},
    {"waves", {Kind::Waves}},
    {"wood", {Kind::Wood, Wave::Triangular}},
    {"wrinkles", {Kind::Wrinkles}}};

const std::unordered_map<std::string_view, Kind> kLists = {
    {"brick", Kind::Brick},          {"checker", Kind::Checker}, {"cubic", Kind::Cubic},
    {"hexagon", Kind::Hexagon},      {"object", Kind::Object},   {"square", Kind::Square},
    {"triangular", Kind::Triangular}};

const std::unordered_map<std::string_view, Wave> kWaves = {
    {"ramp_wave", Wave::Ramp},   {"triangle_wave", Wave::Triangular},
    {"sine_wave", Wave::Sine},   {"scallop_wave", Wave::Scallop},
    {"cubic_wave", Wave::Cubic}, {"poly_wave", Wave::Power}};

template <size_t N>
bool is_one_of(const Token& token, const std::string_view (&words)[N]) {
    return token.kind == TokenKind::Name &&
           std::find(std::begin(words), std::end(words), token.name->text) != std::end(words);
}

/// Returns whether the word is a pattern that Overcast draws by its average color.
bool is_other_pattern(const Token& token) {
    static constexpr std::string_view kWords[] = {"pavement", "potential"};
    return is_one_of(token, kWords);
}

/// Returns whether the map is a picture instead of a pattern.
bool is_picture(const PatternMap& map) {
    return map.image_map && map.stops.empty();
}

bool is_map(const Token& token) {
    static constexpr std::string_view kWords[] = {"color_map",   "colour_map", "pigment_map",
                                                  "texture_map", "normal_map", "density_map"};
    return is_one_of(token, kWords);
}

} // namespace

PatternParts::PatternParts(Reader& reader, Pigment& pigment, MapOf of)
    : reader_(reader), pigment_(pigment), of_(of) {
    restart();
}

void PatternParts::restart() {
    forget();
    changed_ = false;
    if (!pigment_.pattern)
        return;
    pattern_ = pigment_.pattern->pattern;
    if (is_picture(*pigment_.pattern))
        return;
    chosen_ = true;
    stops_ = pigment_.pattern->stops;
    program_ = pigment_.pattern->program;
    image_ = pigment_.pattern->image_map;
}

bool PatternParts::is_pattern(const Token& token) {
    return token.kind == TokenKind::Name &&
           (kPatterns.contains(token.name->text) || kLists.contains(token.name->text));
}

void PatternParts::forget() {
    chosen_ = refused_ = false;
    changed_ = true;
    stops_.clear();
    stops_are_default_ = false;
    pattern_ = {};
    program_.reset();
    image_.reset();
    pattern_.noise = reader_.noise_kind();
}

void PatternParts::choose(Kind kind, Wave wave) {
    chosen_ = changed_ = true;
    refused_ = false;
    pattern_.kind = kind;
    pattern_.wave = wave;
    pattern_.parameters = {};
    program_.reset();
    image_.reset();
    pigment_.holes.reset();
    pigment_.notes.clear();
}

void PatternParts::refuse(const Token& token) {
    chosen_ = refused_ = changed_ = true;
    pigment_.holes.reset();
    const bool of_normal = of_ == MapOf::Normals;
    pigment_.notes = {reader_.note(
        (of_normal ? "normal " : "pattern ") + token.name->text, token.place,
        fmt::format("the pattern {} {}", ovc::quoted(token.name->text),
                    of_normal ? "of a normal is left out" : "is drawn by its average color"))};
}

void PatternParts::add_step(TextureStep step) {
    const TextureStep back{TextureStep::Kind::Affine, rows_of(glm::inverse(pigment_.placed))};
    pattern_.steps.insert(pattern_.steps.begin(), {step, back});
    pigment_.placed = dmat4(1);
}

bool PatternParts::take() {
    const Token token = reader_.peek();
    if (token.kind != TokenKind::Name)
        return false;
    if (is_map(token)) {
        reader_.next();
        stops_ = parse_map(reader_, token.is("texture_map")  ? MapOf::Textures
                                    : token.is("normal_map") ? MapOf::Normals
                                                             : MapOf::Pigments)
                     .stops;
        stops_are_default_ = false;
        changed_ = true;
        return true;
    }
    return take_pattern(token) || take_list(token) || take_wave(token) || take_number(token);
}

bool PatternParts::take_pattern(const Token& token) {
    if (is_other_pattern(token)) {
        reader_.next();
        refuse(token);
        skip_arguments(reader_);
        return true;
    }
    const auto found = kPatterns.find(token.name->text);
    if (found == kPatterns.end())
        return false;
    reader_.next();
    if (token.is("facets") && of_ != MapOf::Normals)
        reader_.fail(token.place, "found facets, expected a pattern that is not for normals alone");
    choose(found->second.kind, found->second.wave);
    if (stops_.empty() && (token.is("bozo") || token.is("mandel"))) {
        stops_ = default_stops(&token, found->second.kind);
        stops_are_default_ = true;
    }
    parse_arguments(token);
    return true;
}

/// In povray the phase of some patterns, and of lists, counts from `frequency` on.
void PatternParts::parse_arguments(const Token& token) {
    if (token.is("gradient")) {
        const dvec3 direction = parse_vector(reader_);
        const double length = glm::length(direction);
        for (int i = 0; i < 3; ++i)
            pattern_.parameters[size_t(i)] = length > 0 ? direction[i] / length : 0;
    } else if (token.is("spiral1") || token.is("spiral2"))
        pattern_.parameters[0] = parse_float(reader_);
    else if (token.is("crackle"))
        pattern_.parameters = {-1, 1, 0, 2, 0, 0};
    else if (token.is("facets"))
        parse_facets();
    else if (token.is("quilted")) {
        pattern_.parameters = {1, 1};
        pattern_.frequency = 0;
    } else if (token.is("ripples") || token.is("waves"))
        pattern_.parameters[0] = reader_.wave_sources;
    else if (token.is("function"))
        take_function(token, parse_function(reader_));
    else if (token.is("pigment_pattern"))
        take_pigment_pattern();
    else if (token.is("image_pattern")) {
        pattern_.frequency = 0;
        take_image_pattern(token);
    } else if (token.is("slope"))
        parse_slope();
    else if (token.is("density_file"))
        take_density_file(token);
    else if (token.is("tiling"))
        parse_tiling(token);
    else if (pattern_.kind == Kind::Fractal)
        parse_fractal(token);
}

/// Reads the number. Those of tilings without a period are read, too.
void PatternParts::parse_tiling(const Token& token) {
    const int number = parse_int(reader_, 1, 27, "the number of a tiling");
    pattern_.parameters[0] = number;
    if (number > int(kTilings))
        refuse(token);
}

/// Reads `coords X`, `size X` and `metric X`.
void PatternParts::parse_facets() {
    using P = FacetParameter;
    pattern_.parameters = {};
    pattern_.parameters[P::kSize] = 0.1;
    pattern_.parameters[P::kMetric] = 2;
    for (;;) {
        if (reader_.take("coords"))
            pattern_.parameters[P::kCoords] = parse_float(reader_);
        else if (reader_.take("size"))
            pattern_.parameters[P::kSize] = parse_float(reader_);
        else if (reader_.take("metric"))
            pattern_.parameters[P::kMetric] = std::max(1e-3, parse_float(reader_));
        else
            return;
    }
}

void PatternParts::take_function(const Token& token, const Function& function) {
    if (!function.formula) {
        refuse(token); // of a transform, a spline or a color
        return;
    }
    program_ = function.program;
}

/// The value is the pigment's brightness.
void PatternParts::take_pigment_pattern() {
    const Pigment pigment = parse_pigment(reader_, reader_.defaults.pigment);
    ProgramBuilder program;
    for (uint32_t i = 0; i < 3; ++i)
        program.add(FormulaStep::Kind::Argument, i);
    program.texture(FormulaStep::Kind::Color, color_program(pigment), 5);
    program_ = program.take();
    pigment_.notes = pigment.notes;
}

/// The value is the brightness of the picture's codes.
void PatternParts::take_image_pattern(const Token& token) {
    const ValueMap values = parse_value_map(reader_, token);
    if (values.image) {
        image_ = values.image;
        return;
    }
    refuse(token);
    pigment_.notes = {values.why_not};
}

/// Reads `{ DIRECTION, LOW, HIGH }` or `{ point_at POINT, LOW, HIGH }`, or the direction alone.
void PatternParts::parse_slope() {
    std::array<double, 10>& p = pattern_.parameters;
    const bool braces = reader_.take('{');
    p[5] = reader_.take("point_at") ? 1 : 0;
    const dvec3 direction = parse_vector(reader_);
    p[0] = direction.x, p[1] = direction.y, p[2] = direction.z;
    p[4] = 1;
    if (!braces)
        return;
    if (reader_.take(',')) {
        p[3] = parse_float(reader_);
        reader_.take_comma();
        p[4] = parse_float(reader_);
    }
    if (reader_.take("altitude")) {
        const dvec3 altitude = parse_vector(reader_);
        double low = 0, high = 1;
        if (reader_.take(',')) {
            low = parse_float(reader_);
            reader_.take_comma();
            high = parse_float(reader_);
        }
        add_altitude(altitude, low, high);
    }
    reader_.expect('}', "slope");
}

/// The slope and the height along `altitude` have shares as the lengths of their vectors.
void PatternParts::add_altitude(const dvec3& altitude, double low, double high) {
    std::array<double, 10>& p = pattern_.parameters;
    const double own = glm::length(dvec3(p[0], p[1], p[2])), other = glm::length(altitude);
    if (!(other > 0) || high == low)
        return;
    const double share = other / (own + other);
    const dvec3 step = altitude / other * (share / (high - low));
    p[6] = step.x, p[7] = step.y, p[8] = step.z;
    p[9] = -low * share / (high - low);
    // The slope's part of the value is the rest.
    const double width = (p[4] - p[3]) / (1 - share);
    p[4] = p[3] + width;
}

/// Reads `[MAGNET] [mandel | julia COMPLEX,] ITERATIONS` behind the first word.
void PatternParts::parse_fractal(const Token& token) {
    using F = FractalParameter;
    std::array<double, 10>& p = pattern_.parameters;
    p[F::kExponent] = token.is("magnet") ? -parse_int(reader_, 1, 2, "the kind of a magnet") : 2;
    const bool is_julia = token.is("magnet") ? reader_.take("julia") : token.is("julia");
    if (token.is("magnet") && !is_julia && !reader_.take("mandel"))
        reader_.fail_here("mandel or julia");
    p[F::kIsJulia] = is_julia ? 1 : 0;
    if (is_julia) {
        const Number c = resized(reader_, parse_number(reader_), 2);
        p[F::kX] = c.v[0], p[F::kY] = c.v[1];
        reader_.take_comma();
    }
    p[F::kIterations] = std::clamp(parse_float(reader_), 1.0, kMaxFractalIterations);
    p[F::kExterior] = 1;
    p[F::kExteriorFactor] = p[F::kInteriorFactor] = 1;
}

/// Reads `df3 "name"`.
void PatternParts::take_density_file(const Token& word) {
    if (!reader_.take("df3"))
        reader_.fail_here("df3");
    const std::string name = parse_text(reader_);
    const std::filesystem::path path = reader_.find_file(name, ".df3");
    Result<DensityGrid> grid = path.empty()
                                   ? Error{fmt::format("there is no file {}", ovc::quoted(name))}
                                   : read_density(path);
    if (grid) {
        reader_.spend(grid->values.size() / 16);
        pattern_.grid = std::move(*grid);
        return;
    }
    refuse(word);
    pigment_.notes = {reader_.note(
        "density_file " + name, word.place,
        fmt::format("{}: the density_file is drawn by its average color", grid.error().message))};
}

/// Takes `exponent`, `exterior` or `interior` of a fractal.
bool PatternParts::take_fractal_part() {
    using F = FractalParameter;
    std::array<double, 10>& p = pattern_.parameters;
    if (pattern_.kind != Kind::Fractal)
        return false;
    if (reader_.take("exponent")) {
        p[F::kExponent] = parse_int(reader_, 2, 33, "the exponent of a fractal");
        if (p[F::kExponent] != 2 && std::exchange(stops_are_default_, false))
            stops_.clear();
        return true;
    }
    const bool outside = reader_.take("exterior");
    if (!outside && !reader_.take("interior"))
        return false;
    const int kind = parse_int(reader_, 0, outside ? 8 : 6, "how a fractal is colored");
    reader_.take_comma();
    p[outside ? F::kExterior : F::kInterior] = kind;
    p[outside ? F::kExteriorFactor : F::kInteriorFactor] = parse_float(reader_);
    return true;
}

/// Takes a word that belongs to one pattern alone.
bool PatternParts::take_own_part() {
    std::array<double, 10>& p = pattern_.parameters;
    if (take_fractal_part() ||
        (refused_ &&
         take_skipped(reader_, {"exterior", "form", "interior", "number_of_sides",
                                "number_of_tiles", "pattern", "sides", "threshold", "tiles"})))
        return true;
    if (pattern_.kind == Kind::Quilted && reader_.take("control0"))
        p[0] = parse_float(reader_);
    else if (pattern_.kind == Kind::Quilted && reader_.take("control1"))
        p[1] = parse_float(reader_);
    else if (pattern_.kind == Kind::Density && reader_.take("interpolate"))
        p[0] = parse_int(reader_, 0, 2, "interpolate");
    else if (pattern_.kind != Kind::Crackle)
        return false;
    else if (reader_.take("form")) {
        const dvec3 form = parse_vector(reader_);
        p[0] = form.x, p[1] = form.y, p[2] = form.z;
    } else if (reader_.take("metric"))
        p[3] = std::max(1e-3, parse_float(reader_));
    else if (reader_.take("offset"))
        p[4] = parse_float(reader_);
    else if (reader_.take("solid"))
        p[5] = parse_flag(reader_) ? 1 : 0;
    else
        return false;
    return true;
}

/// Reads `{ OBJECT ENTRY, ENTRY }`, whose entries are textures, pigments, colors or normals: that
/// of the outside and that of the inside.
void PatternParts::parse_object_list() {
    reader_.expect('{', "object");
    const std::optional<ObjectPtr> named_object = take_named_if<ObjectPtr>(reader_);
    if (!named_object && !starts_object(reader_.peek()))
        reader_.fail_here("an object");
    const ObjectPtr object = named_object ? *named_object : parse_object(reader_);
    pattern_.region = region_of(reader_, object);
    reader_.grow(pattern_.region.triangles.corners.size() * sizeof(dvec3));
    reader_.take_comma();
    parse_list();
    reader_.expect('}', "the entries of a pattern of an object");
}

bool PatternParts::take_list(const Token& token) {
    const auto found = kLists.find(token.name->text);
    if (found == kLists.end())
        return false;
    reader_.next();
    choose(found->second, Wave::Ramp);
    pattern_.frequency = 0;
    pigment_.placed = dmat4(1);
    pattern_.steps.clear();
    if (found->second == Kind::Brick)
        pattern_.parameters = {8, 3, 4.5, 0.5};
    if (found->second == Kind::Object)
        parse_object_list();
    else if (of_ != MapOf::Normals || reader_.peek().is("normal"))
        parse_list();
    return true;
}

void PatternParts::parse_list() {
    std::vector<MapStop> list = parse_entries(reader_, of_);
    // The colors that are not given are the default ones.
    const std::vector<MapStop> others = default_stops(nullptr, pattern_.kind);
    for (size_t i = list.size(); i < others.size(); ++i)
        list.push_back(others[i]);
    stops_ = std::move(list);
}

bool PatternParts::take_wave(const Token& token) {
    const auto found = kWaves.find(token.name->text);
    if (found == kWaves.end())
        return false;
    reader_.next();
    pattern_.wave = found->second;
    pattern_.exponent = 1;
    if (found->second == Wave::Power && starts_number(reader_, reader_.peek()))
        pattern_.exponent = parse_float(reader_);
    changed_ = true;
    return true;
}

bool PatternParts::take_number(const Token& token) {
    if (take_own_part()) {
    } else if (reader_.take("turbulence"))
        pattern_.turbulence = parse_vector(reader_);
    else if (reader_.take("octaves"))
        pattern_.octaves.count =
            uint64_t(std::clamp(parse_float(reader_), 1.0, double(kMaxOctaves)));
    else if (reader_.take("lambda"))
        pattern_.octaves.lambda = parse_float(reader_);
    else if (reader_.take("omega"))
        pattern_.octaves.omega = parse_float(reader_);
    else if (reader_.take("frequency"))
        pattern_.frequency = parse_float(reader_);
    else if (reader_.take("phase"))
        pattern_.phase = parse_float(reader_);
    else if (reader_.take("agate_turb"))
        agate_turb_ = parse_float(reader_);
    else if (reader_.take("noise_generator"))
        pattern_.noise = NoiseKind(parse_int(reader_, 1, 3, "noise_generator"));
    else if (reader_.take("brick_size")) {
        const dvec3 size = parse_vector(reader_);
        for (int i = 0; i < 3; ++i)
            pattern_.parameters[size_t(i)] = size[i];
    } else if (reader_.take("mortar"))
        pattern_.parameters[3] = parse_float(reader_);
    else if (token.is("warp")) {
        reader_.next();
        take_warp();
    } else
        return false;
    changed_ = true;
    return true;
}

/// Warps and turbulence move a picture as they do a pattern.
void PatternParts::finish_picture() {
    std::vector<TextureStep> steps = steps_of(pattern_);
    if (steps == pigment_.pattern->pattern.steps)
        return;
    pigment_.holes.reset(); // which do not move with it
    auto moved = std::make_shared<PatternMap>(*pigment_.pattern);
    moved->pattern.steps = std::move(steps);
    pigment_.pattern = std::move(moved);
}

void PatternParts::finish() {
    if (!chosen_ && pigment_.pattern && is_picture(*pigment_.pattern)) {
        finish_picture();
        return;
    }
    if (!changed_ || (!chosen_ && !pigment_.pattern))
        return;
    pigment_.pattern.reset();
    if (!chosen_)
        return;
    pigment_.color = average_of(stops_);
    if (refused_)
        return;
    if (pattern_.kind == Kind::Agate && (agate_turb_ || pattern_.parameters[0] == 0))
        pattern_.parameters[0] = agate_turb_.value_or(1);
    auto made = std::make_shared<PatternMap>();
    made->pattern = pattern_;
    made->program = program_;
    made->image_map = image_;
    made->stops = stops_.empty() ? default_stops(nullptr, pattern_.kind) : stops_;
    if (pattern_.kind != Kind::Average && !has_cells(pattern_.kind))
        std::stable_sort(made->stops.begin(), made->stops.end(),
                         [](const MapStop& a, const MapStop& b) { return a.at < b.at; });
    count_parts(reader_, *made);
    pigment_.color = average_of(made->stops);
    pigment_.pattern = std::move(made);
}

} // namespace ovc::pov

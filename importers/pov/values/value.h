// SPDX-License-Identifier: Apache-2.0
// What an identifier of the scene language can stand for.
#pragma once

#include "core/scene.h"
#include "importers/pov/words/token.h"

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace ovc::pov {

struct Object;
struct Array;
struct Macro;
struct Function;
struct Spline;

/// A float (size 1), a vector of 2 to 4, or five: a color (red, green, blue, filter, transmit) or a
/// vector of five.
struct Number {
    std::array<double, 5> v{};
    int size = 1;
    bool is_color = false;

    static Number of(double x) { return {{x}, 1, false}; }
    static Number of(const dvec3& p) { return {{p.x, p.y, p.z}, 3, false}; }
};

/// Something about a look that is drawn by an approximation, or left out: a warning where the look
/// is to be seen. kind: of several alike the first is told.
struct Note {
    std::string kind;
    Place place;
    std::string sentence;
};
using Notes = std::vector<std::shared_ptr<const Note>>;

inline std::shared_ptr<const Note> make_note(std::string kind, const Place& place,
                                             std::string sentence) {
    return std::make_shared<const Note>(Note{std::move(kind), place, std::move(sentence)});
}

/// A color with what it lets through: light x color x filter + light x transmit.
struct Color {
    vec3 rgb{0};
    float filter = 0;
    float transmit = 0;

    float opacity() const { return 1 - filter - transmit; }
};

/// A color, the average of a pattern, or a checker of two of them.
struct Pigment {
    Color color;
    std::optional<Color> other; // of a checker
    dmat4 placed{1};            // where a checker stands
    Notes notes;
};

/// A finish, and what it is without the scene: ambient and emission are still apart.
struct Surface {
    Finish finish;
    vec3 ambient{0.1f};
    vec3 emission{0};
    /// As scenes before interiors came have them: a finish's own, which counts more than that of
    /// an interior, and what the light that is let through is multiplied by.
    std::optional<double> ior;
    float refraction = 1;
    Notes notes;
};

/// All layers of a texture, drawn together.
struct Texture {
    Pigment pigment;
    Surface surface;
    Notes notes; // of the whole
};

struct Interior {
    double ior = 1;
    Notes notes;
};

struct Material {
    std::optional<Texture> texture;
    std::optional<Interior> interior;
};

/// A color_map or any other map, drawn together: the average over [0, 1] of its values.
struct ColorMap {
    Color average;
};

/// The pigments of a sky_sphere, the lowest first.
struct SkySphere {
    std::vector<Pigment> pigments;
};

/// Something that has a name and is of no use here: a media, a fog, a normal.
struct Opaque {
    std::string kind;
};

struct CameraValue;
struct DataFile;

using Value = std::variant<std::monostate, Number, std::string, std::shared_ptr<const Object>,
                           Texture, Pigment, Surface, Interior, Material, ColorMap, SkySphere,
                           dmat4, std::shared_ptr<Array>, std::shared_ptr<const Macro>,
                           std::shared_ptr<const Function>, std::shared_ptr<const Spline>,
                           std::shared_ptr<const CameraValue>, std::shared_ptr<DataFile>, Opaque>;

/// "a float", "an object": what a message calls it.
std::string kind_of(const Value& value);

/// A variable. A parameter that a macro takes by reference is bound to the caller's.
struct Slot {
    Value value;
};

struct Array {
    std::vector<size_t> sizes; // of the dimensions
    std::vector<Value> items;  // the last index counts fastest
    uint32_t depth = 1;        // of arrays in arrays
};

/// The tokens [first, last) of a file, run in the place of a call.
struct Macro {
    Name* name = nullptr;
    std::vector<Name*> parameters;
    const SourceFile* file = nullptr;
    size_t first = 0;
    size_t last = 0;
};

/// The points of a spline { }, by their clock.
struct Spline {
    enum class Kind { Linear, Quadratic, Cubic, Natural };
    Kind kind = Kind::Linear;
    std::map<double, Number> points;
};

} // namespace ovc::pov

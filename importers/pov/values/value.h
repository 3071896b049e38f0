// SPDX-License-Identifier: Apache-2.0
// The kinds of value that an identifier of the scene language can have.
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

/// A float (size 1), a vector of 2 to 5 components, or a color (size 5: red, green, blue, filter,
/// transmit).
struct Number {
    std::array<double, 5> v{};
    int size = 1;
    bool is_color = false;

    static Number of(double x) { return {{x}, 1, false}; }
    static Number of(const dvec3& p) { return {{p.x, p.y, p.z}, 3, false}; }
};

/// A part of a look that Overcast approximates or leaves out, which warns where the look is drawn.
struct Note {
    std::string kind; // only the first note of a kind becomes a warning
    Place place;
    std::string sentence;
};
using Notes = std::vector<std::shared_ptr<const Note>>;

inline std::shared_ptr<const Note> make_note(std::string kind, const Place& place,
                                             std::string sentence) {
    return std::make_shared<const Note>(Note{std::move(kind), place, std::move(sentence)});
}

/// A color and its transparency: it lets through light x color x filter + light x transmit.
struct Color {
    vec3 rgb{0};
    float filter = 0;
    float transmit = 0;

    float opacity() const { return 1 - filter - transmit; }
};

/// The holes of an image_map and the color of what is there.
struct Holes {
    Cutout cutout;
    Color color;
    bool one_color = false; // all that is there has this color
};

/// A color, the average of a pattern, or a checker of two of them.
struct Pigment {
    Color color;
    std::shared_ptr<const Holes> holes; // of an image_map; null: none
    bool uv_mapping = false;            // the image_map lies on texture coordinates, not on x and y
    std::optional<Color> other;         // of a checker
    dmat4 placed{1};                    // from its space to that of the object's parent, or to uv
    Notes notes;
};

/// A finish as the scene states it. flatten.cpp computes finish.ambient from ambient, emission and
/// the scene's ambient_light.
struct Surface {
    Finish finish;
    vec3 ambient{0.1f};
    vec3 emission{0};
    /// Old scenes give these in a finish. This ior takes precedence over an interior's, and
    /// refraction is a factor of the light that the surface lets through.
    std::optional<double> ior;
    float refraction = 1;
    Notes notes;
};

/// A texture whose layers are combined into one.
struct Texture {
    Pigment pigment;
    Surface surface;
    Notes notes; // of the whole texture
};

struct Interior {
    double ior = 1;
    Notes notes;
};

struct Material {
    std::optional<Texture> texture;
    std::optional<Interior> interior;
};

/// A color_map or any other map, of which only the average over [0, 1] is kept.
struct ColorMap {
    Color average;
};

/// The pigments of a sky_sphere, the lowest first.
struct SkySphere {
    std::vector<Pigment> pigments;
};

/// A declared value that Overcast does not use: a media, a fog, a normal.
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

/// Returns what a message calls the value: "a number", "an object".
std::string kind_of(const Value& value);

/// A variable. A macro's parameter that is passed by reference shares the caller's slot.
struct Slot {
    Value value;
};

struct Array {
    std::vector<size_t> sizes; // of the dimensions
    std::vector<Value> items;  // the last index varies fastest
    uint32_t depth = 1;        // of nested arrays
};

/// A macro, whose body is the tokens [first, last) of a file.
struct Macro {
    Name* name = nullptr;
    std::vector<Name*> parameters;
    const SourceFile* file = nullptr;
    size_t first = 0;
    size_t last = 0;
};

/// The points of a spline { } by their clock.
struct Spline {
    enum class Kind { Linear, Quadratic, Cubic, Natural };
    Kind kind = Kind::Linear;
    std::map<double, Number> points;
};

} // namespace ovc::pov

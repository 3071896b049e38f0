// SPDX-License-Identifier: Apache-2.0
// The kinds of value that an identifier of the scene language can have.
#pragma once

#include "core/scene.h"
#include "importers/pov/values/program.h"
#include "importers/pov/values/shared_function.h"
#include "importers/pov/words/data_file.h"
#include "importers/pov/words/token.h"

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace ovc::pov {

struct Object;
struct Macro;
struct Value;

/// A float (size 1), a vector of 2 to 5 components, or a color (size 5: red, green, blue, filter,
/// transmit).
struct Number {
    std::array<double, 5> v{};
    int size = 1;
    bool is_color = false;

    static Number of(double x) { return {{x}, 1, false}; }
    static Number of(const dvec3& p) { return {{p.x, p.y, p.z}, 3, false}; }

    /// Returns how bright a color is, as POV-Ray weighs red, green and blue.
    double gray() const { return 0.297 * v[0] + 0.589 * v[1] + 0.114 * v[2]; }
};

/// A part of a look that Overcast approximates or leaves out, which warns where the look is drawn.
struct Note {
    std::string kind; // only the first note of a kind becomes a warning
    Place place;
    std::string sentence;

    auto operator<=>(const Note&) const = default;
};
/// The reader owns the notes (Reader::note), since every copy of a look has the same ones.
using Notes = std::vector<const Note*>;

using Color = TransparentColor;

/// The holes of an image_map and the color of what is there.
struct Holes {
    Cutout cutout;
    Color color;
    bool one_color = false; // all that is there has this color
};

/// The copies of a pigment share its picture's holes, which may be megabytes. A loop may make and
/// forget many pigments, so the last copy frees them.
using HolesPtr = std::shared_ptr<const Holes>;

/// A pattern with the entries of its map or list. The copies of a pigment or texture share it, as
/// they share holes.
struct PatternMap;
using PatternPtr = std::shared_ptr<const PatternMap>;

/// A color, or a pattern of pigments.
struct Pigment {
    Color color;             // with a pattern: about its average
    PatternPtr pattern;      // null: none
    HolesPtr holes;          // of an image_map; null: none
    bool uv_mapping = false; // the image_map lies on texture coordinates, not on x and y
    dmat4 placed{1};         // from its space to that of the object's parent, or to uv
    Notes notes;
};

/// A finish as the scene states it. flatten.cpp computes finish.ambient from ambient, emission and
/// the scene's ambient_light.
struct Surface {
    Finish finish;
    /// Whether these are albedos, the light that goes in all directions together, and not what the
    /// brightest one has.
    bool diffuse_is_albedo = false, phong_is_albedo = false, specular_is_albedo = false;
    vec3 ambient{0.1f};
    vec3 emission{0};
    /// Old scenes give these in a finish. This ior takes precedence over an interior's, and
    /// refraction is a factor of the light that the surface lets through.
    std::optional<double> ior;
    float refraction = 1;
    Notes notes;
};

/// A normal { }, whose pattern tilts normals. Without a pattern it tilts none.
struct Normal {
    Pigment pattern; // its colors do not matter
    Bump::Kind kind = Bump::Kind::Height;
    double amount = 0.5;
    double accuracy = 0.02;
    bool keeps_depth = false;       // no_bump_scale
    std::vector<SlopeStop> profile; // of a slope_map
};
using NormalPtr = std::shared_ptr<const Normal>;

struct Texture;
/// Copies of a texture share the layers below it, which do not change any more.
using TexturePtr = std::shared_ptr<const Texture>;

/// A texture, with the layer below it where it lies on one.
struct Texture {
    Pigment pigment;
    Normal normal;
    Surface surface;
    /// Its pattern, unless null, mixes the textures of its stops; pigment and surface are then
    /// those of the first of them.
    Pigment mix;
    TexturePtr under;
    Notes notes; // of the whole texture
};

/// An entry of a map or list: a pigment or, in a map of textures, a texture.
struct MapStop {
    double at = 0;
    Pigment pigment;
    TexturePtr texture; // null: none
    NormalPtr normal;   // of a map or list of normals; else null

    const Color& average() const { return texture ? texture->pigment.color : pigment.color; }
};

class MapPicture;
/// The picture of an image_map, which the scene's textures show. The copies of a pigment share it.
struct ImageMap {
    std::shared_ptr<const MapPicture> picture;
    ImageTexture image;
};

struct PatternMap {
    Pattern pattern;
    std::vector<MapStop> stops; // at least one, in ascending order except for Average
    ProgramPtr program;         // of Pattern::Kind::Function, in place of pattern.formula
    /// With stops, the pattern is the brightness of this picture. Without any, the picture takes
    /// the place of all these except the pattern's steps.
    std::optional<ImageMap> image_map;
    /// How many patterns there are in this one, with those of its stops and of their stops. Each is
    /// evaluated as often as it comes.
    uint64_t parts = 1;
    /// How deep patterns and layers lie in each other, this one counted.
    uint64_t depth = 1;
    /// The pattern is of what corners of a mesh have in the place of texture coordinates, whatever
    /// the texture's transformations.
    bool on_corners = false;
};

/// A media { }, whose densities are in its own space.
struct Media {
    Medium medium;
    std::vector<Pigment> densities;
    Notes notes;
};

struct Interior {
    double ior = 1;
    Absorption absorption; // a distance of 0: none
    std::vector<Media> media;
    float caustics = 0;
    Notes notes;
};

struct Material {
    std::optional<Texture> texture;
    std::optional<Texture> inside; // of the inner sides
    std::optional<Interior> interior;
};

/// A color_map, pigment_map, texture_map or normal_map, or a slope_map.
struct ColorMap {
    std::vector<MapStop> stops;
    std::vector<SlopeStop> slopes;
};

/// The pigments of a sky_sphere, the lowest first.
struct SkySphere {
    std::vector<Pigment> pigments;
};

/// Names, arrays, groups and clips share objects that do not change any more, and a scene forgets
/// them in any order. The last of them frees the object, as SharedFunction explains; to copy it for
/// each would double a group of groups at every level.
using ObjectPtr = std::shared_ptr<const Object>;

/// A camera whose vectors are as its parts and transformations leave them (parse_camera.h).
struct CameraValue {
    dvec3 location{0};
    dvec3 direction{0, 0, 1};
    dvec3 up{0, 1, 0};
    dvec3 right{1.33, 0, 0}; // povray's default, though its pictures are 4 : 3
    dvec3 sky{0, 1, 0};
    std::optional<double> distance; // from the location to look_at, or to <0, 0, 1> without it
    bool window_given = false;      // whether the scene gives right or up
    bool orthographic = false;
    ImageWindow::Bend bend = ImageWindow::Bend::Flat;
    double vertical_angle = 0;
    double angle = 0;          // of the field of view, in degrees; 0 where the scene gives none
    Normal normal;             // tilts rays
    double aperture = 0;       // of a lens; 0: none
    uint32_t blur_samples = 0; // rays a pixel through it; 0: everything is sharp
    std::optional<dvec3> focal_point;
    std::shared_ptr<const FaceCamera> faces; // of a mesh_camera; null: a window
    uint32_t face_rays = 1;                  // rays a pixel of those
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

/// A formula ready to be computed. Arguments that are missing count as 0.
using NumberFormula = SharedFunction<double(std::span<const double>)>;

/// The color of a pigment at a point.
using ColorFormula = SharedFunction<Color(const dvec3&)>;

/// Exactly one of formula, color, transform, spline and refused is set.
struct Function {
    size_t parameters = 3;
    NumberFormula formula;
    ColorFormula color;
    /// The program of `formula`, or one with the textures of `color`, whose last is the pigment.
    ProgramPtr program;
    std::optional<dmat4> transform;
    std::optional<Spline> spline;
    uint32_t depth = 1;  // of nested closures
    dvec2 grid{0};       // WIDTH, HEIGHT of function WIDTH, HEIGHT { }
    std::string refused; // the reason why it cannot be called
};

/// The value of a variable or of an array's item, which owns it. Macros belong to the reader.
struct Value
    : std::variant<std::monostate, Number, std::string, ObjectPtr, Texture, Pigment, Normal,
                   Surface, Interior, Material, ColorMap, SkySphere, Fog, dmat4, Array,
                   const Macro*, Function, Spline, CameraValue, DataFile, Media, Rainbow> {
    using variant::variant;
    using variant::operator=;
};

/// Returns what a message calls the value: "a number", "an object".
std::string kind_of(const Value& value);

/// A variable. A macro's parameter that is passed by reference shares the caller's slot.
struct Slot {
    Value value;
    uint64_t scope = 0; // the serial number of the scope with which it ends
};

/// A variable, or the item of its array, from which a value is taken later. What is read until then
/// may run code that ends the variable or changes it, so Reader::value_of() looks for it again.
struct ValueHandle {
    Slot* slot = nullptr;
    uint64_t scope = 0; // slot->scope, which tells whether there still is a slot
    std::optional<size_t> item;

    explicit ValueHandle(Slot& of) : slot(&of), scope(of.scope) {}
};

} // namespace ovc::pov

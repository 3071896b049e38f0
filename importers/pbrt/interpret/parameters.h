// SPDX-License-Identifier: Apache-2.0
// Parameters are the "type name" and values behind a directive, and the ways to ask for them.
#pragma once

#include "core/vec.h"
#include "importers/pbrt/interpret/tokens.h"

#include <initializer_list>
#include <iterator>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace ovc::pbrt {

/// The type of a value, whatever the version called it: color and rgb are Rgb, point and point3 are
/// Point3.
enum class Kind {
    Integer,
    Float,
    Bool,
    Point2,
    Point3,
    Vector2,
    Vector3,
    Normal,
    Rgb,
    Xyz,
    Blackbody,
    Spectrum,
    String,
    Texture
};

struct Parameter {
    Kind kind;
    std::string name;
    std::vector<double> numbers; // a Bool is 0 or 1
    std::vector<std::string> strings;
    Place place;
    mutable bool asked = false;     // for its value; left_over.h names the others
    mutable size_t wants = 0;       // values; 0: any number
    mutable bool evaluated = false; // the texture that it names is, at every hit

    bool is_color() const {
        return kind == Kind::Rgb || kind == Kind::Xyz || kind == Kind::Blackbody ||
               kind == Kind::Spectrum;
    }
};

/// Notes what it is asked for.
class Parameters {
public:
    /// Reads up to the next directive, and leaves out parameters of unknown types with a warning.
    /// Returns false after an error.
    bool read(Tokens& tokens, Diagnostics& diagnostics);

    /// Takes the parameters "rgb" through a matrix of colors. What is no color then, because it has
    /// less than nothing of red, green or blue, has none of it.
    void take_colors_through(const dmat3& colors);

    /// Puts parameters before all others, which take their place where they have the same name.
    void put_first(std::vector<Parameter> first) {
        list_.insert(list_.begin(), std::make_move_iterator(first.begin()),
                     std::make_move_iterator(first.end()));
    }

    /// Returns the last parameter of that name and one of these kinds, as in pbrt; null if there is
    /// none.
    const Parameter* find(std::string_view name, std::initializer_list<Kind> kinds) const;
    /// Returns the last parameter of that name and any kind; null if there is none.
    const Parameter* find(std::string_view name) const;

    /// Returns a float, or an integer as one; `otherwise` if it is missing or empty.
    double number(std::string_view name, double otherwise) const;
    bool flag(std::string_view name, bool otherwise) const;
    std::string text(std::string_view name, std::string_view otherwise = {}) const;
    /// Returns the numbers of a parameter of one of these kinds; none if there is none.
    std::span<const double> numbers(std::string_view name, std::initializer_list<Kind> kinds) const;
    /// Moves out and returns the numbers of a parameter of one of these kinds.
    std::vector<double> take(std::string_view name, std::initializer_list<Kind> kinds);
    /// Returns the first three numbers as a point or vector; `otherwise` if there are fewer.
    dvec3 point(std::string_view name, const dvec3& otherwise) const;

    std::vector<Parameter>& all() { return list_; }
    const std::vector<Parameter>& all() const { return list_; }

private:
    /// Does the same as find() for a parameter that has one value.
    const Parameter* find_one(std::string_view name, std::initializer_list<Kind> kinds) const;
    bool read_values(Tokens& tokens, Diagnostics& diagnostics, Parameter& parameter);

    std::vector<Parameter> list_;
};

} // namespace ovc::pbrt

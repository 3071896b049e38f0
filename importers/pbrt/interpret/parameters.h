// SPDX-License-Identifier: Apache-2.0
// Parameters: what follows a directive, "type name" values, and what is asked of it.
#pragma once

#include "core/vec.h"
#include "importers/pbrt/interpret/tokens.h"

#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace ovc::pbrt {

/// What a value is, whatever the version called it: color and rgb are Rgb, point and point3 are
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

    bool is_color() const {
        return kind == Kind::Rgb || kind == Kind::Xyz || kind == Kind::Blackbody ||
               kind == Kind::Spectrum;
    }
};

class Parameters {
public:
    /// Reads up to the next directive. Parameters of unknown types are left out with a warning;
    /// false: an error.
    bool read(Tokens& tokens, Diagnostics& diagnostics);

    /// Where a name occurs twice the last counts, as in pbrt. Null: there is none of these kinds.
    const Parameter* find(std::string_view name, std::initializer_list<Kind> kinds) const;
    /// Of any kind.
    const Parameter* find(std::string_view name) const;

    /// A float, or an integer taken for one; `otherwise` where it is missing or empty.
    double number(std::string_view name, double otherwise) const;
    bool flag(std::string_view name, bool otherwise) const;
    std::string text(std::string_view name, std::string_view otherwise = {}) const;
    /// The numbers of a parameter of one of these kinds; empty where there is none.
    std::span<const double> numbers(std::string_view name, std::initializer_list<Kind> kinds) const;
    /// The same, moved out.
    std::vector<double> take(std::string_view name, std::initializer_list<Kind> kinds);
    /// The first three numbers as a point or vector.
    dvec3 point(std::string_view name, const dvec3& otherwise) const;

    std::vector<Parameter>& all() { return list_; }
    const std::vector<Parameter>& all() const { return list_; }

private:
    bool read_values(Tokens& tokens, Diagnostics& diagnostics, Parameter& parameter);

    std::vector<Parameter> list_;
};

} // namespace ovc::pbrt

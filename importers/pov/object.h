// SPDX-License-Identifier: Apache-2.0
// Objects as a scene states them: shapes with transforms and textures, not yet cut into triangles.
#pragma once

#include "core/box.h"
#include "core/region/round_shape.h"
#include "core/scene.h"
#include "importers/pov/shapes/facets.h"
#include "importers/pov/values/shared_function.h"
#include "importers/pov/values/value.h"

namespace ovc::pov {

/// A shape in its own space.
struct Shape {
    /// Adds the shape's triangles to `out`. A circle gets `segments` straight pieces, which is a
    /// multiple of 4 and at least 8. `open` leaves out the caps at the shape's ends.
    SharedFunction<void(int segments, bool open, Facets& out)> cut;
    /// Adds the triangles that close an open shape where it is an operand of a solid: they bound
    /// its inside, and are not drawn. Null: the shape is closed, or has no inside.
    SharedFunction<void(int segments, Facets& out)> close;
    /// The coefficients of triangles(), which estimates how many triangles cut() adds.
    double fixed = 0;
    double per_square = 0; // x segments^2
    double per_segment = 0;
    std::optional<RoundShape> exact; // of round shapes that have formulas
    bool of_circles = false;         // its curves are circles alone
    /// Lead from the shape's space to its texture coordinates, as x and y. Empty: they are x and y
    /// of the world, or the corners have some.
    std::vector<TextureStep> to_uv;
    bool corners_have_uv = false; // Facets::uv has them
    std::optional<Box> box;       // bounds the shape; set only where cutting it takes long

    double triangles(int segments) const {
        return fixed + segments * (per_segment + segments * per_square);
    }
};

/// An endless plane: the points where normal . p = distance. Points below it are inside.
struct PlaneShape {
    dvec3 normal{0, 1, 0}; // of length 1
    double distance = 0;
};

/// A shape that may be endless, so it is cut within a box.
struct EndlessShape {
    /// Returns the part of the box that the shape may lie in, or an empty box.
    SharedFunction<Box(const Box&)> bounds;
    /// Adds closed triangles to `out`. Returns how many of them, from the first on, lie on the
    /// surface; the others only close it and are not drawn.
    SharedFunction<size_t(const Box&, int cells, Facets& out)> cut;
};

/// A light, or a grid of them that share its color.
struct LightSource {
    Light light;
    std::array<dvec3, 2>
        sides{}; // of the grid's parallelogram, in the middle of which the light is
    std::array<int, 2> counts{1, 1};
    dvec3 point_at{0, 0, 1};  // where each spotlight of the grid aims
    bool circular = false;    // the grid is pressed into a circle
    ObjectPtr projector;      // of projected_through; null: none
    bool illuminates = false; // light comes from all points of the grid, not only shadows
    bool orient = false;      // the grid is a circle that faces the place that it lights
    bool jitter = false;      // each light stands for the cell of the grid around it
};

struct Object {
    std::string_view kind; // the keyword: "sphere"
    Place place;
    Caller caller;
    std::variant<std::monostate, Shape, PlaneShape, EndlessShape, LightSource>
        shape; // a group of children has none
    std::vector<ObjectPtr> children;
    /// The objects of clipped_by, which cut this one, and of bounded_by, which only bound it. Both
    /// are in the space of the object's parent.
    std::vector<ObjectPtr> clips, bounds;
    /// The reason why the object cannot be cut into triangles, or empty. It becomes an error only
    /// where the object is drawn.
    std::string refused;
    Notes notes; // about the object itself

    dmat4 placed{1};                       // from the object's own space to its parent's
    std::optional<Texture> texture;        // none: the parent's
    std::optional<Texture> inside_texture; // of an interior_texture
    std::optional<Interior> interior;
    uint32_t depth = 1;            // levels of objects within objects, as parts, clips or bounds
    uint32_t seen_by = kSeenByAll; // as no_shadow, no_image and no_reflection leave it
    bool uv_mapping = false;       // of its own texture and those of its parts
    bool global_lights = false;    // of a light_group: lights of no group shine on it too
    bool inverse = false;
    bool turned = false;            // whether it has been inverted, be it twice
    bool hollow = false;            // media may fill it
    bool double_illuminate = false; // light that arrives at a far side lights the near one, too
    bool open = false;
    bool faces_inside = false; // a mesh whose triangles run clockwise seen from outside
    bool has_inside = true;    // false for a sheet, which cannot take anything away from a solid
};

} // namespace ovc::pov

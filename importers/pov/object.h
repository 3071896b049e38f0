// SPDX-License-Identifier: Apache-2.0
// Objects as a scene states them: shapes that are not cut into triangles yet, under transforms and
// textures.
#pragma once

#include "core/box.h"
#include "importers/pov/shapes/facets.h"
#include "importers/pov/values/value.h"

namespace ovc::pov {

/// A shape in its own space.
struct Shape {
    /// Cuts it with circles of `segments` straight pieces, a multiple of 4, at least 8; open:
    /// without the caps at its ends.
    std::function<void(int segments, bool open, Facets& out)> cut;
    /// How many triangles that gives: fixed, or per_segment x segments ^ power.
    double fixed = 0;
    double per_square = 0; // x segments^2
    double per_segment = 0;
    std::optional<Box> box; // around it, where cutting it to find out takes long

    double triangles(int segments) const {
        return fixed + segments * (per_segment + segments * per_square);
    }
};

/// An endless plane: normal . p = distance, below it is inside. normal: of any length but 0.
struct PlaneShape {
    dvec3 normal{0, 1, 0};
    double distance = 0;
};

/// A shape whose end, if it has one, is not known: it is cut in a box.
struct EndlessShape {
    /// What of the box it may be in; empty: nothing.
    std::function<Box(const Box&)> bounds;
    /// Closed triangles; as many as it says are of the surface, those behind are not to be seen.
    std::function<size_t(const Box&, int cells, Facets& out)> cut;
};

struct LightSource {
    Light light;
    bool area = false;
};

using ObjectPtr = std::shared_ptr<const Object>;

struct Object {
    std::string_view kind; // the keyword: "sphere"
    Place place;
    Caller caller;
    std::variant<std::monostate, Shape, PlaneShape, EndlessShape, LightSource>
        shape; // none: its children's
    std::vector<ObjectPtr> children;
    /// What bounds it where it is seen (clipped_by), and what may be tested first (bounded_by); in
    /// the space that the object stands in.
    std::vector<ObjectPtr> clips, bounds;
    /// Why it cannot be cut into triangles; empty: it can. Told only where it is to be seen.
    std::string refused;
    Notes notes; // about the object itself

    dmat4 placed{1};                // from its own space to that of what it is a part of
    std::optional<Texture> texture; // none: its parent's
    std::optional<Interior> interior;
    uint32_t depth = 1; // of groups in groups
    bool no_shadow = false;
    bool no_image = false;
    bool inverse = false;
    bool open = false;
    bool has_inside = true; // else it is a sheet that solids have no use for
};

} // namespace ovc::pov

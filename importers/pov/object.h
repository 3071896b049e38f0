// SPDX-License-Identifier: Apache-2.0
// Objects as a scene states them: shapes that are not cut into triangles yet, under transforms and
// textures.
#pragma once

#include "importers/pov/facets.h"
#include "importers/pov/value.h"

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

    double triangles(int segments) const {
        return fixed + segments * (per_segment + segments * per_square);
    }
};

/// An endless plane: normal . p = distance, below it is inside. normal: of any length but 0.
struct PlaneShape {
    dvec3 normal{0, 1, 0};
    double distance = 0;
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
    std::variant<std::monostate, Shape, PlaneShape, LightSource> shape; // none: its children's
    std::vector<ObjectPtr> children;
    /// Why it cannot be cut into triangles; empty: it can. Told only where it is to be seen.
    std::string refused;

    dmat4 placed{1};                // from its own space to that of what it is a part of
    std::optional<Texture> texture; // none: its parent's
    std::optional<Interior> interior;
    uint32_t depth = 1; // of groups in groups
    bool no_shadow = false;
    bool no_image = false;
    bool inverse = false;
    bool open = false;
};

} // namespace ovc::pov

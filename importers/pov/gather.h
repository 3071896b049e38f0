// SPDX-License-Identifier: Apache-2.0
// Gatherer: every visible shape and light of a scene, with what it inherits from its parents.
#pragma once

#include "importers/pov/flatten.h"
#include "importers/pov/material_table.h"
#include "importers/pov/solid.h"

#include <unordered_map>
#include <vector>

namespace ovc::pov {

/// A shape as it stands in the world.
struct Placed {
    const Object* object;
    dmat4 placed;
    bool inverse;
    Cover cover;
    uint32_t seen_by;
    LitBy lit_by;
    bool clockwise = false; // triangles run that way seen from outside
};

/// The state that an object inherits from its parents.
struct Inherited {
    dmat4 placed{1};                  // to the world
    dmat4 in_solid{1};                // to the space of the solid that contains the object
    const Texture* texture = nullptr; // at first that of #default
    dmat4 texture_placed{1};          // applied after the texture's own transformation
    PlacedInterior interior;
    const Texture* inside = nullptr; // of the inner sides, with the placing of `texture`
    uint32_t seen_by = kSeenByAll;
    LitBy lit_by;
    bool uv_mapping = false;
    bool inverse = false;
    bool turned = false; // whether `inverse` has ever changed on the way
    bool hollow = false;
    bool double_illuminate = false;
};

/// The look and the scene, which gets materials and lights, must outlive this.
class Gatherer {
public:
    Gatherer(const Look& look, Scene& scene)
        : holes(scene), look_(look), scene_(scene), materials_(look, scene) {}

    void gather(const Object& object, Inherited from);

    std::vector<Placed> placed;
    std::vector<Solid> solids;
    HoleTable holes;
    bool gather_unseen = false; // whether objects that no ray sees are gathered too

private:
    bool is_wanted(uint32_t seen_by) const { return seen_by != 0 || gather_unseen; }

    void inherit(const Object& object, Inherited& from);

    Cover cover_of(const Object& object, const Inherited& from, bool in_solid = false);

    void tell_of_holes(const Object& object, const ovc::Material& material,
                       bool has_lost_picture) const;

    /// Returns a texture whose pigment has holes as what is there looks: on texture coordinates it
    /// has one color.
    Texture without_holes(const Texture& texture, bool on_uv);

    void add_solid(const Object& object, Inherited from);

    /// Adds an object to the solid's tree as its last node. Returns false, and adds none, for a
    /// light or a group without shapes.
    bool gather_node(const Object& object, Inherited from, Solid& solid);

    SolidLeaf leaf_of(const Object& object, const Inherited& from);

    const Look& look_;
    Scene& scene_;
    MaterialTable materials_;
    std::unordered_map<const PatternMap*, PatternPtr> pictures_without_holes_;
    uint64_t visited_ = 0;
    uint32_t light_groups_ = 0; // so far
};

} // namespace ovc::pov

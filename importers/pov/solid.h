// SPDX-License-Identifier: Apache-2.0
// Solids: objects made by difference, intersection, merge or clipped_by are cut into triangles.
#pragma once

#include "core/box.h"
#include "importers/csg/csg.h"
#include "importers/pov/hole_table.h"
#include "importers/pov/object.h"

namespace ovc::pov {

/// An operand, which is a leaf of the tree.
struct SolidLeaf {
    /// A shape and its material; a mesh has one skin for each texture.
    struct Skin {
        const Object* object;
        Cover cover;
    };
    std::vector<Skin> skins;
    dmat4 placed{1}; // in the solid's space
    bool inverse = false;
    bool has_inside = true;
    Box bounds; // of its bounded_by, in the solid's space; empty without bounded_by
};

/// A tree of operands that are not cut yet. Its space is the one of its object's children. It does
/// not own the objects, which must outlive it.
struct Solid {
    const Object* object;
    dmat4 placed{1}; // from the solid's space to the world
    uint32_t seen_by = kSeenByAll;
    LitBy lit_by;
    std::vector<csg::Node> nodes; // children before parents; the last is the root
    std::vector<SolidLeaf> leaves;
};

/// Returns whether the object's parts bound each other, so that it must be evaluated as a whole.
bool is_solid(const Object& object);
/// Returns the kind of the tree's node for an object that has children. `inverse` asks for the
/// complement, by De Morgan's rules. turned: the object has been inverted, be it twice; POV-Ray
/// makes a merge of a union then.
csg::Kind kind_of(const Object& object, bool inverse, bool turned);

/// The triangles of one material, in the solid's space.
struct SolidPart {
    uint32_t skin; // its number among the skins of all leaves
    Facets facets;
};

/// Returns the surface of a solid, one part for each skin that is seen. `reach`, in the solid's
/// space, cuts off what is endless.
std::vector<SolidPart> evaluate(const Solid& solid, int segments, const Box& reach);

/// Returns the cover of a skin, whose number counts through all leaves.
Cover cover_of(const Solid& solid, uint32_t skin);

/// Returns the numbers of the solids in groups that have the same triangles in their own spaces, as
/// copies of a declared object do. An endless solid is alone, because where it is cut off depends
/// on where it stands.
std::vector<std::vector<uint32_t>> alike(const std::vector<Solid>& solids);

/// Returns a box around the solid, in its space. As in POV-Ray it follows from the boxes of the
/// solid's parts, and is infinite on the sides where the solid may be endless.
Box bounds_of(const Solid& solid, int segments);

/// Returns an estimate of how many triangles the operands are cut into. Planes do not count.
double triangles_of(const Solid& solid, int segments);

} // namespace ovc::pov

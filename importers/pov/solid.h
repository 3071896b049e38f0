// SPDX-License-Identifier: Apache-2.0
// Solids: difference, intersection, merge and clipped_by, from objects to triangles.
#pragma once

#include "core/box.h"
#include "importers/csg/csg.h"
#include "importers/pov/object.h"

namespace ovc::pov {

/// An operand: what stands at a leaf of the tree.
struct SolidLeaf {
    /// A shape and its material; a mesh has one for each texture.
    struct Skin {
        const Object* object;
        uint32_t material;
    };
    std::vector<Skin> skins;
    dmat4 placed{1}; // in the solid's space
    bool inverse = false;
    bool has_inside = true;
    Box bounds; // of its bounded_by, in the solid's space; empty: it has none
};

/// A tree of operands, before they are cut; its space is that of its object's children.
struct Solid {
    const Object* object;
    dmat4 placed{1}; // from its space to the world
    bool no_shadow = false;
    std::vector<csg::Node> nodes; // children before parents; the last is the root
    std::vector<SolidLeaf> leaves;
};

/// Whether the object's parts bound each other: it must be evaluated as a whole.
bool is_solid(const Object& object);
/// The node's kind, for an object of children; inverse: the complement, by De Morgan's rules.
csg::Kind kind_of(const Object& object, bool inverse);

/// The triangles of one material, in the solid's space.
struct SolidPart {
    uint32_t skin; // counted through all leaves
    Facets facets;
};

/// The surface of a solid. reach: where it is cut off if it is endless, in its space.
std::vector<SolidPart> evaluate(const Solid& solid, int segments, const Box& reach);

/// The material of a skin.
uint32_t material_of(const Solid& solid, uint32_t skin);

/// Solids in groups that come out alike, as the copies of a declared one do. Those that are endless
/// end elsewhere each, and are alone.
std::vector<std::vector<uint32_t>> alike(const std::vector<Solid>& solids);

/// The box around it as POV-Ray has it, from its parts' boxes, in its space; what is endless
/// reaches to infinity.
Box bounds_of(const Solid& solid, int segments);

double triangles_of(const Solid& solid, int segments);

} // namespace ovc::pov

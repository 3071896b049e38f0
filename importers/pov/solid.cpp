// SPDX-License-Identifier: Apache-2.0
#include "importers/pov/solid.h"

#include "importers/pov/flatten.h"
#include "importers/pov/shapes/bounds.h"
#include "importers/pov/shapes/implicit.h"
#include "importers/pov/shapes/shape.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>
#include <string>

namespace ovc::pov {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
const Box kEverywhere{dvec3(-kInfinity), dvec3(kInfinity)};

/// An operand's triangles. Each has its normals and its skin.
struct CutLeaf {
    csg::Operand operand;
    std::vector<std::array<dvec3, 3>> normals; // 0 stands for the triangle's normal
    std::vector<uint32_t> skins;
    Box box;
};

/// Returns for each triangle of the closed shape whether the open shape lacks it.
std::vector<uint8_t> hidden_caps(const Shape& shape, int segments, const Facets& closed) {
    assert(closed.corners.size() % 3 == 0);
    const auto key = [](const Facets& facets, size_t t) {
        std::array<double, 9> all;
        for (size_t i = 0; i < 9; ++i)
            all[i] = facets.corners[t + i / 3].position[int(i % 3)];
        return all;
    };
    Facets open;
    shape.cut(segments, /* open= */ true, open);
    std::map<std::array<double, 9>, int> shown;
    for (size_t t = 0; t < open.corners.size(); t += 3)
        ++shown[key(open, t)];
    std::vector<uint8_t> hidden;
    for (size_t t = 0; t < closed.corners.size(); t += 3)
        hidden.push_back(!shown.contains(key(closed, t)));
    return hidden;
}

/// Adds facets, moved into the solid's space, to the leaf, whose box is around those that are not
/// hidden. Mirrored ones still face outside.
void add(const Facets& facets, const std::vector<uint8_t>& hidden, const dmat4& placed,
         uint32_t skin, CutLeaf& leaf) {
    assert(facets.corners.size() == 3 * hidden.size());
    const dmat3 turned = glm::transpose(glm::inverse(dmat3(placed)));
    const bool mirrored = glm::determinant(dmat3(placed)) < 0;
    const size_t order[3] = {0, mirrored ? size_t(2) : 1, mirrored ? size_t(1) : 2};
    for (size_t t = 0; t + 2 < facets.corners.size(); t += 3) {
        std::array<dvec3, 3> at, normals;
        for (size_t i = 0; i < 3; ++i) {
            const Corner& corner = facets.corners[t + order[i]];
            at[i] = dvec3(placed * dvec4(corner.position, 1));
            const dvec3 n = turned * corner.normal;
            const double length = glm::length(n);
            normals[i] = length > 0 && std::isfinite(length) ? n / length : dvec3(0);
            if (is_finite(at[i]) && !hidden[t / 3])
                leaf.box.add(at[i]);
        }
        leaf.operand.triangles.push_back(at);
        leaf.normals.push_back(normals);
        leaf.skins.push_back(skin);
    }
}

/// Adds a half-space that reaches beyond the box on all sides: two triangles of its surface, then
/// walls that only close it.
size_t cut_plane(const PlaneShape& plane, const Box& box, Facets& out) {
    const dvec3 center = box.center();
    const double far = 2 * std::max(glm::length(box.extent()), 1e-9);
    const dvec3& n = plane.normal;
    // How far a plane lies beyond the box makes no difference, so it is moved nearer.
    const double height = std::clamp(plane.distance - glm::dot(n, center), -far, far);
    const int major = major_axis(n);
    dvec3 u(0);
    u[(major + 1) % 3] = 1;
    u = glm::normalize(u - glm::dot(u, n) * n);
    const dvec3 v = glm::cross(n, u), top = center + height * n, down = -3 * far * n;
    const dvec3 rim[4] = {top + far * (u + v), top + far * (v - u), top - far * (u + v),
                          top + far * (u - v)};
    out.add_quad(rim[0], rim[1], rim[2], rim[3]);
    const size_t shown = out.corners.size() / 3; // fewer than two where corners round together
    for (int i = 0; i < 4; ++i) {
        const dvec3 &a = rim[i], &b = rim[(i + 1) % 4];
        out.add_quad(a, a + down, b + down, b);
    }
    out.add_quad(rim[3] + down, rim[2] + down, rim[1] + down, rim[0] + down);
    return shown;
}

/// Turns the triangles round where they face inside, as a mesh's may: then its volume is below 0.
void turn_outward(CutLeaf& leaf) {
    assert(leaf.normals.size() == leaf.operand.triangles.size());
    double volume = 0;
    const dvec3 center = leaf.box.empty() ? dvec3(0) : leaf.box.center();
    for (const auto& t : leaf.operand.triangles)
        volume += glm::dot(t[0] - center, glm::cross(t[1] - center, t[2] - center));
    if (volume < 0)
        for (size_t i = 0; i < leaf.operand.triangles.size(); ++i) {
            std::swap(leaf.operand.triangles[i][1], leaf.operand.triangles[i][2]);
            std::swap(leaf.normals[i][1], leaf.normals[i][2]);
        }
}

/// The fineness with which shapes are cut.
struct Fineness {
    int segments; // of a circle
    int cells;    // of a field

    explicit Fineness(int pieces) : segments(pieces), cells(field_cells(pieces)) {}
};

CutLeaf cut_leaf(const SolidLeaf& leaf, const Fineness& fineness, const Box& reach) {
    const int segments = fineness.segments;
    CutLeaf cut;
    for (const SolidLeaf::Skin& skin : leaf.skins) {
        Facets facets;
        std::vector<uint8_t> hidden;
        if (const auto* shape = std::get_if<Shape>(&skin.object->shape)) {
            shape->cut(segments, /* open= */ false, facets);
            if (skin.object->open)
                hidden = hidden_caps(*shape, segments, facets);
            else if (shape->close) {
                hidden.resize(facets.corners.size() / 3, 0);
                shape->close(segments, facets);
                hidden.resize(facets.corners.size() / 3, 1);
            }
        } else if (const auto* endless = std::get_if<EndlessShape>(&skin.object->shape)) {
            const size_t shown =
                endless->cut(moved(reach, glm::inverse(leaf.placed)), fineness.cells, facets);
            assert(shown <= facets.corners.size() / 3);
            hidden.resize(shown, 0);
            hidden.resize(facets.corners.size() / 3, 1);
        } else if (const auto* plane = std::get_if<PlaneShape>(&skin.object->shape)) {
            const size_t shown = cut_plane(*plane, moved(reach, glm::inverse(leaf.placed)), facets);
            hidden.resize(shown, 0);
            hidden.resize(facets.corners.size() / 3, 1);
        }
        hidden.resize(facets.corners.size() / 3, 0);
        add(facets, hidden, leaf.placed, uint32_t(&skin - leaf.skins.data()), cut);
        cut.operand.hidden.insert(cut.operand.hidden.end(), hidden.begin(), hidden.end());
    }
    assert(cut.operand.hidden.size() == cut.operand.triangles.size());
    if (leaf.has_inside)
        turn_outward(cut);
    cut.operand.solid = leaf.has_inside;
    cut.operand.inverse = leaf.inverse;
    return cut;
}

/// Returns a box around a half-space. It is infinite except on one side, and there as well unless
/// the plane's normal is along an axis.
Box bounds_of_plane(const PlaneShape& plane, const SolidLeaf& leaf) {
    const dvec3 n = glm::transpose(glm::inverse(dmat3(leaf.placed))) * plane.normal *
                    (leaf.inverse ? -1.0 : 1.0);
    const dvec3 on(leaf.placed * dvec4(plane.distance * plane.normal, 1));
    const int axis = major_axis(n);
    Box box = kEverywhere;
    if (n[(axis + 1) % 3] == 0 && n[(axis + 2) % 3] == 0)
        (n[axis] > 0 ? box.hi : box.lo)[axis] = on[axis];
    return box;
}

Box bounds_of_node(const Solid& solid, uint32_t number, const std::vector<Box>& leaves) {
    assert(number < solid.nodes.size());
    const csg::Node& node = solid.nodes[number];
    if (node.kind == csg::Kind::Operand) {
        assert(node.operand < leaves.size());
        return leaves[node.operand];
    }
    const bool all = node.kind == csg::Kind::Intersection || node.kind == csg::Kind::Clip;
    Box box = all ? kEverywhere : Box();
    for (const uint32_t child : node.children) {
        assert(child < number);
        const Box one = bounds_of_node(solid, child, leaves);
        if (all)
            box = box.intersection(one);
        else
            box.add(one);
    }
    return box.empty() ? Box() : box;
}

/// A surface that reaches as far as this counts as endless.
constexpr double kFar = 1e7;

Box without_far_sides(Box box) {
    for (int i = 0; i < 3; ++i) {
        box.lo[i] = box.lo[i] < -0.1 * kFar ? -kInfinity : box.lo[i];
        box.hi[i] = box.hi[i] > 0.1 * kFar ? kInfinity : box.hi[i];
    }
    return box;
}

Box bounds_of_leaf(const SolidLeaf& leaf, int segments) {
    Box box;
    for (const SolidLeaf::Skin& skin : leaf.skins)
        if (const auto* shape = std::get_if<Shape>(&skin.object->shape); shape && shape->box)
            box.add(moved(*shape->box, leaf.placed));
        else if (shape)
            return cut_leaf(leaf, Fineness(segments), {}).box;
        else
            return kEverywhere;
    return box;
}

bool is_finite_box(const Box& box) {
    return is_finite(box.lo) && is_finite(box.hi);
}

/// A solid cut into triangles.
struct Evaluated {
    std::vector<CutLeaf> leaves;
    std::vector<csg::Part> parts;
    Box box;
};

/// Cuts the solid into triangles. Endless operands end where `reach` does.
Evaluated evaluate_within(const Solid& solid, const Fineness& fineness, const Box& reach) {
    Evaluated result;
    csg::Tree tree;
    tree.nodes = solid.nodes;
    for (const SolidLeaf& leaf : solid.leaves) {
        result.leaves.push_back(cut_leaf(leaf, fineness, reach));
        tree.operands.push_back(std::move(result.leaves.back().operand));
    }
    result.parts = csg::evaluate(tree);
    for (const csg::Part& part : result.parts)
        for (const dvec3& corner : part.corners)
            result.box.add(corner);
    for (size_t i = 0; i < tree.operands.size(); ++i)
        result.leaves[i].operand = std::move(tree.operands[i]);
    return result;
}

/// Returns the leaf's shape where it is a T; null where it is another, or a mesh without triangles.
template <class T>
const T* shape_of(const SolidLeaf& leaf) {
    return leaf.skins.empty() ? nullptr : std::get_if<T>(&leaf.skins[0].object->shape);
}

bool has_field(const Solid& solid) {
    return std::any_of(solid.leaves.begin(), solid.leaves.end(),
                       [](const SolidLeaf& leaf) { return shape_of<EndlessShape>(leaf); });
}

/// Returns the box in which a field without end is drawn. In all of `reach` its cells would be as
/// large as the scene.
Box field_reach(const Solid& solid, const Box& reach) {
    constexpr double kFieldReach = 4 / kPlaneReach;
    Box bounds;
    for (const SolidLeaf& leaf : solid.leaves)
        if (!leaf.bounds.empty())
            bounds.add(leaf.bounds);
    if (!bounds.empty()) // POV-Ray also draws surfaces that it meets outside of bounded_by
        return bounds.padded(0.5 * max_component(bounds.extent()));
    const dvec3 half = kFieldReach * 0.5 * reach.extent();
    return {reach.center() - half, reach.center() + half};
}

/// Returns a box for a solid whose parts' boxes do not bound it. Planes at odd angles may still
/// leave a small solid, so it is cut coarsely to see where it is. An endless one ends with `reach`.
Box found_bounds(const Solid& solid, const Box& box, Box reach) {
    if (has_field(solid))
        reach = field_reach(solid, reach);
    const Box largest = box.intersection(reach);
    if (largest.empty())
        return largest;
    const Box found = evaluate_within(solid, Fineness(has_field(solid) ? 48 : 8), largest).box;
    const dvec3 quarter = 0.25 * reach.extent();
    const Box middle{reach.center() - quarter, reach.center() + quarter};
    if (found.empty() || !middle.contains(found.lo) || !middle.contains(found.hi))
        return largest;
    return found.padded(0.1 * glm::length(found.extent()));
}

/// Returns a key that is the same for solids whose trees and shapes are the same, placed alike.
std::string key_of(const Solid& solid) {
    std::string key;
    const auto add = [&key](const auto& value) {
        key.append(reinterpret_cast<const char*>(&value), sizeof value);
    };
    for (const csg::Node& node : solid.nodes) {
        add(node.kind);
        add(node.operand);
        add(node.children.size());
        for (const uint32_t child : node.children)
            add(child);
    }
    for (const SolidLeaf& leaf : solid.leaves) {
        add(leaf.placed);
        add(leaf.inverse);
        add(leaf.has_inside);
        add(leaf.skins.size());
        for (const SolidLeaf::Skin& skin : leaf.skins)
            add(skin.object);
    }
    return key;
}

/// Returns the normal, of any length, that a triangle before cutting has at one of its points; 0
/// where it has no normals of its own.
dvec3 normal_at(const CutLeaf& leaf, uint32_t triangle, const dvec3& p) {
    const auto& t = leaf.operand.triangles[triangle];
    const auto& n = leaf.normals[triangle];
    const dvec3 flat = glm::cross(t[1] - t[0], t[2] - t[0]);
    const double square = glm::dot(flat, flat);
    if ((n[0] == dvec3(0) && n[1] == dvec3(0) && n[2] == dvec3(0)) || !(square > 0))
        return dvec3(0);
    dvec3 sum(0);
    for (size_t i = 0; i < 3; ++i) {
        const dvec3 &a = t[(i + 1) % 3], &b = t[(i + 2) % 3];
        const double weight = glm::dot(glm::cross(a - p, b - p), flat) / square;
        sum += std::clamp(weight, 0.0, 1.0) * (n[i] == dvec3(0) ? flat / std::sqrt(square) : n[i]);
    }
    return sum;
}

} // namespace

/// Returns whether the union has more than one part.
static bool has_several_parts(const Object& object) {
    return object.children.size() > 1 || (object.kind == "union" && object.children.size() == 1 &&
                                          has_several_parts(*object.children[0]));
}

bool is_solid(const Object& object) {
    return std::holds_alternative<EndlessShape>(object.shape) || object.kind == "difference" ||
           object.kind == "intersection" || object.kind == "merge" || !object.clips.empty() ||
           (object.kind == "union" && object.turned && has_several_parts(object));
}

csg::Kind kind_of(const Object& object, bool inverse, bool turned) {
    const bool all = object.kind == "difference" || object.kind == "intersection";
    if (all == inverse)
        return object.kind == "merge" || turned ? csg::Kind::Merge : csg::Kind::Union;
    return csg::Kind::Intersection;
}

std::vector<SolidPart> evaluate(const Solid& solid, int segments, const Box& reach) {
    Box box = bounds_of(solid, segments);
    if (box.empty())
        return {};
    Fineness fineness(segments);
    if (!is_finite_box(box)) {
        box = found_bounds(solid, box, reach);
        fineness.cells *= 3; // endless surfaces often have thin arms
    }
    if (box.empty())
        return {};
    Evaluated cut = evaluate_within(solid, fineness, box);
    std::vector<uint32_t> first; // the number of each leaf's first skin
    uint32_t skins = 0;
    for (const SolidLeaf& leaf : solid.leaves) {
        first.push_back(skins);
        skins += uint32_t(leaf.skins.size());
    }
    std::map<uint32_t, Facets> by_skin;
    for (const csg::Part& part : cut.parts) {
        assert(part.operand < cut.leaves.size());
        const CutLeaf& leaf = cut.leaves[part.operand];
        assert(part.triangle < leaf.skins.size());
        Facets& facets = by_skin[first[part.operand] + leaf.skins[part.triangle]];
        for (const dvec3& corner : part.corners) {
            const dvec3 n = normal_at(leaf, part.triangle, corner);
            facets.corners.push_back({corner, part.turned ? -n : n});
            facets.smooth = facets.smooth || n != dvec3(0);
        }
    }
    std::vector<SolidPart> parts;
    for (auto& [skin, facets] : by_skin)
        parts.push_back({skin, std::move(facets)});
    return parts;
}

Cover cover_of(const Solid& solid, uint32_t skin) {
    size_t leaf = 0;
    for (; skin >= solid.leaves[leaf].skins.size(); ++leaf) {
        assert(leaf + 1 < solid.leaves.size());
        skin -= uint32_t(solid.leaves[leaf].skins.size());
    }
    return solid.leaves[leaf].skins[skin].cover;
}

std::vector<std::vector<uint32_t>> alike(const std::vector<Solid>& solids) {
    std::map<std::string, std::vector<uint32_t>> groups;
    std::vector<std::vector<uint32_t>> all;
    for (uint32_t i = 0; i < solids.size(); ++i)
        groups[key_of(solids[i])].push_back(i);
    for (auto& [key, group] : groups)
        if (group.size() == 1 || is_finite_box(bounds_of(solids[group[0]], 8)))
            all.push_back(std::move(group));
        else
            for (const uint32_t i : group)
                all.push_back({i});
    std::sort(all.begin(), all.end());
    return all;
}

Box bounds_of(const Solid& solid, int segments) {
    assert(!solid.nodes.empty());
    std::vector<Box> boxes;
    bool is_open = false; // an endless shape may be smaller within a box around the whole
    for (const SolidLeaf& leaf : solid.leaves) {
        if (const auto* plane = shape_of<PlaneShape>(leaf))
            boxes.push_back(bounds_of_plane(*plane, leaf));
        else
            boxes.push_back(leaf.inverse ? kEverywhere : bounds_of_leaf(leaf, segments));
        is_open = is_open || (shape_of<EndlessShape>(leaf) && !leaf.inverse);
    }
    const uint32_t root = uint32_t(solid.nodes.size() - 1);
    Box whole = bounds_of_node(solid, root, boxes);
    for (int round = 0; is_open && !whole.empty() && round < 4; ++round) {
        const Box asked = whole.intersection(Box{dvec3(0), dvec3(0)}.padded(kFar));
        for (size_t i = 0; i < solid.leaves.size(); ++i) {
            const SolidLeaf& leaf = solid.leaves[i];
            if (const auto* endless = shape_of<EndlessShape>(leaf); endless && !leaf.inverse)
                boxes[i] = without_far_sides(
                    moved(endless->bounds(moved(asked, glm::inverse(leaf.placed))), leaf.placed));
        }
        whole = bounds_of_node(solid, root, boxes);
    }
    return whole;
}

double triangles_of(const Solid& solid, int segments) {
    double sum = 0;
    for (const SolidLeaf& leaf : solid.leaves)
        for (const SolidLeaf::Skin& skin : leaf.skins)
            if (const Shape* shape = std::get_if<Shape>(&skin.object->shape))
                sum += shape->triangles(segments);
            else if (std::holds_alternative<EndlessShape>(skin.object->shape))
                sum += 4.0 * segments * segments;
    return sum;
}

} // namespace ovc::pov

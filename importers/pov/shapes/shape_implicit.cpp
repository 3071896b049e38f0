// SPDX-License-Identifier: Apache-2.0
// Reads implicit shapes: blob, quadric, cubic, quartic, poly and isosurface.
#include "importers/csg/csg.h"
#include "importers/pov/parse/blended_texture.h"
#include "importers/pov/parse/parse_object.h"
#include "importers/pov/parse/texture.h"
#include "importers/pov/shapes/implicit.h"
#include "importers/pov/shapes/polynomial.h"
#include "importers/pov/shapes/shape.h"
#include "importers/pov/values/function.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <mutex>

namespace ovc::pov {

namespace {

/// A surface net has about two triangles for each cell that the surface crosses.
constexpr double kPerSquare = 4;

/// Returns a shape that keeps its triangles, because it is cut to be measured and to be drawn.
Shape kept(const Box& box, SharedFunction<void(int segments, bool open, Facets& out)> cut) {
    struct Kept {
        std::mutex mutex;
        int segments = 0;
        bool open = false;
        Facets facets;
    };
    Shape shape;
    shape.per_square = kPerSquare;
    shape.box = box;
    shape.cut = [store = std::make_unique<Kept>(), cut = std::move(cut)](int segments, bool open,
                                                                         Facets& out) {
        const std::lock_guard lock(store->mutex);
        if (store->segments != segments || store->open != open) {
            store->facets = {};
            cut(segments, open, store->facets);
            store->segments = segments;
            store->open = open;
        }
        out.corners.insert(out.corners.end(), store->facets.corners.begin(),
                           store->facets.corners.end());
        out.smooth = true;
    };
    return shape;
}

/// A part of a blob. Its field is strength (1 - (d / radius)^2)^2 at the distance d from the line
/// segment a b.
struct Component {
    dvec3 a, b;
    double radius, strength;
    dmat4 to_own{1};
    Box box;

    double operator()(const dvec3& world) const {
        if (!box.contains(world))
            return 0;
        const dvec3 p(to_own * dvec4(world, 1));
        const dvec3 way = b - a;
        const double square = glm::dot(way, way);
        const double along = square > 0 ? std::clamp(glm::dot(p - a, way) / square, 0.0, 1.0) : 0.0;
        const dvec3 off = p - a - along * way;
        const double rest = 1 - glm::dot(off, off) / (radius * radius);
        return rest > 0 ? strength * rest * rest : 0;
    }
};

using Components = std::vector<Component>;

std::function<double(const dvec3&)> blob_value(Components parts, double threshold) {
    return [parts = std::move(parts), threshold](const dvec3& p) {
        double sum = 0;
        for (const Component& part : parts)
            sum += part(p);
        return threshold - sum;
    };
}

/// Returns the formula max(0, 1 - (x^2 + y^2 + dz^2))^2, with the distance dz of z from [0,
/// length].
ProgramPtr round_field() {
    using FormulaOp = FormulaStep::Kind;
    ProgramBuilder square;
    square.add(FormulaOp::Argument, 0);
    square.add(FormulaOp::Argument, 0);
    square.add(FormulaOp::Multiply);
    const ProgramPtr squared = square.take();
    ProgramBuilder field;
    field.constant(1);
    for (uint32_t axis = 0; axis < 3; ++axis) {
        field.add(FormulaOp::Argument, axis);
        if (axis == 2) {
            field.add(FormulaOp::Argument, 2);
            field.constant(0);
            field.add(FormulaOp::Builtin, builtin("max"), 2);
            field.add(FormulaOp::Argument, 3);
            field.add(FormulaOp::Builtin, builtin("min"), 2);
            field.add(FormulaOp::Subtract);
        }
        field.call(squared, 1);
        field.add(FormulaOp::Subtract);
    }
    field.constant(0);
    field.add(FormulaOp::Builtin, builtin("max"), 2);
    field.call(squared, 1);
    return field.take();
}

/// Adds the field of a part at the formula's x, y and z, but not below 0.
void add_field(const Component& part, const ProgramPtr& round, ProgramBuilder& to) {
    using FormulaOp = FormulaStep::Kind;
    const dvec3 way = part.b - part.a;
    const double length = glm::length(way);
    const dvec3 z = length > 0 ? way / length : dvec3(0, 0, 1);
    const dvec3 x =
        glm::normalize(glm::cross(z, std::abs(z.x) < 0.7 ? dvec3(1, 0, 0) : dvec3(0, 1, 0)));
    const dvec3 y = glm::cross(z, x);
    for (const dvec3& axis : {x, y, z}) {
        const dvec4 row =
            glm::transpose(part.to_own) * dvec4(axis, -glm::dot(axis, part.a)) / part.radius;
        to.constant(row.w);
        for (uint32_t i = 0; i < 3; ++i) {
            to.constant(row[int(i)]);
            to.add(FormulaOp::Argument, i);
            to.add(FormulaOp::Multiply);
            to.add(FormulaOp::Add);
        }
    }
    to.constant(length / part.radius);
    to.call(round, 4);
    to.constant(std::max(part.strength, 0.0));
    to.add(FormulaOp::Multiply);
}

/// Returns the texture of a blob whose parts have these, or none.
std::optional<Texture> blob_texture(const Components& parts, const std::vector<Texture>& textures) {
    assert(parts.size() == textures.size());
    const ProgramPtr round = round_field();
    std::vector<WeightedTexture> weighted;
    std::vector<bool> done(parts.size());
    for (size_t first = 0; first < parts.size(); ++first) {
        if (done[first])
            continue;
        ProgramBuilder sum;
        sum.constant(0);
        for (size_t i = first; i < parts.size(); ++i)
            if (!done[i] && same_look(textures[first], textures[i])) {
                done[i] = true;
                add_field(parts[i], round, sum);
                sum.add(FormulaStep::Kind::Add);
            }
        const ProgramPtr weight = sum.take();
        if (!weight)
            return std::nullopt;
        weighted.push_back({textures[first], weight});
    }
    return weighted.empty() ? std::nullopt : blended(weighted, /* on_corners= */ false);
}

/// Gives a blob the textures of its parts, of which those without one take the blob's.
void blend_textures(Reader& reader, const Components& parts,
                    const std::vector<std::optional<Texture>>& own, Object& object) {
    if (std::none_of(own.begin(), own.end(), [](const auto& one) { return one.has_value(); }))
        return;
    Texture rest = object.texture.value_or(reader.defaults);
    if (object.texture)
        place(rest, glm::inverse(object.placed));
    std::vector<Texture> all;
    for (const std::optional<Texture>& one : own)
        all.push_back(one.value_or(rest));
    object.texture = blob_texture(parts, all);
    if (object.texture) {
        place(*object.texture, object.placed);
        return;
    }
    object.texture = all.front();
    place(*object.texture, object.placed);
    reader.omit("blob texture", object.place,
                "a blob of that many parts has the texture of its first part throughout");
}

/// The field refers to the parts.
Field blob_field(const Components& parts, double threshold) {
    Field field;
    field.value = blob_value(parts, threshold);
    const PartsByPlace by_place(parts, [](const Component& part) { return part.box; });
    field.within = [by_place, threshold](const Box& asked) {
        return blob_value(by_place.near(asked), threshold);
    };
    return field;
}

/// Reads `{ place, radius, strength … }` from behind the word.
Component parse_component(Reader& reader, std::string_view kind, Object& holder) {
    reader.expect('{', kind);
    Component part;
    part.a = part.b = parse_vector(reader);
    reader.take_comma();
    if (kind == "cylinder") {
        part.b = parse_vector(reader);
        reader.take_comma();
    }
    part.radius = std::abs(parse_float(reader));
    reader.take_comma();
    reader.take("strength");
    part.strength = parse_float(reader);
    parse_modifiers(reader, holder);
    return part;
}

void place_component(Component& part, const dmat4& placed) {
    assert(part.radius > 0);
    part.to_own = glm::inverse(placed);
    for (const dvec3& end : {part.a, part.b})
        for (int i = 0; i < 8; ++i)
            part.box.add(dvec3(
                placed *
                dvec4(end + part.radius * dvec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1),
                      1)));
}

/// Returns how many cells make the smallest part round, but at most 256, which bounds the memory.
int cells_of(const Components& parts, const Box& box, int segments) {
    assert(!box.empty());
    double smallest = max_component(box.extent());
    for (const Component& part : parts)
        if (part.strength > 0)
            smallest = std::min(smallest, max_component(part.box.extent()));
    const double wanted = 0.25 * segments * max_component(box.extent()) / smallest;
    constexpr double kMax = 256;
    const double min_cells = std::min<double>(field_cells(segments), kMax);
    return wanted > min_cells ? int(std::min(wanted, kMax)) : int(min_cells);
}

std::vector<double> parse_factors(Reader& reader, int order) {
    reader.expect('<', "poly");
    std::vector<double> factors;
    do
        factors.push_back(parse_float(reader));
    while (reader.take(',') || !reader.peek().is('>'));
    reader.expect('>', "poly");
    if (factors.size() != factors_of(order))
        reader.fail(reader.place(), fmt::format("found {} factors, expected {} for the order {}",
                                                factors.size(), factors_of(order), order));
    return factors;
}

/// Returns the box in the space whose coordinates are asinh of these, where the length of a unit
/// falls with the distance from the origin.
Box compressed(const Box& box) {
    const auto each = [](const dvec3& p) {
        return dvec3(std::asinh(p.x), std::asinh(p.y), std::asinh(p.z));
    };
    return {each(box.lo), each(box.hi)};
}

dvec3 expanded(const dvec3& p) {
    return {std::sinh(p.x), std::sinh(p.y), std::sinh(p.z)};
}

/// Returns the field of a polynomial of points that `to_point`, which grows along each axis, makes
/// of places. In a box without a part of the surface one value stands for all.
template <class ToPoint>
Field polynomial_field(const Polynomial& polynomial, const ToPoint& to_point) {
    Field field;
    field.value = [&polynomial, to_point](const dvec3& p) { return polynomial(to_point(p)); };
    field.within = [&polynomial, to_point, value = field.value](const Box& box) {
        const Range range = polynomial.range_over({to_point(box.lo), to_point(box.hi)});
        using Value = decltype(value);
        if (range.lo > 0)
            return Value([](const dvec3&) { return 1.0; });
        return range.hi < 0 ? Value([](const dvec3&) { return -1.0; }) : value;
    };
    return field;
}

/// Cuts an endless polynomial in a large box so that cells grow with the distance from the origin,
/// near which formulas usually bend. Cells of one size would be larger than all that.
size_t cut_graded(const Polynomial& polynomial, const Box& box, int cells, Facets& out) {
    const size_t before = out.corners.size();
    const Field field = polynomial_field(polynomial, &expanded);
    // Far away, where endless surfaces are cut three times as finely, nobody sees it.
    const size_t shown = cut_field(field, compressed(box), std::max(cells / 3, 1), out);
    for (size_t i = before; i < out.corners.size(); ++i) {
        Corner& corner = out.corners[i];
        const dvec3& p = corner.position;
        // A gradient goes back by the derivatives of the map.
        corner.normal /= dvec3(std::cosh(p.x), std::cosh(p.y), std::cosh(p.z));
        corner.position = expanded(p);
    }
    return shown;
}

/// A box whose longest side is longer is cut with graded cells.
constexpr double kLargestEven = 100;

void finish_polynomial(Reader& reader, Object& object, Polynomial polynomial) {
    EndlessShape shape;
    shape.bounds = [polynomial](const Box& box) { return tightened(polynomial, box); };
    shape.cut = [polynomial](const Box& box, int cells, Facets& out) {
        const Box tight = tightened(polynomial, box);
        if (tight.empty())
            return size_t(0);
        out.smooth = true;
        if (max_component(tight.extent()) > kLargestEven)
            return cut_graded(polynomial, tight, cells, out);
        const double margin = 0.02 * max_component(tight.extent());
        return cut_field(polynomial_field(polynomial, [](const dvec3& p) { return p; }),
                         tight.padded(margin), cells, out);
    };
    object.shape = std::move(shape);
    parse_modifiers(reader, object);
}

csg::Operand operand_of(const Facets& facets) {
    csg::Operand operand;
    for (size_t t = 0; t + 2 < facets.corners.size(); t += 3)
        operand.triangles.push_back({facets.corners[t].position, facets.corners[t + 1].position,
                                     facets.corners[t + 2].position});
    return operand;
}

/// Adds the part of the field's surface in the container and, unless `open`, the part of the
/// container's surface in the field.
void cut_contained(const Field& field, const Container& container, int segments, bool open,
                   Facets& out) {
    Facets inside, around;
    const double margin = 0.01 * max_component(container.box.extent());
    cut_field(field, container.box.padded(margin), segments, inside);
    container.shape.cut(segments, false, around);
    csg::Tree tree;
    tree.operands = {operand_of(inside), operand_of(around)};
    tree.nodes = {{csg::Kind::Operand, 0, {}},
                  {csg::Kind::Operand, 1, {}},
                  {csg::Kind::Intersection, 0, {0, 1}}};
    for (const csg::Part& part : csg::evaluate(tree)) {
        if (open && part.operand == 1)
            continue;
        const Facets& source = part.operand == 0 ? inside : around;
        assert(3 * size_t(part.triangle) + 2 < source.corners.size());
        const Corner* whole = &source.corners[3 * size_t(part.triangle)];
        const dvec3 flat = glm::cross(whole[1].position - whole[0].position,
                                      whole[2].position - whole[0].position);
        for (const dvec3& p : part.corners) {
            dvec3 normal(0);
            for (size_t i = 0; i < 3; ++i) {
                const dvec3 &a = whole[(i + 1) % 3].position, &b = whole[(i + 2) % 3].position;
                normal +=
                    std::clamp(glm::dot(glm::cross(a - p, b - p), flat) / glm::dot(flat, flat), 0.0,
                               1.0) *
                    whole[i].normal;
            }
            out.corners.push_back({p, normal});
        }
    }
    out.smooth = true;
}

} // namespace

Container parse_container(Reader& reader) {
    reader.expect('{', "contained_by");
    Container container;
    const bool is_box = reader.take("box");
    if (!is_box && !reader.take("sphere"))
        reader.fail_here("a box or a sphere");
    reader.expect('{', is_box ? "box" : "sphere");
    container.shape = is_box ? parse_box(reader) : parse_sphere(reader);
    reader.expect('}', "contained_by");
    reader.expect('}', "contained_by");
    Facets measured;
    container.shape.cut(8, false, measured);
    for (const Corner& corner : measured.corners)
        container.box.add(corner.position);
    return container;
}

void parse_blob(Reader& reader, Object& object) {
    Components parts;
    std::vector<std::optional<Texture>> textures;
    double threshold = 1;
    Box box;
    for (;;) {
        Object holder;
        Component part;
        if (reader.take("threshold")) {
            threshold = parse_float(reader);
            continue;
        }
        if (reader.take("sphere"))
            part = parse_component(reader, "sphere", holder);
        else if (reader.take("cylinder"))
            part = parse_component(reader, "cylinder", holder);
        else if (reader.take("component")) {
            part.strength = parse_float(reader);
            reader.take_comma();
            part.radius = std::abs(parse_float(reader));
            reader.take_comma();
            part.a = part.b = parse_vector(reader);
        } else if (!reader.take(','))
            break;
        else
            continue;
        if (!(part.radius > 0))
            continue;
        textures.push_back(holder.texture);
        place_component(part, holder.placed);
        if (part.strength > 0)
            box.add(part.box);
        parts.push_back(part);
    }
    object.shape = kept(box, [=](int segments, bool, Facets& out) {
        if (!box.empty())
            cut_field(blob_field(parts, threshold), box, cells_of(parts, box, segments), out);
    });
    parse_modifiers(reader, object);
    blend_textures(reader, parts, textures, object);
}

void parse_quadric(Reader& reader, Object& object) {
    dvec3 rows[3];
    for (dvec3& row : rows) {
        row = parse_vector(reader);
        reader.take_comma();
    }
    const double rest = parse_float(reader);
    Polynomial polynomial;
    const int powers[10][3] = {{2, 0, 0}, {0, 2, 0}, {0, 0, 2}, {1, 1, 0}, {1, 0, 1},
                               {0, 1, 1}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}};
    for (int i = 0; i < 10; ++i)
        if (const double factor = i < 9 ? rows[i / 3][i % 3] : rest; factor != 0)
            polynomial.add({factor, {powers[i][0], powers[i][1], powers[i][2]}});
    finish_polynomial(reader, object, std::move(polynomial));
}

/// Reads cubic { <…> }, quartic { <…> } and poly { order, <…> }.
void parse_polynomial(Reader& reader, Object& object) {
    int order = object.kind == "cubic" ? 3 : 4;
    if (object.kind == "poly") {
        order = parse_int(reader, 2, kMaxOrder, "the order of a poly");
        reader.take_comma();
    }
    finish_polynomial(reader, object, polynomial_of(order, parse_factors(reader, order)));
}

void parse_isosurface(Reader& reader, Object& object) {
    std::optional<Function> function;
    std::optional<Container> container;
    double threshold = 0;
    const Token name = reader.peek();
    for (;;) {
        if (reader.take("function"))
            function = parse_function(reader);
        else if (reader.take("contained_by"))
            container = parse_container(reader);
        else if (reader.take("threshold"))
            threshold = parse_float(reader);
        else if (reader.take("accuracy") || reader.take("max_gradient") || reader.take("max_trace"))
            parse_float(reader);
        else if (reader.take("open"))
            object.open = parse_flag(reader);
        else if (reader.take("evaluate"))
            for (int i = 0; i < 3; ++i) {
                parse_float(reader);
                reader.take_comma();
            }
        else if (!reader.take("all_intersections") && !reader.take(','))
            break;
    }
    if (!function)
        reader.fail(object.place, "found an isosurface without a function");
    if (!container) {
        Facets cube;
        container.emplace();
        for (int axis = 0; axis < 3; ++axis)
            for (const double side : {-1.0, 1.0}) {
                dvec3 u(0), v(0), n(0);
                n[axis] = side;
                u[(axis + 1) % 3] = side;
                v[(axis + 2) % 3] = 1;
                cube.add_quad(n - u - v, n + u - v, n + u + v, n - u + v);
            }
        container->shape.cut = [cube](int, bool, Facets& out) { out = cube; };
        container->box = {dvec3(-1), dvec3(1)};
    }
    if (!function->refused.empty())
        object.refused = function->refused;
    const Field field{[&reader, function = *function, threshold, name](const dvec3& p) {
                          const double at[3] = {p.x, p.y, p.z};
                          return call(reader, name, function, at).v[0] - threshold;
                      },
                      {}};
    object.shape =
        kept(container->box, [field, around = *container](int segments, bool open, Facets& out) {
            cut_contained(field, around, segments, open, out);
        });
    parse_modifiers(reader, object);
}

} // namespace ovc::pov

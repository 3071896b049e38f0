// SPDX-License-Identifier: Apache-2.0
#include "importers/pov/values/builtin_object.h"

#include "importers/pov/shapes/bounds.h"
#include "importers/pov/trace.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace ovc::pov {

namespace {

/// Objects that a scene traced are kept for its next rays, up to these numbers.
constexpr uint64_t kMaxKept = 10'000'000; // triangles of all objects
constexpr size_t kMaxTargets = 1000;      // objects
/// Cutting so many triangles takes about as long as reading a word.
constexpr uint64_t kTrianglesAWord = 16;

/// Finding the box around one or two shapes takes about as long as reading so many words.
constexpr uint64_t kWordsABox = 200;

ObjectPtr parse_object_name(Reader& reader) {
    const Token name = reader.peek();
    const auto object = take_named<ObjectPtr>(reader);
    if (!object)
        reader.fail(name.place,
                    fmt::format("found {}, expected the name of an object", found(name)));
    return *object;
}

/// Returns the object ready for rays, which is valid until the next call.
const TraceTarget& target_of(Reader& reader, const ObjectPtr& object) {
    if (const auto at = reader.targets.find(object); at != reader.targets.end())
        return *at->second;
    auto target = std::make_unique<const TraceTarget>(
        cut_object(*object, std::min(kMaxKept, reader.limits.triangles)));
    reader.spend(target->triangle_count() / kTrianglesAWord);
    reader.grow(3 * target->triangle_count() * sizeof(Corner));
    uint64_t kept = target->triangle_count();
    for (const auto& [other, cut] : reader.targets)
        kept += cut->triangle_count();
    if (kept > kMaxKept || reader.targets.size() >= kMaxTargets)
        reader.targets.clear();
    std::unique_ptr<const TraceTarget>& owned = reader.targets[object];
    owned = std::move(target);
    return *owned;
}

} // namespace

const Region& region_of(Reader& reader, const ObjectPtr& object) {
    return target_of(reader, object).region();
}

Number parse_extent(Reader& reader, const Token& token) {
    assert(token.is("min_extent") || token.is("max_extent"));
    reader.expect('(', token.name->text);
    const ObjectPtr object = parse_object_name(reader);
    reader.expect(')', token.name->text);
    reader.spend(kWordsABox);
    const Box box = bounds_of(*object, reader.limits.triangles);
    return Number::of(token.is("min_extent") ? box.lo : box.hi);
}

Number parse_inside(Reader& reader, const Token& token) {
    reader.expect('(', token.name->text);
    const ObjectPtr object = parse_object_name(reader);
    reader.take_comma();
    const dvec3 point = parse_vector(reader);
    reader.expect(')', token.name->text);
    return Number::of(target_of(reader, object).region().contains(point));
}

Number parse_trace(Reader& reader, const Token& token) {
    reader.expect('(', token.name->text);
    const ObjectPtr object = parse_object_name(reader);
    reader.take_comma();
    const dvec3 from = parse_vector(reader);
    reader.take_comma();
    const dvec3 way = parse_vector(reader);
    Name* normal = nullptr;
    if (reader.take(',')) {
        const Token variable = reader.next();
        if (variable.kind != TokenKind::Name || variable.name->is_keyword)
            reader.fail(variable.place, fmt::format("found {}, expected a variable for the normal",
                                                    found(variable)));
        normal = variable.name;
    }
    reader.expect(')', token.name->text);

    Meeting meeting;
    const double length = glm::length(way);
    if (length > 0 && std::isfinite(length))
        meeting = target_of(reader, object).first_meeting(from, way / length);
    const bool any = std::isfinite(meeting.distance);
    if (normal) {
        Slot* slot = reader.find(normal);
        slot = slot ? slot : &reader.declare(normal, /* local= */ true);
        const double size = glm::length(meeting.normal);
        slot->value = Number::of(any && size > 0 ? meeting.normal / size : dvec3(0));
    }
    return Number::of(any ? from + meeting.distance / length * way : dvec3(0));
}

} // namespace ovc::pov
